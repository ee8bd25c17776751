//! The impact and its computation: impactor, march, failure, effects, output.

use super::fields::{self, Fields};
use super::load::{FACES, face};
use super::plugin::PluginSpec;
use super::support::{self, Unknowns};
use super::tip::{self, Struck};
use crate::document::keys::{Form, Keys, key, words};
use crate::document::reader::{Reader, SceneValue};
use crate::document::source::{Located, Origin, Place, SceneError};
use crate::document::tree::Node;
use crate::units;
use fem_core::load::Face;
use fem_core::plugin::{Dimension, Kind};
use fem_core::recovery::PlyHeights;

/// A rigid mass that strikes a face.
#[derive(Debug, Clone)]
pub struct ImpactorSpec {
    /// What results call it where there are several; their names differ.
    pub name: String,
    /// Mass, kg.
    pub mass: f64,
    /// Speed towards the plate before first touch, m/s.
    pub velocity: f64,
    /// When it would reach the plate at rest, s; it flies freely before.
    pub start: f64,
    /// Where it strikes.
    pub at: Located<ImpactPoint>,
    /// The face that it strikes.
    pub face: Face,
    /// How its force enters the plate.
    pub load: Located<ContactLoad>,
    /// The contact law.
    pub contact: PluginSpec,
    /// The surface whose deflection the indentation of the law counts from, by its depth in thicknesses of the plate, where it lies
    /// below the face.
    pub indentation_from: Option<Located<f64>>,
}

impl ContactLoad {
    /// Radius of the Hertz pressure that tells the deflection under a tip, over that of the tip.
    pub const OF_TIP: f64 = 0.25;

    /// How far from its centre it reaches, m.
    pub fn reach(&self) -> f64 {
        match *self {
            Self::Node => 0.0,
            Self::Patch { radius } => radius,
            Self::Tip { radius } => Self::OF_TIP * radius,
            Self::Square { side } => side * std::f64::consts::FRAC_1_SQRT_2,
        }
    }
}

/// A point of the plane: where an impactor strikes, or something is watched.
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
    /// Where a spherical tip touches the plate.
    Tip {
        /// Radius of the sphere, m.
        radius: f64,
    },
    /// As uniform pressure over a square parallel to the axes.
    Square {
        /// Side of the square, m.
        side: f64,
    },
}

/// An impact and how it is computed.
#[derive(Debug, Clone)]
pub struct ImpactSpec {
    /// The impactors, at least one.
    pub impactors: Vec<ImpactorSpec>,
    /// The reduction; `none` for the full system.
    pub reduction: PluginSpec,
    /// Governors that are named.
    pub keep: Option<Located<Vec<Unknowns>>>,
    /// The march in time.
    pub march: MarchSpec,
}

/// The march in time.
#[derive(Debug, Clone)]
pub struct MarchSpec {
    /// The integrator.
    pub integrator: PluginSpec,
    /// Step, s.
    pub step: Located<f64>,
    /// End, s; the latest one of a march that ends with the separation.
    pub end: Located<f64>,
    /// Whether it ends once all impactors have left the plate.
    pub until_separation: bool,
    /// Error up to which steps are divided, if they are.
    pub tolerance: Option<f64>,
}

impl MarchSpec {
    /// Largest tolerance, above which the estimate of an error means nothing.
    pub const LOOSEST: f64 = 0.1;

    /// Number of steps to the end, and their length, s: as it is written where it fits the end, so that a later end changes no bit
    /// of it, shorter otherwise.
    pub fn steps(&self) -> (u64, f64) {
        let count = self.end.value / self.step.value;
        let steps = (count * (1.0 - 1e-12)).ceil().max(1.0) as u64;
        let whole = (count - steps as f64).abs() <= 1e-12 * count;
        (steps, if whole { self.step.value } else { self.end.value / steps as f64 })
    }
}

