//! Loops in the widest registers of the machine.

use pulp::{Arch, Simd, WithSimd};

/// Runs `loops` compiled for the widest registers that the machine has, with the same result to the bit as anywhere else: what is
/// multiplied and added stays a product and a sum, and no sum changes its order. A call is worth some dozens of operations.
///
/// Loops are compiled so as far as they are inlined into `loops`, and `loops` itself where it is small: what is larger is a [`WithSimd`].
pub fn vectorised<R>(loops: impl FnOnce() -> R) -> R {
    Arch::new().dispatch(loops)
}

/// `ROWS` rows times `columns`, of which `rows` holds one number each.
///
/// A sum begins at zero and takes its products in order, each rounded once with the sum (fused), whatever the machine.
pub fn products<const ROWS: usize, const LANES: usize>(rows: &[f64], columns: &[[f64; LANES]]) -> [[f64; LANES]; ROWS] {
    Arch::new().dispatch(Products { rows, columns })
}

/// `ROWS` rows times the middles of intervals, and their magnitudes times the halves of these, as [`products`] takes its sums, but in
/// single precision.
pub fn products_of_intervals<const ROWS: usize, const LANES: usize>(
    rows: &[f32],
    middles: &[[f32; LANES]],
    halves: &[[f32; LANES]],
) -> [[[f32; LANES]; ROWS]; 2] {
    Arch::new().dispatch(OfIntervals { rows, middles, halves })
}

// Not as closures: those of this size would be called and not compiled anew for wide registers.
struct Products<'a, const ROWS: usize, const LANES: usize> {
    rows: &'a [f64],
    columns: &'a [[f64; LANES]],
}

impl<const ROWS: usize, const LANES: usize> WithSimd for Products<'_, ROWS, LANES> {
    type Output = [[f64; LANES]; ROWS];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let width = self.columns.len();
        let rows: [&[f64]; ROWS] = std::array::from_fn(|row| &self.rows[row * width..][..width]);
        let mut sums = [[0.0; LANES]; ROWS];
        for (k, column) in self.columns.iter().enumerate() {
            for (sum, row) in sums.iter_mut().zip(rows) {
                for lane in 0..LANES {
                    sum[lane] = row[k].mul_add(column[lane], sum[lane]);
                }
            }
        }
        sums
    }
}

struct OfIntervals<'a, const ROWS: usize, const LANES: usize> {
    rows: &'a [f32],
    middles: &'a [[f32; LANES]],
    halves: &'a [[f32; LANES]],
}

impl<const ROWS: usize, const LANES: usize> WithSimd for OfIntervals<'_, ROWS, LANES> {
    type Output = [[[f32; LANES]; ROWS]; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let width = self.middles.len();
        let rows: [&[f32]; ROWS] = std::array::from_fn(|row| &self.rows[row * width..][..width]);
        let [mut sums, mut reaches] = [[[0.0; LANES]; ROWS]; 2];
        for (k, (middle, half)) in self.middles.iter().zip(self.halves).enumerate() {
            for ((sum, reach), row) in sums.iter_mut().zip(&mut reaches).zip(rows) {
                for lane in 0..LANES {
                    sum[lane] = row[k].mul_add(middle[lane], sum[lane]);
                    reach[lane] = row[k].abs().mul_add(half[lane], reach[lane]);
                }
            }
        }
        [sums, reaches]
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
        let [x, y, z] = products::<3, 16>(&rows, &columns);
        assert_eq!(x, [e * e; 16]);
        assert_eq!(y, [2.0 + 4.0 * e + 0.5 * (1.0 + e); 16]);
        assert_eq!(z, [-7.0 - 10.0 * e; 16]);
        let (rows, middles, halves) =
            ([1.0, 0.5, -2.0, 0.5, 3.0, -4.0], [[-1.0; 16], [2.0; 16]], [[0.25; 16], [0.5; 16]]);
        let [middles, halves] = products_of_intervals::<3, 16>(&rows, &middles, &halves);
        assert_eq!(middles.map(|m| m[15]), [0.0, 3.0, -11.0]);
        assert_eq!(halves.map(|h| h[15]), [0.5, 0.75, 2.75]);
    }
}
