//! What a run will cost, from its sizes.
//!
//! Seconds of a phase are a rate times its nominal seconds: those that its work takes on the machine of
//! `docs/performance.md`. Nominal seconds are the same everywhere, so that what is decided by them is decided equally from
//! study to study; rates are measured by the runs of a study as they come in.

use super::axes::{SIZES, value};
use super::record::{PHASES, Record, Size};
use crate::cost::Better;
use crate::model::{Model, Plan};
use fem_core::counters::Counters;

/// Entries of a factor, GFLOP that make it, and the exponent between the two (cells of two layers, 30 000 to 300 000
/// unknowns).
const ENTRIES: f64 = 24e6;
const GFLOP: f64 = 18.0;
const GROWTH: f64 = 1.32;
/// GFLOP a second of a factorisation, with what belongs to it.
const FACTOR: f64 = 13.0;
/// Seconds per entry of a factor and right-hand side, many of these together, and one alone.
const SOLVE: f64 = 0.7e-9;
const SOLVE_ALONE: f64 = 1.0e-9;
/// Seconds per unknown and pair of vectors of a basis.
const ORTHOGONALISE: f64 = 0.6e-9;
/// Seconds of an element's matrices, and of adding those of a cell to the whole.
const ELEMENT: f64 = 1.2e-4;
const CELL: f64 = 5e-5;
/// Seconds per site of the stresses of one mode.
const RECOVER: f64 = 5.5e-7;
/// Seconds of a step, and per mode.
const STEP: f64 = 0.4e-6;
const MODE: f64 = 1.5e-8;
/// Seconds per site and sample, and per mode of these.
const JUDGE: f64 = 8e-8;
const COMBINE: f64 = 2e-9;
/// Growth of the entries of a factor with the columns of nodes.
pub(crate) const FILL: f64 = 1.2;

/// Nominal seconds per phase.
pub(crate) fn nominal(size: &Size) -> [f64; PHASES.len()] {
    let (entries, modes, n) = (size.factor_entries as f64, size.marched as f64, size.unknowns as f64);
    let factor = |entries: f64| GFLOP / FACTOR * (entries / ENTRIES).powf(GROWTH);
    let (sites, steps, samples) = (size.sites as f64, size.work.steps as f64, size.samples as f64);
    let marched = size.reduced || size.marched == 0;
    let solves = if marched { size.work.solves as f64 } else { 0.0 };
    let basis = if size.reduced { solves * SOLVE * entries + modes * modes * n * ORTHOGONALISE } else { 0.0 };
    let step = if marched { STEP + MODE * modes } else { entries * SOLVE_ALONE };
    let stresses = if size.reduced { modes } else { 1.0 };
    [
        size.work.elements as f64 * ELEMENT + size.cells as f64 * CELL,
        factor(entries) + basis,
        sites * stresses * RECOVER,
        steps * step,
        samples * sites * (JUDGE + COMBINE * if size.reduced { modes } else { 100.0 }),
    ]
}

/// Seconds over nominal seconds per phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rates([f64; PHASES.len()]);

impl Rates {
    /// Nominal seconds are seconds.
    pub(super) const NOMINAL: Self = Self([1.0; PHASES.len()]);

    /// Each from the run in which its phase had most to do.
    pub(super) fn of<'a>(records: impl Iterator<Item = &'a Record> + Clone) -> Self {
        let rate = |phase: usize| {
            let each = records.clone().map(|r| (nominal(&r.size)[phase], r.seconds[phase]));
            let largest = each.filter(|(nominal, _)| *nominal > 0.0).max_by(|a, b| a.0.total_cmp(&b.0));
            largest.map_or(1.0, |(nominal, seconds)| seconds / nominal)
        };
        Self(std::array::from_fn(rate))
    }

    /// Seconds of a run of `size`.
    pub(super) fn seconds(&self, size: &Size) -> f64 {
        nominal(size).iter().zip(self.0).map(|(nominal, rate)| nominal * rate).sum()
    }
}

