//! A model of TRADYR: pieces put together by node numbers, condensed on governors.

use super::march::system;
use super::project::Project;
use super::reduced::{Block, Way, reduce};
use crate::error::Error;
use fem_core::assembly::{Cholesky, FactorError, SparseStructure, Symbolic, Symmetric, assemble_blocks, block_pattern};
use fem_core::constraint::Constraints;
use fem_io::deck::{DeckError, DeckSource, Fault, ImpactDeck, MarchCard};
use nalgebra::{Cholesky as Dense, DMatrix, SymmetricEigen};
use std::f64::consts::SQRT_2;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Least pivot of an inertia whose diagonal is scaled to 1.
const SINGULAR: f64 = 1e-12;

/// Growth of the fastest mode over an analysis beyond which schemes without a stable step are refused.
const MOST_GROWTH: f64 = 100.0;

/// K* and M* on the governors, and the way back.
#[derive(Debug)]
pub(super) struct Model {
    pub(super) way: Way,
    /// K*, both triangles, column-major.
    pub(super) k: Vec<f64>,
    /// M*.
    pub(super) m: Vec<f64>,
    stiffness: Symmetric,
    inertia: Symmetric,
    /// Circular frequencies, ascending.
    pub(super) omega: Vec<f64>,
    /// Upper bound of the circular frequencies of plate and contact together.
    bound: f64,
}

impl Model {
    /// # Errors
    /// Matrices that are not there, what can move without strain, governors without inertia.
    pub(super) fn new(source: &DeckSource, deck: &ImpactDeck, project: &Project) -> Result<Self, Error> {
        let per_node = deck.freedom.directions.len();
        let mut placed = Vec::new();
        for piece in &deck.substructures {
            let Some(matrices) = project.matrices(&piece.name.value) else {
                let found = format!("there are no matrices `{}`", piece.name.value);
                return Err(source
                    .error(piece.name.place.clone(), Fault::NoSuchResult, found, "generate them first")
                    .into());
            };
            let dofs: Vec<usize> = piece.nodes.iter().flat_map(|n| n * per_node..(n + 1) * per_node).collect();
            placed.push((dofs, matrices));
        }
        let blocks: Vec<Block<'_>> =
            placed.iter().map(|(dofs, matrices)| Block { dofs, k: &matrices.k, m: &matrices.m }).collect();
        let way = reduce(source, &deck.freedom, &blocks)?;
        let [k, m] = way.condensed();
        let n = deck.freedom.kept.len();
        let order: Vec<usize> = (0..n).collect();
        let all = match Constraints::following(&order, []) {
            Ok(all) => all,
            Err(why) => return Err(source.error(0..0, Fault::Constrained, why.to_string(), "").into()),
        };
        let pattern = Arc::new(block_pattern([&order[..]], &all));
        let whole = |a: &[f64]| assemble_blocks(&pattern, [(&order[..], a)], &all);
        let (stiffness, inertia) = (whole(&k), whole(&m));
        check_inertia(source, deck, &inertia)?;
        let omega = frequencies(n, &k, &m);
        let mut model = Self { way, k, m, stiffness, inertia, omega, bound: 0.0 };
        model.bound = system(deck, &model)?.frequency_bound(model.omega.last().copied().unwrap_or(0.0))?;
        Ok(model)
    }

    /// The governors as a structure that is marched.
    ///
    /// # Errors
    /// More governors than can be numbered.
    pub(super) fn structure(&self) -> Result<SparseStructure, FactorError> {
        let symbolic = Symbolic::new(self.stiffness.pattern().clone())?;
        let name = |i: usize| format!("governor {}", i + 1);
        Ok(SparseStructure::new(symbolic, self.stiffness.clone(), self.inertia.clone(), NonZeroUsize::MIN, name))
    }

    /// The highest circular frequency times DELTA.
    pub(super) fn omega_step(&self, march: &MarchCard) -> f64 {
        self.omega.last().copied().unwrap_or(0.0) * march.step.value
    }

    /// The longest stable step of the schemes that have one.
    pub(super) fn longest_step(&self, march: &MarchCard) -> f64 {
        limit(march) / self.bound
    }

