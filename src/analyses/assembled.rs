//! K and M of a model.

use crate::error::Error;
use crate::forecast::MemoryEstimate;
use crate::model::{Model, Plan};
use fem_core::assembly::{
    Condensation, Condensed, Matrix, Pattern, SparseStructure, Symmetric, assemble, condense, pattern,
};
use fem_core::counters::Counters;
use fem_core::functional::Functional;
use fem_core::structure::{SolveError, Structure};
use fem_dynamics::buckling::{self, Buckling};
use serde::Serialize;
use std::fmt;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// K and M of a model, condensed on its masters where the scene divides the plate into substructures.
#[derive(Debug)]
pub struct Assembled {
    /// Both matrices.
    pub structure: SparseStructure,
    /// Entries of the factor of K.
    pub factor_entries: usize,
    /// Memory that the computation is expected to take at its peak.
    pub memory: MemoryEstimate,
    /// The preload over the one that buckles the plate, negative where only the opposite one does, where there is some.
    pub buckling: Option<f64>,
    /// From the masters to the independent unknowns of the model.
    pub condensation: Option<Condensation>,
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

    /// A functional of the independent unknowns as one of those of the structure.
    pub fn functional(&self, w: &Functional) -> Functional {
        let Some(condensation) = &self.condensation else { return w.clone() };
        let mut f = vec![0.0; condensation.independents()];
        w.add_to(1.0, &mut f);
        let on_masters = condensation.load(&f).0.into_iter().enumerate();
        Functional(on_masters.filter(|(_, w)| *w != 0.0).collect())
    }

    /// Those of some independent unknowns that the structure has.
    pub(super) fn own(&self, unknowns: Vec<usize>) -> Vec<usize> {
        match &self.condensation {
            None => unknowns,
            Some(condensation) => unknowns.into_iter().filter_map(|i| condensation.master(i)).collect(),
        }
    }
}

/// A plate that is divided into substructures.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Substructures {
    /// Those that have an inside.
    pub count: usize,
    /// How many of them were condensed; the others are equal to one of these.
    pub condensed: usize,
    /// Unknowns that are left.
    pub masters: usize,
}

impl fmt::Display for Substructures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { count, condensed, masters } = self;
        write!(f, "{masters} masters of {count} substructures, {condensed} condensed and {} reused", count - condensed)
    }
}

/// Memory that a computation of `model` is expected to take at its peak, before K is assembled; `None` where the plate is divided,
/// whose masters follow from K.
///
/// # Errors
/// More memory than there is, a mass that is wanted where a material has no density.
pub(crate) fn expected_memory(model: &Model) -> Result<Option<MemoryEstimate>, Error> {
    if !matches!(model.plan, Plan::Buckling { .. }) {
        model.check_mass()?;
    }
    if model.division.is_some() {
        return Ok(None);
    }
    let pattern = Arc::new(pattern(&model.plate, &model.constraints));
    Ok(Some(model.analyse(pattern)?.1))
}

/// Assembles K and M of `model`, and what effects add to K, among it what stresses of a preload do. M is left zero where `inertia`
/// is not wanted.
///
/// # Errors
/// A cell that the element refuses, more memory than there is, a mass that is wanted where a material has no density, a preload
/// that buckles the plate.
pub fn structure(
    model: &Model,
    inertia: bool,
    threads: NonZeroUsize,
    counters: &mut Counters,
) -> Result<Assembled, Error> {
    let mut assembled = elastic(model, inertia, threads, counters)?;
    let pattern = assembled.structure.matrices().0.pattern().clone();
    let Some(geometric) = model.effects.geometric(&model.body(), &pattern)? else { return Ok(assembled) };
    assembled.structure.add(1.0, &geometric);
    // The factor serves what comes next as well.
    match assembled.structure.solve_shifted(0.0, &mut vec![0.0; geometric.ndof()], 1) {
        Err(SolveError::NotPositive { .. }) => {}
        other => {
            other?;
            assembled.buckling = share(&mut assembled.structure, &geometric);
            return Ok(assembled);
        }
    }
    assembled.structure.add(-1.0, &geometric);
    let found = factors(&mut assembled.structure, &geometric, FACTORS)?.factors;
    let factor = found.into_iter().filter(|factor| *factor > 0.0).min_by(f64::total_cmp);
    Err(Error::Buckled { factor })
}

