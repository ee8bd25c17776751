//! The effects that a scene asks for; others cost nothing.

use crate::document::keys::{Form, Keys, key, words};
use crate::document::reader::{Field, Reader};
use crate::document::source::{Located, SceneError};
use crate::document::tree::Node;
use fem_core::damping::{Damping, Rayleigh};
use fem_core::plugin::Dimension;

/// Whether an effect is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Switch {
    /// No.
    #[default]
    Off,
    /// Yes.
    On,
    /// As the advisor finds it to matter.
    Auto,
}

/// What is done about damage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Damage {
    /// Nothing.
    Off,
    /// Its onset is found; the plate stays as it is.
    #[default]
    Onset,
}

/// What is done about delamination.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delamination {
    /// Nothing.
    Off,
    /// The contact force at which it begins is found, by energies; the plate stays as it is.
    Threshold,
}

/// The effects of a scene.
#[derive(Debug, Clone, Default)]
pub struct EffectsSpec {
    /// Damage.
    pub damage: Damage,
    /// Delamination; by default its threshold as far as damage is looked for and the toughness is known.
    pub delamination: Option<Located<Delamination>>,
    /// Membrane stiffening: strains of large deflections; off unless the scene asks for it.
    pub membrane: Option<Located<Switch>>,
    /// Damping of the plate.
    pub damping: Option<Located<Damping>>,
    /// Inertia of the plate; on unless the scene switches it off.
    pub inertia: Option<Located<Switch>>,
    /// Gravity, which pulls impactors and plate along the way of the impactors, m/s².
    pub gravity: Option<Located<f64>>,
    /// Change of temperature since the plate was free of stress, K.
    pub cure: Option<Located<f64>>,
}

