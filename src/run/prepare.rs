//! Assemble, reduce, couple to the impactors.

use super::{Sizes, Substructures};
use crate::cost::Stopwatch;
use crate::error::Error;
use crate::memory::{self, Estimate};
use crate::model::{Impact, Model, Plan, Strike};
use fem_core::assembly::{Condensation, Condensed, Matrix, SparseStructure, assemble, condense, pattern};
use fem_core::counters::Counters;
use fem_core::prolongation::Prolongation;
use fem_core::reduction::Functional;
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

/// K and M of a model, condensed on its masters where the scene divides the plate into substructures.
#[derive(Debug)]
pub struct Assembled {
    /// Both matrices.
    pub structure: SparseStructure,
    /// Entries of the factor of K.
    pub factor_entries: usize,
    /// What the computation takes at its peak, as it is expected.
    pub memory: Estimate,
    /// From the masters to the independent unknowns of the model.
    pub condensation: Option<Condensation>,
}

impl Full {
    /// Right-hand sides solved for so far.
    pub(super) fn solves(&self) -> u64 {
        self.structure.work().1
    }
}

impl Assembled {
    /// A load on the independent unknowns as one on those of the structure, and the displacements that come on top of
    /// what follows from these, if any.
    pub fn load(&self, f: &[f64]) -> (Vec<f64>, Option<Vec<f64>>) {
        match &self.condensation {
            None => (f.to_vec(), None),
            Some(condensation) => {
                let (on_masters, own) = condensation.load(f);
                (on_masters, Some(own))
            }
        }
    }

    /// Displacements of all independent unknowns.
    pub fn expand(&self, u: Vec<f64>) -> Vec<f64> {
        match &self.condensation {
            None => u,
            Some(condensation) => condensation.expand(&u),
        }
    }

    /// Independent unknown that one of the structure stands for.
    pub fn independent(&self, i: usize) -> usize {
        self.condensation.as_ref().map_or(i, |condensation| condensation.independent(i))
    }

    /// How the plate is divided, if it is.
    pub fn substructures(&self) -> Option<Substructures> {
        let condensation = self.condensation.as_ref()?;
        let (count, condensed) = condensation.counts();
        Some(Substructures { count, condensed, masters: condensation.ndof() })
    }

    fn functional(&self, w: &Functional) -> Functional {
        let Some(condensation) = &self.condensation else { return w.clone() };
        let mut f = vec![0.0; condensation.independents()];
        w.add_to(1.0, &mut f);
        let on_masters = condensation.load(&f).0.into_iter().enumerate();
        Functional(on_masters.filter(|(_, w)| *w != 0.0).collect())
    }

    /// Those of some independent unknowns that the structure has.
    fn own(&self, unknowns: Vec<usize>) -> Vec<usize> {
        match &self.condensation {
            None => unknowns,
            Some(condensation) => unknowns.into_iter().filter_map(|i| condensation.master(i)).collect(),
        }
    }
}

/// Assembles K and M of `model`. M is left zero where `inertia` is not wanted.
///
/// # Errors
/// A cell that the element refuses, more memory than there is.
pub fn structure(
    model: &Model,
    inertia: bool,
    threads: NonZeroUsize,
    counters: &mut Counters,
) -> Result<Assembled, Error> {
    let Model { plate, element, constraints, division, .. } = model;
    let (described, originals) = (plate.clone(), constraints.clone());
    let name = move |i: usize| described.describe(originals.original(i));
    let Some(division) = division else {
        let pattern = Arc::new(pattern(plate, constraints));
        let (symbolic, memory) = memory::analysed(model, pattern.clone())?;
        let mut matrix = |which| assemble(plate, &**element, constraints, &pattern, which, threads, counters);
        let k = matrix(Matrix::Stiffness)?;
        let m = if inertia { matrix(Matrix::Mass)? } else { vec![0.0; k.len()] };
        let factor_entries = symbolic.entries();
        let structure = SparseStructure::new(symbolic, k, m, threads, name);
        return Ok(Assembled { structure, factor_entries, memory, condensation: None });
    };
    let Condensed { pattern, k, m, way } =
        condense(plate, &**element, constraints, division, inertia, threads, counters)?;
    let (symbolic, memory) = memory::analysed(model, Arc::new(pattern))?;
    let factor_entries = symbolic.entries();
    let masters: Vec<usize> = (0..way.ndof()).map(|i| way.independent(i)).collect();
    let structure = SparseStructure::new(symbolic, k, m, threads, move |i| name(masters[i]));
    Ok(Assembled { structure, factor_entries, memory, condensation: Some(way) })
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
    let mut assembled = structure(model, true, threads, &mut counters)?;
    stopwatch.lap("assemble");
    let (stiffness_entries, factor_entries) = (assembled.structure.entries(), assembled.factor_entries);
    let (substructures, memory) = (assembled.substructures(), assembled.memory);
    let contacts: Vec<Functional> = impact.strikes.iter().map(|s| assembled.functional(&s.contact)).collect();
    let reduced = match &impact.reduction {
        None => None,
        Some(reduction) => {
            let governors = assembled.own(model.governors(impact, GOVERNORS));
            let structure = &mut assembled.structure;
            if assembled.condensation.is_none() {
                structure.offer_coarse(Prolongation::linear_in_z(&model.plate, &model.constraints));
            }
            let basis = reduction.basis(structure, &distinct(&contacts), &governors);
            Some(basis.and_then(|basis| Reduced::project(structure, &basis)).map_err(|why| {
                let name = &impact.spec.reduction.name;
                model.scene.source.error_at(&name.place, format!("reduction `{}`: {why}", name.value), "")
            })?)
        }
    };
    let Assembled { structure, condensation, .. } = assembled;
    (counters.factorisations, counters.solves) = structure.work();
    stopwatch.lap("reduce");

    let impactor = |((spec, strike), contact): ((&scene::Impactor, &Strike), &Functional)| Impactor {
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
        Some(r) => (Box::new(r.modal.clone()), Some(Full { structure, contacts })),
    };
    let mut system = ImpactSystem::new(structure, impactors);
    let march = &impact.spec.march;
    let limited = impact.integrator.limit();
    let (longest_step, highest) =
        limit::longest_step(&mut system, limited).map_err(|e| unmarchable(model, impact, e))?;
    let hertz = |omega: f64| omega / std::f64::consts::TAU;
    if let (StepLimit::OmegaDt(omega_dt), Some(omega)) = (limited, highest)
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
        lowest_frequency: reduced.as_ref().and_then(|r| r.modal.frequencies().next()).map(hertz),
        longest_step,
        steps,
        step: if whole { march.step.value } else { march.end.value / steps as f64 },
    };
    Ok(Prepared { model, impact, system, reduced, full, condensation, sizes, counters, stopwatch })
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
    let help = "choose an implicit integrator such as `newmark`, a mass that is regular (`element.mass = \"cubic\"`), or \
                another reduction";
    model.scene.source.error_at(&name.place, message, help).into()
}
