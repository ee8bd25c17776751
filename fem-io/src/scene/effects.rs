//! What a scene says of effects: two settings that every scene may have, and the keys of effects that others know.

use crate::document::keys::{Form, Key, Keys, key, words};
use crate::document::reader::SceneValue;
use crate::document::source::{Located, Place, SceneError, SceneSource};
use crate::document::tree::Item;
use fem_core::plugin::unknown_key;
use std::sync::Arc;

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
    /// Interfaces open where their law says so.
    Growth,
    /// As with `Growth` where the sound plate strains its interfaces so far, else as with `Threshold`.
    Auto,
}

/// What a scene says of effects.
#[derive(Debug, Clone, Default)]
pub struct EffectsSpec {
    /// Damage.
    pub damage: Damage,
    /// Delamination; by default its threshold as far as damage is looked for and the toughness is known.
    pub delamination: Option<Located<Delamination>>,
    /// The effects that the scene names, in its order.
    pub named: Vec<EffectSpec>,
}

/// An effect as a scene names it; whoever knows the effects reads its value.
#[derive(Debug, Clone)]
pub struct EffectSpec {
    name: String,
    key_place: Place,
    item: Item,
    source: Arc<SceneSource>,
}

impl EffectSpec {
    /// Its key in `effects`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where its value stands.
    pub fn place(&self) -> &Place {
        &self.item.place
    }

    /// Its value, that of `key`.
    pub fn value(&self, key: &Key) -> SceneValue<'_> {
        SceneValue::new(&self.item, &self.key_place, format!("effects.{}", self.name), key.example, &self.source)
    }

    /// The error of an effect that is none of `known`.
    pub fn unknown<'a>(&self, known: impl Iterator<Item = &'a str>) -> SceneError {
        let help = format!("`{}` {}", self.name, unknown_key(&self.name, known));
        self.source.error_at(&self.key_place, format!("unknown key `effects.{}`", self.name), help)
    }
}

/// A setting of every scene in its table of effects, and where it comes from.
#[derive(Debug, Clone, Copy)]
pub struct EffectSetting {
    /// Its key.
    pub key: Key,
    /// Where it comes from.
    pub source: &'static str,
}

/// The settings of every scene; the keys of effects follow them.
pub const EFFECT_SETTINGS: &[EffectSetting] = &[
    EffectSetting { key: KEYS[0], source: "AFWAL-TR-87-4117" },
    EffectSetting { key: KEYS[1], source: "Davies and Zhang 1995; Olsson 2001" },
];

pub(super) const KEYS: Keys = &[
    key(
        "damage",
        Form::Words(&words(&DAMAGES)),
        r#""onset""#,
        "first failure of plies and interfaces by the criteria of the scene",
    )
    .default(r#""onset""#),
    key(
        "delamination",
        Form::Words(&words(&DELAMINATIONS)),
        r#""threshold""#,
        "the force at which the laminate delaminates, or delaminations that grow; the threshold follows `damage` by default",
    ),
];
const DAMAGES: [(&str, Damage); 2] = [("onset", Damage::Onset), ("off", Damage::Off)];
const DELAMINATIONS: [(&str, Delamination); 4] = [
    ("off", Delamination::Off),
    ("threshold", Delamination::Threshold),
    ("growth", Delamination::Growth),
    ("auto", Delamination::Auto),
];

/// What a table of effects says of delamination; whatever is wrong with it is found when it is read.
pub(super) fn delamination_in(field: &SceneValue<'_>) -> Option<Delamination> {
    let entries = field.entries().ok()?;
    let (_, value) = entries.iter().find(|(key, _)| *key == "delamination")?;
    value.choice(&DELAMINATIONS).ok()
}

pub(super) fn read(field: &SceneValue<'_>) -> Result<EffectsSpec, SceneError> {
    let mut effects = EffectsSpec::default();
    for (name, value) in field.entries()? {
        match name {
            "damage" => effects.damage = value.with_example(KEYS[0].example).choice(&DAMAGES)?,
            "delamination" => {
                let value = value.with_example(KEYS[1].example);
                effects.delamination = Some(value.at(value.choice(&DELAMINATIONS)?));
            }
            _ => effects.named.push(EffectSpec {
                name: name.to_owned(),
                key_place: value.key_place().clone(),
                item: value.item().clone(),
                source: Arc::clone(value.source()),
            }),
        }
    }
    Ok(effects)
}
