//! The impact and its computation: impactor, march, failure, effects, output.

use super::plugin::PluginSpec;
use super::reader::{Field, Keys, Reader};
use super::source::{Located, Place, SceneError};
use super::tree::Node;
use crate::units;
use fem_core::plugin::Dimension;

/// A rigid mass that strikes the top face from above.
#[derive(Debug, Clone, PartialEq)]
pub struct Impactor {
    /// Mass, kg.
    pub mass: f64,
    /// Speed downwards at first touch, m/s.
    pub velocity: f64,
    /// Where it strikes.
    pub at: Located<ImpactPoint>,
    /// How its force enters the plate.
    pub load: Located<ContactLoad>,
}

/// A point of the plane: where an impactor strikes, for one.
#[derive(Debug, Clone, PartialEq)]
pub enum ImpactPoint {
    /// At the one node of this group of the mesh.
    Group(String),
    /// At x, y in m.
    Point([f64; 2]),
}

/// How a contact force enters the plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactLoad {
    /// At one node: singular in a solid, so that stresses near it depend on the mesh.
    Node,
    /// As Hertz pressure over a circle.
    Patch {
        /// Radius of the circle, m.
        radius: f64,
    },
}

/// What is done about damage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Damage {
    /// Nothing.
    Off,
    /// Its onset is found; the plate stays as it is.
    Onset,
}

/// An impact and how it is computed.
#[derive(Debug, Clone)]
pub struct Impact {
    /// The impactor.
    pub impactor: Impactor,
    /// The contact law.
    pub contact: PluginSpec,
    /// The reduction; `none` for the full system.
    pub reduction: PluginSpec,
    /// The march in time.
    pub march: March,
}

/// The march in time.
#[derive(Debug, Clone)]
pub struct March {
    /// The integrator.
    pub integrator: PluginSpec,
    /// Step, s.
    pub step: Located<f64>,
    /// End, s.
    pub end: Located<f64>,
}

/// Where and when failure is looked for.
#[derive(Debug, Clone)]
pub struct Failure {
    /// The criteria.
    pub criteria: Vec<PluginSpec>,
    /// Time between two scans, s.
    pub every: f64,
    /// What stresses are averaged over in the plane.
    pub window: Window,
    /// Only cells within this distance of the impact are scanned, m.
    pub radius: Option<f64>,
    /// Where it stands.
    pub place: Place,
}

/// What the stresses of a ply are averaged over in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Window {
    /// One element: onset times then depend on the mesh.
    Element,
    /// A square of this edge, m.
    Square(f64),
}

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output {
    /// Time between two lines of the history, s; every step if `None`.
    pub history_every: Option<f64>,
    /// Plots of the histories.
    pub plots: bool,
}

impl Default for Output {
    fn default() -> Self {
        Self { history_every: None, plots: true }
    }
}

