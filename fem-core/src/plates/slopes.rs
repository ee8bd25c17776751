//! Slopes of the middle of cells, by which deflections stretch a plate.

use crate::contracts::element::{Cell, Element};

/// Step of the differences of shape functions, in natural coordinates.
const STEP: f64 = 0.25;

/// Adds two rows, ∂w/∂x and ∂w/∂y of each unknown in the middle of a cell: differences that are exact for polynomials of the fourth
/// degree.
pub(crate) fn add_slopes(
    element: &dyn Element,
    cell: &Cell<'_>,
    at: [f64; 2],
    shape: &mut Vec<f64>,
    rows: &mut Vec<f64>,
) {
    let local = element.info().ndof();
    shape.resize(3 * local, 0.0);
    let mut natural = vec![[0.0; 2]; local];
    let directions = if element.info().is_section() { 1 } else { 2 };
    for d in 0..directions {
        for (steps, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let mut xi = [at[0], at[1], 0.0];
            xi[d] += steps * STEP;
            element.shape(cell, xi, shape);
            for (g, n) in natural.iter_mut().zip(shape.chunks_exact(3)) {
                g[d] += weight / (12.0 * STEP) * n[2];
            }
        }
    }
    let [by_r, by_s] = cell.plane(at[0], at[1]).inverse;
    for d in 0..2 {
        rows.extend(natural.iter().map(|[r, s]| r * by_r[d] + s * by_s[d]));
    }
}