pub(super) const KEYS: Keys = &[
    key("damage", Form::Words(&words(&DAMAGES)), r#""onset""#, EFFECTS[0].summary).default(r#""onset""#),
    key("delamination", Form::Words(&words(&DELAMINATIONS)), r#""threshold""#, EFFECTS[1].summary),
    key("membrane", Form::Words(&words(&SWITCHES)), r#""auto""#, EFFECTS[2].summary).default(r#""off""#),
    key(
        "damping",
        Form::OneOf(&[OFF, Form::Table(DAMPING)]),
        r#"{ mass = "30 1/s", stiffness = "2e-8 s" }"#,
        EFFECTS[3].summary,
    )
    .default(r#""off""#),
    key("inertia", Form::Words(&words(&SWITCHES)), r#""off""#, EFFECTS[4].summary).default(r#""on""#),
    key("gravity", Form::OneOf(&[OFF, Form::Quantity(Dimension::ACCELERATION)]), r#""9.81 m/s^2""#, EFFECTS[5].summary)
        .default(r#""off""#),
    key("cure", Form::OneOf(&[OFF, Form::Quantity(Dimension::TEMPERATURE)]), r#""-150 K""#, EFFECTS[6].summary)
        .default(r#""off""#),
];
const DAMAGES: [(&str, Damage); 2] = [("onset", Damage::Onset), ("off", Damage::Off)];
const DELAMINATIONS: [(&str, Delamination); 2] = [("off", Delamination::Off), ("threshold", Delamination::Threshold)];
const SWITCHES: [(&str, Switch); 3] = [("off", Switch::Off), ("on", Switch::On), ("auto", Switch::Auto)];
const OFF: Form = Form::Words(&["off"]);
const DAMPING: Keys = &[
    key("mass", Form::Quantity(Dimension::FREQUENCY), r#""30 1/s""#, "factor of the mass matrix"),
    key("stiffness", Form::Quantity(Dimension::TIME), r#""2e-8 s""#, "factor of the stiffness matrix"),
    key("ratio", Form::Number, "0.02", "of every mode to critical damping; needs a reduction to modes"),
];

/// An effect as lists show it.
#[derive(Debug, Clone, Copy)]
pub struct EffectInfo {
    /// Its key in `effects`.
    pub name: &'static str,
    /// Its values, the default first.
    pub values: &'static str,
    /// What it does.
    pub summary: &'static str,
    /// Where it comes from.
    pub source: &'static str,
}

/// All effects.
pub const EFFECTS: &[EffectInfo] = &[
    EffectInfo {
        name: "damage",
        values: "\"onset\", \"off\"",
        summary: "first failure of plies and interfaces by the criteria of the scene",
        source: "AFWAL-TR-87-4117",
    },
    EffectInfo {
        name: "delamination",
        values: "\"threshold\", \"off\"",
        summary: "the contact force at which the laminate delaminates; follows `damage` unless it is given",
        source: "Davies and Zhang 1995; Olsson 2001",
    },
    EffectInfo {
        name: "membrane",
        values: "\"off\", \"on\", \"auto\"",
        summary: "membrane stiffening: strains of large deflections",
        source: "von Karman 1910",
    },
    EffectInfo {
        name: "damping",
        values: "\"off\", { mass, stiffness }, { ratio }",
        summary: "viscous damping C = mass M + stiffness K, or the same ratio for every mode of a reduced plate",
        source: "Rayleigh 1877",
    },
    EffectInfo {
        name: "inertia",
        values: "\"on\", \"off\", \"auto\"",
        summary: "inertia of the plate; without it the plate is at rest under the contact forces at every instant",
        source: "Shivakumar, Elber, Illg 1985",
    },
    EffectInfo {
        name: "gravity",
        values: "\"off\", an acceleration",
        summary: "weight of impactors and plate along the direction of impact",
        source: "Newton 1687",
    },
    EffectInfo {
        name: "cure",
        values: "\"off\", a change of temperature",
        summary: "residual stresses of the plies; the change counts from the temperature at which the plate is free of \
            stress",
        source: "Tsai and Hahn 1980",
    },
];

pub(super) fn read(field: &Field<'_>) -> Result<EffectsSpec, SceneError> {
    let table = field.table(KEYS)?;
    let damage = table.optional("damage").map(|f| f.choice(&DAMAGES));
    Ok(EffectsSpec {
        damage: damage.transpose()?.unwrap_or_default(),
        delamination: choice(&table, "delamination", &DELAMINATIONS)?,
        membrane: switch(&table, "membrane")?,
        damping: unless_off(&table, "damping", read_damping)?,
        inertia: switch(&table, "inertia")?,
        gravity: unless_off(&table, "gravity", |field| field.positive(Dimension::ACCELERATION))?,
        cure: unless_off(&table, "cure", |field| field.quantity(Dimension::TEMPERATURE))?,
    })
}

/// What `read` makes of a value that is not `"off"`.
fn unless_off<T>(
    table: &Reader<'_>,
    key: &str,
    read: impl Fn(&Field<'_>) -> Result<T, SceneError>,
) -> Result<Option<Located<T>>, SceneError> {
    let field = table.optional(key).filter(|field| !matches!(field.node(), Node::Text(text) if text == "off"));
    field.map(|field| Ok(field.at(read(&field)?))).transpose()
}

fn read_damping(field: &Field<'_>) -> Result<Damping, SceneError> {
    if let Node::Text(_) = field.node() {
        field.choice(&[("off", ())])?;
    }
    let table = field.table(DAMPING)?;
    let [proportional, ratio] = match table.optional("mass") {
        Some(_) => table.either(["mass", "ratio"])?,
        None => table.either(["stiffness", "ratio"])?,
    };
    let factor = |key, dimension| table.optional(key).map_or(Ok(0.0), |field| field.positive(dimension));
    match (ratio, proportional) {
        (Some(ratio), _) => match ratio.number()? {
            value if value > 0.0 && value <= 1.0 => Ok(Damping::Ratio(value)),
            value => {
                let message = format!("{value} is not a ratio to critical damping");
                Err(ratio.error(message, "give a number between 0 and 1: ratio = 0.02"))
            }
        },
        (None, Some(_)) => Ok(Damping::Rayleigh(Rayleigh {
            mass: factor("mass", Dimension::FREQUENCY)?,
            stiffness: factor("stiffness", Dimension::TIME)?,
        })),
        (None, None) => Err(field.error(
            "does not say how much",
            "give `mass`, `stiffness` or both, C = mass M + stiffness K, or the `ratio` of every mode: { ratio = 0.02 }",
        )),
    }
}

fn switch(table: &Reader<'_>, key: &str) -> Result<Option<Located<Switch>>, SceneError> {
    choice(table, key, &SWITCHES)
}

fn choice<T: Copy>(table: &Reader<'_>, key: &str, words: &[(&str, T)]) -> Result<Option<Located<T>>, SceneError> {
    table.optional(key).map(|field| Ok(field.at(field.choice(words)?))).transpose()
}