/// Where and when failure is looked for.
#[derive(Debug, Clone)]
pub struct Failure {
    /// The criteria; their names differ.
    pub criteria: Vec<CriterionSpec>,
    /// Time between two scans, s.
    pub every: f64,
    /// What stresses are averaged over in the plane.
    pub window: Window,
    /// Where in its height a ply is judged.
    pub plies: PlyHeights,
    /// Only cells within this distance of the impact are scanned, m.
    pub radius: Option<f64>,
    /// Places whose indices are written over time.
    pub watch: Vec<IndexWatch>,
    /// Where it stands.
    pub place: Place,
}

/// A criterion as a scene names it.
#[derive(Debug, Clone)]
pub struct CriterionSpec {
    /// The plug-in.
    pub plugin: PluginSpec,
    /// What results call it: the name that the scene gives it (`as`), otherwise the plug-in's.
    pub label: String,
}

/// A place whose indices are written over time.
#[derive(Debug, Clone, PartialEq)]
pub struct IndexWatch {
    /// Where on the plate.
    pub at: Located<ImpactPoint>,
    /// Where in the laminate.
    pub depth: Located<Depth>,
    /// The criterion, counted in [`Failure::criteria`]; all that look there if `None`.
    pub criterion: Option<usize>,
}

/// A ply or the resin between two plies, counted from 0 at the bottom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// Ply `k`.
    Ply(usize),
    /// Between ply `k` and the ply above it.
    Interface(usize),
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
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Time between two lines of the history, s; as few as 2000 lines need if `None`.
    pub history_every: Option<f64>,
    /// Wall-clock time between two checkpoints of a march, s.
    pub checkpoint_every: f64,
    /// How many modes of the reduced plate are followed, if any.
    pub modes: Option<Located<usize>>,
    /// Plots of the histories.
    pub plots: bool,
    /// A table of the largest indices over the plate.
    pub maps: bool,
    /// Fields over the plate, as files of VTK.
    pub fields: Option<Fields>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            history_every: None,
            checkpoint_every: CHECKPOINT_EVERY,
            modes: None,
            plots: true,
            maps: false,
            fields: None,
        }
    }
}

