//! When the largest index of a mode first passed each of many levels: when onset would be under other strengths.

use serde::{Deserialize, Serialize};

/// Levels lie this far apart, relative, from half the index of failure to twice.
const STEP: f64 = 1.01;
const LOWEST: f64 = 0.5;
const LEVELS: usize = 140;

/// Share of a time by which a level must be passed later than the one before it to count as passed by another crest.
const APART: f64 = 0.02;

/// First passages of the largest index of a mode, anywhere, through levels from 0.5 to 2.
///
/// An index that grows like the square of stress passes the level (1 + x)² when it would reach 1 were the strength larger by x. Where
/// it ripples, the time of a first passage jumps from crest to crest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Climb {
    /// s, infinite for levels that were not passed; they never fall.
    times: Vec<f64>,
}

/// Two crests of an index of which either may be the first to reach 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crests {
    /// Index up to which the first one reaches, to one in a hundred.
    pub first: f64,
    /// When the next passes that, s; infinite where none does.
    pub next: f64,
}

impl Default for Climb {
    fn default() -> Self {
        Self { times: vec![f64::INFINITY; LEVELS] }
    }
}

impl Climb {
    fn level(k: usize) -> f64 {
        LOWEST * STEP.powi(k as i32)
    }

    /// How many levels `index` has passed.
    fn passed(index: f64) -> usize {
        if index < LOWEST {
            return 0;
        }
        // The logarithm may lie a level off by rounding.
        let near = ((index.min(2.0 * LOWEST * STEP.powi(LEVELS as i32)) / LOWEST).ln() / STEP.ln()) as usize;
        (near.saturating_sub(1)..LEVELS).find(|k| Self::level(*k) > index).unwrap_or(LEVELS)
    }

    /// An index that went from `before` at time `from` to `now` at `t`, in a straight line.
    pub(super) fn take(&mut self, (from, before): (f64, f64), (t, now): (f64, f64)) {
        // Most are far below what was passed before.
        if now < LOWEST || self.times[LEVELS - 1] <= from {
            return;
        }
        let top = Self::passed(now);
        // What was passed earlier lies below.
        if top == 0 || self.times[top - 1] <= from || now <= before {
            return;
        }
        for k in Self::passed(before)..top {
            let share = (Self::level(k) - before) / (now - before);
            self.times[k] = self.times[k].min((from + (t - from) * share).min(t));
        }
    }

    /// The lowest level that was not passed by the time `from`; infinite where all were.
    pub(super) fn open(&self, from: f64) -> f64 {
        self.times.iter().position(|time| *time > from).map_or(f64::INFINITY, Self::level)
    }

    /// When the index first passed `level`, s: between two levels by a straight line unless a crest ends there. `None` for one that
    /// was not passed, or is not among those that are kept.
    pub fn at(&self, level: f64) -> Option<f64> {
        let above = Self::passed(level);
        let (low, high) = (*self.times.get(above.checked_sub(1)?)?, *self.times.get(above)?);
        let share = (level / Self::level(above - 1)).ln() / STEP.ln();
        let time =
            if self.jumps(above) { low.max(if share > 0.0 { high } else { low }) } else { low + (high - low) * share };
        time.is_finite().then_some(time)
    }

    fn jumps(&self, k: usize) -> bool {
        !(self.times[k] <= (1.0 + APART) * self.times[k - 1])
    }

    /// The last level between `low` and `high` that one crest reaches and only another one passes.
    pub fn crests(&self, low: f64, high: f64) -> Option<Crests> {
        let between = Self::passed(low).max(1)..Self::passed(high);
        let jump = between.filter(|k| self.times[k - 1].is_finite() && self.jumps(*k)).min_by(|a, b| {
            let far = |k: usize| Self::level(k).ln().abs();
            far(*a).total_cmp(&far(*b))
        })?;
        Some(Crests { first: Self::level(jump - 1), next: self.times[jump] })
    }

    /// Whether it can be that of a scan: as many times as levels, in order.
    pub(super) fn is_sound(&self) -> bool {
        self.times.len() == LEVELS && self.times.is_sorted()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// Of an index that is sampled every 1 ms.
    fn climb(indices: &[f64]) -> Climb {
        let mut climb = Climb::default();
        for (k, pair) in indices.windows(2).enumerate() {
            climb.take((k as f64 * 1e-3, pair[0]), ((k + 1) as f64 * 1e-3, pair[1]));
        }
        climb
    }

    #[test]
    fn levels_are_passed_along_straight_lines() {
        let climb = climb(&[0.0, 1.0, 0.2, 0.9, 3.0]);
        for (level, time) in [(0.6, 0.6e-3), (0.98, 0.98e-3), (1.3, 3e-3 + 1e-3 * 0.4 / 2.1), (1.9, 3e-3 + 1e-3 / 2.1)]
        {
            let found = climb.at(level).unwrap();
            assert!((found / time - 1.0).abs() < 2e-3, "{level}: {found:e}, not {time:e}");
        }
        assert_eq!((climb.at(0.3), climb.at(5.0)), (None, None));
    }

    #[test]
    fn crests_that_compete_are_found() {
        let climb = climb(&[0.0, 1.03, 0.5, 1.2, 0.4, 0.9]);
        let Crests { first, next } = climb.crests(0.9, 1.1).unwrap();
        assert!((1.01..=1.03).contains(&first), "{first}");
        assert!((2.7e-3..2.8e-3).contains(&next), "{next}");
        assert_eq!(climb.crests(0.6, 1.0), None);
        // Nothing goes beyond 1.2.
        let Crests { first, next } = climb.crests(1.1, 1.4).unwrap();
        assert!(first > 1.18 && next == f64::INFINITY);
    }

    #[test]
    fn the_first_place_counts() {
        let mut climb = climb(&[0.0, 0.8, 1.6]);
        climb.take((0.0, 0.0), (1e-3, 1.2));
        assert!((climb.at(1.0).unwrap() - 1e-3 / 1.2).abs() < 1e-5);
        assert!((climb.at(1.5).unwrap() - (1e-3 + 1e-3 * 0.7 / 0.8)).abs() < 1e-5);
        assert!(climb.is_sound());
    }

    #[test]
    fn any_index_is_taken() {
        let climb = climb(&[f64::INFINITY, 0.0, f64::INFINITY, 1e308]);
        assert!(climb.is_sound() && climb.at(1.0).is_some());
    }
}
