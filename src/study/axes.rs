//! What a study varies.

use crate::error::Error;
use crate::model::{Model, Plan};
use crate::registry::{NO_REDUCTION, Registry};
use fem_core::mesh::PlaneMesh;
use fem_core::plate::ZDerivatives;
use fem_core::plugin::{
    Built, Kind, ParamDefault, ParamForm, ParamInfo, Params, Plugin as _, PluginInfo, Role, unknown_key,
};
use fem_core::time::StepLimit;
use fem_dynamics::reduce::Ritz;
use fem_io::scene::{Analysis, ContactLoad, MarchSpec, MeshSource, Scene, Setting, Window};

/// A part of the settings that is varied while the others stay as the scene has them.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyAxis {
    /// Its name in tables and on the command line.
    pub name: String,
    /// What its levels are.
    pub kind: AxisKind,
    /// The levels; those of a ladder from coarse to fine.
    pub levels: Vec<Level>,
}

/// What the levels of an axis are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisKind {
    /// Finer and finer: each halves a length or a time, or doubles a number.
    Ladder,
    /// Other ways to the same answer.
    Ways,
    /// Other problems: what they change is not an error.
    Problems,
}

/// A level of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Its name in tables.
    pub label: String,
    /// What it sets in the scene; empty for the scene's own level.
    pub setting: Setting,
    /// Whether to take the longest stable step, which depends on the model.
    pub at_limit: bool,
}

impl Level {
    fn new<const N: usize>(label: impl Into<String>, keys: [(&str, String); N]) -> Self {
        let setting = keys.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
        Self { label: label.into(), setting, at_limit: false }
    }

    /// The scene itself.
    fn own(label: impl Into<String>) -> Self {
        Self::new(label, [])
    }
}

/// Sizes of reductions that are alternatives.
const LADDER: [usize; 4] = [20, 40, 80, 160];

/// Steps that are tried, over that of the scene.
const STEPS: [f64; 6] = [8.0, 4.0, 2.0, 1.0, 0.5, 0.25];

/// Refinements of the scene's mesh that are tried, and how often one of equal cells is coarsened.
const REFINEMENTS: usize = 3;
const COARSENINGS: usize = 2;

/// Key of the step.
pub(super) const STEP: &str = "march.step";
/// Key of the tolerance that steps are divided to.
const TOLERANCE: &str = "march.tolerance";

/// Names of all axes, in the order in which they are run.
pub const NAMES: [&str; 13] = [
    "mesh",
    "layers",
    "reduction",
    "step",
    "geometry",
    "z-derivatives",
    "quadrature",
    "reductions",
    "integrators",
    "element",
    "mass",
    "contact",
    "window",
];

/// Those of them that are ladders.
pub(super) const LADDERS: [&str; 4] = ["mesh", "layers", "reduction", "step"];

/// Most combinations of levels of all ladders.
const MOST_TOGETHER: f64 = 1e5;

/// The axes of `scene`, whose model is `model`: those of `names`, or else those that its scene asks for, or else all that fit it, and the scene's
/// own. An axis of other ways brings the ladders that they are judged by.
///
/// # Errors
/// A name that no axis has, ladders of too many levels to be combined.
pub fn axes(scene: &Scene, model: &Model, registry: &Registry, names: &[String]) -> Result<Vec<StudyAxis>, Error> {
    let study = &scene.study;
    let own = || study.own.iter().map(|own| own.name.value.as_str());
    let known = || NAMES.into_iter().chain(own());
    if let Some(name) = names.iter().find(|name| known().all(|known| known != name.as_str())) {
        let help = format!("`{name}` {}", unknown_key(name, known()));
        return Err(Error::Axis { name: name.clone(), help });
    }
    if let Some(name) = study.axes.iter().flatten().find(|name| !NAMES.contains(&name.value.as_str())) {
        let help = format!("`{}` {}", name.value, unknown_key(&name.value, known()));
        return Err(scene.source.error_at(&name.place, format!("there is no axis `{}`", name.value), help).into());
    }
    let asked: Vec<&str> = match (names, &study.axes) {
        ([], None) => known().collect(),
        ([], Some(axes)) => axes.iter().map(|name| name.value.as_str()).chain(own()).collect(),
        (names, _) => names.iter().map(String::as_str).collect(),
    };
    let wanted = |name: &str| asked.contains(&name) || asked.iter().any(|axis| judges(axis).contains(&name));
    let mut axes: Vec<StudyAxis> = NAMES
        .into_iter()
        .filter(|name| wanted(name))
        .filter_map(|name| standard(name, scene, model, registry))
        .collect();
    for axis in study.own.iter().filter(|axis| asked.contains(&axis.name.value.as_str())) {
        let label =
            |keys: &Setting| keys.iter().map(|(key, value)| format!("{key} {value}")).collect::<Vec<_>>().join(", ");
        let levels =
            axis.levels.iter().map(|keys| Level { label: label(keys), setting: keys.clone(), at_limit: false });
        let kind = if axis.ladder { AxisKind::Ladder } else { AxisKind::Problems };
        axes.push(StudyAxis { name: axis.name.value.clone(), kind, levels: levels.collect() });
    }
    let ladders = axes.iter().filter(|axis| axis.kind == AxisKind::Ladder);
    let together = ladders.map(|axis| axis.levels.len() as f64).product();
    if together > MOST_TOGETHER { Err(Error::TooManyLevels { together }) } else { Ok(axes) }
}

