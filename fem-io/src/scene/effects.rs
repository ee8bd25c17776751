//! The effects that a scene calls for; what it does not name costs nothing.

use super::reader::{Field, Keys, Reader};
use super::source::{Located, SceneError};
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
    /// Change of temperature since the plate was without stresses, K.
    pub cure: Option<Located<f64>>,
}

const EFFECTS: Keys =
    &[("damage", r#""onset""#), ("membrane", r#""auto""#), ("damping", r#""off""#), ("cure", r#""-150 K""#)];

pub(super) fn read(field: &Field<'_>) -> Result<Effects, SceneError> {
    let table = field.table(EFFECTS)?;
    if let Some(field) = table.optional("damping") {
        field.choice(&[("off", ())])?;
    }
    let damage = table.optional("damage").map(|f| f.choice(&[("onset", Damage::Onset), ("off", Damage::Off)]));
    let cure = |field: Field<'_>| Ok(field.at(field.quantity(Dimension::TEMPERATURE)?));
    Ok(Effects {
        damage: damage.transpose()?.unwrap_or_default(),
        membrane: switch(&table, "membrane")?,
        cure: table.optional("cure").map(cure).transpose()?,
    })
}

fn switch(table: &Reader<'_>, key: &str) -> Result<Option<Located<Switch>>, SceneError> {
    let switches = [("off", Switch::Off), ("on", Switch::On), ("auto", Switch::Auto)];
    table.optional(key).map(|field| Ok(field.at(field.choice(&switches)?))).transpose()
}
