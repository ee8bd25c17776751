//! Natural frequencies.

use super::assembled::{self, Substructures};
use super::supports;
use crate::cost::{Phase, Stopwatch};
use crate::error::Error;
use crate::model::Model;
use fem_core::assembly::{Matrix, assemble, pattern};
use fem_core::counters::Counters;
use fem_core::structure::Structure;
use fem_dynamics::modes::{self, Modes};
use std::num::NonZeroUsize;
use std::sync::Arc;

/// The lowest modes of a model and what finding them cost.
#[derive(Debug, Clone)]
pub struct ModesSolution {
    /// Frequencies, and shapes over the independent unknowns.
    pub modes: Modes,
    /// Mass that moves with each mode along x, y and z, kg: (φᵀ M r)² for unit modal mass.
    pub effective_masses: Vec<[f64; 3]>,
    /// Independent unknowns.
    pub unknowns: usize,
    /// Entries of the factor of K.
    pub factor_entries: usize,
    /// The preload over the one that buckles the plate ([`Assembled::buckling`](assembled::Assembled::buckling)).
    pub buckling: Option<f64>,
    /// How the plate is divided, if it is.
    pub substructures: Option<Substructures>,
    /// The largest share of a mode's stiffness that supports of nodal values cost between the nodes, where it is worth a word
    /// ([`softness`](fem_core::assembly::softness)).
    pub softness: Option<f64>,
    /// Work done.
    pub counters: Counters,
    /// Time per phase.
    pub phases: Vec<Phase>,
}

/// Finds the `count` lowest modes.
///
/// # Errors
/// A cell that the element refuses, a matrix that cannot be factorised, modes that do not converge.
pub fn solve(model: &Model, count: usize, threads: NonZeroUsize) -> Result<ModesSolution, Error> {
    let mut stopwatch = Stopwatch::default();
    let mut counters = Counters::default();
    let mut assembled = assembled::structure(model, true, threads, &mut counters)?;
    stopwatch.lap("assemble");
    let mut modes = modes::lowest(&mut assembled.structure, count, !model.held)?;
    let softness = supports::soft_shapes(model, &mut assembled.structure, &modes.shapes);
    (counters.factorisations, counters.solves) = assembled.structure.work();
    modes.shapes = assembled.expand(modes.shapes);
    let n = model.constraints.ndof();
    // Substructures that are condensed have forgotten how their mass is spread.
    let whole = match &assembled.condensation {
        None => None,
        Some(_) => {
            let Model { plate, element, constraints, .. } = model;
            let pattern = Arc::new(pattern(plate, constraints));
            Some(assemble(plate, &**element, constraints, &pattern, Matrix::Mass, threads, &mut counters)?)
        }
    };
    let mut momenta = [0, 1, 2].map(|_| vec![0.0; n]);
    // Symmetric modes have no net motion across a mirror, or off the axis of a half-turn.
    let open = |axis: usize| model.plate.symmetry().operations().all(|o| o.keeps_axis(axis));
    for (axis, momentum) in momenta.iter_mut().enumerate().filter(|(axis, _)| open(*axis)) {
        let moves = |i: usize| {
            let dof = model.plate.locate(model.constraints.original(i)).2;
            f64::from(u8::from(dof.m() == 0 && dof.n() == axis + 1))
        };
        let moves: Vec<f64> = (0..n).map(moves).collect();
        match &whole {
            None => assembled.structure.add_mass(1.0, &moves, momentum),
            Some(m) => m.add_product(1.0, &moves, momentum),
        }
    }
    let mass = |shape: &[f64], m: &[f64]| shape.iter().zip(m).map(|(a, b)| a * b).sum::<f64>().powi(2);
    let effective_masses = modes.shapes.chunks_exact(n.max(1)).map(|s| [0, 1, 2].map(|d| mass(s, &momenta[d])));
    let effective_masses = effective_masses.collect();
    stopwatch.lap("modes");
    let (substructures, phases) = (assembled.substructures(), stopwatch.phases().to_vec());
    let (factor_entries, buckling) = (assembled.factor_entries, assembled.buckling);
    Ok(ModesSolution {
        modes,
        effective_masses,
        unknowns: n,
        factor_entries,
        buckling,
        substructures,
        softness,
        counters,
        phases,
    })
}
