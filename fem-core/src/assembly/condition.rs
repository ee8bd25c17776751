//! How far the unknowns of K u = f follow errors of K and f.

use super::{Cholesky, Symmetric};

/// Condition of the stiffness beyond which its digits are worth a word: six of 16 are left.
pub const NOTABLE_CONDITION: f64 = 1e10;

/// Share of it from which on pivots call for the estimate. In thin plates of the tests with conditions of 1e9 to 1e11 they show no less
/// than a twentieth of it.
const SUSPECT: f64 = 1e-3;

/// Products with the inverse before the estimate is taken as it is; two iterations are usual.
const ITERATIONS: usize = 5;

/// An estimate of the condition number ‖S‖₁ ‖S⁻¹‖₁ of S = D^−½ A D^−½, D the diagonal of A; `solve` is `x ← A⁻¹ x`.
///
/// A Cholesky solution is as accurate as the condition of S lets it be, whatever the units of the unknowns (van der Sluis
/// 1969; Demmel 1989), and A itself holds each entry to rounding only: of 16 digits, log₁₀ of the condition may be lost.
/// ‖S‖₁ is exact. ‖S⁻¹‖₁ is Hager's estimate, a lower bound, by Higham's algorithm 4.1 (1988) for a symmetric
/// matrix: usually exact, rarely below a third. It takes 3 to 11 solves, 5 as a rule.
///
/// A must be positive definite. NaN where the solutions are.
pub(super) fn estimate(a: &Symmetric, mut solve: impl FnMut(&mut [f64])) -> f64 {
    let root: Vec<f64> = diagonal(a).map(f64::sqrt).collect();
    let inverse = inverse(a.ndof(), |x| {
        x.iter_mut().zip(&root).for_each(|(x, d)| *x *= d);
        solve(x);
        x.iter_mut().zip(&root).for_each(|(x, d)| *x *= d);
    });
    norm(a) * inverse
}

/// What the pivots of `factor`, that of `a`, let the same condition number be: n ‖S‖₁ / p, p the smallest pivot of S. No solve.
///
/// 1/p is the last diagonal entry of the inverse of a leading block of S (Schur's complement), never more than ‖S⁻¹‖₂; and where
/// a motion v costs all but nothing, S⁻¹ ≈ v vᵀ / λ, the last unknown of it has p = λ / v². No entry of S⁻¹ exceeds the largest of
/// its diagonal, and n of them make the norm. So the condition is beyond this only where v is larger elsewhere than there: no bound,
/// but the order of one. 0 of no unknowns.
pub(super) fn from_pivots(a: &Symmetric, factor: &Cholesky) -> f64 {
    factor.weakest(a.lower()).map_or(0.0, |(_, pivot)| a.ndof() as f64 * norm(a) / pivot)
}

/// The estimate where the pivots do not show that it is far below [`NOTABLE_CONDITION`]; `solves` counts.
pub(super) fn notable(a: &Symmetric, factor: &mut Cholesky, solves: &mut u64) -> Option<f64> {
    let harmless = from_pivots(a, factor) <= SUSPECT * NOTABLE_CONDITION;
    (!harmless).then(|| {
        estimate(a, |x| {
            factor.solve(x, 1);
            *solves += 1;
        })
    })
}

fn diagonal(a: &Symmetric) -> impl Iterator<Item = f64> {
    a.pattern().starts()[..a.ndof()].iter().map(|at| a.lower().val()[*at])
}

/// ‖S‖₁.
fn norm(a: &Symmetric) -> f64 {
    let (n, values) = (a.ndof(), a.lower().val());
    let (starts, rows) = (a.pattern().starts(), a.pattern().rows());
    let over: Vec<f64> = diagonal(a).map(|d| 1.0 / d.sqrt()).collect();
    let mut sums = vec![0.0; n];
    for j in 0..n {
        for (i, value) in (starts[j]..starts[j + 1]).map(|at| (rows[at], values[at])) {
            let scaled = (value * over[i] * over[j]).abs();
            sums[j] += scaled;
            if i != j {
                sums[i] += scaled;
            }
        }
    }
    sums.into_iter().fold(0.0, f64::max)
}

