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

/// `y ← y + A x`, A of as many rows, its columns `stride` apart; some columns go together, one after the other, so that y is read and
/// written for all of them once. As wide as the loop that it is inlined into.
#[inline(always)]
pub(crate) fn add_columns(a: &[f64], stride: usize, x: &[f64], y: &mut [f64]) {
    const TOGETHER: usize = 4;
    let n = y.len();
    let (fours, rest) = x.as_chunks::<TOGETHER>();
    for (columns, x) in (0..).step_by(TOGETHER).zip(fours) {
        let [p, q, r, s]: [&[f64]; TOGETHER] = std::array::from_fn(|k| &a[(columns + k) * stride..][..n]);
        for ((((y, p), q), r), s) in y.iter_mut().zip(p).zip(q).zip(r).zip(s) {
            *y = *y + x[0] * p + x[1] * q + x[2] * r + x[3] * s;
        }
    }
    for (column, x) in (fours.len() * TOGETHER..).zip(rest) {
        y.iter_mut().zip(&a[column * stride..][..n]).for_each(|(y, a)| *y += x * a);
    }
}
