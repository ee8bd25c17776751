//! Lanczos iteration for the lowest modes that given shapes excite.

use fem_core::reduction::ReductionError;
use fem_core::structure::Structure;
use nalgebra::{DMatrix, SymmetricEigen};

/// Relative residual at which a mode counts as found.
const TOLERANCE: f64 = 1e-9;

/// A new direction shorter than this fraction of its image ends the Krylov space.
const EXHAUSTED: f64 = 1e-12;

/// The `count` lowest modes of the operator x ← A x = K⁻¹ M x (A self-adjoint in the metric of M) in the Krylov space of
/// the shapes `start`, `n × modes` column-major; fewer when the space is exhausted first.
///
/// Lanczos with full reorthogonalisation in the metric of M. A singular M leaves components in the vectors that it
/// cannot see: one more application of A purifies the modes.
///
/// # Errors
/// Those of the operator, and a space that grows beyond five times the modes without convergence.
pub(super) fn lowest_modes(
    structure: &mut dyn Structure,
    mut operator: impl FnMut(&mut dyn Structure, &mut [f64]) -> Result<(), ReductionError>,
    start: &[f64],
    count: usize,
) -> Result<Vec<f64>, ReductionError> {
    let n = structure.ndof();
    let limit = n.min(5 * count + 60);
    let (mut v, mut mv): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let (mut alpha, mut beta): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut w = vec![0.0; n];
    for shape in start.chunks_exact(n) {
        for (w, s) in w.iter_mut().zip(shape) {
            *w += s;
        }
    }
    if count == 0 {
        return Ok(Vec::new());
    }
    operator(structure, &mut w)?;
    let mut image = vec![0.0; n];
    loop {
        // w becomes the next basis vector; twice is enough (Parlett).
        let before = norm(structure, &w, &mut image);
        for _ in 0..2 {
            for (v, mv) in v.chunks_exact(n).zip(mv.chunks_exact(n)) {
                let share = dot(mv, &w);
                axpy(-share, v, &mut w);
            }
        }
        let length = norm(structure, &w, &mut image);
        if !length.is_finite() {
            return Err(ReductionError("the Lanczos iteration met a number that is not finite".into()));
        }
        let steps = alpha.len();
        let exhausted = length <= EXHAUSTED * before || steps == limit;
        if exhausted || (steps > count && steps.is_multiple_of(4)) {
            let t = DMatrix::from_fn(steps, steps, |i, j| match i.abs_diff(j) {
                0 => alpha[i],
                1 => beta[i.min(j)],
                _ => 0.0,
            });
            let eigen = SymmetricEigen::new(t);
            let mut order: Vec<usize> = (0..steps).filter(|i| eigen.eigenvalues[*i] > 0.0).collect();
            order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
            order.truncate(count);
            let residual = |i: &usize| length * eigen.eigenvectors[(steps - 1, *i)].abs() / eigen.eigenvalues[*i];
            let found = order.iter().all(|i| residual(i) <= TOLERANCE);
            if found || exhausted {
                if steps == limit && !found && steps < n {
                    return Err(ReductionError(format!(
                        "{count} modes did not converge in a Krylov space of {limit} vectors: ask for fewer"
                    )));
                }
                let mut modes = vec![0.0; n * order.len()];
                for (i, mode) in order.iter().zip(modes.chunks_exact_mut(n)) {
                    for (s, v) in eigen.eigenvectors.column(*i).iter().zip(v.chunks_exact(n)) {
                        axpy(*s, v, mode);
                    }
                }
                operator(structure, &mut modes)?;
                for mode in modes.chunks_exact_mut(n) {
                    let length = norm(structure, mode, &mut image);
                    mode.iter_mut().for_each(|x| *x /= length);
                }
                return Ok(modes);
            }
        }
        if steps > 0 {
            beta.push(length);
        }
        w.iter_mut().for_each(|x| *x /= length);
        image.iter_mut().for_each(|x| *x /= length);
        v.extend_from_slice(&w);
        mv.extend_from_slice(&image);
        operator(structure, &mut w)?;
        alpha.push(dot(&image, &w));
    }
}

/// √(xᵀ M x), with M x left in `image`.
fn norm(structure: &dyn Structure, x: &[f64], image: &mut [f64]) -> f64 {
    image.fill(0.0);
    structure.add_mass(1.0, x, image);
    dot(x, image).max(0.0).sqrt()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn axpy(scale: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += scale * x;
    }
}
