//! Stresses of the places that are watched, as products with the coordinates of a reduced plate.

use crate::forecast::Demand;
use fem_core::failure::StressRange;
use fem_core::tensor::{Ply, Stress6};
use fem_core::vectorised::{products, products_of_intervals};
use fem_dynamics::reduce::TensionPatterns;
use fem_failure::scan::{Samples, windows};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Columns of a product.
pub(super) const LANES: usize = Demand::BATCH;

/// Samples that fill all lanes when a scan looks at them window by window.
pub(super) const SURVEYED: usize = LANES * (LANES - 1) + 1;

/// Columns of coordinates, `LANES` numbers for each of them.
type Columns = Vec<[f64; LANES]>;

/// The stress at each site per unit of each coordinate: those of the march, and where its deflections stretch a plate the amounts of its
/// tensions.
#[derive(Debug)]
pub(super) struct StressOperator {
    /// Of each site six rows, one number per coordinate.
    rows: Vec<f64>,
    width: usize,
    /// Stresses that do not follow from the coordinates, six a site; empty where there are none.
    residual: Vec<f64>,
    coarse: OnceLock<Coarse>,
    /// The tensions, if there are some.
    tensions: Option<Arc<TensionPatterns>>,
}

/// The rows in single precision, in units of coordinates that bring the largest number of each to between 1/2 and 1.
#[derive(Debug)]
struct Coarse {
    rows: Vec<f32>,
    /// Powers of two, by which coordinates are divided.
    units: Vec<f64>,
}

impl StressOperator {
    /// From fields of stresses, six a site, one for each of `width` coordinates.
    pub(super) fn new(fields: &[f64], width: usize, residual: Vec<f64>) -> Self {
        let height = fields.len() / width.max(1);
        let mut rows = vec![0.0; fields.len()];
        // A square of both at a time stays near.
        for (first, block) in (0..).step_by(8).zip(fields.chunks(8 * height.max(1))) {
            for row in 0..height {
                for (out, field) in rows[row * width + first..].iter_mut().zip(block.chunks_exact(height)) {
                    *out = field[row];
                }
            }
        }
        Self { rows, width, residual, coarse: OnceLock::new(), tensions: None }
    }

    /// The same with the stresses of these tensions behind those of the coordinates.
    pub(super) fn with_tensions(self, tensions: &Arc<TensionPatterns>) -> Self {
        Self { tensions: Some(Arc::clone(tensions)), ..self }
    }

    /// The six rows of `site`, and its stresses that do not follow from the coordinates.
    pub(super) fn of(&self, site: usize) -> (&[f64], [f64; 6]) {
        (&self.rows[6 * site * self.width..][..6 * self.width], self.residual(site))
    }

    /// That of rows that were kept ([`StressOperator::rows`]); `None` where they are not six for each of so many `sites`.
    pub(super) fn of_rows(rows: Vec<f64>, sites: usize, width: usize, residual: Vec<f64>) -> Option<Self> {
        let fits = Some(rows.len()) == sites.checked_mul(6 * width) && rows.iter().all(|row| row.is_finite());
        fits.then_some(Self { rows, width, residual, coarse: OnceLock::new(), tensions: None })
    }

    /// Of each site six rows, one number per coordinate.
    pub(super) fn rows(&self) -> &[f64] {
        &self.rows
    }

    /// Number of coordinates.
    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// Whether the rows of `sites` give `field`, the stresses of coordinates `q` that do follow from them, but for rounding.
    pub(super) fn gives(&self, sites: impl Iterator<Item = usize>, q: &[f64], field: &[f64]) -> bool {
        let rows = sites.flat_map(|site| self.of(site).0.chunks_exact(self.width));
        let sums = rows.map(|row| row.iter().zip(q).map(|(s, q)| s * q).sum::<f64>());
        let largest = field.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        sums.zip(field).all(|(sum, stress)| (sum - stress).abs() <= 1e-8 * largest)
    }

