//! Which of the numbers that vary matter: Sobol's indices.

use super::Sweep;
use super::design::generator;
use super::figures::CaseFigures;
use super::runner::CaseRow;
use rand::RngExt;
use serde::Serialize;

/// Times that the blocks are drawn again for the intervals.
const DRAWS: usize = 500;
/// Least blocks of which indices are worth a word.
const LEAST: usize = 8;

/// What share of the variance of a result a key has: alone, and with all that it does together with others. Intervals of 95 % are
/// those of blocks that are drawn again (bootstrap).
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct Importance {
    pub result: String,
    pub key: String,
    pub first: f64,
    pub first_low: f64,
    pub first_high: f64,
    pub total: f64,
    pub total_low: f64,
    pub total_high: f64,
}

/// Of the design that is made for it, all results that vary; blocks of cases of which one failed are left out.
pub fn importance(sweep: &Sweep<'_>, rows: &[CaseRow]) -> Vec<Importance> {
    let design = &sweep.design;
    let width = design.axes.len() + 2;
    let whole = rows.chunk_by(|a, b| (a.case - 1) / width == (b.case - 1) / width).filter(|block| block.len() == width);
    let of = |row: &CaseRow| Some(results(sweep, row.case, row.result.as_ref().ok()?));
    let blocks: Vec<Vec<Results>> = whole.filter_map(|block| block.iter().map(of).collect()).collect();
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in blocks.iter().flatten().flatten() {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let mut all = Vec::new();
    for name in names {
        // Not every case has every result.
        let value = |case: &Results| case.iter().find(|(own, _)| own == name)?.1;
        let values: Vec<Vec<f64>> = blocks.iter().filter_map(|block| block.iter().map(value).collect()).collect();
        let indices = sobol_indices(&values, design.seed);
        all.extend(indices.into_iter().zip(&design.axes).map(|(of, axis)| {
            let [[first, first_low, first_high], [total, total_low, total_high]] = of;
            let (result, key) = (name.clone(), axis.key.clone());
            Importance { result, key, first, first_low, first_high, total, total_low, total_high }
        }));
    }
    all
}

/// Results that indices are computed of, where a case has them.
type Results = Vec<(String, Option<f64>)>;

fn results(sweep: &Sweep<'_>, number: usize, case: &CaseFigures) -> Results {
    let mut all = Vec::new();
    for of in &case.impactors {
        let name = |what: &str| of.name.as_ref().map_or(what.to_owned(), |name| format!("{name} {what}"));
        all.push((name("peak_force_N"), Some(of.peak_force)));
        all.push((name("deflection_m"), Some(of.deflection)));
        all.push((name("absorbed_energy_J"), Some(of.absorbed_energy)));
    }
    if let Some(of) = &case.grown {
        all.push(("delaminated_area_m2".to_owned(), Some(of.projected_area)));
        all.push(("dissipated_energy_J".to_owned(), Some(of.dissipated_energy)));
    }
    all.extend(case.modes.iter().map(|mode| (format!("{} index", mode.name), Some(mode.index))));
    if !sweep.quantities.is_empty() {
        let values = sweep.design.case(number - 1);
        all.extend(sweep.quantities.iter().map(|of| (of.name.clone(), of.value(&values, case))));
    }
    all
}

/// Of each key the first-order and the total index, each with the ends of its interval, from blocks f(A), f(B), f(A with key 1 of B), …
///
/// Sᵢ = E[f(B)(f(Aᵢ) − f(A))]/V, with f from its mean (Saltelli et al. 2010); Tᵢ = E[(f(A) − f(Aᵢ))²]/2V (Jansen 1999). None where
/// nothing varies or the blocks are few.
fn sobol_indices(blocks: &[Vec<f64>], seed: u64) -> Vec<[[f64; 3]; 2]> {
    let keys = blocks.first().map_or(0, |block| block.len().saturating_sub(2));
    let both = || blocks.iter().flat_map(|block| &block[..2]);
    let (least, most) = both().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), f| (a.min(*f), b.max(*f)));
    if blocks.len() < LEAST || !(most > least) {
        return Vec::new();
    }
    let mut random = generator(seed, u64::MAX);
    let drawn: Vec<Vec<usize>> =
        (0..DRAWS).map(|_| (0..blocks.len()).map(|_| random.random_range(0..blocks.len())).collect()).collect();
    let all: Vec<usize> = (0..blocks.len()).collect();
    (0..keys)
        .map(|key| {
            let estimate = |chosen: &[usize]| {
                let n = chosen.len() as f64;
                let mean = chosen.iter().map(|k| blocks[*k][0] + blocks[*k][1]).sum::<f64>() / (2.0 * n);
                let square = |f: f64| (f - mean).powi(2);
                let variance =
                    chosen.iter().map(|k| square(blocks[*k][0]) + square(blocks[*k][1])).sum::<f64>() / (2.0 * n);
                let first = chosen.iter().map(|k| (blocks[*k][1] - mean) * (blocks[*k][2 + key] - blocks[*k][0]));
                let total = chosen.iter().map(|k| (blocks[*k][0] - blocks[*k][2 + key]).powi(2));
                [first.sum::<f64>() / (n * variance), total.sum::<f64>() / (2.0 * n * variance)]
            };
            let again: Vec<[f64; 2]> = drawn.iter().map(|chosen| estimate(chosen)).collect();
            let whole = estimate(&all);
            [0, 1].map(|which| {
                let mut values: Vec<f64> = again.iter().map(|of| of[which]).filter(|value| value.is_finite()).collect();
                values.sort_by(f64::total_cmp);
                let at =
                    |share: f64| values.get((share * values.len() as f64) as usize).copied().unwrap_or(whole[which]);
                [whole[which], at(0.025), at(0.975)]
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::{Design, SweepAxis, Variation};
    use super::*;
    use fem_io::scene::Sampling;
    use std::f64::consts::PI;

    fn blocks(samples: usize, f: &dyn Fn(&[f64]) -> f64) -> Vec<Vec<f64>> {
        let axis = |key: usize| SweepAxis {
            key: key.to_string(),
            variation: Variation::parse(&format!("uniform({}, {PI})", -PI), None).unwrap(),
        };
        let design = Design::new((0..3).map(axis).collect(), Some(Sampling::Saltelli), samples, 3, &[]).unwrap();
        assert_eq!(design.count, 5 * samples);
        let case = |k: usize| f(&design.case(k).iter().map(|x| x.parse().unwrap()).collect::<Vec<f64>>());
        (0..samples).map(|block| (0..5).map(|k| case(5 * block + k)).collect()).collect()
    }

    fn agree(found: &[[[f64; 3]; 2]], want: [[f64; 2]; 3], near: f64) {
        for (found, want) in found.iter().zip(want) {
            for ([index, low, high], want) in found.iter().zip(want) {
                assert!((index - want).abs() < near, "{index} {want}");
                assert!(*low - 1e-9 <= want && want <= high + 1e-9, "{low} to {high}: {want}");
            }
        }
    }

    /// Ishigami and Homma (1990), sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁; closed forms as in Saltelli et al. (2008).
    #[test]
    fn the_ishigami_function_has_its_indices() {
        let f = |x: &[f64]| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin();
        let (v1, v2) = (0.5 * (1.0 + 0.1 * PI.powi(4) / 5.0).powi(2), 49.0 / 8.0);
        let v13 = 0.01 * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
        let v = v1 + v2 + v13;
        let want = [[v1 / v, (v1 + v13) / v], [v2 / v, v2 / v], [0.0, v13 / v]];
        assert!((want[0][0] - 0.3139).abs() < 1e-4 && (want[2][1] - 0.2437).abs() < 1e-4);
        agree(&sobol_indices(&blocks(2048, &f), 3), want, 0.02);
    }

    /// Of a sum, each has the share of its variance, and no more together with others.
    #[test]
    fn a_linear_model_has_its_shares() {
        let f = |x: &[f64]| x[0] + 2.0 * x[1] + 3.0 * x[2];
        agree(&sobol_indices(&blocks(1024, &f), 3), [1.0, 4.0, 9.0].map(|v| [v / 14.0; 2]), 0.02);
    }
}
