//! What a study varies.

use crate::registry::{NO_REDUCTION, Registry};
use fem_core::plugin::{Built, Kind, Params, PluginInfo};
use fem_core::time::StepLimit;

/// A part of the settings that is varied while the others stay as the scene has them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Every reduction on offer, with several numbers of unknowns.
    Reduction,
    /// Every integrator on offer, with several steps.
    Integrator,
}

/// One variation of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// What it varies.
    pub axis: Axis,
    /// Its name in tables.
    pub label: String,
    /// The keys that it lays over the scene, TOML.
    pub keys: String,
    /// True where the step is to be the longest that is stable, which takes a look at the model.
    pub at_limit: bool,
}

impl Setting {
    /// Its keys with another step, s.
    pub(super) fn keys_with_step(&self, step: f64) -> String {
        let others: String = self.keys.lines().filter(|l| !l.starts_with(STEP)).map(|l| format!("{l}\n")).collect();
        format!("{others}{STEP} = \"{step:e} s\"\n")
    }
}

const STEP: &str = "march.step";

/// Parameters by which reductions call their size.
const SIZES: [&str; 3] = ["vectors", "modes", "governors"];

/// Sizes that are tried.
const LADDER: [usize; 4] = [20, 40, 80, 160];

/// Reductions that have another way: parameter and value of it.
const OTHER_WAYS: [(&str, &str, &str); 3] =
    [("guyan", "select", "ratio"), ("irs", "select", "ratio"), ("ritz", "space", "krylov")];

/// Steps that are tried, over that of the scene.
const STEPS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

impl Axis {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Reduction, Self::Integrator];

    /// Its name in tables and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reduction => "reduction",
            Self::Integrator => "integrator",
        }
    }

    /// Its settings for a scene whose step is `step` (s).
    pub fn settings(self, registry: &Registry, step: f64) -> Vec<Setting> {
        match self {
            Self::Reduction => reductions(registry),
            Self::Integrator => integrators(registry, step),
        }
    }
}

/// Keys of the full model at `step`, s.
pub fn full(step: f64) -> String {
    format!("reduction = {{ method = \"{NO_REDUCTION}\" }}\n{}", marched("newmark", step))
}

/// Keys of a march.
fn marched(integrator: &str, step: f64) -> String {
    format!("march.integrator = \"{integrator}\"\n{STEP} = \"{step:e} s\"\n")
}

fn reductions(registry: &Registry) -> Vec<Setting> {
    let setting = |label: String, keys: String| Setting { axis: Axis::Reduction, label, keys, at_limit: false };
    let mut all = vec![setting(NO_REDUCTION.into(), format!("reduction = {{ method = \"{NO_REDUCTION}\" }}"))];
    for info in registry.list(Kind::Reduction) {
        let name = info.name;
        let size = info.params.iter().map(|p| p.name).find(|param| SIZES.contains(param));
        let other = OTHER_WAYS.iter().find(|way| way.0 == name);
        for way in [None].into_iter().chain(other.map(Some)) {
            let label = way.map_or(name.to_owned(), |(_, _, value)| format!("{name} {value}"));
            let choice = way.map_or(String::new(), |(_, key, value)| format!(", {key} = \"{value}\""));
            match size {
                None => all.push(setting(label, format!("reduction = {{ method = \"{name}\"{choice} }}"))),
                Some(size) => all.extend(LADDER.map(|count| {
                    let keys = format!("reduction = {{ method = \"{name}\", {size} = {count}{choice} }}");
                    setting(format!("{label} {count}"), keys)
                })),
            }
        }
    }
    all
}

fn integrators(registry: &Registry, step: f64) -> Vec<Setting> {
    let each = |info: &PluginInfo| {
        let name = info.name;
        let setting = move |label: String, step, at_limit| Setting {
            axis: Axis::Integrator,
            label: format!("{name} {label}"),
            keys: marched(name, step),
            at_limit,
        };
        let limited = match registry.build(Kind::Integrator, name, &Params::default()) {
            Ok(Built::Integrator(integrator)) => integrator.limit() != StepLimit::None,
            _ => false,
        };
        let steps = STEPS.map(|share| setting(format!("{:.4} us", step * share * 1e6), step * share, false));
        steps.into_iter().chain(limited.then(|| setting("at its limit".into(), step, true)))
    };
    registry.list(Kind::Integrator).flat_map(each).collect()
}
