//! The effects that a model simulates.

use super::Model;
use super::builder::Builder;
use fem_core::element::Element;
use fem_io::scene::{Analysis, SceneError, Switch};

/// Effects beyond the linear elastic plate; each is chosen by the scene, or by the advisor where the scene leaves it to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Effects {
    /// Membrane stiffening: strains of large deflections.
    pub membrane: bool,
}

/// A decision about an effect that the scene leaves to the advisor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// The effect, as the scene calls it.
    pub effect: &'static str,
    /// Whether it is simulated.
    pub on: bool,
    /// What was asked, a formula.
    pub formula: &'static str,
    /// Its value as it is expected, beforehand.
    pub expected: f64,
    /// The value from which on the effect is needed.
    pub threshold: f64,
}

/// What the scene calls membrane stiffening.
pub(crate) const MEMBRANE: &str = "membrane";

impl Model {
    /// Whether the scene leaves an effect to the advisor who was not asked yet ([`crate::advise::decided`]). Until then it
    /// is off.
    pub fn undecided(&self) -> bool {
        let auto = self.scene.effects.membrane.as_ref().is_some_and(|wish| wish.value == Switch::Auto);
        auto && !self.decisions.iter().any(|decision| decision.effect == MEMBRANE)
    }
}

impl Builder<'_> {
    pub(super) fn effects(&self, element: &dyn Element) -> Result<Effects, SceneError> {
        Ok(Effects { membrane: self.membrane(element)? })
    }

    fn membrane(&self, element: &dyn Element) -> Result<bool, SceneError> {
        let Some(wish) = &self.scene.effects.membrane else { return Ok(false) };
        if wish.value == Switch::Off {
            return Ok(false);
        }
        let refused = |message: String, help: &str| Err(self.error(wish, message, help));
        if matches!(self.scene.analysis, Analysis::Modes { .. }) {
            return refused("natural modes are those of small vibrations".into(), "leave `membrane` out");
        }
        if element.large_displacements().is_none() {
            let name = &self.scene.element.name.value;
            let message = format!("the element `{name}` knows no large displacements");
            return refused(
                message,
                "choose an element that does, such as `hermite-prism` or `mitc4`, or leave `membrane` out",
            );
        }
        if self.scene.substructures.is_some() {
            return refused(
                "condensed substructures are linear".into(),
                "leave `substructures` out and name a reduction, for example: reduction = { method = \"ritz\", vectors = 40 }",
            );
        }
        Ok(wish.value == Switch::On)
    }
}