/// What a setting one level finer than that of a run of `size`, which took `seconds` per phase, would cost in addition.
pub fn one_level_better(size: &Size, seconds: [f64; PHASES.len()]) -> Vec<Better> {
    let now = nominal(size);
    let more = |what: &'static str, finer: Size| {
        let each = nominal(&finer).into_iter().zip(now).zip(seconds);
        let more = each.map(|((then, now), s)| if now > 0.0 { s * (then / now - 1.0) } else { 0.0 });
        Better { what, more_cpu_s: more.sum() }
    };
    let with = |cells: f64, columns: f64, per_column: f64| {
        let times = |n: usize, by: f64| (n as f64 * by) as usize;
        let mut finer = Size {
            cells: times(size.cells, cells),
            unknowns: times(size.unknowns, columns * per_column),
            factor_entries: times(size.factor_entries, columns.powf(FILL) * per_column.powi(2)),
            sites: times(size.sites, columns),
            ..*size
        };
        finer.work.elements = (size.work.elements as f64 * cells) as u64;
        if !size.reduced && size.marched > 0 {
            finer.marched = finer.unknowns;
        }
        finer
    };
    let mut all = Vec::new();
    if size.work.steps > 0 {
        let mut finer = *size;
        finer.work.steps *= 2;
        all.push(more("half the step", finer));
    }
    if size.reduced {
        let mut finer = Size { marched: 2 * size.marched, ..*size };
        finer.work.solves *= 2;
        all.push(more("twice the vectors", finer));
    }
    all.push(more("cells of half the edge", with(4.0, 4.0, 1.0)));
    let levels = (2 * size.layers + 1) as f64 / (size.layers + 1) as f64;
    all.push(more("twice the layers", with(2.0, 1.0, levels)));
    all
}

/// Sizes of `model` before it is run, from those of a run of the same scene under another setting.
pub(super) fn size(model: &Model, base: &Size) -> Size {
    let ratio = |a: usize, b: usize| a as f64 / b.max(1) as f64;
    let scaled = |value: f64, by: f64| (value * by).round();
    let plane = &model.plate.plane;
    let (cells, columns, unknowns) = (model.plate.cells(), model.plate.columns.len(), model.constraints.ndof());
    let by_columns = ratio(columns, base.columns);
    let per_column = ratio(unknowns, base.unknowns) / by_columns;
    let quads = ratio(plane.quads.len() * base.layers, base.cells);
    let mut size = Size {
        cells,
        layers: model.plate.layers(),
        cell_m: (plane.area() / plane.quads.len() as f64).sqrt(),
        columns,
        unknowns,
        factor_entries: scaled(base.factor_entries as f64, by_columns.powf(FILL) * per_column.powi(2)) as usize,
        sites: scaled(base.sites as f64, quads) as usize,
        ..*base
    };
    size.work.elements = scaled(base.work.elements as f64, ratio(cells, base.cells)) as u64;
    if let Plan::Impact(impact) = &model.plan {
        let (spec, before) = (&impact.spec, base.marched);
        let asked = SIZES.iter().find_map(|size| value(&model.scene, &format!("reduction.{size}")));
        size.reduced = impact.reduction.is_some();
        size.marched = if size.reduced { asked.unwrap_or(before).min(unknowns) } else { unknowns };
        if size.reduced && base.reduced {
            size.work.solves = scaled(base.work.solves as f64, ratio(size.marched, before)) as u64;
        }
        size.work.steps = (spec.march.end.value / spec.march.step.value).ceil() as u64;
        size.step_s = spec.march.step.value;
    }
    size
}

/// Sizes under several settings at once, each of which changes `base` by a factor.
pub(super) fn together<'a>(base: &Size, each: impl Iterator<Item = &'a Size> + Clone) -> Size {
    let product = |of: &dyn Fn(&Size) -> f64| {
        let own = of(base);
        each.clone().fold(own, |value, size| if own > 0.0 { value * of(size) / own } else { value })
    };
    let count = |of: &dyn Fn(&Size) -> usize| product(&|size| of(size) as f64).round() as usize;
    let number = |of: &dyn Fn(&Size) -> u64| product(&|size| of(size) as f64).round() as u64;
    Size {
        cells: count(&|s| s.cells),
        layers: count(&|s| s.layers),
        cell_m: product(&|s| s.cell_m),
        columns: count(&|s| s.columns),
        unknowns: count(&|s| s.unknowns),
        marched: count(&|s| s.marched),
        reduced: each.clone().all(|s| s.reduced),
        factor_entries: count(&|s| s.factor_entries),
        sites: count(&|s| s.sites),
        step_s: product(&|s| s.step_s),
        samples: number(&|s| s.samples),
        // What else is counted tells nothing of the time.
        work: Counters {
            elements: number(&|s| s.work.elements),
            solves: number(&|s| s.work.solves),
            steps: number(&|s| s.work.steps),
            ..base.work
        },
    }
}
