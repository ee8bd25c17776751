//! Loops in the widest registers of the machine.

use pulp::{Arch, Simd, WithSimd};

/// Runs `loops` compiled for the widest registers that the machine has, with the same result to the bit as anywhere else: what is
/// multiplied and added stays a product and a sum, and no sum changes its order. A call is worth some dozens of operations.
///
/// Loops are compiled so as far as they are inlined into `loops`, and `loops` itself where it is small: what is larger is a [`WithSimd`].
pub fn vectorised<R>(loops: impl FnOnce() -> R) -> R {
    Arch::new().dispatch(loops)
}

/// Sums kept side by side, so that one addition need not wait for the last.
const TOGETHER: usize = 8;

/// aᵀ b, in sums that are kept side by side. As wide as the loop that it is inlined into.
#[inline(always)]
pub fn sum_of_products(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (a.as_chunks::<TOGETHER>(), b.as_chunks::<TOGETHER>());
    let rest: f64 = a.1.iter().zip(b.1).map(|(a, b)| a * b).sum();
    let mut sums = [0.0; TOGETHER];
    for (a, b) in a.0.iter().zip(b.0) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// `y ← y + A x`, A of as many rows, its columns `stride` apart; some columns go together, one after the other, so that y is read and
/// written for all of them once. As wide as the loop that it is inlined into.
#[inline(always)]
pub fn add_columns(a: &[f64], stride: usize, x: &[f64], y: &mut [f64]) {
    const AT_ONCE: usize = 4;
    let n = y.len();
    let (fours, rest) = x.as_chunks::<AT_ONCE>();
    for (columns, x) in (0..).step_by(AT_ONCE).zip(fours) {
        let [p, q, r, s]: [&[f64]; AT_ONCE] = std::array::from_fn(|k| &a[(columns + k) * stride..][..n]);
        for ((((y, p), q), r), s) in y.iter_mut().zip(p).zip(q).zip(r).zip(s) {
            *y = *y + x[0] * p + x[1] * q + x[2] * r + x[3] * s;
        }
    }
    for (column, x) in (fours.len() * AT_ONCE..).zip(rest) {
        y.iter_mut().zip(&a[column * stride..][..n]).for_each(|(y, a)| *y += x * a);
    }
}

/// A x, of as many rows, which stand one after the other in `a`.
pub fn rows_times(a: &[f64], x: &[f64], out: &mut [f64]) {
    Arch::new().dispatch(RowsTimes { a, x, out });
}

/// `y ← y + Aᵀ x`, of as many rows, which stand one after the other in `a`.
pub fn add_rows(a: &[f64], x: &[f64], y: &mut [f64]) {
    Arch::new().dispatch(AddRows { a, x, y });
}

/// Three rows times `columns`, of which `rows` holds one number each.
///
/// A sum begins at zero and takes its products in order, each rounded once with the sum (fused), whatever the machine.
pub fn products<const LANES: usize>(rows: &[f64], columns: &[[f64; LANES]]) -> [[f64; LANES]; 3] {
    Arch::new().dispatch(Products { rows, columns })
}

/// Three rows times the middles of intervals, and their magnitudes times the halves of these, as [`products`] takes its sums, but in
/// single precision.
pub fn products_of_intervals<const LANES: usize>(
    rows: &[f32],
    middles: &[[f32; LANES]],
    halves: &[[f32; LANES]],
) -> [[[f32; LANES]; 3]; 2] {
    Arch::new().dispatch(OfIntervals { rows, middles, halves })
}

// Not as closures: those of this size would be called and not compiled anew for wide registers.
struct RowsTimes<'a> {
    a: &'a [f64],
    x: &'a [f64],
    out: &'a mut [f64],
}

impl WithSimd for RowsTimes<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let rows = self.a.chunks_exact(self.x.len());
        self.out.iter_mut().zip(rows).for_each(|(out, row)| *out = sum_of_products(row, self.x));
    }
}

struct AddRows<'a> {
    a: &'a [f64],
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for AddRows<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        add_columns(self.a, self.y.len(), self.x, self.y);
    }
}

struct Products<'a, const LANES: usize> {
    rows: &'a [f64],
    columns: &'a [[f64; LANES]],
}

impl<const LANES: usize> WithSimd for Products<'_, LANES> {
    type Output = [[f64; LANES]; 3];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let width = self.columns.len();
        let (first, others) = self.rows.split_at(width);
        let (second, third) = others.split_at(width);
        let [mut x, mut y, mut z] = [[0.0; LANES]; 3];
        for (((column, a), b), c) in self.columns.iter().zip(first).zip(second).zip(third) {
            for lane in 0..LANES {
                x[lane] = a.mul_add(column[lane], x[lane]);
                y[lane] = b.mul_add(column[lane], y[lane]);
                z[lane] = c.mul_add(column[lane], z[lane]);
            }
        }
        [x, y, z]
    }
}

struct OfIntervals<'a, const LANES: usize> {
    rows: &'a [f32],
    middles: &'a [[f32; LANES]],
    halves: &'a [[f32; LANES]],
}

impl<const LANES: usize> WithSimd for OfIntervals<'_, LANES> {
    type Output = [[[f32; LANES]; 3]; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let width = self.middles.len();
        let (first, others) = self.rows.split_at(width);
        let (second, third) = others.split_at(width);
        let [mut x, mut y, mut z, mut u, mut v, mut w] = [[0.0; LANES]; 6];
        let columns = self.middles.iter().zip(self.halves);
        for ((((middle, half), a), b), c) in columns.zip(first).zip(second).zip(third) {
            for lane in 0..LANES {
                x[lane] = a.mul_add(middle[lane], x[lane]);
                y[lane] = b.mul_add(middle[lane], y[lane]);
                z[lane] = c.mul_add(middle[lane], z[lane]);
                u[lane] = a.abs().mul_add(half[lane], u[lane]);
                v[lane] = b.abs().mul_add(half[lane], v[lane]);
                w[lane] = c.abs().mul_add(half[lane], w[lane]);
            }
        }
        [[x, y, z], [u, v, w]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_sums_stay_two_roundings() {
        // (1 + e)² − 1 − 2e is e² in one rounding, and 0 in two.
        let e = f64::EPSILON;
        let (a, mut sums) = ([1.0 + e; 8], [-1.0 - 2.0 * e; 8]);
        vectorised(|| sums.iter_mut().zip(&a).for_each(|(sum, a)| *sum += a * a));
        assert_eq!(sums, [0.0; 8]);
    }

    #[test]
    fn products_are_fused_and_in_order() {
        let (e, rows) = (f64::EPSILON, [1.0, 1.0 + f64::EPSILON, -2.0, 0.5, 3.0, -4.0]);
        let columns = [[-1.0 - 2.0 * e; 16], [1.0 + e; 16]];
        let [x, y, z] = products::<16>(&rows, &columns);
        assert_eq!(x, [e * e; 16]);
        assert_eq!(y, [2.0 + 4.0 * e + 0.5 * (1.0 + e); 16]);
        assert_eq!(z, [-7.0 - 10.0 * e; 16]);
        let (rows, middles, halves) =
            ([1.0, 0.5, -2.0, 0.5, 3.0, -4.0], [[-1.0; 16], [2.0; 16]], [[0.25; 16], [0.5; 16]]);
        let [middles, halves] = products_of_intervals(&rows, &middles, &halves);
        assert_eq!(middles.map(|m| m[15]), [0.0, 3.0, -11.0]);
        assert_eq!(halves.map(|h| h[15]), [0.5, 0.75, 2.75]);
    }
}
