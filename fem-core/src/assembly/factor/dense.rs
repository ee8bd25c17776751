//! The dense work of a front, in tiles that threads share.

use faer::dyn_stack::{MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};
use std::sync::{Mutex, PoisonError};

/// Pivots that are eliminated together, and rows or columns of a tile. They depend on the size of the front alone, and so does every bit.
const TILE: usize = 256;

/// What [`eliminate`] needs for fronts of up to so many `pivots`.
pub(super) fn scratch(pivots: usize) -> StackReq {
    cholesky_in_place_scratch::<f64>(pivots.min(TILE), Par::Seq, Default::default())
}

/// Eliminates the pivots of a front: `panel` (`size × pivots`) becomes their columns of the factor, and from the lower triangle of
/// `square` (`size − pivots` a side) what they do below is taken off.
///
/// # Errors
/// The first pivot that is not positive.
pub(super) fn eliminate(
    panel: &mut [f64],
    square: &mut [f64],
    (size, pivots): (usize, usize),
    threads: usize,
    scratch: &mut MemStack,
) -> Result<(), usize> {
    let mut rest = &mut panel[..];
    for first in (0..pivots).step_by(TILE) {
        let width = TILE.min(pivots - first);
        let (columns, later) = rest.split_at_mut(size * width);
        let own = MatMut::from_column_major_slice_mut(columns, size, width).split_at_row_mut(first).1;
        let (mut diagonal, mut under) = own.split_at_row_mut(width);
        cholesky_in_place(diagonal.rb_mut(), Default::default(), Par::Seq, scratch, Default::default()).map_err(
            |e| match e {
                LltError::NonPositivePivot { index } => first + index,
            },
        )?;
        if let Some(index) = (0..width).find(|i| !diagonal[(*i, *i)].is_finite()) {
            return Err(first + index);
        }
        let diagonal = diagonal.rb();
        shared(rows(under.rb_mut()), threads, |rows| {
            solve_lower_triangular_in_place(diagonal, rows.transpose_mut(), Par::Seq);
        });
        let under = under.rb();
        // Rows from here on are those of `under`; columns that are pivots later.
        let tiles = later.chunks_mut((size * TILE).max(1)).enumerate().map(|(number, columns)| {
            let width = columns.len() / size;
            let columns = MatMut::from_column_major_slice_mut(columns, size, width);
            (number * TILE, columns.split_at_row_mut(first + TILE + number * TILE).1)
        });
        shared(tiles.collect(), threads, |(start, columns)| take(columns, under, start));
        rest = later;
    }
    let below = size - pivots;
    let under = MatRef::from_column_major_slice(panel, size, pivots).split_at_row(pivots).1;
    let tiles = square.chunks_mut((below * TILE).max(1)).enumerate().map(|(number, columns)| {
        let width = columns.len() / below;
        let columns = MatMut::from_column_major_slice_mut(columns, below, width);
        (number * TILE, columns.split_at_row_mut(number * TILE).1)
    });
    shared(tiles.collect(), threads, |(start, columns)| take(columns, under, start));
    Ok(())
}

/// Takes from `columns`, which begin with row `start` and its diagonal, the product of `under` with its own rows.
fn take(columns: MatMut<'_, f64>, under: MatRef<'_, f64>, start: usize) {
    let width = columns.ncols();
    let under = under.split_at_row(start).1;
    let (own, others) = under.split_at_row(width);
    let (diagonal, rest) = columns.split_at_row_mut(width);
    let full = BlockStructure::Rectangular;
    let product = |to: MatMut<'_, f64>, shape, rows| {
        matmul(to, shape, Accum::Add, rows, full, own.transpose(), full, -1.0, Par::Seq);
    };
    product(diagonal, BlockStructure::TriangularLower, own);
    if rest.nrows() > 0 {
        product(rest, full, others);
    }
}

/// Tiles of rows.
fn rows(mut matrix: MatMut<'_, f64>) -> Vec<MatMut<'_, f64>> {
    let mut tiles = Vec::new();
    while matrix.nrows() > 0 {
        let height = TILE.min(matrix.nrows());
        let (tile, rest) = matrix.split_at_row_mut(height);
        tiles.push(tile);
        matrix = rest;
    }
    tiles
}

/// Does `work` on every tile, on some threads.
fn shared<T: Send>(tiles: Vec<T>, threads: usize, work: impl Fn(T) + Sync) {
    let threads = threads.min(tiles.len());
    if threads < 2 {
        return tiles.into_iter().for_each(work);
    }
    let tiles = Mutex::new(tiles.into_iter());
    let next = || tiles.lock().unwrap_or_else(PoisonError::into_inner).next();
    let all = || std::iter::from_fn(next).for_each(&work);
    std::thread::scope(|scope| {
        (1..threads).for_each(|_| {
            scope.spawn(all);
        });
        all();
    });
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use faer::dyn_stack::MemBuffer;
    use nalgebra::DMatrix;

    /// A front of a definite matrix, and a pivot that makes it indefinite if there is one.
    fn front(size: usize, bad: Option<usize>) -> DMatrix<f64> {
        let mut a = DMatrix::from_fn(size, size, |i, j| (((7 * (i + j) + i * j) % 23) as f64 - 11.0) / 23.0);
        (0..size).for_each(|i| a[(i, i)] = if bad == Some(i) { -1.0 } else { size as f64 });
        a
    }

    fn eliminated(a: &DMatrix<f64>, pivots: usize, threads: usize) -> (Result<(), usize>, Vec<f64>, Vec<f64>) {
        let size = a.nrows();
        let mut panel = a.as_slice()[..size * pivots].to_vec();
        let below = size - pivots;
        let mut square = a.view((pivots, pivots), (below, below)).clone_owned().as_slice().to_vec();
        let mut buffer = MemBuffer::new(scratch(pivots));
        let done = eliminate(&mut panel, &mut square, (size, pivots), threads, MemStack::new(&mut buffer));
        (done, panel, square)
    }

    #[test]
    fn fronts_of_one_tile_and_of_many() {
        for (size, pivots) in [(1, 1), (40, 12), (256, 256), (300, 257), (700, 600), (800, 20), (520, 256)] {
            let a = front(size, None);
            let (done, panel, square) = eliminated(&a, pivots, 1);
            assert_eq!(done, Ok(()));
            // L of the pivots, then what is left below: A₂₂ − L₂₁ L₂₁ᵀ.
            let factor = a.clone().cholesky().unwrap().l();
            let near = |found: f64, want: f64| assert!((found - want).abs() < 1e-10 * size as f64, "{size} {pivots}");
            (0..pivots).for_each(|j| (j..size).for_each(|i| near(panel[i + size * j], factor[(i, j)])));
            let (below, l) = (size - pivots, factor.view((pivots, 0), (size - pivots, pivots)));
            let left = a.view((pivots, pivots), (below, below)) - l * l.transpose();
            (0..below).for_each(|j| (j..below).for_each(|i| near(square[i + below * j], left[(i, j)])));
            for threads in [2, 3, 8] {
                assert!(eliminated(&a, pivots, threads) == (Ok(()), panel.clone(), square.clone()), "{size} {threads}");
            }
        }
    }

    #[test]
    fn the_first_bad_pivot_is_named() {
        for bad in [0, 100, 255, 256, 400] {
            assert_eq!(eliminated(&front(500, Some(bad)), 450, 2).0, Err(bad));
        }
    }
}
