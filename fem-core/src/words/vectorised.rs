//! Loops in the widest registers of the machine.

use pulp::Arch;

/// Runs `loops` compiled for the widest registers that the machine has, with the same result to the bit as anywhere else: what is
/// multiplied and added stays a product and a sum, and no sum changes its order. A call is worth some dozens of operations.
///
/// Loops are compiled so as far as they are inlined into `loops`.
pub fn vectorised<R>(loops: impl FnOnce() -> R) -> R {
    Arch::new().dispatch(loops)
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
}
