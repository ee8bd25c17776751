//! Sparse matrices of a plate: pattern once, values many times, Cholesky with its storage reused (feature `assembly`).
//!
//! faer carries them: a [`Pattern`] is its symbolic matrix, [`Symmetric::lower`] its matrix, and whatever it offers goes on from
//! there. Threads, equal cells, substructures and the factorisation are ours.

mod alike;
mod blocks;
mod cell_map;
mod coarse;
mod condition;
mod equilibrium;
mod factor;
mod free;
mod inside;
mod krylov;
mod large;
mod lawful;
mod membrane;
mod ordering;
mod pattern;
mod preload;
mod released;
mod separable;
mod softness;
mod sparse;
mod substructure;
mod symmetric;

pub use blocks::{assemble_blocks, block_pattern};
pub use condition::NOTABLE_CONDITION;
pub use equilibrium::{Equilibrium, EquilibriumError, InternalForce, equilibrium};
pub use factor::{Cholesky, FactorError, Symbolic};
pub use free::free_forces;
pub use inside::Inside;
pub use large::LargePlate;
pub use lawful::{LawForce, LawPlate};
pub use membrane::MembraneStrains;
pub use ordering::{column_order, elimination_order};
pub use pattern::{Pattern, PatternError, pattern};
pub use preload::{add_geometric_stiffness, displacements_at_rest};
pub use separable::{
    Growth, Path, PathEnd, PathError, PathPoint, Separable, SeparableError, SeparableParts, SeparableWork,
};
pub use softness::softness;
pub use sparse::SparseStructure;
pub use substructure::{Condensation, CondensationError, Condensed, Division, condense};
pub use symmetric::Symmetric;

use crate::contracts::element::{Element, ElementError, Scratch, form};
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;
use crate::words::counters::Counters;
use alike::Alike;
use cell_map::CellMap;
use std::fmt;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Which matrix to assemble.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Matrix {
    Stiffness,
    Mass,
}

/// An element matrix that could not be made.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyError {
    /// Number of the quad in the file.
    pub quad_tag: u64,
    /// Layer of cells from the bottom.
    pub layer: usize,
    /// What the element said.
    pub error: ElementError,
}

impl fmt::Display for AssemblyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cell {} of the mesh, layer {}: {}", self.quad_tag, self.layer + 1, self.error)
    }
}
impl std::error::Error for AssemblyError {}

/// Matrices made side by side before they are added.
const BATCH: usize = 64;

/// K or M of `plate` on its [`pattern()`].
///
/// Cells of equal shape and plies share one matrix; of those that a symmetry maps onto each other one counts for all.
/// Threads share the integration only; matrices are added in one order,
/// so the result is the same bit for bit for any number of threads.
///
/// # Errors
/// A cell that the element refuses.
pub fn assemble(
    plate: &Plate,
    element: &dyn Element,
    constraints: &Constraints,
    pattern: &Arc<Pattern>,
    matrix: Matrix,
    threads: NonZeroUsize,
    counters: &mut Counters,
) -> Result<Symmetric, AssemblyError> {
    let size = plate.most_unknowns().pow(2);
    let mut sum = Symmetric::zero(pattern.clone());
    let mut map = CellMap::default();
    let alike = Alike::of(plate);
    let mut batch = vec![0.0; size * BATCH.min(alike.len())];
    let mut scratches: Vec<Scratch> = (0..threads.get()).map(|_| Scratch::default()).collect();
    let integrate = |cell: usize, scratch: &mut Scratch, out: &mut [f64]| -> Result<(), AssemblyError> {
        let (quad, layer) = plate.place(cell);
        let view = plate.cell(cell);
        let element = form(element, view.corners.domain());
        let out = &mut out[..element.info().ndof().pow(2)];
        let done = match matrix {
            Matrix::Stiffness => element.stiffness(&view, scratch, out),
            Matrix::Mass => element.mass(&view, scratch, out),
        };
        let finite = || if out[0].is_finite() { Ok(()) } else { Err(ElementError("the matrix is not finite".into())) };
        done.and_then(|()| finite()).map_err(|error| AssemblyError {
            quad_tag: plate.plane.quad_tags[quad],
            layer,
            error,
        })
    };
    for first in (0..alike.len()).step_by(BATCH) {
        let count = BATCH.min(alike.len() - first);
        let batch = &mut batch[..count * size];
        let share = count.div_ceil(threads.get());
        if threads.get() == 1 {
            for (i, out) in batch.chunks_exact_mut(size).enumerate() {
                integrate(alike.cells(first + i)[0].0 as usize, &mut scratches[0], out)?;
            }
        } else {
            std::thread::scope(|scope| {
                let (integrate, alike) = (&integrate, &alike);
                let workers: Vec<_> = batch
                    .chunks_mut(share * size)
                    .zip(&mut scratches)
                    .enumerate()
                    .map(|(w, (part, scratch))| {
                        scope.spawn(move || {
                            part.chunks_exact_mut(size).enumerate().try_for_each(|(i, out)| {
                                integrate(alike.cells(first + w * share + i)[0].0 as usize, scratch, out)
                            })
                        })
                    })
                    .collect();
                workers.into_iter().try_for_each(|w| match w.join() {
                    Ok(result) => result,
                    Err(panic) => std::panic::resume_unwind(panic),
                })
            })?;
        }
        counters.elements += count as u64;
        for (i, a) in batch.chunks_exact(size).enumerate() {
            let cells = alike.cells(first + i);
            let a = &a[..plate.info_of(plate.place(cells[0].0 as usize).0).ndof().pow(2)];
            for (cell, weight) in cells {
                map.set(plate, constraints, *cell as usize);
                map.scatter(a, *weight, &mut sum);
            }
        }
    }
    counters.elements_reused += (alike.total() - alike.len()) as u64;
    Ok(sum)
}
