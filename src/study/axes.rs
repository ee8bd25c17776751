//! What a study varies.

use super::ways;
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::registry::{NO_REDUCTION, Registry};
use fem_core::plugin::Dimension;
use fem_core::plugin::{Kind, Plugin as _, Role, unknown_key};
use fem_dynamics::reduce::Ritz;
use fem_io::scene::{DelaminationSpec, MarchSpec, MeshSource, OwnAxis, Scene, Setting};

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
    pub(super) fn new<const N: usize>(label: impl Into<String>, keys: [(&str, String); N]) -> Self {
        let setting = keys.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
        Self { label: label.into(), setting, at_limit: false }
    }

    /// The scene itself.
    fn own(label: impl Into<String>) -> Self {
        Self::new(label, [])
    }
}

/// Sizes of reductions that are alternatives.
pub(super) const LADDER: [usize; 4] = [20, 40, 80, 160];

/// Steps that are tried, over that of the scene.
const STEPS: [f64; 6] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.125];

/// Refinements of the scene's mesh that are tried, and how often one of equal cells is coarsened.
const REFINEMENTS: usize = 3;
const COARSENINGS: usize = 2;

/// Key of the step.
pub(super) const STEP: &str = "march.step";
/// Key of the tolerance that steps are divided to.
pub(super) const TOLERANCE: &str = "march.tolerance";

/// Names of all axes, in the order in which they are run.
pub const NAMES: [&str; 15] = [
    "mesh",
    "layers",
    "reduction",
    "step",
    "points",
    "margin",
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

/// That of the layers of cells.
pub(super) const LAYERS: &str = "layers";

/// Those of them that are ladders.
pub(super) const LADDERS: [&str; 6] = ["mesh", LAYERS, "reduction", "step", "points", "margin"];

/// Most combinations of levels of all ladders.
const MOST_TOGETHER: f64 = 1e5;

/// The axes of `scene`, whose model is `model`: those of `names`, or else those that its scene asks for, or else all that fit it, and the scene's
/// own. An axis of other ways brings the ladders that they are judged by.
///
/// # Errors
/// A name that no axis has, one that two axes have, ladders of too many levels to be combined.
pub fn axes(scene: &Scene, model: &Model, registry: &Registry, names: &[String]) -> Result<Vec<StudyAxis>, Error> {
    let study = &scene.study;
    let own = || study.own.iter().map(|own| own.name.value.as_str());
    let known = || NAMES.into_iter().chain(own());
    for (k, OwnAxis { name, .. }) in study.own.iter().enumerate() {
        if NAMES.into_iter().chain(own().take(k)).any(|other| other == name.value) {
            let what = format!("there is another axis `{}`", name.value);
            return Err(scene.source.error_at(&name.place, what, "give this one another name").into());
        }
    }
    if let Some(name) = names.iter().find(|name| known().all(|known| known != name.as_str())) {
        let help = format!("`{name}` {}", unknown_key(name, known()));
        return Err(Error::Axis { name: name.clone(), help });
    }
    if let Some(name) = study.axes.iter().flatten().find(|name| known().all(|known| known != name.value)) {
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
    // Delaminations that grow have laid layers and chosen what marches them.
    let grows = scene.delamination.is_some() || scene.grown.is_some();
    let (kind, levels) = match name {
        LAYERS | "reduction" | "reductions" | "integrators" if grows => return None,
        "points" => (AxisKind::Ladder, points(scene)?),
        "margin" => (AxisKind::Ladder, margin(model)?),
        "mesh" => (AxisKind::Ladder, mesh(scene)),
        "layers" => (AxisKind::Ladder, layers(scene, model)),
        "reduction" => (AxisKind::Ladder, reduction(scene, model, registry)?),
        "step" => (AxisKind::Ladder, steps(scene, model)?),
        "geometry" => (AxisKind::Ways, ways::geometry(scene, &model.plate.plane)),
        "z-derivatives" => (AxisKind::Ways, ways::z_derivatives(scene, model)),
        "quadrature" => (AxisKind::Ways, ways::quadrature(scene, registry)),
        "reductions" => (AxisKind::Ways, scene.impact().map(|_| ways::reductions(registry))?),
        "integrators" => (AxisKind::Ways, ways::integrators(scene, registry)?),
        "element" => (AxisKind::Ways, ways::elements(scene, registry)),
        "mass" => (AxisKind::Ways, ways::mass(scene, registry)),
        "contact" => (AxisKind::Problems, ways::contact(scene)?),
        "window" => (AxisKind::Problems, ways::window(model)),
        _ => return None,
    };
    let varies = levels.iter().any(|level| !level.setting.is_empty());
    varies.then(|| StudyAxis { name: name.to_owned(), kind, levels })
}

pub(super) fn quoted(text: impl std::fmt::Display) -> String {
    format!("\"{text}\"")
}

/// A whole number of the scene.
pub(super) fn value(scene: &Scene, key: &str) -> Option<usize> {
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
pub(super) fn reduced(name: &str, size: Option<(&str, usize)>, choice: &str) -> [(&'static str, String); 1] {
    let size = size.map_or(String::new(), |(key, n)| format!(", {key} = {n}"));
    [("reduction", format!("{{ method = \"{name}\"{size}{choice} }}"))]
}

pub(super) fn seconds(step: f64) -> String {
    quoted(format!("{step:e} s"))
}

/// Points of integration of a cell of an interface.
fn points(scene: &Scene) -> Option<Vec<Level>> {
    let own = scene.delamination.as_ref()?.points;
    let label = |n: usize| format!("{n} x {n} points");
    let level = |n: usize| Level::new(label(n), [("delamination.points", n.to_string())]);
    let coarser = Some((own / 2).max(DelaminationSpec::LEAST_POINTS)).filter(|n| *n < own).map(level);
    let finer = Some(2 * own).filter(|n| *n <= DelaminationSpec::MOST_POINTS).map(level);
    Some(coarser.into_iter().chain([Level::own(label(own))]).chain(finer).collect())
}

/// Width of what is open ahead of damage.
fn margin(model: &Model) -> Option<Vec<Level>> {
    let own = model.separation.as_ref()?.growth.margin;
    let label = |margin: f64| Dimension::LENGTH.of(margin).to_string();
    let wider = |by: f64| Level::new(label(by * own), [("delamination.margin", quoted(format!("{:e} m", by * own)))]);
    Some(vec![Level::own(label(own)), wider(2.0), wider(4.0)])
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
        let label = format!("{}{to}", Dimension::TIME.of(step));
        if *share == 1.0 {
            return Some(Level::own(label));
        }
        let mut level = Level::new(label, [(STEP, seconds(step))]);
        level.setting.extend(tolerance.map(|tolerance| (TOLERANCE.to_owned(), format!("{tolerance:e}"))));
        tolerance.is_none_or(|tolerance| tolerance <= MarchSpec::LOOSEST).then_some(level)
    };
    Some(STEPS.iter().filter_map(level).collect())
}
