//! What a run of a study will cost: nominal seconds at rates that the runs before it have shown.

use super::record::RunRecord;
use crate::forecast::{FILL, PHASES, Size, nominal};
use crate::model::{Model, Plan, mean_cell};
use fem_core::counters::Counters;

/// Seconds over nominal seconds per phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rates([f64; PHASES.len()]);

impl Rates {
    /// Nominal seconds are seconds.
    pub(super) const NOMINAL: Self = Self([1.0; PHASES.len()]);

    /// Each from the run in which its phase had most to do.
    pub(super) fn of<'a>(records: impl Iterator<Item = &'a RunRecord> + Clone) -> Self {
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
        cell_m: mean_cell(&model.plate),
        columns,
        unknowns,
        factor_entries: scaled(base.factor_entries as f64, by_columns.powf(FILL) * per_column.powi(2)) as usize,
        sites: scaled(base.sites as f64, quads) as usize,
        ..*base
    };
    size.work.elements = scaled(base.work.elements as f64, ratio(cells, base.cells)) as u64;
    if let Plan::Impact(impact) = &model.plan {
        let (spec, before) = (&impact.spec, base.marched);
        size.reduced = impact.reduction.is_some();
        size.marched = if size.reduced { impact.vectors.unwrap_or(before).min(unknowns) } else { unknowns };
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
