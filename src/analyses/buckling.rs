//! Factors on a preload that buckle the plate.

use super::assembled::{self, factors};
use super::supports;
use crate::cost::{Phase, Stopwatch};
use crate::error::Error;
use crate::model::Model;
use fem_core::counters::Counters;
use fem_core::structure::Structure;
use fem_dynamics::buckling::Buckling;
use std::num::NonZeroUsize;

/// The load factors of a model and what finding them cost.
#[derive(Debug, Clone)]
pub struct BucklingSolution {
    /// Factors, and shapes over the independent unknowns, whose largest displacement is 1 m.
    pub buckling: Buckling,
    /// Independent unknowns.
    pub unknowns: usize,
    /// Entries of the factor of K.
    pub factor_entries: usize,
    /// The largest share of a shape's stiffness that supports of nodal values cost between the nodes, where it is worth a word
    /// ([`softness`](fem_core::assembly::softness)).
    pub softness: Option<f64>,
    /// Work done.
    pub counters: Counters,
    /// Time per phase.
    pub phases: Vec<Phase>,
}

/// Finds the `count` load factors nearest to zero, of either sign: (K + λ K_G) φ = 0.
///
/// # Errors
/// A model without a preload, a cell that the element refuses, a plate that is not held, factors that do not converge.
pub fn solve(model: &Model, count: usize, threads: NonZeroUsize) -> Result<BucklingSolution, Error> {
    let mut stopwatch = Stopwatch::default();
    let mut counters = Counters::default();
    let mut assembled = assembled::elastic(model, false, threads, &mut counters)?;
    let pattern = assembled.structure.matrices().0.pattern().clone();
    let geometric = model.effects.geometric(&model.body(), &pattern)?.ok_or(Error::NoPreload)?;
    stopwatch.lap("assemble");
    let mut buckling = factors(&mut assembled.structure, &geometric, count)?;
    let softness = supports::soft_shapes(model, &mut assembled.structure, &buckling.shapes);
    let mut u = vec![0.0; model.plate.ndof()];
    for shape in buckling.shapes.chunks_exact_mut(model.constraints.ndof().max(1)) {
        model.constraints.expand(shape, &mut u);
        let moved = u.iter().enumerate().filter(|(dof, _)| model.plate.locate(*dof).2.m() == 0);
        let largest = moved.fold(0.0_f64, |most, (_, u)| if u.abs() > most.abs() { *u } else { most });
        shape.iter_mut().for_each(|x| *x /= largest);
    }
    (counters.factorisations, counters.solves) = assembled.structure.work();
    stopwatch.lap("modes");
    let (factor_entries, phases) = (assembled.factor_entries, stopwatch.phases().to_vec());
    Ok(BucklingSolution { buckling, unknowns: model.constraints.ndof(), factor_entries, softness, counters, phases })
}
