//! Which cases a sweep has.

use super::copula::Copula;
use super::variation::Variation;
use crate::error::Error;
use fem_io::scene::Sampling;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Most cases of a sweep: rows of a table that one process holds.
const MOST: usize = 1_000_000;
/// What a case takes that shares its plate, s, and in the files, bytes: of the report's case 1.
const EACH_SECONDS: f64 = 0.02;
const EACH_BYTES: f64 = 1e3;
/// Most cases of Sobol's sequence, as far as it is tabulated.
const MOST_SOBOL: usize = 1 << 16;
/// Most keys that its dimensions are enough for, twice each in blocks of Saltelli's.
const MOST_AXES: usize = 100;

/// A key of the scene and what it becomes.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepAxis {
    /// The path of the key.
    pub key: String,
    /// What it becomes.
    pub variation: Variation,
}

/// The cases of a sweep. Each follows from its number and the seed alone, whoever asks for it.
#[derive(Debug, Clone)]
pub struct Design {
    /// What is varied.
    pub axes: Vec<SweepAxis>,
    /// How cases are chosen.
    pub sampling: Sampling,
    /// How many there are.
    pub count: usize,
    /// What random numbers follow from.
    pub seed: u64,
    /// Of each axis, the part of each case of a Latin hypercube.
    parts: Vec<Vec<usize>>,
    copula: Copula,
}

impl Design {
    /// The cases of `axes`, whose numbers have `correlations` as in `KEY,KEY=0.6`; by default a grid where all of them have so many
    /// values, else random numbers.
    ///
    /// # Errors
    /// No axes, more cases than can be, numbers without end on a grid, correlations that no numbers can have.
    pub fn new(
        axes: Vec<SweepAxis>,
        sampling: Option<Sampling>,
        samples: usize,
        seed: u64,
        correlations: &[String],
    ) -> Result<Self, Error> {
        let refuse = |message: String, help: &str| Error::Sweep { message, help: help.to_owned() };
        if axes.is_empty() {
            let help = "give `--set impactor.velocity=1..5:9`, or a table `[sweep]` in the scene";
            return Err(refuse("nothing is varied".into(), help));
        }
        if axes.len() > MOST_AXES {
            return Err(refuse(
                format!("{} keys are varied, and at most {MOST_AXES} can be", axes.len()),
                "vary fewer",
            ));
        }
        let endless = axes.iter().find(|axis| axis.variation.count().is_none());
        let sampling = sampling.unwrap_or(if endless.is_none() { Sampling::Grid } else { Sampling::Random });
        let cases = match (sampling, endless) {
            (Sampling::Grid, Some(axis)) => {
                let help = "say how many, as in 1..5:9, or choose `--design random`, `latin-hypercube` or `sobol`";
                return Err(refuse(format!("`{}` has numbers without end, and a grid takes each", axis.key), help));
            }
            (Sampling::Grid, None) => {
                axes.iter().map(|axis| axis.variation.count().unwrap_or(1) as f64).product::<f64>()
            }
            (Sampling::Saltelli, _) => samples as f64 * (axes.len() + 2) as f64,
            _ => samples as f64,
        };
        let most = match sampling {
            Sampling::Sobol => MOST_SOBOL,
            Sampling::Saltelli => MOST_SOBOL * (axes.len() + 2),
            _ => MOST,
        };
        if cases > most as f64 {
            let help = "vary fewer keys, take fewer values, or sample: `--design latin-hypercube --samples 1000`";
            let kind = sampling.name();
            let (days, gigabytes) = (cases * EACH_SECONDS / 86_400.0, cases * EACH_BYTES / 1e9);
            return Err(refuse(
                format!(
                    "these are {cases:.0} cases, {gigabytes:.3} GB of tables and, where each takes {:.0} ms, {days:.3} days, and a \
                     sweep by `{kind}` has at most {most}",
                    1e3 * EACH_SECONDS
                ),
                help,
            ));
        }
        let count = cases as usize;
        let parts = match sampling {
            Sampling::LatinHypercube => (0..axes.len()).map(|axis| shuffled(count, seed, axis)).collect(),
            _ => Vec::new(),
        };
        let help = "give `--correlate KEY,KEY=0.6` for two keys with distributions, once a pair";
        let copula = Copula::new(&axes, correlations).map_err(|why| refuse(why, help))?;
        if !copula.is_none() && sampling == Sampling::Saltelli {
            let help = "Sobol's indices are those of independent numbers: leave the correlations out, or choose another design";
            return Err(refuse("`saltelli` takes no correlations".into(), help));
        }
        Ok(Self { axes, sampling, count, seed, parts, copula })
    }

