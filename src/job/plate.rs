//! Many impacts on one plate.

use super::impact::advance;
use super::{Finished, Follow, Found, ImpactFound};
use crate::advise;
use crate::analyses::impact::{March, SharedPlate};
use crate::cost::Cost;
use crate::error::Error;
use crate::model::{Model, leaves_plate};
use crate::output::summary::ImpactSummary;
use crate::registry::Registry;
use fem_io::scene::Scene;
use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};

/// The reduced plate of a scene, kept for many impacts: who seeks an impact, or maps many, pays for its matrices and its modes
/// once. Impacts may be computed on several threads at a time.
#[derive(Debug)]
pub struct KeptPlate {
    /// Impacts are told from it one after the other: integrators go from thread to thread, and are not shared.
    model: Mutex<Model>,
    plate: SharedPlate,
}

impl KeptPlate {
    /// That of `scene`; `threads` integrate the matrices of elements.
    ///
    /// # Errors
    /// What [`run`](super::run) is refused for; [`Error::NotKept`] where an impact needs more than a reduced plate.
    pub fn new(scene: &Scene, registry: &Registry, threads: NonZeroUsize) -> Result<Self, Error> {
        let model = Model::new(scene, registry)?;
        let plate = SharedPlate::new(&model, threads)?.ok_or(Error::NotKept)?;
        Ok(Self { model: Mutex::new(model), plate })
    }

    /// The impact of `scene`, which may differ from that of the plate in the impactor (but for the place and the patch of its
    /// contact), the contact law and strengths. It finds what [`run`](super::run) finds, to the bit, but for estimates of
    /// errors, which need the plate before its reduction.
    ///
    /// # Errors
    /// [`Error::OtherPlate`] where `scene` differs in more; otherwise as [`run`](super::run).
    pub fn impact(&self, scene: &Scene, registry: &Registry, follow: &mut dyn Follow) -> Result<Finished, Error> {
        let model = advise::decided(self.struck(scene, registry)?, NonZeroUsize::MIN)?;
        let prepared = self.plate.struck(&model)?;
        let sizes = prepared.sizes;
        let mut march = March::start(prepared)?;
        advance(&model, &mut march, None, follow)?;
        let outcome = march.finish();
        let summary = ImpactSummary::new(&model, &sizes, &outcome);
        let cost = Cost::new(NonZeroUsize::MIN, outcome.phases.clone());
        let found = Found::Impact(Box::new(ImpactFound { sizes, outcome, summary }));
        follow.found(&found, &cost);
        Ok(Finished { model, found, cost, folder: None })
    }

    fn struck(&self, scene: &Scene, registry: &Registry) -> Result<Model, Error> {
        let model = self.model.lock().unwrap_or_else(PoisonError::into_inner);
        let other = || {
            let (old, new) = (&model.origin.keys, &scene.keys);
            let differs = |key: &&String| !leaves_plate(key) && old.get(*key) != new.get(*key);
            let key = old.keys().chain(new.keys()).find(differs).cloned().unwrap_or_default();
            Error::OtherPlate { key }
        };
        model.struck_anew(scene, registry)?.ok_or_else(other)
    }
}