/// An estimate of ‖B‖₁ of a symmetric B of order n from `apply`, `x ← B x`.
fn inverse(n: usize, mut apply: impl FnMut(&mut [f64])) -> f64 {
    let norm = |x: &[f64]| x.iter().map(|x| x.abs()).sum::<f64>();
    let mut x = vec![1.0 / n.max(1) as f64; n];
    let (mut found, mut unit) = (0.0, None);
    let mut signs = Vec::new();
    for _ in 0..ITERATIONS {
        apply(&mut x);
        let size = norm(&x);
        if size.is_nan() {
            return f64::NAN;
        }
        let now: Vec<f64> = x.iter().map(|x| 1.0_f64.copysign(*x)).collect();
        if unit.is_some() && size <= found || now == signs {
            found = size.max(found);
            break;
        }
        found = size;
        signs = now;
        x.copy_from_slice(&signs);
        apply(&mut x);
        let Some(top) = (0..n).max_by(|i, j| x[*i].abs().total_cmp(&x[*j].abs())) else { break };
        if unit == Some(top) {
            break;
        }
        unit = Some(top);
        x.fill(0.0);
        x[top] = 1.0;
    }
    // What cancels in all of the above does not in this one.
    let step = 1.0 / n.saturating_sub(1).max(1) as f64;
    x.iter_mut().enumerate().for_each(|(i, x)| *x = (1.0 + i as f64 * step) * [1.0, -1.0][i % 2]);
    apply(&mut x);
    found.max(2.0 * norm(&x) / (3.0 * n.max(1) as f64))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::assembly::{Cholesky, Pattern, Symbolic};
    use std::num::NonZeroUsize;
    use std::sync::Arc;

    /// The estimate of a dense matrix, and how many solves it took.
    fn of(n: usize, a: impl Fn(usize, usize) -> f64) -> (f64, usize) {
        let starts = (0..=n).map(|j| (0..j).map(|j| n - j).sum()).collect();
        let pattern = Arc::new(Pattern::new(starts, (0..n).flat_map(|j| j..n).collect()));
        let mut matrix = Symmetric::zero(pattern.clone());
        let entries = (0..n).flat_map(|j| (j..n).map(move |i| (i, j))).map(|(i, j)| a(i, j));
        matrix.lower_mut().val_mut().iter_mut().zip(entries).for_each(|(to, value)| *to = value);
        let mut factor = Cholesky::new(Symbolic::new(pattern).unwrap(), NonZeroUsize::MIN);
        factor.factorise(matrix.lower()).unwrap();
        let mut solves = 0;
        let found = estimate(&matrix, |x| {
            solves += 1;
            factor.solve(x, 1);
        });
        (found, solves)
    }

    #[test]
    fn condition_of_known_matrices() {
        assert!((of(1, |_, _| 7.0).0 - 1.0).abs() < 1e-15);
        // 51 springs in a row between two walls: ‖A‖₁ = 4, the sum of the middle column of A⁻¹ is 25 · 26/2.
        let chain = |i: usize, j: usize| if i == j { 2.0 } else { -f64::from(u8::from(i == j + 1)) };
        let (found, solves) = of(50, chain);
        assert!((found / 1300.0 - 1.0).abs() < 1e-12 && solves <= 11, "{found} {solves}");
    }

    #[test]
    fn units_of_the_unknowns_make_no_difference() {
        let stiff = |i: usize, j: usize| 1.0 / (i + j + 1) as f64;
        let unit = |i: usize| 10_f64.powi(3 * (i as i32) - 9);
        let (plain, scaled) = (of(6, stiff).0, of(6, |i, j| stiff(i, j) * unit(i) * unit(j)).0);
        assert!((plain / scaled - 1.0).abs() < 1e-6, "{plain} {scaled}");
    }

    #[test]
    fn what_is_no_number_stays_none() {
        let mut one = Symmetric::zero(Arc::new(Pattern::new(vec![0, 1], vec![0])));
        one.lower_mut().val_mut()[0] = 1.0;
        assert!(estimate(&one, |x| x[0] = f64::NAN).is_nan());
    }
}