    /// Refuses steps that blow up; returns by how much the fastest mode grows where every step grows.
    ///
    /// # Errors
    /// A DELTA beyond the limit of the scheme, with the largest that is possible.
    pub(super) fn check_step(&self, source: &DeckSource, march: &MarchCard) -> Result<Option<f64>, DeckError> {
        let (x, steps, limit) = (self.omega_step(march), march.steps as f64, limit(march));
        if !(x <= limit) {
            let longest = march.step.value * limit / x;
            let found = format!(
                "DELTA is {}: the highest frequency times DELTA is {x:.4}, INTALG {} allows {limit:.4}",
                march.step.value, march.order
            );
            let help = format!("DELTA of {longest:.3e} or less; derivatives as governors have high frequencies");
            return Err(source.error(march.step.place.clone(), Fault::Unstable, found, help));
        }
        let touching = self.bound * march.step.value;
        // Schemes without a stable step grow while contact lasts, which the balance of energy sees.
        if march.order > 2 && !(touching <= limit) {
            let found = format!(
                "DELTA is {}: the highest frequency of plate and contact times DELTA is {touching:.4}, INTALG {} allows {limit:.4} \
                 (of the plate alone {x:.4})",
                march.step.value, march.order
            );
            let longest = self.longest_step(march);
            let help = if longest > 0.0 {
                format!(
                    "DELTA of {longest:.3e} or less, or look at K, M, I and C: a contact this stiff is often a slip of units"
                )
            } else {
                "look at K, M, I and C: no DELTA is short enough for a contact this stiff".to_owned()
            };
            return Err(source.error(march.step.place.clone(), Fault::Unstable, found, help));
        }
        Ok(match march.order {
            1 => Some((0.5 * steps * (x * x).ln_1p()).exp()),
            2 => Some((0.5 * steps * (0.25 * x.powi(4)).ln_1p()).exp()),
            _ => None,
        })
    }
}

/// ω Δt that a scheme allows: its limit of stability, or what grows no more than [`MOST_GROWTH`] in all steps.
fn limit(march: &MarchCard) -> f64 {
    // |amplification|² of the scheme for ω Δt, less 1, is its square and a quarter of its fourth power.
    let growth = (2.0 * MOST_GROWTH.ln() / march.steps as f64).exp_m1();
    match march.order {
        1 => growth.sqrt(),
        2 => (4.0 * growth).powf(0.25),
        3 => 3.0_f64.sqrt(),
        _ => 2.0 * SQRT_2,
    }
}

fn check_inertia(source: &DeckSource, deck: &ImpactDeck, inertia: &Symmetric) -> Result<(), DeckError> {
    let refuse = |governor: usize| {
        let place = deck.freedom.places[governor].clone();
        let found = format!("{} is a governor without inertia", deck.freedom.phrase(deck.freedom.kept[governor]));
        let help = "the reduced mass must be positive definite: name translations, no more than the pieces have";
        source.error(place, Fault::SingularMass, found, help)
    };
    let too_large = |why: FactorError| source.error(deck.freedom.count.clone(), Fault::TooLarge, why.to_string(), "");
    let mut factor = Cholesky::new(Symbolic::new(inertia.pattern().clone()).map_err(too_large)?, NonZeroUsize::MIN);
    factor.factorise(inertia.lower()).map_err(|why| match why {
        FactorError::NotPositive { column } => refuse(column),
        why => too_large(why),
    })?;
    match factor.weakest(inertia.lower()) {
        Some((column, pivot)) if !(pivot > SINGULAR) => Err(refuse(column)),
        _ => Ok(()),
    }
}

/// Circular frequencies of K* and M*, ascending; 0 of motions without strain.
///
/// `fem_dynamics` finds modes in the metric of K and bounds the highest frequency. Governors may describe rigid motions, so that
/// K* is singular where M* is definite, and the listing prints the highest frequency itself.
fn frequencies(n: usize, k: &[f64], m: &[f64]) -> Vec<f64> {
    let [k, m] = [k, m].map(|a| DMatrix::from_column_slice(n, n, a));
    let Some(l) = Dense::new(m).map(Dense::unpack) else { return Vec::new() };
    let Some(half) = l.solve_lower_triangular(&k) else { return Vec::new() };
    let Some(inner) = l.solve_lower_triangular(&half.transpose()) else { return Vec::new() };
    let eigen = SymmetricEigen::new((&inner + inner.transpose()) * 0.5);
    let mut omega: Vec<f64> = eigen.eigenvalues.iter().map(|square| square.max(0.0).sqrt()).collect();
    omega.sort_by(f64::total_cmp);
    omega
}