/// The ladders by whose finest levels the ways of an axis are judged; by the scene as it is, where there are none.
pub(super) fn judges(axis: &str) -> &'static [&'static str] {
    match axis {
        "reductions" => &["reduction", "step"],
        "integrators" => &["step"],
        "geometry" => &["mesh"],
        _ => &[],
    }
}

/// The axis `name` of `scene`, whose model is `model`, if it has at least one level beside the scene's own.
fn standard(name: &str, scene: &Scene, model: &Model, registry: &Registry) -> Option<StudyAxis> {
    let (kind, levels) = match name {
        "mesh" => (AxisKind::Ladder, mesh(scene)),
        "layers" => (AxisKind::Ladder, layers(scene, model)),
        "reduction" => (AxisKind::Ladder, reduction(scene, model, registry)?),
        "step" => (AxisKind::Ladder, steps(scene, model)?),
        "geometry" => (AxisKind::Ways, geometry(scene, &model.plate.plane)),
        "z-derivatives" => (AxisKind::Ways, z_derivatives(scene, model)),
        "quadrature" => (AxisKind::Ways, quadrature(scene, registry)),
        "reductions" => (AxisKind::Ways, scene.impact().map(|_| reductions(registry))?),
        "integrators" => (AxisKind::Ways, integrators(scene, registry)?),
        "element" => (AxisKind::Ways, elements(scene, registry)),
        "mass" => (AxisKind::Ways, mass(scene, registry)),
        "contact" => (AxisKind::Problems, contact(scene)?),
        "window" => (AxisKind::Problems, window(model)),
        _ => return None,
    };
    let varies = levels.iter().any(|level| !level.setting.is_empty());
    varies.then(|| StudyAxis { name: name.to_owned(), kind, levels })
}

fn quoted(text: impl std::fmt::Display) -> String {
    format!("\"{text}\"")
}

/// A whole number of the scene.
fn value(scene: &Scene, key: &str) -> Option<usize> {
    scene.keys.get(key)?.parse().ok()
}

fn mesh(scene: &Scene) -> Vec<Level> {
    let refined = value(scene, "mesh.refine").unwrap_or(0);
    let mut levels = Vec::new();
    if let (MeshSource::Rectangle { cells, .. }, 0) = (&scene.mesh, refined) {
        let coarser = (1..=COARSENINGS).rev().map(|k| 1 << k).filter(|by| cells.iter().all(|n| n % by == 0));
        levels.extend(coarser.map(|by| {
            let [x, y] = cells.map(|n| n / by);
            Level::new(format!("{x} x {y} cells"), [("mesh.cells", format!("[{x}, {y}]"))])
        }));
    }
    let refine = |n: usize| Level::new(format!("refine {n}"), [("mesh.refine", n.to_string())]);
    levels.extend((0..refined).map(refine));
    levels.push(Level::own(if refined == 0 { "as given".to_owned() } else { format!("refine {refined}") }));
    levels.extend((1..=REFINEMENTS).map(|k| refine(refined + k)));
    levels
}

/// The mesh refined without regard to the curves that its boundary follows, or with regard where the scene has none.
fn geometry(scene: &Scene, plane: &PlaneMesh) -> Vec<Level> {
    if plane.curved_turn() == 0.0 {
        return Vec::new();
    }
    let refined = value(scene, "mesh.refine").unwrap_or(0) + 1;
    let other =
        if scene.keys.get("mesh.curves").is_some_and(|kept| kept == "\"straight\"") { "kept" } else { "straight" };
    let keys = [("mesh.refine", refined.to_string()), ("mesh.curves", quoted(other))];
    vec![Level::new(format!("refine {refined}, curves {other}"), keys)]
}

fn layers(scene: &Scene, model: &Model) -> Vec<Level> {
    // Laminates in a list have no single key that divides them anew.
    if model.plate.info().is_shell() || !scene.keys.contains_key("laminate.plies") {
        return Vec::new();
    }
    let (plies, own) = (model.laminate.plies.len(), model.laminate.layers.len());
    let level = |n: usize| Level::new(in_layers(n), [("laminate.layers", n.to_string())]);
    let halved = std::iter::successors(Some(own), |n| Some(n / 2).filter(|n| *n > 0)).skip(1);
    let doubled = std::iter::successors(Some(own), |n| Some((2 * n).min(plies)).filter(|m| m > n)).skip(1);
    let mut levels: Vec<Level> = halved.map(level).collect();
    levels.reverse();
    levels.push(Level::own(in_layers(own)));
    levels.extend(doubled.map(level));
    levels
}