    /// What each key becomes in case `k`, counted from 0, as `--set` takes it.
    pub fn case(&self, k: usize) -> Vec<String> {
        if self.sampling == Sampling::Grid {
            // The last axis varies first.
            let mut left = k;
            let mut values: Vec<String> = Vec::new();
            for axis in self.axes.iter().rev() {
                let count = axis.variation.count().unwrap_or(1);
                values.push(axis.variation.level(left % count));
                left /= count;
            }
            values.reverse();
            return values;
        }
        let mut random = generator(self.seed, k as u64);
        let sobol =
            |k: usize, dimension: usize| f64::from(sobol_burley::sample(k as u32, dimension as u32, self.seed as u32));
        let mut share = |axis: usize| match self.sampling {
            Sampling::Sobol => sobol(k, axis),
            Sampling::Saltelli => {
                // Of each block the first has all keys of A, the second all of B, the others all of A but one of B.
                let (block, which) = (k / (self.axes.len() + 2), k % (self.axes.len() + 2));
                let of_b = which == 1 || which == axis + 2;
                sobol(block, if of_b { axis + self.axes.len() } else { axis })
            }
            Sampling::LatinHypercube => (self.parts[axis][k] as f64 + random.random::<f64>()) / self.count as f64,
            Sampling::Random | Sampling::Grid => random.random::<f64>(),
        };
        let shares = self.copula.correlated((0..self.axes.len()).map(&mut share).collect());
        self.axes.iter().zip(shares).map(|(axis, share)| axis.variation.at(share)).collect()
    }
}

/// Random numbers of a case of their own. Streams of one state are not independent of each other (the second numbers of 4000 streams
/// had a variance seven standard errors off), so that each begins at a state of its own.
pub(super) fn generator(seed: u64, stream: u64) -> Pcg64 {
    let first = mixed(mixed(seed).wrapping_add(stream));
    let second = mixed(first);
    Pcg64::new((u128::from(first) << 64) | u128::from(second), u128::from(mixed(second)))
}

/// A number of which every bit depends on all bits of `x` (SplitMix64, Steele, Lea and Flood 2014).
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

