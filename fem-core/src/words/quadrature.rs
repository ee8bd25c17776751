//! Gauss-Legendre quadrature.
//!
//! ```
//! use fem_core::quadrature::gauss_legendre;
//!
//! // Three points are exact to the fifth degree: ∫ x⁴ dx = 2/5.
//! let integral: f64 = gauss_legendre(3).iter().map(|(x, weight)| weight * x.powi(4)).sum();
//! assert!((integral - 0.4).abs() < 1e-15);
//! ```

use std::sync::LazyLock;

/// Largest rule that [`gauss_legendre`] holds.
pub const MAX_POINTS: usize = 32;

/// Points and weights of the `n`-point Gauss-Legendre rule on [-1, 1], exact to degree 2n − 1.
///
/// `n` beyond [`MAX_POINTS`] gives the rule of `MAX_POINTS` points.
pub fn gauss_legendre(n: usize) -> &'static [(f64, f64)] {
    static RULES: LazyLock<Vec<Vec<(f64, f64)>>> = LazyLock::new(|| (0..=MAX_POINTS).map(rule).collect());
    &RULES[n.min(MAX_POINTS)]
}

/// Roots of Pₙ by Newton's method from Tricomi's estimate; the rule is symmetric to the last bit.
fn rule(n: usize) -> Vec<(f64, f64)> {
    let mut rule = vec![(0.0, 0.0); n];
    for i in 0..n.div_ceil(2) {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..64 {
            let (p1, p0) = legendre(n, x);
            slope = n as f64 * (x * p1 - p0) / (x * x - 1.0);
            let dx = p1 / slope;
            x -= dx;
            if dx.abs() < 1e-16 {
                break;
            }
        }
        if 2 * i + 1 == n {
            x = 0.0;
            slope = n as f64 * legendre(n - 1, 0.0).0;
        }
        let w = 2.0 / ((1.0 - x * x) * slope * slope);
        rule[i] = (-x, w);
        rule[n - 1 - i] = (x, w);
    }
    rule
}

/// (Pₙ(x), Pₙ₋₁(x)).
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut p0, mut p1) = (0.0, 1.0);
    for k in 1..=n {
        let k = k as f64;
        (p0, p1) = (p1, ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k);
    }
    (p1, p0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_to_its_degree() {
        for n in 1..=16 {
            let rule = gauss_legendre(n);
            for degree in 0..2 * n {
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
                let exact = if degree % 2 == 0 { 2.0 / (degree as f64 + 1.0) } else { 0.0 };
                assert!((sum - exact).abs() < 4e-15, "n {n} degree {degree}: {sum} {exact}");
            }
        }
    }
}