fn in_layers(n: usize) -> String {
    if n == 1 { "1 layer".to_owned() } else { format!("{n} layers") }
}

fn reduction(scene: &Scene, model: &Model, registry: &Registry) -> Option<Vec<Level>> {
    let name = &scene.impact()?.reduction.name.value;
    if name == NO_REDUCTION {
        // What a scene without a reduction would take instead.
        let usual = Ritz::INFO;
        let size = usual.params_of(Role::Size).next()?;
        let level = |n: usize| Level::new(format!("{} {n}", usual.name), reduced(usual.name, Some((size.name, n)), ""));
        return Some(LADDER.map(level).into_iter().chain([Level::own(NO_REDUCTION)]).collect());
    }
    let size = registry.info(Kind::Reduction, name)?.params_of(Role::Size).next()?.name;
    let own = match &model.plan {
        Plan::Impact(impact) => impact.vectors?,
        _ => return None,
    };
    let key = format!("reduction.{size}");
    let level = |n: usize| Level::new(format!("{n} {size}"), [(key.as_str(), n.to_string())]);
    let coarser = [4, 2].map(|by| own / by).into_iter().filter(|n| *n > 0).map(level);
    let finer = [2, 4].map(|by| level(own * by));
    Some(coarser.chain([Level::own(format!("{own} {size}"))]).chain(finer).collect())
}

/// Keys of a reduction.
fn reduced(name: &str, size: Option<(&str, usize)>, choice: &str) -> [(&'static str, String); 1] {
    let size = size.map_or(String::new(), |(key, n)| format!(", {key} = {n}"));
    [("reduction", format!("{{ method = \"{name}\"{size}{choice} }}"))]
}

fn reductions(registry: &Registry) -> Vec<Level> {
    let mut all = vec![Level::new(NO_REDUCTION, reduced(NO_REDUCTION, None, ""))];
    let complete = |info: &&PluginInfo| info.params.iter().all(|row| row.default != ParamDefault::Required);
    for info in registry.list(Kind::Reduction).filter(complete) {
        let name = info.name;
        let size = info.params_of(Role::Size).next().map(|row| row.name);
        let others = info.params_of(Role::Way).flat_map(|row| other_words(row).map(|word| (row.name, word)));
        for way in [None].into_iter().chain(others.map(Some)) {
            let label = way.map_or(name.to_owned(), |(_, word)| format!("{name} {word}"));
            let choice = way.map_or(String::new(), |(key, word)| format!(", {key} = \"{word}\""));
            match size {
                None => all.push(Level::new(label, reduced(name, None, &choice))),
                Some(size) => all.extend(
                    LADDER.map(|n| Level::new(format!("{label} {n}"), reduced(name, Some((size, n)), &choice))),
                ),
            }
        }
    }
    all
}

/// The words of a parameter but its default.
fn other_words(row: &ParamInfo) -> impl Iterator<Item = &'static str> + use<> {
    let (words, default) = match row.form {
        ParamForm::Word(words) => (words, row.default),
        _ => (&[][..], row.default),
    };
    words.iter().map(|(word, _)| *word).filter(move |word| default != ParamDefault::Word(word))
}

pub(super) fn seconds(step: f64) -> String {
    quoted(format!("{step:e} s"))
}

/// Steps; where they are divided to a tolerance, that follows them, so that their parts are longer or shorter as they are.
fn steps(scene: &Scene, model: &Model) -> Option<Vec<Level>> {
    let march = &scene.impact()?.march;
    let Plan::Impact(impact) = &model.plan else { return None };
    let order = impact.integrator.order() as i32;
    let level = |share: &f64| {
        let step = march.step.value * share;
        let tolerance = march.tolerance.map(|tolerance| tolerance * share.powi(order));
        let to = tolerance.map_or(String::new(), |tolerance| format!(" to {tolerance:.0e}"));
        let label = format!("{:.4} us{to}", step * 1e6);
        if *share == 1.0 {
            return Some(Level::own(label));
        }
        let mut level = Level::new(label, [(STEP, seconds(step))]);
        level.setting.extend(tolerance.map(|tolerance| (TOLERANCE.to_owned(), format!("{tolerance:e}"))));
        tolerance.is_none_or(|tolerance| tolerance <= MarchSpec::LOOSEST).then_some(level)
    };
    Some(STEPS.iter().filter_map(level).collect())
}