    /// Coordinates of a march with all that stresses follow from.
    pub(super) fn extended<'a>(&self, samples: &'a [f64]) -> Cow<'a, [f64]> {
        let Some(tensions) = &self.tensions else { return Cow::Borrowed(samples) };
        let follow = tensions.follow();
        let with_amounts = |q: &[f64]| q.iter().copied().chain(follow.amounts(q)).collect::<Vec<_>>();
        Cow::Owned(samples.chunks_exact((self.width - follow.terms()).max(1)).flat_map(with_amounts).collect())
    }

    /// [Extended](StressOperator::extended) `samples`, one after the other, as columns; lanes without a sample are zero.
    pub(super) fn columns(&self, samples: &[f64]) -> Columns {
        let lane = |k: usize| std::array::from_fn(|lane| samples.get(lane * self.width + k).copied().unwrap_or(0.0));
        (0..self.width).map(lane).collect()
    }

    /// The stresses of `site` for each of the `columns`, by component. A sum takes its terms in one order whatever stands beside it,
    /// so that a stress does not depend on what else is computed.
    pub(super) fn stresses(&self, site: usize, columns: &Columns) -> [[f64; LANES]; 6] {
        let rows = self.of(site).0;
        // Three rows at a time leave all sums in registers.
        let (first, second) = rows.split_at(3 * self.width);
        let [[a, b, c], [d, e, f]] = [first, second].map(|rows| products(rows, columns));
        let mut out = [a, b, c, d, e, f];
        for (out, residual) in out.iter_mut().zip(self.residual(site)) {
            out.iter_mut().for_each(|s| *s += residual);
        }
        out
    }

    fn residual(&self, site: usize) -> [f64; 6] {
        std::array::from_fn(|i| self.residual.get(6 * site + i).copied().unwrap_or(0.0))
    }

    fn coarse(&self) -> &Coarse {
        self.coarse.get_or_init(|| {
            let mut units = vec![0.0_f64; self.width];
            for row in self.rows.chunks_exact(self.width.max(1)) {
                units.iter_mut().zip(row).for_each(|(unit, s)| *unit = unit.max(s.abs()));
            }
            let power = |largest: f64| (-1.0 - largest.log2().floor().clamp(-1000.0, 1000.0)).exp2();
            units.iter_mut().for_each(|unit| *unit = if *unit > 0.0 { power(*unit) } else { 1.0 });
            let scaled = |row: &[f64]| row.iter().zip(&units).map(|(s, unit)| (s * unit) as f32).collect::<Vec<_>>();
            let rows = self.rows.chunks_exact(self.width.max(1)).flat_map(scaled).collect();
            Coarse { rows, units }
        })
    }
}

/// Samples of coordinates, as a scan asks for their stresses.
pub(super) struct Sampled<'a> {
    operator: &'a StressOperator,
    /// Of each window.
    columns: Vec<Columns>,
    /// Of each window, a lane: the middle of each coordinate's range, and half its length.
    middles: Vec<[f32; LANES]>,
    halves: Vec<[f32; LANES]>,
    /// Of each window, what numbers too small for single precision may add to a stress, Pa.
    lost: [f64; LANES],
}

impl<'a> Sampled<'a> {
    /// Of `count` samples, at most [`SURVEYED`], whose [extended](StressOperator::extended) coordinates stand one after the other.
    ///
    /// The range of Σ S q over |q − m| ≤ h is Σ S m ± Σ |S| h. In single precision, of unit roundoff u, each of the two sums of n terms
    /// is wrong by less than (n + 3) u Σ |S| |m| or |h| (rows, coordinates, products with sums), so that halves of
    /// h + c (|m| + h) with c = 2 (n + 8) u hold what an exact sum has.
    pub(super) fn new(operator: &'a StressOperator, coordinates: &[f64], count: usize) -> Self {
        let width = operator.width;
        let of = |window: &Range<usize>| &coordinates[window.start * width..window.end * width];
        let windows: Vec<_> = windows(count).collect();
        let (mut middles, mut halves) = (vec![[0.0; LANES]; width], vec![[0.0; LANES]; width]);
        let tiny = f64::from(f32::MIN_POSITIVE) * (width + 1) as f64;
        let mut lost = [tiny; LANES];
        let rounding = (width + 8) as f64 * f64::from(f32::EPSILON);
        for (lane, window) in windows.iter().enumerate() {
            let units = &operator.coarse().units;
            for (k, ((middles, halves), unit)) in middles.iter_mut().zip(&mut halves).zip(units).enumerate() {
                let values = of(window).iter().skip(k).step_by(width);
                let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
                let middle = 0.5 * (low + high);
                let reach = (high - middle).max(middle - low);
                let half = reach + rounding * (middle.abs() + reach);
                (middles[lane], halves[lane]) = ((middle / unit) as f32, (half / unit) as f32);
                lost[lane] += tiny * (middle.abs() + half) / unit;
            }
        }
        let columns = windows.iter().map(|window| operator.columns(of(window))).collect();
        Self { operator, columns, middles, halves, lost }
    }
}

