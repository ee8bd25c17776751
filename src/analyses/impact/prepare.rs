//! Assemble, reduce, couple to the impactors.

use super::Sizes;
use super::membrane::StretchOf;
use super::sag::Sag;
use crate::analyses::assembled::{Assembled, structure};
use crate::cost::Stopwatch;
use crate::error::Error;
use crate::model::{Impact, Model, Plan, Strike};
use fem_core::assembly::{Condensation, LargePlate, SparseStructure};
use fem_core::counters::Counters;
use fem_core::damping::Damping;
use fem_core::functional::Functional;
use fem_core::prolongation::Prolongation;
use fem_core::reduction::ReductionError;
use fem_core::structure::{SolveError, Structure};
use fem_core::time::{Integrator, StepError};
use fem_dynamics::impact::{ImpactSystem, Impactor};
use fem_dynamics::limit::{self, TooLong};
use fem_dynamics::reduce::{Companions, Reduced, Stiffened, static_responses};
use fem_io::scene;
use std::num::NonZeroUsize;

/// Governors offered to a reduction.
const GOVERNORS: usize = 2000;

/// An indentation, m.
const TOUCH: f64 = 1e-9;

/// A model assembled, reduced and coupled to its impactors.
#[derive(Debug)]
pub struct Prepared<'a> {
    pub(super) model: &'a Model,
    pub(super) impact: &'a Impact,
    pub(super) system: ImpactSystem,
    /// Displacements at rest under gravity, from which those of the system count.
    pub(super) sag: Option<Vec<f64>>,
    pub(super) reduced: Option<Reduced>,
    /// A reduced plate that its deflections stretch, and what it does beside its modes.
    pub(super) stiffened: Option<(Stiffened, Companions)>,
    /// What a reduced model was made from.
    pub(super) full: Option<Full>,
    pub(super) condensation: Option<Condensation>,
    /// Sizes and limits.
    pub sizes: Sizes,
    pub(super) counters: Counters,
    pub(super) stopwatch: Stopwatch,
}

/// The plate before its reduction.
#[derive(Debug)]
pub(super) struct Full {
    pub(super) structure: SparseStructure,
    /// Where each impactor strikes.
    pub(super) contacts: Vec<Functional>,
}

impl Full {
    /// Right-hand sides solved for so far.
    pub(super) fn solves(&self) -> u64 {
        self.structure.work().1
    }
}

