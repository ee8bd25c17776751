//! The lowest natural frequencies of a structure.

use crate::lanczos::Lanczos;
use crate::vector::dot;
use fem_core::structure::{SolveError, Structure};

/// Start vectors, and the largest multiplicity of a frequency that is sure to be found.
pub(crate) const BLOCK: usize = 4;

/// Natural modes, by frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Circular frequencies, rad/s.
    pub omega: Vec<f64>,
    /// Shapes, `ndof × modes`, column-major, of unit modal mass; the largest entry is positive.
    pub shapes: Vec<f64>,
}

/// The `count` lowest modes of K φ = ω² M φ; all of them where there are fewer. The free motions of the structure count as
/// modes of frequency zero where `with_free` says so; else they are left out.
///
/// Block Lanczos on K⁻¹ M with full reorthogonalisation in the metric of M, beside the free motions. A singular M is not a
/// problem: vectors are kept free of what it cannot see by one more application of the operator at the end (purification).
///
/// # Errors
/// A matrix that cannot be factorised, or no convergence in a space of 5 `count` + 80 vectors.
pub fn lowest(structure: &mut dyn Structure, count: usize, with_free: bool) -> Result<Modes, SolveError> {
    let n = structure.ndof();
    let mut free = if with_free { structure.free_motions().to_vec() } else { Vec::new() };
    free.truncate(n * count);
    let moving = free.len() / n.max(1);
    let start: Vec<f64> = (0..BLOCK).flat_map(|k| rough(n, k)).collect();
    let inverse = |structure: &mut dyn Structure, x: &mut [f64]| {
        let columns = x.len() / n.max(1);
        structure.solve_shifted(0.0, x, columns)
    };
    let (theta, shapes) = Lanczos::excited(structure, inverse, &start)?.lowest(count - moving, 0.0)?;
    let mut shapes = [free, shapes].concat();
    for shape in shapes.chunks_exact_mut(n.max(1)) {
        let mut image = vec![0.0; n];
        structure.add_mass(1.0, shape, &mut image);
        let largest = shape.iter().fold(0.0_f64, |a, b| if b.abs() > a.abs() { *b } else { a });
        let scale = largest.signum() / dot(shape, &image).sqrt();
        shape.iter_mut().for_each(|x| *x *= scale);
    }
    let omega = std::iter::repeat_n(0.0, moving).chain(theta.iter().map(|theta| theta.recip().sqrt())).collect();
    Ok(Modes { omega, shapes })
}

/// The `k`-th of vectors that no symmetry makes orthogonal to a mode, the same on every machine.
pub(crate) fn rough(n: usize, k: usize) -> impl Iterator<Item = f64> {
    (0..n).map(move |i| ((i * (7919 + 2 * k) + 31 * k) % 1009) as f64 / 1009.0 - 0.47)
}