const IMPACTOR: Keys = &[
    ("mass", r#""2.49 kg""#),
    ("velocity", r#""1.56 m/s""#),
    ("at", r#"{ group = "impact" }"#),
    ("patch_radius", r#""3 mm""#),
    ("load", r#""node""#),
];
const AT: Keys = &[("group", r#""impact""#), ("x", r#""0 mm""#), ("y", r#""0 mm""#)];
const MARCH: Keys = &[("integrator", r#""newmark""#), ("step", r#""0.5 us""#), ("end", r#""1 ms""#)];
const FAILURE: Keys = &[
    ("criteria", r#"["hashin-report", "octahedral"]"#),
    ("every", r#""5 us""#),
    ("window", r#""2.54 mm""#),
    ("radius", r#""10 mm""#),
];
const EFFECTS: Keys = &[("damage", r#""onset""#), ("membrane", r#""off""#), ("damping", r#""off""#)];
const OUTPUT: Keys = &[("history_every", r#""1 us""#), ("plots", "true")];

/// Most steps of a march: more is a slip in step or end, and would seem to hang.
const MAX_STEPS: f64 = 1e9;

pub(super) fn read_impactor(field: &Field<'_>) -> Result<Impactor, SceneError> {
    let table = field.table(IMPACTOR)?;
    let velocity_field = table.required("velocity")?;
    let (mass, velocity) =
        (table.required("mass")?.positive(Dimension::MASS)?, velocity_field.positive(Dimension::VELOCITY)?);
    // Energies are compared with it.
    if !(0.5 * mass * velocity * velocity).is_normal() {
        return Err(velocity_field
            .error("the energy of the impact is out of the range of numbers", "look for a slip in mass or velocity"));
    }
    Ok(Impactor { mass, velocity, at: read_point(&table.required("at")?)?, load: read_load(&table)? })
}

pub(super) fn read_point(field: &Field<'_>) -> Result<Located<ImpactPoint>, SceneError> {
    let table = field.table(AT)?;
    let [x, y] = ["x", "y"].map(|key| table.optional(key));
    let point = match (table.optional("group"), x.or(y)) {
        (Some(_), Some(stray)) => {
            return Err(stray.error("does not go with `group`", "give a group of the mesh, or x and y"));
        }
        (None, Some(_)) => {
            let coordinate = |key| table.required(key)?.quantity(Dimension::LENGTH);
            ImpactPoint::Point([coordinate("x")?, coordinate("y")?])
        }
        _ => ImpactPoint::Group(table.required("group")?.text()?.to_owned()),
    };
    Ok(field.at(point))
}

fn read_load(table: &Reader<'_>) -> Result<Located<ContactLoad>, SceneError> {
    let [load, patch] = table.either(["load", "patch_radius"])?;
    if let Some(load) = load {
        return Ok(load.at(load.choice(&[("node", ContactLoad::Node)])?));
    }
    let patch = patch.map_or_else(|| table.required("patch_radius"), Ok)?;
    Ok(patch.at(ContactLoad::Patch { radius: patch.positive(Dimension::LENGTH)? }))
}

pub(super) fn read_march(field: &Field<'_>) -> Result<March, SceneError> {
    let table = field.table(MARCH)?;
    let integrator = PluginSpec::read_or_name(&table.required("integrator")?)?;
    let (step_field, end_field) = (table.required("step")?, table.required("end")?);
    let (step, end) = (step_field.positive(Dimension::TIME)?, end_field.positive(Dimension::TIME)?);
    let steps = end / step;
    if !(1.0..=MAX_STEPS).contains(&steps) {
        return Err(end_field.error(
            format!("an end at {end:e} s is {steps:.3e} steps of {step:e} s"),
            format!("between 1 and {MAX_STEPS:e} steps can be marched"),
        ));
    }
    Ok(March { integrator, step: step_field.at(step), end: end_field.at(end) })
}

pub(super) fn read_failure(field: &Field<'_>, wanted: bool) -> Result<Failure, SceneError> {
    let table = field.table(FAILURE)?;
    let criteria = match (table.optional("criteria"), wanted) {
        (None, false) => Vec::new(),
        _ => table.required("criteria")?.list()?.iter().map(PluginSpec::read_or_name).collect::<Result<_, _>>()?,
    };
    let window = table.required("window")?;
    let window = match window.node() {
        Node::Text(text) if text == "element" => Window::Element,
        Node::Text(text) if !units::begins_with_number(text) => {
            return Err(window.error(format!("`{text}` is no window"), "write \"element\" or a length, \"2.54 mm\""));
        }
        _ => Window::Square(window.positive(Dimension::LENGTH)?),
    };
    Ok(Failure {
        criteria,
        every: table.required("every")?.positive(Dimension::TIME)?,
        window,
        radius: table.optional("radius").map(|field| field.positive(Dimension::LENGTH)).transpose()?,
        place: table.place().clone(),
    })
}

pub(super) fn read_effects(field: &Field<'_>) -> Result<Damage, SceneError> {
    let table = field.table(EFFECTS)?;
    for key in ["membrane", "damping"] {
        if let Some(field) = table.optional(key) {
            effect(&field, &[("off", ())])?;
        }
    }
    table
        .optional("damage")
        .map_or(Ok(Damage::Onset), |field| effect(&field, &[("onset", Damage::Onset), ("off", Damage::Off)]))
}

fn effect<T: Copy>(field: &Field<'_>, available: &[(&str, T)]) -> Result<T, SceneError> {
    let text = field.text()?;
    available.iter().find(|(word, _)| *word == text).map(|(_, effect)| *effect).ok_or_else(|| {
        let words: Vec<_> = available.iter().map(|(word, _)| *word).collect();
        field.error(format!("`{text}` is not available yet"), format!("available: {}", words.join(", ")))
    })
}

pub(super) fn read_output(field: &Field<'_>) -> Result<Output, SceneError> {
    let table = field.table(OUTPUT)?;
    Ok(Output {
        history_every: table.optional("history_every").map(|field| field.positive(Dimension::TIME)).transpose()?,
        plots: table.optional("plots").map_or(Ok(true), |field| field.flag())?,
    })
}