/// Assembles and reduces `model` and checks the step.
///
/// # Errors
/// A scene without an impact, a cell that the element refuses, a structure that is not held, a reduction that fails, a
/// step beyond the stability limit.
pub fn prepare(model: &Model, threads: NonZeroUsize) -> Result<Prepared<'_>, Error> {
    let Plan::Impact(impact) = &model.plan else { return Err(Error::NoImpact) };
    if model.undecided() {
        return Err(Error::Undecided);
    }
    let mut stopwatch = Stopwatch::default();
    let mut counters = Counters::default();
    let effects = model.effects;
    // Without inertia a linear plate is what its static responses are, and a reduction has nothing to add to them.
    let at_rest = !effects.inertia && !effects.membrane;
    let inertia = effects.inertia || (effects.membrane && impact.reduction.is_some());
    let mut assembled = structure(model, inertia, threads, &mut counters)?;
    stopwatch.lap("assemble");
    let (stiffness_entries, factor_entries) = (assembled.structure.entries(), assembled.factor_entries);
    let (substructures, memory) = (assembled.substructures(), assembled.memory);
    let contacts: Vec<Functional> = impact.strikes.iter().map(|s| assembled.functional(&s.contact)).collect();
    let basis = match &impact.reduction {
        _ if at_rest => Some(static_responses(&mut assembled.structure, &distinct(&contacts))),
        None => None,
        Some(reduction) => {
            let governors = assembled.own(model.governors(impact, GOVERNORS));
            let structure = &mut assembled.structure;
            if assembled.condensation.is_none() {
                structure.offer_coarse(Prolongation::linear_in_z(&model.plate, &model.constraints));
            }
            Some(reduction.basis(structure, &distinct(&contacts), &governors))
        }
    };
    let sag = effects.gravity.map(|gravity| Sag::of(model, gravity, &mut assembled)).transpose()?;
    let project = |basis: Result<Vec<f64>, ReductionError>| {
        let with_sag = |mut basis: Vec<f64>| {
            basis.extend(sag.iter().flat_map(|sag| &sag.u));
            Reduced::project(&assembled.structure, &basis)
        };
        basis.and_then(with_sag).map_err(|why| {
            let name = &impact.spec.reduction.name;
            model.scene.source.error_at(&name.place, format!("reduction `{}`: {why}", name.value), "")
        })
    };
    let mut reduced = basis.map(project).transpose()?;
    let Assembled { mut structure, condensation, .. } = assembled;
    if let (Some(reduced), false) = (&mut reduced, effects.inertia) {
        reduced.modal.without_inertia();
    }
    match (effects.damping, &mut reduced) {
        (Some(damping), Some(reduced)) => reduced.modal.damp(damping),
        (Some(Damping::Rayleigh(damping)), None) => structure.damp(damping),
        // The scene is refused a ratio without modes.
        (Some(Damping::Ratio(_)) | None, _) => {}
    }
    let stiffened = match &reduced {
        Some(reduced) if effects.membrane => {
            let stiffened = Stiffened::new(&mut structure, reduced, &distinct(&contacts), &StretchOf(model));
            Some(stiffened.map_err(|why| SolveError(why.0))?)
        }
        None if effects.membrane => {
            structure.stiffen(LargePlate::new(&model.plate, model.element.clone(), &model.constraints));
            None
        }
        _ => None,
    };
    (counters.factorisations, counters.solves) = structure.work();
    stopwatch.lap("reduce");

    let impactor = |((spec, strike), contact): ((&scene::ImpactorSpec, &Strike), &Functional)| Impactor {
        mass: spec.mass,
        velocity: spec.velocity,
        start: spec.start,
        load: match &reduced {
            None => contact.0.clone(),
            Some(r) => r.restrict(contact).into_iter().enumerate().collect(),
        },
        law: strike.law.clone(),
    };
    let impactors: Vec<Impactor> =
        impact.spec.impactors.iter().zip(&impact.strikes).zip(&contacts).map(impactor).collect();
    let (structure, full): (Box<dyn Structure>, _) = match &reduced {
        None => (Box::new(structure), None),
        Some(r) => {
            let modal: Box<dyn Structure> = match &stiffened {
                Some((stiffened, _)) => Box::new(stiffened.clone()),
                None => Box::new(r.modal.clone()),
            };
            (modal, Some(Full { structure, contacts }))
        }
    };
    let sag = sag.map(|sag| match &reduced {
        None => sag,
        Some(reduced) => sag.within(reduced),
    });
    let weight = sag.as_ref().zip(effects.gravity).map(|(sag, acceleration)| sag.weight(acceleration));
    let mut system = ImpactSystem::new(structure, impactors).under(weight);
    if !effects.inertia {
        system = system.without_inertia();
    }
    let march = &impact.spec.march;
    if let (Some(reduced), false) = (&reduced, effects.inertia) {
        let trial = ImpactSystem::new(Box::new(reduced.modal.clone()), system.impactors().to_vec());
        touched(trial, impact.integrator.clone(), march.step.value).map_err(|e| unmarchable(model, impact, e))?;
    }
    let limited = impact.integrator.limit();
    let (longest_step, highest) =
        limit::longest_step(&mut system, limited).map_err(|e| unmarchable(model, impact, e))?;
    let hertz = |omega: f64| omega / std::f64::consts::TAU;
    if let (Some(omega_dt), Some(omega)) = (limited.product(), highest)
        && !(march.step.value <= longest_step)
    {
        let frequency = hertz(omega_dt / longest_step);
        let (step, limit, plate) = (march.step.value, longest_step, hertz(omega));
        let why = TooLong { step, limit, omega_dt, frequency, plate }.to_string();
        let help = "shorten `march.step`, reduce the model, or choose an implicit integrator such as `newmark`";
        return Err(model.scene.source.error_at(&march.step.place, why, help).into());
    }
    let count = march.end.value / march.step.value;
    let steps = (count * (1.0 - 1e-12)).ceil().max(1.0) as u64;
    let lowest = reduced.as_ref().and_then(|r| r.modal.frequencies().next());
    // As it is written where it fits the end: a later end then changes no bit of it.
    let whole = (count - steps as f64).abs() <= 1e-12 * count;
    let sizes = Sizes {
        unknowns: model.constraints.ndof(),
        substructures,
        marched: system.structure().ndof(),
        stiffness_entries,
        factor_entries,
        memory,
        static_stiffness: 1.0 / system.static_flexibility(0)?,
        highest_frequency: highest.map(hertz),
        sag: sag.as_ref().map(|sag| system.deflection(0, &sag.u)),
        lowest_frequency: lowest.filter(|omega| omega.is_finite()).map(hertz),
        longest_step,
        steps,
        step: if whole { march.step.value } else { march.end.value / steps as f64 },
    };
    let sag = sag.map(|sag| sag.u);
    Ok(Prepared { model, impact, system, sag, reduced, stiffened, full, condensation, sizes, counters, stopwatch })
}

/// Makes a step with all impactors in contact, to see whether `integrator` needs the inverse of a mass that has none.
///
/// # Errors
/// [`StepError::SingularMass`], then; what else a step may meet is for the march to tell.
fn touched(mut system: ImpactSystem, mut integrator: Box<dyn Integrator>, dt: f64) -> Result<(), StepError> {
    let mut state = system.initial();
    state.u[system.structure().ndof()..].fill(TOUCH);
    integrator.resume(&mut system);
    match integrator.step(&mut system, &mut state, dt) {
        Err(error @ StepError::SingularMass(_)) => Err(error),
        _ => Ok(()),
    }
}

/// Contacts in the very same place once.
fn distinct(contacts: &[Functional]) -> Vec<Functional> {
    let mut distinct: Vec<Functional> = Vec::new();
    for contact in contacts {
        if !distinct.contains(contact) {
            distinct.push(contact.clone());
        }
    }
    distinct
}

/// The error of an integrator that cannot march `model`; one that needs M⁻¹ where M has none is shown in the scene.
pub(super) fn unmarchable(model: &Model, impact: &Impact, error: StepError) -> Error {
    let StepError::SingularMass(why) = error else { return error.into() };
    let name = &impact.spec.march.integrator.name;
    let message = format!("`{}` needs the inverse of the mass matrix, which is singular: {why}", name.value);
    let help = match model.effects.inertia {
        true => {
            "choose an implicit integrator such as `newmark`, a mass that is regular (`element.mass = \"cubic\"`), or \
             another reduction"
        }
        false => "choose an implicit integrator such as `newmark`, or leave `effects.inertia` out",
    };
    model.scene.source.error_at(&name.place, message, help).into()
}
