//! A ladder that was climbed: what error each of its levels leaves, and how fast it falls.

use super::axes::Level;
use super::converge::{Convergence, ErrorBar, limit};
use super::quantity::FORCE_HISTORY;
use super::record::RunRecord;
use crate::forecast::Size;

/// An axis of finer and finer levels after its runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Ladder {
    /// Name of the axis.
    pub axis: String,
    /// The levels that ran, coarse to fine.
    pub levels: Vec<Rung>,
    /// Per quantity: what its sequence says, and what to add to the finest level's value to reach the limit.
    pub limits: Vec<Limit>,
    /// Why no finer level ran; empty until that is decided.
    pub end: String,
}

/// A level of a ladder.
#[derive(Debug, Clone, PartialEq)]
pub struct Rung {
    /// The level.
    pub level: Level,
    /// Sizes of its run.
    pub size: Size,
    /// Relative error of each quantity that this axis leaves, the others as the scene has them.
    pub errors: Vec<(String, ErrorBar)>,
    values: Vec<Option<f64>>,
}

/// The limit of a quantity along a ladder.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// The quantity.
    pub quantity: String,
    /// What is known of it; differences are relative.
    pub convergence: Convergence,
    /// The limit, where the quantity is a number.
    pub value: Option<f64>,
}

impl Rung {
    /// The largest of its errors of `quantities`; `None` where one is unknown.
    pub fn worst(&self, quantities: &[String]) -> Option<ErrorBar> {
        ErrorBar::worst(self.errors.iter().filter(|e| quantities.contains(&e.0)).map(|e| e.1))
    }
}

impl Ladder {
    /// From the runs of an axis, coarse to fine; differences below `matters` are of no interest.
    pub(super) fn new(axis: &str, runs: &[(Level, RunRecord)], quantities: &[String], matters: f64) -> Self {
        let mut ladder = Self { axis: axis.to_owned(), levels: Vec::new(), limits: Vec::new(), end: String::new() };
        let Some((_, finest)) = runs.last() else { return ladder };
        ladder.levels = runs
            .iter()
            .map(|(level, record)| Rung {
                level: level.clone(),
                size: record.size,
                errors: Vec::new(),
                values: Vec::new(),
            })
            .collect();
        for quantity in quantities {
            let values: Vec<Option<f64>> = runs.iter().map(|(_, record)| record.value(quantity)).collect();
            let difference = |a: &RunRecord, b: &RunRecord| a.difference(b, quantity).map_or(f64::NAN, f64::abs);
            let pairs = runs.windows(2).map(|pair| difference(&pair[0].1, &pair[1].1));
            let convergence = Convergence::of(&pairs.collect::<Vec<_>>(), matters);
            let known: Option<Vec<f64>> = values.iter().copied().collect();
            let scale = finest.value(quantity).unwrap_or(0.0).abs();
            let value = known.and_then(|values| limit(&values, convergence, scale));
            let left = match convergence {
                Convergence::Stalls { difference } => difference,
                other => Some(other.left()).filter(|left| left.is_finite()).unwrap_or(0.0),
            };
            let bar = convergence.bar();
            // What is extrapolated is as uncertain at every level; from the finest level, all that it leaves is added.
            let extrapolated = value.is_some() && value != finest.value(quantity);
            for (rung, (_, record)) in ladder.levels.iter_mut().zip(runs) {
                let own = record.value(quantity);
                let error = match (own, value) {
                    (Some(own), Some(value)) if quantity != FORCE_HISTORY => ((own - value) / value).abs(),
                    _ => difference(record, finest),
                };
                let bar = if extrapolated || std::ptr::eq(record, finest) { bar } else { left + bar };
                // An error below what is left of the last level is not known to be smaller.
                let error = if error >= left { error } else { left };
                rung.errors.push((quantity.clone(), ErrorBar { error, bar }));
                rung.values.push(own);
            }
            ladder.limits.push(Limit { quantity: quantity.clone(), convergence, value });
        }
        ladder
    }

    /// What its finest level leaves of the quantity of which it may leave most: a plan counts on it.
    pub(super) fn leaves(&self) -> Option<&Limit> {
        let feared = |limit: &&Limit| limit.convergence.feared();
        self.limits.iter().filter(|limit| feared(limit).is_finite()).max_by(|a, b| feared(a).total_cmp(&feared(b)))
    }

    /// Whether there is a quantity without a limit in sight.
    pub(super) fn stalls(&self) -> bool {
        self.limits.iter().any(|limit| matches!(limit.convergence, Convergence::Stalls { .. }))
    }

    /// What to add to the value of `quantity` at level `rung` to reach the limit, and what is left then, both relative;
    /// `None` where there is no limit. Levels that were climbed one ladder at a time say less of all together: of what is
    /// extrapolated, all that the finest level leaves is doubted.
    pub(super) fn correction(&self, quantity: &str, rung: usize) -> Option<(f64, ErrorBar)> {
        let k = self.limits.iter().position(|limit| limit.quantity == quantity)?;
        let limit = &self.limits[k];
        let rung = self.levels.get(rung)?;
        let (left, bar) = (limit.convergence.left(), limit.convergence.bar());
        match (rung.values[k], limit.value, limit.convergence) {
            (Some(own), Some(value), Convergence::Converges { .. }) => {
                Some(((value - own) / own.abs(), ErrorBar { error: left, bar: left.max(bar) }))
            }
            _ if left.is_finite() => Some((0.0, rung.errors[k].1)),
            _ => None,
        }
    }
}
