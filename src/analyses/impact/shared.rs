//! A plate that many impacts share.

use super::prepare::{Before, Prepared, Ready, Struck, make_ready, rests, strike};
use crate::analyses::expansion::Expansion;
use crate::analyses::samples::PlateStresses;
use crate::effect::Effect;
use crate::error::Error;
use crate::model::{Model, Plan};
use fem_core::assembly::Condensation;
use fem_core::counters::Counters;
use fem_core::functional::Functional;
use fem_core::structure::Structure;
use fem_dynamics::reduce::{Companions, MembranePlate, Reduced};
use std::num::NonZeroUsize;
use std::sync::Arc;

/// A reduced plate with all that is the same of it whatever strikes it: who marches many impacts on it makes it once.
#[derive(Debug)]
pub struct SharedPlate {
    effects: Vec<Box<dyn Effect>>,
    pub(super) reduced: Arc<Reduced>,
    pub(super) membrane: Option<(MembranePlate, Companions)>,
    condensation: Option<Arc<Condensation>>,
    contacts: Vec<Functional>,
    pub(super) stresses: Option<Arc<PlateStresses>>,
    before: Before,
    counters: Counters,
}

impl SharedPlate {
    /// The plate of `model`; `None` where it is not reduced, so that it has to be made anew for each impact.
    ///
    /// # Errors
    /// As [`prepare`](super::prepare()), but for the step.
    pub fn new(model: &Model, threads: NonZeroUsize) -> Result<Option<Self>, Error> {
        let Plan::Impact(impact) = &model.plan else { return Err(Error::NoImpact) };
        let undecided = model.effects.undecided() || model.grown.is_some();
        if undecided || model.separation.is_some() || model.laws.is_some() {
            return Ok(None);
        }
        if impact.reduction.is_none() && !rests(model) {
            return Ok(None);
        }
        let ready = make_ready(model, impact, threads)?;
        let Ready { effects, plate, contacts, condensation, before, counters, .. } = ready;
        let Some(reduced) = plate.reduced.map(Arc::new) else { return Ok(None) };
        let (companions, condensation) =
            (plate.stretched.as_ref().map(|(_, companions)| companions.clone()), condensation.map(Arc::new));
        let (of_march, condensed) = (Some(Arc::clone(&reduced)), condensation.clone());
        let expansion = Expansion { model, reduced: of_march, companions, share: None, condensation: condensed };
        let stresses = match model.criteria.is_empty() {
            true => None,
            false => Some(Arc::new(PlateStresses::new(model, &expansion)?)),
        };
        Ok(Some(Self {
            effects,
            reduced,
            membrane: plate.stretched,
            condensation,
            contacts,
            stresses,
            before,
            counters,
        }))
    }

    /// The impact of `model` on it, whose plate must be this one. It marches as [`prepare`](super::prepare()) has it, to the bit, without estimates
    /// of errors, which need the plate before its reduction.
    ///
    /// # Errors
    /// A scene without an impact, a step beyond the stability limit.
    pub fn struck<'a>(&self, model: &'a Model) -> Result<Prepared<'a>, Error> {
        let Plan::Impact(impact) = &model.plan else { return Err(Error::NoImpact) };
        let structure: Box<dyn Structure> = match &self.membrane {
            Some((membrane, _)) => Box::new(membrane.clone()),
            None => Box::new(self.reduced.modal.clone()),
        };
        let struck = Struck {
            structure,
            effects: self.effects.clone(),
            reduced: Some(Arc::clone(&self.reduced)),
            membrane: self.membrane.clone(),
            condensation: self.condensation.clone(),
        };
        let prepared = strike((model, impact), struck, &self.contacts, self.before.clone())?;
        Ok(Prepared { counters: self.counters, stresses: self.stresses.clone(), ..prepared })
    }
}
