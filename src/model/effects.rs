//! The effects that a model simulates.

use super::Model;
use super::NamedCriterion;
use super::builder::Builder;
use crate::registry::NO_REDUCTION;
use fem_core::damping::Damping;
use fem_core::element::Element;
use fem_core::failure::Site;
use fem_failure::delamination::DelaminationThreshold;
use fem_io::scene::{self, Analysis, Damage, Delamination, Located, SceneError, Switch};

/// Effects beyond the linear elastic plate; each is chosen by the scene, or by the advisor where the scene leaves it to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effects {
    /// Membrane stiffening: strains of large deflections.
    pub membrane: bool,
    /// Damping of the plate.
    pub damping: Option<Damping>,
    /// Inertia of the plate; without it the plate is at rest under the contact forces at every instant.
    pub inertia: bool,
    /// Weight of plate and impactors, m/s².
    pub gravity: Option<f64>,
    /// Change of temperature since the plate was free of stress, K: residual stresses.
    pub cure: Option<f64>,
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
    /// Its value as expected before the run.
    pub expected: f64,
    /// The value from which on the effect is needed.
    pub threshold: f64,
}

/// What the scene calls membrane stiffening.
pub(crate) const MEMBRANE: &str = "membrane";

/// What the scene calls the inertia of the plate.
pub(crate) const INERTIA: &str = "inertia";

impl Model {
    /// Whether the scene leaves an effect to the advisor who was not asked yet (`fem::advise::decided`). Until then
    /// membrane stiffening is off, and inertia on.
    pub fn undecided(&self) -> bool {
        self.leaves(MEMBRANE) || self.leaves(INERTIA)
    }

    /// Whether the scene leaves this effect to the advisor, who has not decided yet.
    pub(crate) fn leaves(&self, effect: &str) -> bool {
        let wishes = &self.scene.effects;
        let wish = if effect == MEMBRANE { &wishes.membrane } else { &wishes.inertia };
        let auto = wish.as_ref().is_some_and(|wish| wish.value == Switch::Auto);
        auto && !self.decisions.iter().any(|decision| decision.effect == effect)
    }
}

impl Builder<'_> {
    pub(super) fn effects(&self, element: &dyn Element, criteria: &[NamedCriterion]) -> Result<Effects, SceneError> {
        Ok(Effects {
            membrane: self.membrane(element)?,
            damping: self.damping()?,
            inertia: self.inertia()?,
            gravity: self.gravity()?,
            cure: self.cure(criteria)?,
        })
    }

    /// `threshold` where the scene wants it.
    pub(super) fn threshold(
        &self,
        threshold: Option<DelaminationThreshold>,
    ) -> Result<Option<DelaminationThreshold>, SceneError> {
        match &self.scene.effects.delamination {
            None => Ok(threshold.filter(|_| self.scene.effects.damage == Damage::Onset)),
            Some(wish) if wish.value == Delamination::Off => Ok(None),
            Some(wish) if threshold.is_none() => Err(self.error(
                wish,
                "no material gives the toughness between the plies",
                "give the material of `laminate.interface`, or of the plies, its `GIIc`, for example: GIIc = \"0.6 kJ/m^2\"",
            )),
            Some(wish) => {
                self.in_time(wish, "delamination", "leave it out")?;
                Ok(threshold)
            }
        }
    }

    /// The impact, which an effect of the scene needs.
    fn in_time<T>(&self, effect: &Located<T>, name: &str, help: &str) -> Result<&scene::ImpactSpec, SceneError> {
        let missing =
            || self.error(effect, format!("`effects.{name}` needs an impact, and this analysis has none"), help);
        self.scene.impact().ok_or_else(missing)
    }

    fn damping(&self) -> Result<Option<Damping>, SceneError> {
        let Some(damping) = &self.scene.effects.damping else { return Ok(None) };
        let impact = self.in_time(damping, "damping", "leave it out")?;
        if matches!(damping.value, Damping::Ratio(_)) && impact.reduction.name.value == NO_REDUCTION {
            return Err(self.error(
                damping,
                "the ratio damps the modes of a reduced plate, and this plate is not reduced",
                "name a reduction, for example: reduction = { method = \"ritz\", vectors = 40 }; or give C = mass M + \
                 stiffness K: damping = { mass = \"30 1/s\", stiffness = \"2e-8 s\" }",
            ));
        }
        Ok(Some(damping.value))
    }

    fn inertia(&self) -> Result<bool, SceneError> {
        let Some(wish) = self.scene.effects.inertia.as_ref().filter(|wish| wish.value != Switch::On) else {
            return Ok(true);
        };
        self.in_time(wish, "inertia", "leave it out")?;
        if wish.value == Switch::Auto {
            return Ok(true);
        }
        if let Some(modes) = &self.scene.output.modes {
            let message = "`output.modes` follows vibrations, and a plate without inertia has none";
            return Err(self.error(modes, message, "leave one of `output.modes` and `effects.inertia` out"));
        }
        Ok(false)
    }

    fn gravity(&self) -> Result<Option<f64>, SceneError> {
        let Some(gravity) = &self.scene.effects.gravity else { return Ok(None) };
        self.in_time(gravity, "gravity", "leave it out; at rest it is a load: load = [{ gravity = [...] }]")?;
        if self.scene.substructures.is_some() {
            let message = "gravity is not carried inside condensed substructures";
            return Err(self.error(gravity, message, "leave one of `substructures` and `effects.gravity` out"));
        }
        Ok(Some(gravity.value))
    }

    fn cure(&self, criteria: &[NamedCriterion]) -> Result<Option<f64>, SceneError> {
        let Some(change) = &self.scene.effects.cure else { return Ok(None) };
        let refused = |message: &str, help: &str| Err(self.error(change, message, help));
        if matches!(self.scene.analysis, Analysis::Modes { .. }) {
            return refused("residual stresses do not change the natural modes of a free plate", "leave `cure` out");
        }
        let looks = criteria.iter().any(|(_, criterion)| criterion.info().site == Site::Interface);
        let judged = self.scene.interface.as_ref().filter(|_| looks);
        if let (Analysis::Static(_), Some(resin)) = (&self.scene.analysis, judged) {
            let message = "the resin between plies has no thermal strain of its own in a static analysis";
            return Err(self.error(resin, message, "leave the criteria that judge interfaces out, or `effects.cure`"));
        }
        let plies = self.scene.laminate.value.plies.iter().map(|ply| ply.material);
        for material in plies.chain(judged.map(|resin| resin.value)).map(|m| &self.scene.materials[m]) {
            if let Err(why) = material.value.thermal_expansion() {
                let help =
                    "give it, for example: alpha1 = \"-1e-6 1/K\", alpha2 = \"26e-6 1/K\"; or leave `effects.cure` out";
                return Err(self.error(material, why.to_string(), help));
            }
        }
        Ok(Some(change.value))
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
            let message = format!("the element `{name}` does not support large deflections");
            return refused(
                message,
                "use an element that does, such as `hermite-prism` or `mitc4`, or leave `membrane` out",
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
