//! Loops in the widest registers of the machine.

use pulp::{Arch, Simd, WithSimd};

/// Runs `loops` compiled for the widest registers that the machine has, with the same result to the bit as anywhere else: what is
/// multiplied and added stays a product and a sum, and no sum changes its order. A call is worth some dozens of operations.
///
/// Loops are compiled so as far as they are inlined into `loops`.
pub fn vectorised<R>(loops: impl FnOnce() -> R) -> R {
    Arch::new().dispatch(loops)
}

/// Three rows times `columns`, of which `rows` holds one number each, or their magnitudes.
///
/// A sum begins at zero and takes its products in order, each rounded once with the sum (fused), whatever the machine.
pub fn products<const MAGNITUDES: bool, const LANES: usize>(
    rows: &[f64],
    columns: &[[f64; LANES]],
) -> [[f64; LANES]; 3] {
    Arch::new().dispatch(Products::<MAGNITUDES, LANES> { rows, columns })
}

struct Products<'a, const MAGNITUDES: bool, const LANES: usize> {
    rows: &'a [f64],
    columns: &'a [[f64; LANES]],
}

impl<const MAGNITUDES: bool, const LANES: usize> WithSimd for Products<'_, MAGNITUDES, LANES> {
    type Output = [[f64; LANES]; 3];

    // Not as a closure: one of this size would be called and not compiled anew for wide registers.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let width = self.columns.len();
        let (first, others) = self.rows.split_at(width);
        let (second, third) = others.split_at(width);
        let [mut x, mut y, mut z] = [[0.0; LANES]; 3];
        for (((column, a), b), c) in self.columns.iter().zip(first).zip(second).zip(third) {
            let (a, b, c) = if MAGNITUDES { (a.abs(), b.abs(), c.abs()) } else { (*a, *b, *c) };
            for lane in 0..LANES {
                x[lane] = a.mul_add(column[lane], x[lane]);
                y[lane] = b.mul_add(column[lane], y[lane]);
                z[lane] = c.mul_add(column[lane], z[lane]);
            }
        }
        [x, y, z]
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
        let [x, y, z] = products::<false, 16>(&rows, &columns);
        assert_eq!(x, [e * e; 16]);
        assert_eq!(y, [2.0 + 4.0 * e + 0.5 * (1.0 + e); 16]);
        assert_eq!(z, [-7.0 - 10.0 * e; 16]);
        assert_eq!(products::<true, 16>(&rows, &columns)[2], [3.0 * (-1.0 - 2.0 * e) + 4.0 * (1.0 + e); 16]);
    }
}
