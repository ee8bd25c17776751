//! A choice held against what happened.

use super::rim::Rim;
use crate::effect::Hindsight;
use crate::model::{Model, Plan};
use fem_io::tables::HistoryRow;

/// How far a run of `model` went beyond a linear plate, and when A (w/h)² passed `threshold`: of the impactor under which the
/// plate went farthest; `None` where supports do not surround it.
pub fn hindsight(model: &Model, history: &[HistoryRow], threshold: f64) -> Option<Hindsight> {
    let Plan::Impact(impact) = &model.plan else { return None };
    let thickness = model.laminate.thickness();
    let each = impact.strikes.iter().enumerate().filter_map(|(i, strike)| {
        let held = Rim::around(model, strike.centre)?.held?;
        let coefficient = held.coefficient();
        let number = |w: f64| coefficient * w * w;
        let over = |row: &HistoryRow| row.impactors[i].plate_displacement_m.abs() / thickness;
        let (deflection, at) = history.iter().map(|row| (over(row), row.time_s)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let first = history.iter().position(|row| number(over(row)) > threshold);
        let since = first.map(|row| crossing(history, row, (threshold / coefficient).sqrt(), over));
        Some(Hindsight { reached: number(deflection), coefficient, held: held.name(), deflection, at, since })
    });
    each.max_by(|a, b| a.reached.total_cmp(&b.reached))
}

/// When a value passes `level` between the row before `row` and that row.
fn crossing(history: &[HistoryRow], row: usize, level: f64, value: impl Fn(&HistoryRow) -> f64) -> f64 {
    let after = &history[row];
    let Some(before) = row.checked_sub(1).map(|row| &history[row]) else { return after.time_s };
    let (low, high) = (value(before), value(after));
    before.time_s + (after.time_s - before.time_s) * (level - low) / (high - low)
}