pub(super) const IMPACTOR: Keys = &[
    key("name", Form::Text, r#""first""#, "what results call it where there are several"),
    key("mass", Form::Quantity(Dimension::MASS), r#""2.49 kg""#, "mass of the rigid impactor").required(),
    key(
        "velocity",
        Form::Quantity(Dimension::VELOCITY),
        r#""1.56 m/s""#,
        "speed towards the plate at the beginning; unless its weight acts before, that of first touch",
    ),
    key(
        "energy",
        Form::OneOf(&[Form::Quantity(Dimension::ENERGY), Form::Quantity(Dimension::FORCE)]),
        r#""6.7 J/mm""#,
        "energy of the impact instead of its velocity, or energy per thickness of the laminate",
    ),
    key(
        "drop_height",
        Form::Quantity(Dimension::LENGTH),
        r#""0.5 m""#,
        "height of a free fall instead of its velocity, v = sqrt(2 g h) with g = 9.80665 m/s2",
    ),
    key("start", Form::Quantity(Dimension::TIME), r#""50 us""#, "when it would reach the plate at rest")
        .default(r#""0 s""#),
    key("at", Form::Table(AT), r#"{ group = "impact" }"#, "where it strikes").required(),
    key("face", Form::Words(&words(&FACES)), r#""bottom""#, "face that it strikes").default(r#""top""#),
    key(
        "diameter",
        Form::Quantity(Dimension::LENGTH),
        r#""16 mm""#,
        "diameter of its spherical tip; with `material` it makes Hertz's law, instead of `contact`",
    ),
    key("material", Form::Text, r#""steel""#, "material of its tip, one of `materials`, isotropic"),
    key("patch_radius", Form::Quantity(Dimension::LENGTH), r#""3 mm""#, "its force is a Hertz pressure on this circle"),
    key(
        "tip_radius",
        Form::Quantity(Dimension::LENGTH),
        r#""8 mm""#,
        "radius of its spherical tip: its force acts where tip and plate touch, on ever more of it",
    ),
    key("patch_side", Form::Quantity(Dimension::LENGTH), r#""2 mm""#, "its force is a uniform pressure on this square"),
    key("load", Form::Words(&["node"]), r#""node""#, "its force acts at one node"),
    key(
        "contact",
        Form::Plugin(Kind::Contact, LAW, &[]),
        r#"{ law = "hertz", k = "1.07e5 N/mm^1.5" }"#,
        "contact law of this impactor; that of the scene if left out",
    ),
    key(
        "indentation_from",
        Form::Words(&words(&SURFACES)),
        r#""mid-plane""#,
        "surface that the law's indentation counts from; below the face, its squeeze counts once",
    )
    .default(r#""face""#),
];
/// Surfaces that an indentation counts from, by their depth in thicknesses.
const SURFACES: [(&str, f64); 3] = [("face", 0.0), ("mid-plane", 0.5), ("opposite-face", 1.0)];
pub(super) const AT: Keys = &[
    key("group", Form::Text, r#""impact""#, "a group of the mesh with one node"),
    key("x", Form::Quantity(Dimension::LENGTH), r#""0 mm""#, "x of the point, instead of a group"),
    key("y", Form::Quantity(Dimension::LENGTH), r#""0 mm""#, "y of the point, instead of a group"),
];
/// The end of a march that follows the impactors until they have left.
pub(super) const SEPARATION: &str = "separation";
/// When such a march ends at the latest unless a scene says, s.
const LATEST: f64 = 20e-3;
pub(super) const MARCH: Keys = &[
    key(
        "integrator",
        Form::OneOf(&[Form::PluginName(Kind::Integrator), Form::Plugin(Kind::Integrator, "name", &[])]),
        r#""newmark""#,
        "scheme in time: `fem list integrators`",
    )
    .required(),
    key("step", Form::Quantity(Dimension::TIME), r#""0.5 us""#, "step in time").required(),
    key(
        "end",
        Form::OneOf(&[Form::Words(&[SEPARATION]), Form::Quantity(Dimension::TIME)]),
        r#""1 ms""#,
        "time at which the march ends; \"separation\": once all impactors have left the plate",
    )
    .required(),
    key(
        "latest",
        Form::Quantity(Dimension::TIME),
        r#""10 ms""#,
        "time at which a march to the separation ends at the latest; 20 ms if left out",
    ),
    key(
        "tolerance",
        Form::Number,
        "1e-3",
        "steps are halved until the changes of velocity in each part are right to this share; whole steps if left out",
    ),
];
pub(super) const FAILURE: Keys = &[
    key(
        "criteria",
        Form::List(&Form::OneOf(&[
            Form::PluginName(Kind::Criterion),
            Form::Plugin(
                Kind::Criterion,
                "name",
                &[key(LABEL, Form::Text, r#""puck-2""#, "what results call it; the name if left out")],
            ),
        ])),
        r#"["hashin-report", "octahedral"]"#,
        "criteria by name: `fem list criteria`",
    ),
    key("every", Form::Quantity(Dimension::TIME), r#""5 us""#, "time between two looks at the stresses").required(),
    key(
        "window",
        Form::OneOf(&[Form::Words(&["element"]), Form::Quantity(Dimension::LENGTH)]),
        r#""2.54 mm""#,
        "stresses are means over a square of this edge, or over an element",
    )
    .required(),
    key(
        "plies",
        Form::Words(&words(&PLIES)),
        r#""faces""#,
        "plies are judged by their mean, at faces and middle, or there where they are thicker than an eighth of the laminate",
    )
    .default(r#""auto""#),
    key(
        "radius",
        Form::Quantity(Dimension::LENGTH),
        r#""10 mm""#,
        "only cells within this distance of an impact are judged; all if left out",
    ),
    key(
        "watch",
        Form::List(&Form::Table(WATCH)),
        r#"[{ at = { group = "impact" }, ply = 1 }]"#,
        "places whose failure indices are written over time",
    ),
];
const PLIES: [(&str, PlyHeights); 3] =
    [("auto", PlyHeights::Auto), ("faces", PlyHeights::Faces), ("mean", PlyHeights::Mean)];
const WATCH: Keys = &[
    key("at", Form::Table(AT), r#"{ x = "0 mm", y = "0 mm" }"#, "where on the plate").required(),
    key("ply", Form::Count(1), "1", "in this ply, counted from the bottom"),
    key("interface", Form::Text, r#""1|2""#, "between these two plies"),
    key("criterion", Form::Text, r#""hashin-report""#, "of this criterion; of all that look there if left out"),
];
/// Key under which a contact law is named.
const LAW: &str = "law";
/// Key by which a scene names a criterion of its own way.
const LABEL: &str = "as";
pub(super) const OUTPUT: Keys = &[
    key(
        "history_every",
        Form::Quantity(Dimension::TIME),
        r#""1 us""#,
        "time between two lines of history.csv; about 2000 lines if left out",
    ),
    key("checkpoint_every", Form::Quantity(Dimension::TIME), r#""60 s""#, "wall-clock time between two checkpoints")
        .default(r#""60 s""#),
    key("modes", Form::Count(1), "6", "modes of the reduced plate that are followed"),
    key("plots", Form::Flag, "true", "pictures of the histories").default("true"),
    key("maps", Form::Flag, "true", "a table of the largest indices over the plate").default("false"),
    key(
        "fields",
        Form::OneOf(&[Form::Flag, Form::Table(fields::KEYS)]),
        "true",
        "displacements, stresses and indices over the plate as files of VTK",
    )
    .default("false"),
];

/// Time between two checkpoints unless the scene says otherwise, s.
const CHECKPOINT_EVERY: f64 = 60.0;

/// Most modes that are followed: one picture shows them all beside the others and the sum.
const MOST_MODES: usize = 38;

/// Most steps of a march: more is a mistake in step or end, and would seem to hang.
const MAX_STEPS: f64 = 1e9;

/// Governors that are named.
const KEEP: &str = "keep";
pub(super) const REDUCTION: Keys = &[key(
    KEEP,
    Form::List(&Form::Table(support::UNKNOWNS)),
    r#"[{ group = "line", at = "mid-plane", dofs = ["U30"] }]"#,
    "governors of `guyan` and `irs` that are named; the rest spreads over the plate",
)];

/// The keys of an impact: one table of an impactor or a list of them, a contact law for those without their own.
pub(super) fn read_impact(root: &Reader<'_>, struck: &Struck<'_>) -> Result<ImpactSpec, SceneError> {
    let march = read_march(&root.required("march")?)?;
    let field = root.required("impactor")?;
    let fields = if matches!(field.node(), Node::List(_)) { field.list()? } else { vec![field] };
    let mut impactors: Vec<ImpactorSpec> = Vec::new();
    for (number, field) in (1..).zip(&fields) {
        let impactor = read_impactor(root, field, number, (struck, march.end.value))?;
        if impactors.iter().any(|other| other.name == impactor.name) {
            let message =
                format!("a second impactor is called `{}`, and results could not tell them apart", impactor.name);
            return Err(field.error(message, "give each a `name` of its own"));
        }
        impactors.push(impactor);
    }
    let field = root.required("reduction")?;
    let kept = field.entries()?.into_iter().find(|(key, _)| *key == KEEP);
    let keep = kept.map(|(_, kept)| {
        let each = kept.list()?.iter().map(support::unknowns).collect::<Result<_, SceneError>>()?;
        Ok(kept.at(each))
    });
    Ok(ImpactSpec {
        impactors,
        reduction: PluginSpec::read(&field, "method", &[KEEP])?,
        keep: keep.transpose()?,
        march,
    })
}

/// Velocity, m/s, at which a tenth of the strain at first touch, V over the speed of sound through the plate, is reached in
/// most laminates.
const FASTEST: f64 = 300.0;

fn read_impactor(
    root: &Reader<'_>,
    field: &SceneValue<'_>,
    number: usize,
    (struck, end): (&Struck<'_>, f64),
) -> Result<ImpactorSpec, SceneError> {
    let table = field.table(IMPACTOR)?;
    let name =
        table.optional("name").map_or(Ok(format!("impactor-{number}")), |field| field.text().map(str::to_owned))?;
    let mass = table.required("mass")?.positive(Dimension::MASS)?;
    let (velocity_field, velocity) = tip::velocity(&table, mass, struck)?;
    // Energies are compared with it.
    if !(0.5 * mass * velocity * velocity).is_normal() {
        return Err(velocity_field.error(
            "the energy of the impact is too large or too small for floating-point numbers",
            "look for a typing error in mass or velocity",
        ));
    }
    if velocity > FASTEST {
        return Err(velocity_field.error(
            format!("{velocity} m/s is no impact at low velocity: waves of pressure would go through the plate, which are left out"),
            format!("look for a typing error in number or unit; at most {FASTEST} m/s are taken"),
        ));
    }
    let start = match table.optional("start") {
        None => 0.0,
        Some(field) => match field.quantity(Dimension::TIME)? {
            start if !(0.0..end).contains(&start) => {
                let message = format!("{start:e} s is not within the march, which ends at {end:e} s");
                return Err(field.error(message, "give a time from 0 on and before `march.end`"));
            }
            start => start,
        },
    };
    let load = read_load(&table)?;
    let contact = match tip::law(&table, struck)? {
        Some((_, tip)) if !fits(&load, tip.positive(Dimension::LENGTH)?) => {
            return Err(tip.error("is not twice the `tip_radius`", "a tip has one radius: leave one of the two out"));
        }
        Some((law, tip)) => match table.optional("contact").or_else(|| root.optional("contact")) {
            Some(_) => return Err(tip.error("makes Hertz's law, and there is a `contact`", "leave one of the two out")),
            None => law,
        },
        None => PluginSpec::read(&table.optional("contact").map_or_else(|| root.required("contact"), Ok)?, LAW, &[])?,
    };
    Ok(ImpactorSpec {
        name,
        mass,
        velocity,
        start,
        at: read_point(&table.required("at")?)?,
        face: face(&table)?,
        load,
        contact,
        indentation_from: match table.optional("indentation_from") {
            Some(field) => Some(field.at(field.choice(&SURFACES)?)).filter(|from| from.value > 0.0),
            None => None,
        },
    })
}

pub(super) fn read_point(field: &SceneValue<'_>) -> Result<Located<ImpactPoint>, SceneError> {
    Ok(field.at(point(&field.table(AT)?)?))
}

/// The point of a table with these keys.
pub(super) fn point(table: &Reader<'_>) -> Result<ImpactPoint, SceneError> {
    // What a text says of the place goes over what stands beneath it.
    let [group, x] = table.either(["group", "x"])?;
    let [_, y] = table.either(["group", "y"])?;
    Ok(match (group, x.or(y)) {
        (_, Some(_)) => {
            let coordinate = |key| table.required(key)?.quantity(Dimension::LENGTH);
            ImpactPoint::Point([coordinate("x")?, coordinate("y")?])
        }
        (Some(group), None) => ImpactPoint::Group(group.text()?.to_owned()),
        (None, None) => ImpactPoint::Group(table.required("group")?.text()?.to_owned()),
    })
}

/// Whether the tip of a load, if it is one, has this diameter.
fn fits(load: &Located<ContactLoad>, diameter: f64) -> bool {
    !matches!(load.value, ContactLoad::Tip { radius } if (2.0 * radius / diameter - 1.0).abs() > 1e-9)
}

/// Ways in which the force of an impactor enters the plate, of which one counts.
pub(super) const LOADS: [&str; 4] = ["load", "patch_radius", "patch_side", "tip_radius"];

fn read_load(table: &Reader<'_>) -> Result<Located<ContactLoad>, SceneError> {
    let [round, square, tip] = table.either(["patch_radius", "patch_side", "tip_radius"])?;
    if let Some(square) = square {
        table.either(["load", "patch_side"])?;
        return Ok(square.at(ContactLoad::Square { side: square.positive(Dimension::LENGTH)? }));
    }
    if let Some(tip) = tip {
        table.either(["load", "tip_radius"])?;
        return Ok(tip.at(ContactLoad::Tip { radius: tip.positive(Dimension::LENGTH)? }));
    }
    let [load, patch] = match round {
        Some(_) => table.either(["load", "patch_radius"])?,
        None => [table.optional("load"), None],
    };
    if let Some(load) = load {
        return Ok(load.at(load.choice(&[("node", ContactLoad::Node)])?));
    }
    let patch = patch.map_or_else(|| table.required("patch_radius"), Ok)?;
    Ok(patch.at(ContactLoad::Patch { radius: patch.positive(Dimension::LENGTH)? }))
}

pub(super) fn read_march(field: &SceneValue<'_>) -> Result<MarchSpec, SceneError> {
    let table = field.table(MARCH)?;
    let integrator = PluginSpec::read_or_name(&table.required("integrator")?, &[])?;
    let step_field = table.required("step")?;
    let (end_field, end, until_separation) = read_end(&table)?;
    let step = step_field.positive(Dimension::TIME)?;
    let steps = end / step;
    if !(1.0..=MAX_STEPS).contains(&steps) {
        return Err(end_field.error(
            format!("an end at {end:e} s is {steps:.3e} steps of {step:e} s"),
            format!("between 1 and {MAX_STEPS:e} steps can be marched"),
        ));
    }
    let tolerance = table.optional("tolerance").map(|field| match field.number()? {
        share if share > 0.0 && share <= MarchSpec::LOOSEST => Ok(share),
        share => Err(field.error(
            format!("a tolerance of {share} cannot be kept"),
            format!("give a share above 0 and up to {}", MarchSpec::LOOSEST),
        )),
    });
    let (step, end) = (step_field.at(step), end_field.at(end));
    Ok(MarchSpec { integrator, step, end, until_separation, tolerance: tolerance.transpose()? })
}

/// Where the end of a march stands, when it is, s, and whether the separation comes before it.
fn read_end<'a>(table: &Reader<'a>) -> Result<(SceneValue<'a>, f64, bool), SceneError> {
    let (end, latest) = (table.required("end")?, table.optional("latest"));
    let separation = matches!(end.node(), Node::Text(text) if !units::begins_with_number(text));
    if separation {
        end.choice(&[(SEPARATION, ())])?;
    }
    match (separation, latest) {
        (true, Some(latest)) => {
            let time = latest.positive(Dimension::TIME)?;
            Ok((latest, time, true))
        }
        (true, None) => Ok((end, LATEST, true)),
        // Another end that is set over the scene is one without a latest time.
        (false, Some(latest)) if end.place().origin <= latest.place().origin => {
            let help = "write end = \"separation\", or leave `latest` out";
            Err(latest.error("is for marches that end with the separation", help))
        }
        (false, _) => {
            let time = end.positive(Dimension::TIME)?;
            Ok((end, time, false))
        }
    }
}

pub(super) fn read_failure(field: &SceneValue<'_>, wanted: bool, in_time: bool) -> Result<Failure, SceneError> {
    let table = field.table(FAILURE)?;
    let criteria = match (table.optional("criteria"), wanted) {
        (None, false) => Vec::new(),
        _ => read_criteria(&table.required("criteria")?)?,
    };
    let every = table.required("every")?;
    if !in_time && every.place().origin != Origin::Preset {
        return Err(every.error("needs an impact: nothing else is looked at over time", "leave it out"));
    }
    let watch = match table.optional("watch") {
        None => Vec::new(),
        Some(field) if !in_time => {
            return Err(field.error("histories need an impact", "leave it out, or write a `[[profile]]`"));
        }
        Some(field) => field.list()?.iter().map(|field| read_watch(field, &criteria)).collect::<Result<_, _>>()?,
    };
    let window = table.required("window")?;
    let window = match window.node() {
        Node::Text(text) if text == "element" => Window::Element,
        Node::Text(text) if !units::begins_with_number(text) => {
            return Err(window.error(format!("`{text}` is not a window"), "write \"element\" or a length, \"2.54 mm\""));
        }
        _ => Window::Square(window.positive(Dimension::LENGTH)?),
    };
    Ok(Failure {
        criteria,
        every: every.positive(Dimension::TIME)?,
        window,
        plies: table.optional("plies").map_or(Ok(PlyHeights::Auto), |field| field.choice(&PLIES))?,
        radius: table.optional("radius").map(|field| field.positive(Dimension::LENGTH)).transpose()?,
        watch,
        place: table.place().clone(),
    })
}

fn read_criteria(field: &SceneValue<'_>) -> Result<Vec<CriterionSpec>, SceneError> {
    let mut criteria: Vec<CriterionSpec> = Vec::new();
    for field in field.list()? {
        let plugin = PluginSpec::read_or_name(&field, &[LABEL])?;
        let label = match field.node() {
            Node::Table(_) => field.entries()?.into_iter().find(|(key, _)| *key == LABEL),
            _ => None,
        };
        let label = label.map_or(Ok(plugin.name.value.as_str()), |(_, field)| field.text())?.to_owned();
        if criteria.iter().any(|other| other.label == label) {
            let name = &plugin.name.value;
            return Err(field.error(
                format!("a second criterion is called `{label}`, and results could not tell them apart"),
                format!("give it another name in the results: {{ name = \"{name}\", {LABEL} = \"{name}-2\" }}"),
            ));
        }
        criteria.push(CriterionSpec { plugin, label });
    }
    Ok(criteria)
}

fn read_watch(field: &SceneValue<'_>, criteria: &[CriterionSpec]) -> Result<IndexWatch, SceneError> {
    let table = field.table(WATCH)?;
    let depth = match table.either(["ply", "interface"])? {
        [_, Some(interface)] => interface.at(read_interface(&interface)?),
        [ply, None] => {
            let ply = ply
                .ok_or_else(|| table.missing("ply", "give a ply, `ply = 1`, or an interface, `interface = \"1|2\"`"))?;
            ply.at(Depth::Ply(ply.count()? - 1))
        }
    };
    let criterion = table.optional("criterion").map(|field| field.word(criteria.iter().map(|c| c.label.as_str())));
    Ok(IndexWatch { at: read_point(&table.required("at")?)?, depth, criterion: criterion.transpose()? })
}

/// `"3|4"`, as results write it.
fn read_interface(field: &SceneValue<'_>) -> Result<Depth, SceneError> {
    let plies = field.text()?.split_once('|').and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    match plies {
        Some((below, above)) if 0_usize < below && below.checked_add(1) == Some(above) => {
            Ok(Depth::Interface(below - 1))
        }
        _ => Err(field.error(
            format!("`{}` is not an interface", field.text()?),
            "write the two plies that meet there, counted from 1 at the bottom: \"1|2\"",
        )),
    }
}

/// The keys of the output; `march` is that of an impact.
pub(super) fn read_output(field: &SceneValue<'_>, march: Option<&MarchSpec>) -> Result<Output, SceneError> {
    let table = field.table(OUTPUT)?;
    let modes = table.optional("modes").map(|field| match field.count()? {
        count @ 1..=MOST_MODES => Ok(field.at(count)),
        count => Err(field.error(format!("{count} modes"), format!("at most {MOST_MODES} can be followed"))),
    });
    let in_time = |key| match table.optional(key) {
        Some(field) if march.is_none() => {
            Err(field.error("needs an impact: nothing else is written over time", "leave it out"))
        }
        field => Ok(field),
    };
    let checkpoint = table.optional("checkpoint_every").map(|field| field.positive(Dimension::TIME));
    Ok(Output {
        checkpoint_every: checkpoint.transpose()?.unwrap_or(CHECKPOINT_EVERY),
        modes: modes.transpose()?,
        history_every: in_time("history_every")?.map(|field| field.positive(Dimension::TIME)).transpose()?,
        plots: table.optional("plots").map_or(Ok(true), |field| field.flag())?,
        maps: table.optional("maps").map_or(Ok(false), |field| field.flag())? && in_time("maps")?.is_some(),
        fields: table.optional("fields").map_or(Ok(None), |field| fields::read(&field, march))?,
    })
}
