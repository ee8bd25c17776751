//! Plain vector algebra.

use fem_core::vectorised::vectorised;
use pulp::{Arch, Simd, WithSimd};

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

/// `y ← A x`, A square and small, column by column: rows whose sums fit into registers go through all columns together.
pub(crate) fn square_product(a: &[f64], x: &[f64], y: &mut [f64]) {
    Arch::new().dispatch(SquareProduct { a, x, y });
}

// No closure: one of this size would be called and not compiled anew for wide registers.
struct SquareProduct<'a> {
    a: &'a [f64],
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for SquareProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        const ROWS: usize = 16;
        let Self { a, x, y } = self;
        let n = y.len();
        // The last rows are taken again where they do not fill a block: a sum does not depend on what stands beside it.
        let mut first = 0;
        while let Some(out) = y.get_mut(first..).and_then(|rest| rest.first_chunk_mut::<ROWS>()) {
            let mut sums = [0.0; ROWS];
            for (column, x) in a.chunks_exact(n).zip(x) {
                let Some(column) = column[first..].first_chunk::<ROWS>() else { break };
                sums.iter_mut().zip(column).for_each(|(sum, a)| *sum = x.mul_add(*a, *sum));
            }
            *out = sums;
            first = if first + ROWS < n { (first + ROWS).min(n - ROWS) } else { n };
        }
        if n < ROWS {
            for (row, y) in y.iter_mut().enumerate() {
                *y = a.iter().skip(row).step_by(n).zip(x).fold(0.0, |sum: f64, (a, x)| x.mul_add(*a, sum));
            }
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_products_of_any_size() {
        for n in [0, 1, 3, 15, 16, 17, 31, 32, 60] {
            let x: Vec<f64> = (0..n).map(|i| i as f64 - 7.0).collect();
            // Small whole numbers, whose sums are exact.
            let a: Vec<f64> = (0..n * n).map(|k| ((k * 31) % 17) as f64).collect();
            let want: Vec<f64> = (0..n).map(|row| (0..n).map(|column| a[row + n * column] * x[column]).sum()).collect();
            let mut y = vec![f64::NAN; n];
            square_product(&a, &x, &mut y);
            assert_eq!(y, want, "{n}");
        }
    }
}
