//! Which cases a sweep has.

use super::variation::Variation;
use crate::error::Error;
use fem_io::scene::Sampling;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Most cases of a sweep: rows of a table that one process holds.
const MOST: usize = 1_000_000;
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
}

impl Design {
    /// The cases of `axes`; by default a grid where all of them have so many values, else random numbers.
    ///
    /// # Errors
    /// No axes, more cases than can be, numbers without end on a grid.
    pub fn new(axes: Vec<SweepAxis>, sampling: Option<Sampling>, samples: usize, seed: u64) -> Result<Self, Error> {
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
            return Err(refuse(
                format!("these are {cases:.0} cases, and a sweep by `{kind}` has at most {most}"),
                help,
            ));
        }
        let count = cases as usize;
        let parts = match sampling {
            Sampling::LatinHypercube => (0..axes.len()).map(|axis| shuffled(count, seed, axis)).collect(),
            _ => Vec::new(),
        };
        Ok(Self { axes, sampling, count, seed, parts })
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
        self.axes.iter().enumerate().map(|(axis, of)| of.variation.at(share(axis))).collect()
    }
}

/// Random numbers of a case of their own.
pub(super) fn generator(seed: u64, stream: u64) -> Pcg64 {
    Pcg64::new((u128::from(seed) << 64) | 0x5eed, u128::from(stream))
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
        let grid = Design::new(axes(&["1..3:3", "a,b"]), None, 100, 1).unwrap();
        let cases: Vec<String> = (0..grid.count).map(|k| grid.case(k).join(" ")).collect();
        assert_eq!(cases, ["1 a", "1 b", "2 a", "2 b", "3 a", "3 b"]);
        let big = Design::new(axes(&["0..1:1000", "0..1:1000", "0..1:1000"]), None, 100, 1).unwrap_err();
        assert!(big.to_string().contains("1000000000 cases"), "{big}");
        assert!(Design::new(axes(&["0..1"]), Some(Sampling::Grid), 100, 1).is_err());
    }

    /// Independent numbers scatter by 1/√(12 n) about 1/2 in the mean; parts of equal probability hold one each.
    #[test]
    fn samples_fill_the_range() {
        for sampling in [Sampling::Random, Sampling::LatinHypercube, Sampling::Sobol] {
            let design = Design::new(axes(&["0..1", "0..1"]), Some(sampling), 256, 7).unwrap();
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
            assert_eq!(design.case(17), Design::new(axes(&["0..1", "0..1"]), Some(sampling), 256, 7).unwrap().case(17));
        }
    }
}
