//! A part of the settings that is raised, level by level, while the others are as the scene has them.

use crate::registry::NO_REDUCTION;
use crate::study::axes::{AxisKind, Level, StudyAxis};
use crate::study::converge::Convergence;

#[derive(Debug)]
pub(super) struct Climb {
    pub(super) name: String,
    /// From the scene's level up; with the one below it where that is the finest.
    pub(super) levels: Vec<Level>,
    /// That of the scene.
    pub(super) own: usize,
    /// What each level that was run changes of every quantity against the one below it; infinite where one of the two lacks it.
    changes: Vec<Vec<f64>>,
    /// Why the next level cannot be run.
    pub(super) closed: Option<String>,
}

impl Climb {
    pub(super) fn new(axis: StudyAxis) -> Option<Self> {
        let own = axis.levels.iter().position(|level| level.setting.is_empty())?;
        // All unknowns: there is nothing to raise, and nothing left.
        if axis.levels[own].label == NO_REDUCTION {
            return None;
        }
        let below = usize::from(own > 0 && own + 1 == axis.levels.len());
        let levels = axis.levels.into_iter().skip(own - below).collect();
        let changes = Vec::new();
        let ladder = axis.kind == AxisKind::Ladder;
        ladder.then_some(Self { name: axis.name, levels, own: below, changes, closed: None })
    }

    /// Highest level that was run beside the scene's or above it; that of the scene where none was.
    pub(super) fn top(&self) -> usize {
        if self.changes.is_empty() { self.own } else { self.changes.len() }
    }

    /// The next level to be run, and the one that it is held against.
    pub(super) fn next(&self) -> [usize; 2] {
        [self.changes.len(), self.changes.len() + 1]
    }

    /// Takes what the level above the top changes.
    pub(super) fn take(&mut self, changes: Vec<f64>) {
        self.changes.push(changes);
    }

    /// Sum of what levels above `from` and up to `to` change of the quantity `q`.
    pub(super) fn change(&self, q: usize, from: usize, to: usize) -> f64 {
        self.changes[from..to].iter().map(|change| change[q]).sum()
    }

    fn convergence(&self, q: usize) -> Convergence {
        Convergence::of(&self.changes.iter().map(|change| change[q]).collect::<Vec<_>>(), 0.0)
    }

    /// Whether the last level changes the quantity `q` hardly less than the one below.
    pub(super) fn stalls(&self, q: usize) -> bool {
        matches!(self.convergence(q), Convergence::Stalls { .. })
    }

    /// Estimated error of the level `rung` in `q`: what the levels above it change, and what the last of them leaves; beyond the
    /// top what would be left there.
    pub(super) fn leaves(&self, q: usize, rung: usize) -> f64 {
        let (convergence, top) = (self.convergence(q), self.top());
        let left = if self.stalls(q) { convergence.feared() } else { convergence.left() };
        match rung.checked_sub(top) {
            None => left + self.change(q, rung, top),
            Some(0) => left,
            // What is left falls with the ratio that it follows from.
            Some(beyond) => {
                let last = self.changes.last().map_or(0.0, |last| last[q]);
                left * (left / (left + last)).powi(beyond as i32)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use fem_io::scene::Setting;

    /// A ladder whose result is `value` at each level, climbed to its end.
    fn climbed(values: &[f64]) -> Climb {
        let level = |k: usize| Level {
            label: k.to_string(),
            setting: (k > 0).then(|| ("mesh.refine".to_owned(), k.to_string())).into_iter().collect::<Setting>(),
            at_limit: false,
        };
        let levels = (0..values.len()).map(level).collect();
        let mut climb = Climb::new(StudyAxis { name: "mesh".into(), kind: AxisKind::Ladder, levels }).unwrap();
        values.windows(2).for_each(|pair| climb.take(vec![(pair[0] - pair[1]).abs()]));
        climb
    }

    #[test]
    fn errors_of_steady_ladders_are_what_is_said() {
        for order in [0.5_f64, 1.0, 2.0, 2.9] {
            let error = |k: usize| 0.1 * (-order * k as f64).exp2();
            let climb = climbed(&[0, 1, 2, 3].map(|k| 1.0 + error(k)));
            for rung in 0..6 {
                let said = climb.leaves(0, rung);
                assert!((said / error(rung) - 1.0).abs() < 1e-9, "order {order}, level {rung}: {said:.2e}");
            }
        }
    }

    #[test]
    fn a_ladder_that_does_not_converge_leaves_four_times_its_last_change() {
        let climb = climbed(&[1.4, 1.3, 1.2, 1.1]);
        let left = climb.leaves(0, 3);
        assert!(climb.stalls(0) && left > 0.4 && left < 0.5 && (climb.leaves(0, 0) - left - 0.3).abs() < 1e-12);
    }

    #[test]
    fn of_one_change_as_much_again_is_left() {
        let climb = climbed(&[1.2, 1.1]);
        assert!((climb.leaves(0, 0) - 0.2).abs() < 1e-12 && (climb.leaves(0, 1) - 0.1).abs() < 1e-12);
        assert_eq!(climbed(&[1.0]).leaves(0, 0), f64::INFINITY);
    }
}
