//! Assemble, reduce, couple to the impactors.

use super::Sizes;
use crate::cost::Stopwatch;
use crate::error::Error;
use crate::model::{Impact, Model, Plan, Strike};
use fem_core::assembly::{Matrix, SparseStructure, Symbolic, assemble, pattern};
use fem_core::counters::Counters;
use fem_core::prolongation::Prolongation;
use fem_core::structure::Structure;
use fem_core::time::{StepError, StepLimit};
use fem_dynamics::impact::{ImpactSystem, Impactor};
use fem_dynamics::limit::{self, TooLong};
use fem_dynamics::reduce::Reduced;
use fem_io::scene;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Governors offered to a reduction.
const GOVERNORS: usize = 2000;

/// A model assembled, reduced and coupled to its impactors.
#[derive(Debug)]
pub struct Prepared<'a> {
    pub(super) model: &'a Model,
    pub(super) impact: &'a Impact,
    pub(super) system: ImpactSystem,
    pub(super) reduced: Option<Reduced>,
    /// Sizes and limits.
    pub sizes: Sizes,
    pub(super) counters: Counters,
    pub(super) stopwatch: Stopwatch,
}

/// K and M of `model`, and the number of entries of the factor of K. M is left zero where `inertia` is not wanted.
///
/// # Errors
/// A cell that the element refuses, a pattern too large to factorise.
pub fn structure(
    model: &Model,
    inertia: bool,
    threads: NonZeroUsize,
    counters: &mut Counters,
) -> Result<(SparseStructure, usize), Error> {
    let pattern = Arc::new(pattern(&model.plate, &model.constraints));
    let mut matrix =
        |which| assemble(&model.plate, &*model.element, &model.constraints, &pattern, which, threads, counters);
    let k = matrix(Matrix::Stiffness)?;
    let m = if inertia { matrix(Matrix::Mass)? } else { vec![0.0; k.len()] };
    let symbolic = Symbolic::new(pattern.clone())?;
    let entries = symbolic.entries();
    let (plate, originals) = (model.plate.clone(), model.constraints.clone());
    let name = move |column| plate.describe(originals.original(column));
    let coarse = Prolongation::linear_in_z(&model.plate, &model.constraints);
    Ok((SparseStructure::new(symbolic, k, m, threads, name).with_coarse(coarse), entries))
}

/// Assembles and reduces `model` and checks the step.
///
/// # Errors
/// A scene without an impact, a cell that the element refuses, a structure that is not held, a reduction that fails, a
/// step beyond the stability limit.
pub fn prepare(model: &Model, threads: NonZeroUsize) -> Result<Prepared<'_>, Error> {
    let Plan::Impact(impact) = &model.plan else { return Err(Error::NoImpact) };
    let mut stopwatch = Stopwatch::default();
    let mut counters = Counters::default();
    let (mut structure, factor_entries) = structure(model, true, threads, &mut counters)?;
    stopwatch.lap("assemble");
    let (unknowns, stiffness_entries) = (structure.ndof(), structure.entries());
    let reduced = match &impact.reduction {
        None => None,
        Some(reduction) => {
            let governors = model.governors(impact, GOVERNORS);
            let basis = reduction.basis(&mut structure, &impact.contacts(), &governors);
            Some(basis.and_then(|basis| Reduced::project(&structure, &basis)).map_err(|why| {
                let name = &impact.spec.reduction.name;
                model.scene.source.error_at(&name.place, format!("reduction `{}`: {why}", name.value), "")
            })?)
        }
    };
    (counters.factorisations, counters.solves) = structure.work();
    stopwatch.lap("reduce");

    let impactor = |(spec, strike): (&scene::Impactor, &Strike)| Impactor {
        mass: spec.mass,
        velocity: spec.velocity,
        start: spec.start,
        load: match &reduced {
            None => strike.contact.0.clone(),
            Some(r) => r.restrict(&strike.contact).into_iter().enumerate().collect(),
        },
        law: strike.law.clone(),
    };
    let impactors = impact.spec.impactors.iter().zip(&impact.strikes).map(impactor).collect();
    let structure: Box<dyn Structure> = match &reduced {
        None => Box::new(structure),
        Some(r) => Box::new(r.modal.clone()),
    };
    let mut system = ImpactSystem::new(structure, impactors);
    let march = &impact.spec.march;
    let limited = impact.integrator.limit();
    let (longest_step, highest) =
        limit::longest_step(&mut system, limited).map_err(|e| unmarchable(model, impact, e))?;
    let hertz = |omega: f64| omega / std::f64::consts::TAU;
    if let (StepLimit::OmegaDt(omega_dt), Some(omega)) = (limited, highest)
        && march.step.value > longest_step
    {
        let frequency = hertz(omega_dt / longest_step);
        let (step, limit, plate) = (march.step.value, longest_step, hertz(omega));
        let why = TooLong { step, limit, omega_dt, frequency, plate }.to_string();
        let help = "shorten `march.step`, reduce the model, or choose an implicit integrator such as `newmark`";
        return Err(model.scene.source.error_at(&march.step.place, why, help).into());
    }
    let count = march.end.value / march.step.value;
    let steps = (count * (1.0 - 1e-12)).ceil().max(1.0) as u64;
    // As it is written where it fits the end: a later end then changes no bit of it.
    let whole = (count - steps as f64).abs() <= 1e-12 * count;
    let sizes = Sizes {
        unknowns,
        marched: system.structure().ndof(),
        stiffness_entries,
        factor_entries,
        static_stiffness: 1.0 / system.static_flexibility(0)?,
        highest_frequency: highest.map(hertz),
        lowest_frequency: reduced.as_ref().and_then(|r| r.modal.frequencies().next()).map(hertz),
        longest_step,
        steps,
        step: if whole { march.step.value } else { march.end.value / steps as f64 },
    };
    Ok(Prepared { model, impact, system, reduced, sizes, counters, stopwatch })
}

/// The error of an integrator that cannot march `model`; one that needs M⁻¹ where M has none is shown in the scene.
pub(super) fn unmarchable(model: &Model, impact: &Impact, error: StepError) -> Error {
    let StepError::SingularMass(why) = error else { return error.into() };
    let name = &impact.spec.march.integrator.name;
    let message = format!("`{}` needs the inverse of the mass matrix, which is singular: {why}", name.value);
    let help = "choose an implicit integrator such as `newmark`, a mass that is regular (`element.mass = \"cubic\"`), or \
                another reduction";
    model.scene.source.error_at(&name.place, message, help).into()
}
