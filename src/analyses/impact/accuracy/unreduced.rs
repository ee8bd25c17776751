//! Estimates of a run whose plate is not reduced: those of a reduced one that is marched beside it.

use super::{Before, Estimates, layers, mesh};
use crate::analyses::impact::Sizes;
use crate::analyses::impact::prepare::{beside, project_answers};
use crate::effect::Effect;
use crate::model::{Impact, Model};
use fem_core::functional::{Functional, orthogonalise};
use fem_core::plugin::{Built, Params, Plugin as _, Value};
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::reduce::Ritz;

/// Vectors of the plate beside the run, and steps of the run for each of them, at least.
const VECTORS: u32 = 60;
const STEPS: u64 = 4;

/// Answers to springs and rings, at most: they are full vectors.
const ANSWERS: usize = 200;

/// Marches of the plate in a few vectors, where these are few beside the steps of the run.
///
/// What a run differs by from the plate beside it counts as the error of its step, so that this holds what the vectors leave as well.
pub(in crate::analyses::impact) fn estimate(
    (model, impact): (&Model, &Impact),
    system: &mut ImpactSystem,
    effects: &[Box<dyn Effect>],
    contacts: &[Functional],
    sizes: &Sizes,
) -> Option<Estimates> {
    let rings = impact.strikes.iter().filter_map(|strike| strike.tip.as_ref()).flat_map(|(_, rings)| rings);
    let answers = orthogonalise(model.one_sided().map(|spring| &spring.at).chain(rings).cloned().collect());
    if answers.len() > ANSWERS || sizes.steps < STEPS * (u64::from(VECTORS) + answers.len() as u64) {
        return None;
    }
    let vectors = Params::default().with("vectors", Value::Number(VECTORS.into()));
    let Ok(Built::Reduction(ritz)) = Ritz::build(&vectors) else { return None };
    let structure = system.structure_mut();
    let basis = ritz.basis(structure, contacts, &[]).ok()?;
    let mut reduced = project_answers(structure, &answers, basis, Vec::new()).ok()?;
    effects.to_vec().iter_mut().for_each(|effect| effect.on_reduced(&mut reduced));
    let beside = beside((model, impact), system, contacts, &reduced);
    let sizes = Sizes { marched: reduced.modal.frequencies().count(), ..*sizes };
    let run = Before {
        system: &beside,
        reduced: &reduced,
        membrane: None,
        integrator: impact.integrator.clone(),
        sizes: &sizes,
        couple: None,
        mesh: mesh::estimate(model, &beside, &reduced, None).ok()?,
        layers: layers::estimate(model, &reduced).ok()?,
    };
    Some(Estimates::new(run, None, sizes.steps))
}
