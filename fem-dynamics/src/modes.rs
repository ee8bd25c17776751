//! The lowest natural frequencies of a structure.

use crate::lanczos::Lanczos;
use crate::vector::dot;
use fem_core::structure::{SolveError, Structure};

/// Start vectors, and the largest multiplicity of a frequency that is sure to be found.
const BLOCK: usize = 4;

/// Shift for structures that are not held, as a fraction of the Rayleigh quotient of a rough vector, which is near the
/// highest ω²: about the square of the lowest flexible frequency, in any unit.
const SHIFT: f64 = 1e-7;

/// Natural modes, by frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Circular frequencies, rad/s.
    pub omega: Vec<f64>,
    /// Shapes, `ndof × modes`, column-major, of unit modal mass; the largest entry is positive.
    pub shapes: Vec<f64>,
}

/// The `count` lowest modes of K φ = ω² M φ; all of them where there are fewer.
///
/// Block Lanczos on (K + σM)⁻¹ M with full reorthogonalisation in the metric of M. σ = 0 for a structure that is `held`;
/// else it follows from K and M themselves, so that the answer does not depend on units, and rigid motions come out with
/// frequencies of zero (to rounding). A singular M is not a problem: vectors are kept free of what it cannot see by one
/// more application of the operator at the end (purification).
///
/// # Errors
/// A matrix that cannot be factorised, or no convergence in a space of 5 `count` + 80 vectors.
pub fn lowest(structure: &mut dyn Structure, count: usize, held: bool) -> Result<Modes, SolveError> {
    let n = structure.ndof();
    // Vectors that no symmetry makes orthogonal to a mode, the same on every machine.
    let rough = |k: usize| (0..n).map(move |i| ((i * (7919 + 2 * k) + 31 * k) % 1009) as f64 / 1009.0 - 0.47);
    let shift = if held { 0.0 } else { SHIFT * rayleigh(structure, &rough(0).collect::<Vec<_>>()) };
    let start: Vec<f64> = (0..BLOCK).flat_map(rough).collect();
    let inverse = |structure: &mut dyn Structure, x: &mut [f64]| {
        let columns = x.len() / n.max(1);
        structure.solve_shifted(shift, x, columns)
    };
    let (theta, mut shapes) = Lanczos::excited(structure, inverse, &start)?.lowest(count, 0.0)?;
    for shape in shapes.chunks_exact_mut(n.max(1)) {
        let mut image = vec![0.0; n];
        structure.add_mass(1.0, shape, &mut image);
        let largest = shape.iter().fold(0.0_f64, |a, b| if b.abs() > a.abs() { *b } else { a });
        let scale = largest.signum() / dot(shape, &image).sqrt();
        shape.iter_mut().for_each(|x| *x *= scale);
    }
    let omega = theta.iter().map(|theta| (1.0 / theta - shift).max(0.0).sqrt()).collect();
    Ok(Modes { omega, shapes })
}

fn rayleigh(structure: &dyn Structure, x: &[f64]) -> f64 {
    let (mut stiff, mut inert) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    structure.add_stiffness(1.0, x, &mut stiff);
    structure.add_mass(1.0, x, &mut inert);
    dot(x, &stiff) / dot(x, &inert)
}
