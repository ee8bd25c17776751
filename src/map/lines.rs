//! Where functions of the unit square are zero.

use crate::sweep::border;

/// Parts of each side of the square, and of a line.
const PARTS: usize = 48;
const FINE: usize = 512;

/// Both ends of the pieces of the line on which `level` is zero, linear between the points of a fine grid.
pub(super) fn pieces(level: &dyn Fn([f64; 2]) -> f64) -> Vec<Vec<[f64; 2]>> {
    let shares: Vec<f64> = (0..=PARTS).map(|k| k as f64 / PARTS as f64).collect();
    let values: Vec<f64> = shares.iter().flat_map(|x| shares.iter().map(|y| level([*x, *y]))).collect();
    border(&shares, &shares, &|i, j| Some(1.0 + values[i * (PARTS + 1) + j]))
}

/// Points at which `level` is zero, in the unit square or on its lower side.
pub(super) fn zeros(level: &dyn Fn([f64; 2]) -> f64, dimensions: usize) -> Vec<[f64; 2]> {
    if dimensions > 1 {
        return pieces(level).into_iter().filter_map(|piece| piece.first().copied()).collect();
    }
    let at = |k: usize| k as f64 / FINE as f64;
    let values: Vec<f64> = (0..=FINE).map(|k| level([at(k), 0.0])).collect();
    let crossed = (1..=FINE).filter(|k| (values[k - 1] < 0.0) != (values[*k] < 0.0));
    crossed.map(|k| [at(k - 1) + values[k - 1] / (values[k - 1] - values[k]) / FINE as f64, 0.0]).collect()
}
