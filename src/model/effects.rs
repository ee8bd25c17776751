//! The effects that a model simulates.

use super::NamedCriterion;
use super::builder::Builder;
use fem_core::element::Element;
use fem_core::failure::Site;
use fem_io::scene::{Analysis, SceneError, Switch};

/// Effects beyond the linear elastic plate; each is chosen by the scene, or by the advisor where the scene leaves it to it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effects {
    /// Membrane stiffening: strains of large deflections.
    pub membrane: bool,
    /// Change of temperature since the plate was without stresses, K: residual stresses.
    pub cure: Option<f64>,
}

impl Builder<'_> {
    pub(super) fn effects(&self, element: &dyn Element, criteria: &[NamedCriterion]) -> Result<Effects, SceneError> {
        Ok(Effects { membrane: self.membrane(element)?, cure: self.cure(criteria)? })
    }

    fn cure(&self, criteria: &[NamedCriterion]) -> Result<Option<f64>, SceneError> {
        let Some(change) = &self.scene.effects.cure else { return Ok(None) };
        let refused = |message: &str, help: &str| Err(self.error(change, message, help));
        if matches!(self.scene.analysis, Analysis::Modes { .. }) {
            return refused("residual stresses of a free plate change none of its natural modes", "leave `cure` out");
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
