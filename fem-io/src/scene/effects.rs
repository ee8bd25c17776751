//! The effects that a scene calls for; what it does not name costs nothing.

use super::reader::{Field, Keys, Reader};
use super::source::{Located, SceneError};
use super::tree::Node;
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

/// The effects of a scene.
#[derive(Debug, Clone, Default)]
pub struct Effects {
    /// Damage.
    pub damage: Damage,
    /// Membrane stiffening: strains of large deflections; off where the scene says nothing of it.
    pub membrane: Option<Located<Switch>>,
    /// Damping of the plate.
    pub damping: Option<Located<Damping>>,
}

const EFFECTS: Keys =
    &[("damage", r#""onset""#), ("membrane", r#""auto""#), ("damping", r#"{ mass = "30 1/s", stiffness = "2e-8 s" }"#)];
const DAMPING: Keys = &[("mass", r#""30 1/s""#), ("stiffness", r#""2e-8 s""#), ("ratio", "0.02")];

pub(super) fn read(field: &Field<'_>) -> Result<Effects, SceneError> {
    let table = field.table(EFFECTS)?;
    let damage = table.optional("damage").map(|f| f.choice(&[("onset", Damage::Onset), ("off", Damage::Off)]));
    Ok(Effects {
        damage: damage.transpose()?.unwrap_or_default(),
        membrane: switch(&table, "membrane")?,
        damping: unless_off(&table, "damping", read_damping)?,
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
            value => Err(ratio.error(format!("{value} is no ratio to critical damping"), "between 0 and 1: ratio = 0.02")),
        },
        (None, Some(_)) => Ok(Damping::Rayleigh(Rayleigh {
            mass: factor("mass", Dimension::FREQUENCY)?,
            stiffness: factor("stiffness", Dimension::TIME)?,
        })),
        (None, None) => Err(field.error(
            "says not how much",
            "give `mass`, `stiffness` or both, C = mass M + stiffness K, or the `ratio` of every mode: { ratio = 0.02 }",
        )),
    }
}

fn switch(table: &Reader<'_>, key: &str) -> Result<Option<Located<Switch>>, SceneError> {
    let switches = [("off", Switch::Off), ("on", Switch::On), ("auto", Switch::Auto)];
    table.optional(key).map(|field| Ok(field.at(field.choice(&switches)?))).transpose()
}