fn integrators(scene: &Scene, registry: &Registry) -> Option<Vec<Level>> {
    let step = scene.impact()?.march.step.value;
    let each = |name: &'static str| {
        let keys = |step| [("march.integrator", quoted(name)), (STEP, seconds(step))];
        let limited = match registry.build(Kind::Integrator, name, &Params::default()) {
            Ok(Built::Integrator(integrator)) => integrator.limit() != StepLimit::None,
            _ => false,
        };
        let steps = [4.0, 2.0, 1.0, 0.5].map(|share| step * share);
        let each = steps.map(|step| Level::new(format!("{name} {:.4} us", step * 1e6), keys(step)));
        let longest = Level { at_limit: true, ..Level::new(format!("{name} at its limit"), keys(step)) };
        each.into_iter().chain(limited.then_some(longest))
    };
    Some(registry.list(Kind::Integrator).flat_map(|info| each(info.name)).collect())
}

fn z_derivatives(scene: &Scene, model: &Model) -> Vec<Level> {
    let other = match scene.z_derivatives.value {
        ZDerivatives::Shared => "layer-wise",
        ZDerivatives::LayerWise => "shared",
    };
    let matter = model.plate.layers() > 1 && model.plate.info().dofs.iter().any(|dof| dof.m() == 3);
    if matter { vec![Level::new(other, [("element.z_derivatives", quoted(other))])] } else { Vec::new() }
}

fn quadrature(scene: &Scene, registry: &Registry) -> Vec<Level> {
    const ORDERS: [usize; 4] = [3, 4, 5, 6];
    let info = registry.info(Kind::Element, &scene.element.name.value);
    let Some(row) = info.and_then(|info| info.params_of(Role::Quadrature).next()) else { return Vec::new() };
    let key = format!("element.{}", row.name);
    ORDERS.map(|n| Level::new(format!("{n} Gauss points"), [(key.as_str(), n.to_string())])).to_vec()
}

fn mass(scene: &Scene, registry: &Registry) -> Vec<Level> {
    let inert = !matches!(scene.analysis, Analysis::Static(_));
    let info = registry.info(Kind::Element, &scene.element.name.value).filter(|_| inert);
    let Some(row) = info.and_then(|info| info.params_of(Role::Inertia).next()) else { return Vec::new() };
    let ParamForm::Word(words) = row.form else { return Vec::new() };
    let key = format!("element.{}", row.name);
    let own = scene.keys.get(&key);
    let differs = |word: &&'static str| own.map_or(row.default != ParamDefault::Word(word), |own| *own != quoted(word));
    let others = words.iter().map(|(word, _)| *word).filter(differs);
    others.map(|word| Level::new(word, [(key.as_str(), quoted(word))])).collect()
}

fn elements(scene: &Scene, registry: &Registry) -> Vec<Level> {
    let others = registry.list(Kind::Element).map(|info| info.name).filter(|name| *name != scene.element.name.value);
    others
        .map(|name| {
            let mut level = Level::new(name, [("element.kind", quoted(name))]);
            let built = registry.build(Kind::Element, name, &Params::default());
            // A shell has one layer of cells.
            if let Ok(Built::Element(element)) = built
                && element.info().is_shell()
            {
                level.setting.insert("laminate.layers".into(), "1".into());
            }
            level
        })
        .collect()
}

fn contact(scene: &Scene) -> Option<Vec<Level>> {
    let node = Level::new("node", [("impactor.load", quoted("node"))]);
    let side = |side: f64| {
        Level::new(format!("square {:.3} mm", side * 1e3), [("impactor.patch_side", quoted(format!("{side:e} m")))])
    };
    let radius = |radius: f64| {
        Level::new(
            format!("radius {:.3} mm", radius * 1e3),
            [("impactor.patch_radius", quoted(format!("{radius:e} m")))],
        )
    };
    Some(match scene.impact()?.impactors.first()?.load.value {
        ContactLoad::Node => [1e-3, 2e-3, 4e-3].map(radius).to_vec(),
        ContactLoad::Patch { radius: own } => vec![node, radius(0.5 * own), radius(2.0 * own)],
        ContactLoad::Square { side: own } => vec![node, side(0.5 * own), side(2.0 * own)],
    })
}

fn window(model: &Model) -> Vec<Level> {
    if model.criteria.is_empty() || !matches!(model.plan, Plan::Impact(_)) {
        return Vec::new();
    }
    let side =
        |side: f64| Level::new(format!("{:.3} mm", side * 1e3), [("failure.window", quoted(format!("{side:e} m")))]);
    match model.window {
        Window::Element => [1e-3, 2e-3, 4e-3].map(side).to_vec(),
        Window::Square(own) => {
            vec![Level::new("element", [("failure.window", quoted("element"))]), side(0.5 * own), side(2.0 * own)]
        }
    }
}