impl Samples for Sampled<'_> {
    fn ranges(&mut self, site: usize, out: &mut [StressRange]) {
        let width = self.operator.width;
        let rows = &self.operator.coarse().rows[6 * site * width..][..6 * width];
        let (first, second) = rows.split_at(3 * width);
        let sums = [first, second].map(|rows| products_of_intervals(rows, &self.middles, &self.halves));
        let [mut low, mut high] = [[[0.0; LANES]; 6]; 2];
        for (i, residual) in self.operator.residual(site).into_iter().enumerate() {
            let [middles, halves] = &sums[i / 3];
            for lane in 0..LANES {
                let (middle, half) = (f64::from(middles[i % 3][lane]), f64::from(halves[i % 3][lane]));
                let half = half + self.lost[lane] + 4.0 * f64::EPSILON * (middle.abs() + half + residual.abs());
                (low[i][lane], high[i][lane]) = (middle + residual - half, middle + residual + half);
            }
        }
        for (lane, out) in out.iter_mut().enumerate() {
            let [low, high] = [&low, &high].map(|components| at(components, lane));
            *out = StressRange { low, high };
        }
    }

    fn stresses(&mut self, site: usize, window: usize, out: &mut [Stress6<Ply>]) {
        put(&self.operator.stresses(site, &self.columns[window]), out);
    }
}

/// Turns components of samples into samples of components.
pub(super) fn put(components: &[[f64; LANES]; 6], out: &mut [Stress6<Ply>]) {
    out.iter_mut().enumerate().for_each(|(lane, out)| *out = at(components, lane));
}

fn at([a, b, c, d, e, f]: &[[f64; LANES]; 6], lane: usize) -> Stress6<Ply> {
    Stress6::new([a[lane], b[lane], c[lane], d[lane], e[lane], f[lane]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_hold_the_stresses_closely() {
        // Beyond single precision, within it, and at its edge.
        for unit in [1e-200, 1e-30, 1.0, 1e30, 1e45] {
            ranges_hold(unit, 100);
            ranges_hold(unit, 1);
        }
    }

    fn ranges_hold(unit: f64, count: usize) {
        let (sites, width) = (3, 5);
        let wave = |k: usize| (k as f64 * 0.7).sin();
        let fields: Vec<f64> = (0..6 * sites * width).map(|k| 1e9 * unit * wave(k * k)).collect();
        let residual: Vec<f64> = (0..6 * sites).map(|k| 1e7 * wave(3 * k)).collect();
        let coordinates: Vec<f64> =
            (0..width * count).map(|k| wave((1 + k / width) * (1 + k % width)) * 0.01 / unit).collect();
        let operator = StressOperator::new(&fields, width, residual.clone());
        let mut sampled = Sampled::new(&operator, &coordinates, count);
        let all: Vec<_> = windows(count).collect();
        let mut ranges = vec![StressRange { low: Stress6::new([0.0; 6]), high: Stress6::new([0.0; 6]) }; all.len()];
        let mut out = [Stress6::new([0.0; 6]); LANES];
        for site in 0..sites {
            sampled.ranges(site, &mut ranges);
            for (number, window) in all.iter().enumerate() {
                sampled.stresses(site, number, &mut out[..window.len()]);
                let StressRange { low, high } = ranges[number];
                for i in 0..6 {
                    let field = |k: usize| fields[k * 6 * sites + 6 * site + i];
                    let (mut terms, mut reach) = (0.0, 0.0);
                    for k in 0..width {
                        let values = || window.clone().map(|sample| coordinates[sample * width + k]);
                        let (least, most) = (values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max));
                        terms += field(k).abs() * least.abs().max(most.abs());
                        reach += 0.5 * field(k).abs() * (most - least);
                    }
                    let length = high.0[i] - low.0[i];
                    let least = 1e-14 * residual[6 * site + i].abs() + 1e-20;
                    assert!(length <= 2.0 * reach + 1e-5 * terms + least, "{length} of {reach} and {terms}");
                    for (sample, stress) in window.clone().zip(&out) {
                        let of = |k: usize| field(k) * coordinates[sample * width + k];
                        let sum = (0..width).map(of).sum::<f64>() + residual[6 * site + i];
                        assert!((stress.0[i] - sum).abs() < 1e-6, "{} is not {sum}", stress.0[i]);
                        assert!(low.0[i] <= stress.0[i] && stress.0[i] <= high.0[i]);
                    }
                }
            }
        }
    }

    #[test]
    fn stresses_beyond_single_precision_have_no_ranges() {
        let operator = StressOperator::new(&[1e39; 6], 1, Vec::new());
        let mut range = [StressRange { low: Stress6::new([0.0; 6]), high: Stress6::new([0.0; 6]) }];
        Sampled::new(&operator, &[2.0], 1).ranges(0, &mut range);
        assert!(!range[0].low.is_finite() && !range[0].high.is_finite());
    }
}