fn shuffled(count: usize, seed: u64, axis: usize) -> Vec<usize> {
    let mut parts: Vec<usize> = (0..count).collect();
    parts.shuffle(&mut Pcg64::seed_from_u64(seed.wrapping_add((axis as u64) << 32)));
    parts
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn axes(words: &[&str]) -> Vec<SweepAxis> {
        let each = |words: &&str| SweepAxis { key: "k".into(), variation: Variation::parse(words, None).unwrap() };
        words.iter().map(each).collect()
    }

    #[test]
    fn a_grid_has_every_pair() {
        let grid = Design::new(axes(&["1..3:3", "a,b"]), None, 100, 1, &[]).unwrap();
        let cases: Vec<String> = (0..grid.count).map(|k| grid.case(k).join(" ")).collect();
        assert_eq!(cases, ["1 a", "1 b", "2 a", "2 b", "3 a", "3 b"]);
        let big = Design::new(axes(&["0..1:1000", "0..1:1000", "0..1:1000"]), None, 100, 1, &[]).unwrap_err();
        assert!(big.to_string().contains("1000000000 cases"), "{big}");
        assert!(Design::new(axes(&["0..1"]), Some(Sampling::Grid), 100, 1, &[]).is_err());
    }

    /// Means and variances of 4000 independent numbers, and of their products, are within four standard errors for every seed.
    #[test]
    fn random_numbers_are_independent() {
        let axes = axes(&["normal(0, 1)", "normal(0, 1)", "normal(0, 1)"]);
        for seed in 1..5 {
            let design = Design::new(axes.clone(), None, 4000, seed, &[]).unwrap();
            let all: Vec<Vec<f64>> =
                (0..4000).map(|k| design.case(k).iter().map(|value| value.parse().unwrap()).collect()).collect();
            let mean = |f: &dyn Fn(&[f64]) -> f64| all.iter().map(|z| f(z)).sum::<f64>() / 4000.0;
            let error = 4.0 / 4000.0_f64.sqrt();
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                let found = [mean(&|z| z[i]), (mean(&|z| z[i] * z[i]) - 1.0) / 2.0_f64.sqrt(), mean(&|z| z[i] * z[j])];
                assert!(found.iter().all(|off| off.abs() < error), "{seed} {i}: {found:?}");
            }
        }
    }

    /// Of 4000 pairs the correlation of the normal numbers behind is known to 1/√4000, and each keeps its own distribution.
    #[test]
    fn numbers_scatter_together() {
        let axes = || axes(&["normal(50, 5)", "weibull(60, 12)", "lognormal(2, 0.1)"]);
        let named =
            || (0..).zip(axes()).map(|(k, axis)| SweepAxis { key: format!("k{k}"), ..axis }).collect::<Vec<_>>();
        let with = |pairs: &[&str]| {
            let pairs: Vec<String> = pairs.iter().map(|pair| (*pair).to_owned()).collect();
            Design::new(named(), None, 4000, 3, &pairs)
        };
        let design = with(&["k0,k1=0.7", "k2, k0 = -0.4"]).unwrap();
        let scores: Vec<Vec<f64>> = (0..design.count)
            .map(|k| {
                let each = design.case(k).into_iter().zip(&design.axes).map(|(value, axis)| {
                    let Variation::Scatter { by, .. } = &axis.variation else { panic!("it scatters") };
                    super::super::distribution::standard_quantile(by.share_below(value.parse().unwrap()))
                });
                each.collect()
            })
            .collect();
        let mean = |f: &dyn Fn(&[f64]) -> f64| scores.iter().map(|z| f(z)).sum::<f64>() / 4000.0;
        for (i, j, want) in [(0, 1, 0.7), (0, 2, -0.4), (1, 2, 0.0)] {
            let found = mean(&|z| z[i] * z[j]);
            assert!((found - want).abs() < 0.06, "{i} {j}: {found}, {want}");
            assert!(mean(&|z| z[i]).abs() < 0.05 && (mean(&|z| z[i] * z[i]) - 1.0).abs() < 0.08);
        }
        for (pairs, why) in [
            (&["k0,k1=0.9", "k0,k2=0.9", "k1,k2=-0.9"][..], "not positive definite"),
            (&["k0,k1=1"], "between -1 and 1"),
            (&["k0,k9=0.1"], "does not vary"),
            (&["k0=0.1"], "write KEY,KEY=0.6"),
            (&["k0,k1=0.1", "k1,k0=0.1"], "already"),
        ] {
            let said = with(pairs).unwrap_err().to_string();
            assert!(said.contains(why), "{pairs:?}: {said}");
        }
    }

    /// Independent numbers scatter by 1/√(12 n) about 1/2 in the mean; parts of equal probability hold one each.
    #[test]
    fn samples_fill_the_range() {
        for sampling in [Sampling::Random, Sampling::LatinHypercube, Sampling::Sobol] {
            let design = Design::new(axes(&["0..1", "0..1"]), Some(sampling), 256, 7, &[]).unwrap();
            for axis in 0..2 {
                let mut values: Vec<f64> = (0..256).map(|k| design.case(k)[axis].parse().unwrap()).collect();
                let mean = values.iter().sum::<f64>() / 256.0;
                let bound = if sampling == Sampling::Random { 0.072 } else { 0.002 };
                assert!((mean - 0.5).abs() < bound, "{sampling:?} {mean}");
                values.sort_by(f64::total_cmp);
                if sampling != Sampling::Random {
                    assert!(values.iter().enumerate().all(|(k, v)| (v * 256.0) as usize == k), "{sampling:?}");
                }
            }
            assert_eq!(
                design.case(17),
                Design::new(axes(&["0..1", "0..1"]), Some(sampling), 256, 7, &[]).unwrap().case(17)
            );
        }
    }
}
