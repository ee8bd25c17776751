//! The effects that a scene names, and the settings beside them.

use super::builder::Builder;
use super::{Model, NamedCriterion, Plan};
use crate::effect::{Body, Effects, Facts, Wish};
use crate::error::Error;
use crate::registry::NO_REDUCTION;
use fem_core::element::Element;
use fem_failure::delamination::DelaminationThreshold;
use fem_io::scene::{Damage, Delamination, EffectSpec, Scene, SceneError};

impl Model {
    /// The plate on which effects act.
    pub fn body(&self) -> Body<'_> {
        let Self { plate, element, laminates, materials, constraints, .. } = self;
        let at_rest = !matches!(self.plan, Plan::Impact(_));
        Body { plate, element: &**element, laminates, materials, constraints, at_rest }
    }
}

impl Builder<'_> {
    pub(super) fn effects(&self, element: &dyn Element, criteria: &[NamedCriterion]) -> Result<Effects, SceneError> {
        let named = &self.scene.effects.named;
        let read = |spec| Ok((spec, self.registry.read_effect(spec)?));
        let wishes: Vec<(&EffectSpec, Wish)> = named.iter().map(read).collect::<Result<_, SceneError>>()?;
        let wanted = wishes.iter().filter_map(|(_, wish)| match wish {
            Wish::Off => None,
            Wish::On(effect) | Wish::Auto(effect) => Some(effect.info().key.name),
        });
        let wanted: Vec<&str> = wanted.collect();
        let full = self.scene.impact().is_some_and(|impact| impact.reduction.name.value == NO_REDUCTION);
        let mut effects = Effects::new(self.registry.effects().collect());
        for (spec, wish) in wishes {
            let place = spec.place();
            effects.add(wish, &Facts { scene: self.scene, element, criteria, full, effects: &wanted, place })?;
        }
        Ok(effects)
    }

    /// The model of another reading of the scene.
    pub(super) fn other(&self, scene: Option<&Scene>) -> Result<Option<Box<Model>>, Error> {
        scene.map(|scene| Ok(Box::new(Model::new(scene, self.registry)?))).transpose()
    }

    /// `threshold` where the scene wants it.
    pub(super) fn threshold(
        &self,
        threshold: Option<DelaminationThreshold>,
    ) -> Result<Option<DelaminationThreshold>, SceneError> {
        match &self.scene.effects.delamination {
            None => Ok(threshold.filter(|_| self.scene.effects.damage == Damage::Onset)),
            Some(wish) if wish.value == Delamination::Off => Ok(None),
            // What grows is followed; no impact gives the force a meaning.
            Some(_) if self.scene.impact().is_none() && self.scene.delamination.is_some() => Ok(None),
            Some(wish) if threshold.is_none() => Err(self.error(
                wish,
                "no material gives the toughness between the plies",
                "give the material of `laminate.interface`, or of the plies, its `GIIc`, for example: GIIc = \"0.6 kJ/m^2\"",
            )),
            Some(wish) if self.scene.impact().is_none() => Err(self.error(
                wish,
                "`effects.delamination` needs an impact, and this analysis has none",
                "leave it out",
            )),
            Some(_) => Ok(threshold),
        }
    }
}
