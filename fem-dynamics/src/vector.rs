//! Plain vector algebra.

use fem_core::vectorised::vectorised;

/// Sums kept side by side, so that one addition need not wait for the last.
const LANES: usize = 8;

/// aᵀ b.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let rest: f64 = a.1.iter().zip(b.1).map(|(a, b)| a * b).sum();
    let mut sums = [0.0; LANES];
    vectorised(|| {
        for (a, b) in a.0.iter().zip(b.0) {
            for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
                *sum += a * b;
            }
        }
    });
    sums.iter().sum::<f64>() + rest
}

/// `y ← y + scale · x`.
pub(crate) fn axpy(scale: f64, x: &[f64], y: &mut [f64]) {
    vectorised(|| y.iter_mut().zip(x).for_each(|(y, x)| *y += scale * x));
}