/// Factors looked at for the first that is positive: those of a shear load come in pairs of either sign.
pub(super) const FACTORS: usize = 4;

/// The part that a preload is of the one that buckles the plate, whose stiffness has that of the preload, `geometric`, in it; if none of
/// the [`FACTORS`] looked at is of that load, of the opposite one, negative; `None` where none is found.
fn share(structure: &mut SparseStructure, geometric: &Symmetric) -> Option<f64> {
    // Factors on what is added to the preload.
    let more = factors(structure, geometric, FACTORS).ok()?.factors;
    let shares: Vec<f64> = more.iter().map(|more| (1.0 + more).recip()).filter(|share| share.is_finite()).collect();
    let largest = shares.iter().copied().max_by(f64::total_cmp)?;
    if largest > 0.0 { Some(largest) } else { shares.into_iter().min_by(f64::total_cmp) }
}

/// The `count` factors on a `geometric` stiffness that are nearest to zero and take all stiffness from `structure`, and its shapes.
///
/// # Errors
/// A structure that is not held, factors that do not converge.
pub(super) fn factors(
    structure: &mut SparseStructure,
    geometric: &Symmetric,
    count: usize,
) -> Result<Buckling, SolveError> {
    buckling::factors(structure, |scale, x, y| geometric.add_product(scale, x, y), count)
}

/// K and M of the plate that is not divided, with its springs and what effects add to K, but for the stresses of a preload.
///
/// # Errors
/// A cell that the element refuses, a spring outside the plate.
pub(super) fn undivided(
    model: &Model,
    pattern: &Arc<Pattern>,
    inertia: bool,
    threads: NonZeroUsize,
    counters: &mut Counters,
) -> Result<(Symmetric, Symmetric), Error> {
    let Model { plate, element, constraints, .. } = model;
    let mut matrix = |which| assemble(plate, &**element, constraints, pattern, which, threads, counters);
    let mut k = matrix(Matrix::Stiffness)?;
    let m = if inertia { matrix(Matrix::Mass)? } else { Symmetric::zero(pattern.clone()) };
    for spring in &model.springs {
        k.add_spring(spring.stiffness, &spring.at).map_err(SolveError::other)?;
    }
    model.effects.on_stiffness(&model.body(), &mut k)?;
    Ok((k, m))
}

/// The same without the stresses of a preload.
///
/// # Errors
/// As [`structure`], but for the preload.
pub fn elastic(
    model: &Model,
    inertia: bool,
    threads: NonZeroUsize,
    counters: &mut Counters,
) -> Result<Assembled, Error> {
    let Model { plate, element, constraints, division, .. } = model;
    if inertia {
        model.check_mass()?;
    }
    let (described, originals) = (plate.clone(), constraints.clone());
    let name = move |i: usize| described.describe(originals.original(i));
    let Some(division) = division else {
        let pattern = Arc::new(pattern(plate, constraints));
        let (symbolic, memory) = model.analyse(pattern.clone())?;
        let (k, m) = undivided(model, &pattern, inertia, threads, counters)?;
        let factor_entries = symbolic.entries();
        let mut structure = SparseStructure::new(symbolic, k, m, threads, name);
        structure.release(&model.motions);
        return Ok(Assembled { structure, factor_entries, memory, buckling: None, condensation: None });
    };
    let Condensed { k, m, way } = condense(plate, &**element, constraints, division, inertia, threads, counters)?;
    let (symbolic, memory) = model.analyse(k.pattern().clone())?;
    let factor_entries = symbolic.entries();
    let masters: Vec<usize> = (0..way.ndof()).map(|i| way.independent(i)).collect();
    let of_masters = |motion: &[f64]| masters.iter().map(|i| motion[*i]).collect::<Vec<_>>();
    let motions: Vec<f64> = model.motions.chunks_exact(constraints.ndof()).flat_map(of_masters).collect();
    let mut structure = SparseStructure::new(symbolic, k, m, threads, move |i| name(masters[i]));
    structure.release(&motions);
    Ok(Assembled { structure, factor_entries, memory, buckling: None, condensation: Some(way) })
}
