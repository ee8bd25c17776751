//! Plain vector algebra.

use fem_core::vectorised::{sum_of_products, vectorised};

/// aᵀ b.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    vectorised(|| sum_of_products(a, b))
}

/// `y ← y + scale · x`.
pub(crate) fn axpy(scale: f64, x: &[f64], y: &mut [f64]) {
    vectorised(|| y.iter_mut().zip(x).for_each(|(y, x)| *y += scale * x));
}
