//! Contact-force histories, compared.

use crate::analyses::impact::StepForces;
use serde::{Deserialize, Serialize};

/// Samples up to the last force, at most.
const SAMPLES: usize = 4000;

/// A force over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Force {
    /// Time between two samples, s, and how many there are from the beginning to the end of the march.
    every: f64,
    count: usize,
    /// From the beginning; after the last of them there is none.
    forces: Vec<f64>,
}

impl Force {
    /// Of a march of so many `steps`; what a history keeps of it does not matter.
    pub(super) fn of(run: &StepForces, steps: usize) -> Self {
        let stride = run.last().div_ceil(SAMPLES).max(1);
        let forces = (0..=run.last().div_ceil(stride)).map(|k| run.after(k * stride)).collect();
        Self { every: stride as f64 * run.step(), count: steps / stride + 1, forces }
    }

    /// Whether there is one at any time.
    pub(super) fn acts(&self) -> bool {
        self.forces.iter().any(|force| *force != 0.0)
    }

    /// ‖F − F_ref‖ / ‖F_ref‖ at the times of the reference, up to the end of either; not a number where F_ref is 0.
    pub(super) fn difference(&self, reference: &Self) -> f64 {
        let end = (self.count - 1) as f64 * self.every * (1.0 + 1e-12);
        let times = (0..reference.count).map(|k| (k, k as f64 * reference.every)).take_while(|(_, t)| *t <= end);
        let last = (self.forces.len() + 1) as f64 * self.every;
        let (mut difference, mut size) = (0.0, 0.0);
        for (k, t) in times.take_while(|(k, t)| *k < reference.forces.len() || *t <= last) {
            difference += (self.at(t) - reference.sample(k)).powi(2);
            size += reference.sample(k).powi(2);
        }
        if size > 0.0 { (difference / size).sqrt() } else { f64::NAN }
    }

    fn sample(&self, k: usize) -> f64 {
        self.forces.get(k).copied().unwrap_or(0.0)
    }

    /// By the cubic through the four samples around `t`.
    fn at(&self, t: f64) -> f64 {
        let last = self.count - 1;
        let time = |k: usize| k as f64 * self.every;
        let near = (t / self.every) as usize;
        let after = (near.saturating_sub(1)..=last).find(|k| time(*k) >= t).unwrap_or(last);
        let first = after.saturating_sub(2).min(last.saturating_sub(3));
        let near = first..(first + 4).min(last + 1);
        let weight = |i: usize| -> f64 {
            near.clone().filter(|j| *j != i).map(|j| (t - time(j)) / (time(i) - time(j))).product()
        };
        near.clone().map(|i| weight(i) * self.sample(i)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn march(dt: f64, steps: u64, force: impl Fn(f64) -> f64) -> Force {
        let mut forces = StepForces::new(dt);
        (1..=steps).for_each(|k| forces.take(k, force(k as f64 * dt)));
        Force::of(&forces, steps as usize)
    }

    #[test]
    fn cubics_agree_whatever_their_samples() {
        let cubic = |t: f64| t * t * (3.0 - t);
        let (a, b) = (march(0.1, 20, cubic), march(0.07, 28, cubic));
        assert!(a.difference(&b) < 1e-14 && b.difference(&a) < 1e-13);
        let more = march(0.1, 20, |t| 1.01 * cubic(t));
        assert!((more.difference(&b) - 0.01).abs() < 1e-12);
    }

    #[test]
    fn a_later_end_changes_nothing_and_no_force_has_no_measure() {
        let blow = |scale: f64| move |t: f64| if t < 1.0 { scale * (std::f64::consts::PI * t).sin() } else { 0.0 };
        let (short, long) =
            ([1.0, 1.1].map(|s| march(0.01, 150, blow(s))), [1.0, 1.1].map(|s| march(0.01, 90_000, blow(s))));
        assert_eq!(short[0].difference(&short[1]), long[0].difference(&long[1]));
        assert_eq!(short[0].forces, long[0].forces);
        let none = march(0.01, 150, |_| 0.0);
        assert!(short[0].difference(&none).is_nan() && !none.acts() && short[0].acts());
        assert!((none.difference(&short[0]) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_long_force_is_thinned() {
        let long = march(1e-6, 100_000, |t| 1.0 + t);
        assert!((2000..=4002).contains(&long.forces.len()), "{}", long.forces.len());
        assert!(long.difference(&march(2e-6, 50_000, |t| 1.0 + t)) < 1e-2);
    }
}
