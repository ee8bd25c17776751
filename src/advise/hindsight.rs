//! A choice held against what happened.

use super::membrane::THRESHOLD;
use super::rim::Rim;
use crate::model::{MEMBRANE, Model, Plan};
use fem_io::tables::HistoryRow;

/// How far a run went beyond a linear plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hindsight {
    /// Largest A (w/h)².
    pub reached: f64,
    /// A.
    pub coefficient: f64,
    /// How the edge is held, in words.
    pub held: &'static str,
    /// Largest w/h, and when, s.
    pub deflection: f64,
    /// Time of the largest deflection, s.
    pub at: f64,
    /// From when on A (w/h)² is above 0.05, s.
    pub since: Option<f64>,
}

impl Hindsight {
    /// Of the impactor under which the plate went farthest; `None` where supports do not surround it.
    pub fn of(model: &Model, history: &[HistoryRow]) -> Option<Self> {
        let Plan::Impact(impact) = &model.plan else { return None };
        let thickness = model.laminate.thickness();
        let each = impact.strikes.iter().enumerate().filter_map(|(i, strike)| {
            let held = Rim::around(model, strike.centre)?.held?;
            let coefficient = held.coefficient();
            let number = |w: f64| coefficient * w * w;
            let over = |row: &HistoryRow| row.impactors[i].plate_displacement_m.abs() / thickness;
            let (deflection, at) =
                history.iter().map(|row| (over(row), row.time_s)).max_by(|a, b| a.0.total_cmp(&b.0))?;
            let first = history.iter().position(|row| number(over(row)) > THRESHOLD);
            let since = first.map(|row| crossing(history, row, (THRESHOLD / coefficient).sqrt(), over));
            let name = held.name();
            Some(Self { reached: number(deflection), coefficient, held: name, deflection, at, since })
        });
        each.max_by(|a, b| a.reached.total_cmp(&b.reached))
    }

    /// What the user should know where the choice was wrong.
    pub fn warning(&self, model: &Model) -> Option<String> {
        let Self { reached, coefficient, held, deflection, at, since } = *self;
        match (since, model.effects.membrane) {
            (Some(since), false) => Some(format!(
                "without membrane stiffening the force is wrong by more than {:.0} % from {:.4} ms on and by about {:.0} % at \
                 {:.4} ms, when the plate deflects by {deflection:.2} thicknesses (A (w/h)^2, A = {coefficient} for an edge \
                 {held}): switch it on with `effects.membrane = \"on\"`, or \"auto\"",
                100.0 * THRESHOLD,
                since * 1e3,
                100.0 * reached,
                at * 1e3
            )),
            (None, true) if model.decisions.iter().any(|decision| decision.effect == MEMBRANE) => Some(format!(
                "the advisor switched membrane stiffening on, and A (w/h)^2 came to {reached:.4} only: \
                 `effects.membrane = \"off\"` keeps the force right within {:.0} %",
                100.0 * THRESHOLD
            )),
            _ => None,
        }
    }
}

/// When a value passes `level` between the row before `row` and that row.
fn crossing(history: &[HistoryRow], row: usize, level: f64, value: impl Fn(&HistoryRow) -> f64) -> f64 {
    let after = &history[row];
    let Some(before) = row.checked_sub(1).map(|row| &history[row]) else { return after.time_s };
    let (low, high) = (value(before), value(after));
    before.time_s + (after.time_s - before.time_s) * (level - low) / (high - low)
}
