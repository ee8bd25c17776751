//! The lowest natural frequencies of a structure.

use crate::vector::{axpy, dot};
use fem_core::structure::{SolveError, Structure};
use nalgebra::{DMatrix, SymmetricEigen};

/// Start vectors, and the largest multiplicity of a frequency that is sure to be found.
const BLOCK: usize = 4;

/// Relative residual at which a mode counts as found; its frequency is then good to about the square of it.
const TOLERANCE: f64 = 1e-8;

/// A direction shorter than this fraction of what it was before orthogonalisation is none.
const EXHAUSTED: f64 = 1e-10;

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
/// frequencies of zero (to rounding). A singular M is no trouble: vectors are kept free of what it cannot see by one more
/// application of the operator at the end (purification).
///
/// # Errors
/// A matrix that cannot be factorised, or no convergence in a space of 5 `count` + 80 vectors.
pub fn lowest(structure: &mut dyn Structure, count: usize, held: bool) -> Result<Modes, SolveError> {
    let n = structure.ndof();
    let mut space = Space { n, ..Space::default() };
    // Vectors that no symmetry makes orthogonal to a mode, the same on every machine.
    let rough = |k: usize| (0..n).map(move |i| ((i * (7919 + 2 * k) + 31 * k) % 1009) as f64 / 1009.0 - 0.47);
    let shift = if held { 0.0 } else { SHIFT * rayleigh(structure, &rough(0).collect::<Vec<_>>()) };
    let mut block: Vec<Vec<f64>> = (0..BLOCK).map(|k| rough(k).collect()).collect();
    for x in &mut block {
        apply(structure, shift, x)?;
    }
    let limit = n.min(5 * count + 80);
    loop {
        let first = space.size();
        for x in block.drain(..) {
            space.add(structure, x)?;
        }
        let last = first..space.size();
        for i in last.clone() {
            let mut image = space.mv[i * n..(i + 1) * n].to_vec();
            structure.solve_shifted(shift, &mut image, 1)?;
            space.project(image);
        }
        let size = space.size();
        let eigen = SymmetricEigen::new(DMatrix::from_fn(size, size, |i, j| space.t[i.max(j)][i.min(j)]));
        let mut order: Vec<usize> = (0..size).filter(|i| eigen.eigenvalues[*i] > 0.0).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        order.truncate(count);
        // What the last block sends beyond the space is what a mode still lacks.
        let mut beyond = Vec::new();
        for j in last.clone() {
            let mut x = space.images[j].clone();
            let length = space.orthogonalise(structure, &mut x)?;
            beyond.push(length.unwrap_or(0.0));
            if length.is_some() {
                block.push(x);
            }
        }
        let residual = |i: usize| {
            let parts = last.clone().zip(&beyond).map(|(j, l)| eigen.eigenvectors[(j, i)].abs() * l);
            parts.sum::<f64>() / eigen.eigenvalues[i]
        };
        let found = order.len() == count && order.iter().all(|i| residual(*i) <= TOLERANCE);
        if found || block.is_empty() {
            let theta: Vec<f64> = order.iter().map(|i| eigen.eigenvalues[*i]).collect();
            let combine = |i: &usize| {
                let mut x = vec![0.0; n];
                for (s, image) in eigen.eigenvectors.column(*i).iter().zip(&space.images) {
                    axpy(s / eigen.eigenvalues[*i], image, &mut x);
                }
                x
            };
            let shapes: Vec<Vec<f64>> = order.iter().map(combine).collect();
            return Ok(finish(structure, shift, &theta, shapes));
        }
        if size >= limit {
            return Err(SolveError(format!(
                "{count} modes did not converge in a space of {size} vectors: ask for fewer"
            )));
        }
    }
}

fn finish(structure: &dyn Structure, shift: f64, theta: &[f64], shapes: Vec<Vec<f64>>) -> Modes {
    let mut modes = Modes { omega: Vec::new(), shapes: Vec::new() };
    for (theta, mut shape) in theta.iter().zip(shapes) {
        modes.omega.push((1.0 / theta - shift).max(0.0).sqrt());
        let mut image = vec![0.0; shape.len()];
        structure.add_mass(1.0, &shape, &mut image);
        let largest = shape.iter().fold(0.0_f64, |a, b| if b.abs() > a.abs() { *b } else { a });
        let scale = largest.signum() / dot(&shape, &image).sqrt();
        shape.iter_mut().for_each(|x| *x *= scale);
        modes.shapes.extend(shape);
    }
    modes
}

fn rayleigh(structure: &dyn Structure, x: &[f64]) -> f64 {
    let (mut stiff, mut inert) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    structure.add_stiffness(1.0, x, &mut stiff);
    structure.add_mass(1.0, x, &mut inert);
    dot(x, &stiff) / dot(x, &inert)
}

/// `x ← (K + σM)⁻¹ M x`.
fn apply(structure: &mut dyn Structure, shift: f64, x: &mut Vec<f64>) -> Result<(), SolveError> {
    let mut image = vec![0.0; x.len()];
    structure.add_mass(1.0, x, &mut image);
    structure.solve_shifted(shift, &mut image, 1)?;
    *x = image;
    Ok(())
}

/// An M-orthonormal basis with its images.
#[derive(Default)]
struct Space {
    n: usize,
    v: Vec<f64>,
    /// M V.
    mv: Vec<f64>,
    /// A V.
    images: Vec<Vec<f64>>,
    /// T = Vᵀ M A V: the upper triangle by columns.
    t: Vec<Vec<f64>>,
}

impl Space {
    fn size(&self) -> usize {
        self.v.len() / self.n.max(1)
    }

    /// Makes `x` orthogonal to the basis (twice is enough); its length, or `None` if nothing of it is left.
    fn orthogonalise(&self, structure: &dyn Structure, x: &mut [f64]) -> Result<Option<f64>, SolveError> {
        let length = |x: &[f64]| {
            let mut image = vec![0.0; x.len()];
            structure.add_mass(1.0, x, &mut image);
            dot(x, &image).max(0.0).sqrt()
        };
        let before = length(x);
        for _ in 0..2 {
            for (v, mv) in self.v.chunks_exact(self.n).zip(self.mv.chunks_exact(self.n)) {
                let share = dot(mv, x);
                axpy(-share, v, x);
            }
        }
        let after = length(x);
        if !after.is_finite() {
            return Err(SolveError("the Lanczos iteration met a number that is not finite".into()));
        }
        Ok((after > EXHAUSTED * before).then_some(after))
    }

    /// Takes the image of the next vector.
    fn project(&mut self, image: Vec<f64>) {
        let upto = self.images.len() + 1;
        self.t.push(self.mv.chunks_exact(self.n).take(upto).map(|mv| dot(mv, &image)).collect());
        self.images.push(image);
    }

    fn add(&mut self, structure: &dyn Structure, mut x: Vec<f64>) -> Result<(), SolveError> {
        let Some(length) = self.orthogonalise(structure, &mut x)? else { return Ok(()) };
        x.iter_mut().for_each(|x| *x /= length);
        let mut image = vec![0.0; self.n];
        structure.add_mass(1.0, &x, &mut image);
        self.v.extend(x);
        self.mv.extend(image);
        Ok(())
    }
}
