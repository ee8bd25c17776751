//! What the cases of a sweep whose numbers scatter say together.

use super::distribution::{standard_quantile, standard_share};
use super::runner::CaseRow;
use serde::Serialize;
use statrs::distribution::{Beta, ContinuousCDF};
use statrs::function::gamma::ln_gamma;

/// Confidence of intervals and of basis values.
const CONFIDENCE: f64 = 0.95;

/// How often something happened.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct Probability {
    pub what: String,
    pub cases: usize,
    pub of: usize,
    pub probability: f64,
    /// Clopper and Pearson's interval of 95 % (1934), which holds whatever the probability is.
    pub low: f64,
    pub high: f64,
}

/// A force below which so few parts are damaged, with a confidence of 95 %: 1 % of them for A, 10 % for B.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct Basis {
    pub basis: &'static str,
    pub force_N: f64,
    /// Of what it holds: `normal`, mean − k s of normal numbers; `nonparametric`, a rank of any.
    pub method: &'static str,
    /// k, or the rank counted from the least.
    pub factor: f64,
}

/// All of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct Scatter {
    pub damage: Vec<Probability>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_at_first_damage_mean_N: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_at_first_damage_deviation_N: Option<f64>,
    pub bases: Vec<Basis>,
}

/// Of the cases that did not fail.
pub fn scatter(rows: &[CaseRow]) -> Scatter {
    let found: Vec<_> = rows.iter().filter_map(|row| row.result.as_ref().ok()).collect();
    let share = |what: String, cases: usize| Probability::of(what, cases, found.len());
    let mut damage = Vec::new();
    if let Some(one) = found.first() {
        damage.push(share("any damage".into(), found.iter().filter(|case| case.first.is_some()).count()));
        for (k, mode) in one.modes.iter().enumerate() {
            let reached = |case: &&&super::CaseFigures| case.modes.get(k).is_some_and(|mode| mode.onset.is_some());
            damage.push(share(mode.name.clone(), found.iter().filter(reached).count()));
        }
    }
    let mut forces: Vec<f64> = found.iter().filter_map(|case| Some(case.first.as_ref()?.force)).collect();
    forces.sort_by(f64::total_cmp);
    let (n, all) = (forces.len() as f64, forces.len() == found.len());
    let mean = forces.iter().sum::<f64>() / n;
    let deviation = (forces.iter().map(|force| (force - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
    let mut bases = Vec::new();
    for (basis, share) in [("A", 0.01), ("B", 0.1)] {
        if all && forces.len() > 2 && deviation > 0.0 {
            let factor = basis_factor(forces.len(), share);
            bases.push(Basis { basis, force_N: mean - factor * deviation, method: "normal", factor });
        }
        // Cases without damage stand above all others.
        if let Some(rank) = rank(found.len(), share)
            && let Some(force) = forces.get(rank - 1)
        {
            bases.push(Basis { basis, force_N: *force, method: "nonparametric", factor: rank as f64 });
        }
    }
    let several = forces.len() > 1;
    Scatter {
        damage,
        force_at_first_damage_mean_N: several.then_some(mean),
        force_at_first_damage_deviation_N: several.then_some(deviation),
        bases,
    }
}

impl Probability {
    fn of(what: String, cases: usize, of: usize) -> Self {
        let tail = 0.5 * (1.0 - CONFIDENCE);
        let bound = |a: usize, b: usize, p: f64| Beta::new(a as f64, b as f64).map(|beta| beta.inverse_cdf(p)).ok();
        let low = bound(cases, of - cases + 1, tail).filter(|_| cases > 0).unwrap_or(0.0);
        let high = bound(cases + 1, of - cases, 1.0 - tail).filter(|_| cases < of).unwrap_or(1.0);
        Self { what, cases, of, probability: cases as f64 / of.max(1) as f64, low, high }
    }
}

/// Factor k of `n` normal numbers for which, with 95 % confidence, at most the `share` of all lies below mean − k s: one-sided, from
/// the noncentral t distribution, t₀.₉₅(n−1, z √n)/√n (MIL-HDBK-17-1F, 8.5.10).
///
/// It solves E[Φ(√n (k s/σ − z))] = 0.95, where (n−1) s²/σ² is of χ², by Simpson's rule and bisection.
pub fn basis_factor(n: usize, share: f64) -> f64 {
    const PARTS: usize = 1000;
    let (freedom, root, z) = (n as f64 - 1.0, (n as f64).sqrt(), -standard_quantile(share));
    // Logarithms, because powers and factorials of hundreds have no number.
    let constant = ln_gamma(0.5 * freedom) + 0.5 * freedom * std::f64::consts::LN_2;
    let density = |x: f64| ((0.5 * freedom - 1.0) * x.ln() - 0.5 * x - constant).exp();
    let width = 9.0 / (2.0 * freedom).sqrt();
    let (low, high) = ((1.0 - width).max(1e-9), 1.0 + width);
    let h = (high - low) / PARTS as f64;
    let confidence = |k: f64| {
        let each = (0..=PARTS).map(|i| {
            let s = low + i as f64 * h;
            let weight = if i == 0 || i == PARTS { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
            weight * 2.0 * freedom * s * density(freedom * s * s) * standard_share(root * (k * s - z))
        });
        each.sum::<f64>() * h / 3.0
    };
    let (mut low, mut high) = (0.0, 400.0);
    for _ in 0..60 {
        let k = 0.5 * (low + high);
        if confidence(k) < CONFIDENCE { low = k } else { high = k }
    }
    0.5 * (low + high)
}

/// The largest rank, counted from 1 at the least, that with 95 % confidence has at most the `share` of all below it; `None` where `n`
/// numbers are too few.
fn rank(n: usize, share: f64) -> Option<usize> {
    // P(at least r of n below) is the incomplete beta function I_share(r, n − r + 1).
    let sure = |r: usize| Beta::new(r as f64, (n - r + 1) as f64).is_ok_and(|beta| beta.cdf(share) >= CONFIDENCE);
    (1..=n).take_while(|r| sure(*r)).last()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// MIL-HDBK-17-1F, tables 8.5.10 and 8.5.11.
    #[test]
    fn factors_are_those_published() {
        for (n, a, b) in
            [(5, 5.741, 3.407), (10, 3.981, 2.355), (20, 3.295, 1.926), (30, 3.064, 1.777), (100, 2.684, 1.527)]
        {
            for (share, want) in [(0.01, a), (0.1, b)] {
                let got = basis_factor(n, share);
                assert!((got / want - 1.0).abs() < 1e-3, "{n} {share}: {got}, {want}");
            }
        }
    }

    /// The fit of MIL-HDBK-17-1F, 8.5.10, good to 0.2 %.
    #[test]
    fn factors_of_many_follow_the_fit() {
        for n in [16, 60, 300, 3000, 100_000] {
            let x = n as f64;
            let fits = [
                (0.01, 2.326 + (1.34 - 0.522 * x.ln() + 3.87 / x).exp()),
                (0.1, 1.282 + (0.958 - 0.520 * x.ln() + 3.19 / x).exp()),
            ];
            for (share, fit) in fits {
                let got = basis_factor(n, share);
                assert!((got / fit - 1.0).abs() < 3e-3, "{n} {share}: {got}, {fit}");
            }
        }
    }

    /// MIL-HDBK-17-1F, tables 8.5.12 and 8.5.13: B from 29 on, the second from 46; A from 299 on.
    #[test]
    fn ranks_are_those_published() {
        let b = [(28, None), (29, Some(1)), (45, Some(1)), (46, Some(2)), (61, Some(3))];
        for (n, want) in b {
            assert_eq!(rank(n, 0.1), want, "{n}");
        }
        assert_eq!([rank(298, 0.01), rank(299, 0.01)], [None, Some(1)]);
    }

    /// Clopper and Pearson of 10 in 100: 4.90 % to 17.62 %; of none in 10: up to 30.85 %.
    #[test]
    fn intervals_are_those_published() {
        let ten = Probability::of(String::new(), 10, 100);
        assert!((ten.low - 0.049).abs() < 1e-4 && (ten.high - 0.1762).abs() < 1e-4, "{ten:?}");
        let none = Probability::of(String::new(), 0, 10);
        assert!(none.low == 0.0 && (none.high - 0.3085).abs() < 1e-4, "{none:?}");
    }
}
