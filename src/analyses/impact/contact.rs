//! Contacts as the steps of a march see them.

use fem_dynamics::impact::Touch;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// What the steps of a march, and the parts of divided ones, saw of a contact, whatever rows its history has.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ContactRecord {
    /// Number of separate contacts.
    pub count: u32,
    /// Time with a force, s.
    pub duration: f64,
    /// Largest force, N, and when it first was, s.
    pub force: (f64, f64),
    /// ∫ F² dt, N² s, and ∫ (dF/dt)² dt, N²/s.
    pub power: [f64; 2],
    /// Largest indentation, m.
    pub deepest: f64,
    /// Indentation that the law keeps when the force is gone, m: a dent.
    pub dent: f64,
    /// Largest radius of the patch under a spherical tip, m; 0 without one.
    pub radius: f64,
    /// Largest deflection of the plate under the impactor, m, towards which it moves.
    pub deflection: f64,
    /// Times, s, and magnitudes, m, of the deflection while it grew beyond all before; the last is the largest. The step
    /// before is always there, so that a level is crossed between two neighbours.
    pub growth: Vec<(f64, f64)>,
    /// When the force first reached each delamination threshold of the model, s: of all interfaces, and of one delamination.
    pub threshold_times: [Option<f64>; 2],
}

impl ContactRecord {
    /// Mean frequency of the force, Hz: √(∫ Ḟ² dt / ∫ F² dt) / 2π, of half a sine 1/(2 duration). Nothing without a force.
    pub fn frequency(&self) -> Option<f64> {
        let [square, rate] = self.power;
        (square > 0.0).then(|| (rate / square).sqrt() / TAU)
    }
}

/// Follows a contact from step to step.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Follower {
    thresholds: Option<[f64; 2]>,
    /// Time, force and magnitude of the deflection at the step before; all are 0 at the beginning.
    last: (f64, f64, f64),
    /// First and last time with a force, s.
    touched: Option<[f64; 2]>,
    record: ContactRecord,
}

impl Follower {
    /// `thresholds`: forces whose first reaching is noted, N.
    pub(super) fn new(thresholds: Option<[f64; 2]>) -> Self {
        Self { thresholds, last: (0.0, 0.0, 0.0), touched: None, record: ContactRecord::default() }
    }

    /// Of a march that begins at time `t`, s.
    pub(crate) fn since(t: f64) -> Self {
        Self { last: (t, 0.0, 0.0), ..Self::new(None) }
    }

    /// Times of thresholds come by linear interpolation between steps.
    pub(crate) fn take(&mut self, t: f64, Touch { indentation, force, deflection, radius, .. }: Touch) {
        let Self { thresholds, last: (before, low, shallow), touched, record } = self;
        record.deepest = record.deepest.max(indentation);
        record.radius = record.radius.max(radius);
        record.deflection = record.deflection.max(deflection);
        record.count += u32::from(force > 0.0 && *low <= 0.0);
        let dt = t - *before;
        if force > 0.0 {
            record.duration += dt;
            *touched = Some([touched.map_or(t, |[first, _]| first), t]);
        }
        record.power[0] += force * force * dt;
        record.power[1] += (force - *low).powi(2) / dt;
        if force > record.force.0 {
            record.force = (force, t);
        }
        let deflection = deflection.abs();
        let reached = record.growth.last().copied().unwrap_or_default();
        if deflection > reached.1 {
            if reached.0 < *before || record.growth.is_empty() {
                record.growth.push((*before, *shallow));
            }
            record.growth.push((t, deflection));
        }
        for (time, level) in record.threshold_times.iter_mut().zip(thresholds.iter().flatten()) {
            if time.is_none() && force >= *level {
                *time = Some(*before + (t - *before) * ((level - *low) / (force - *low)));
            }
        }
        self.last = (t, force, deflection);
    }

    /// First and last time with a force, s.
    pub(super) fn touched(&self) -> Option<[f64; 2]> {
        self.touched
    }

    /// Whether it can be that of so many steps and parts of steps.
    pub(super) fn is_sound(&self, steps: u64) -> bool {
        u64::from(self.record.count) <= steps + 1 && self.record.growth.len() as u64 <= 2 * steps + 2
    }

    pub(crate) fn finish(self) -> ContactRecord {
        self.record
    }
}

/// The force of all impactors together at every step, N, as far as there is one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct StepForces {
    dt: f64,
    /// That after the first step comes first; after the last of them the force is 0.
    forces: Vec<f64>,
}

impl StepForces {
    /// None yet, at steps of `dt`, s.
    pub fn new(dt: f64) -> Self {
        Self { dt, forces: Vec::new() }
    }

    /// Takes that after step number `step`, counted from 1; steps that are left out have none.
    pub fn take(&mut self, step: u64, force: f64) {
        if force != 0.0 {
            self.forces.resize(step as usize - 1, 0.0);
            self.forces.push(force);
        }
    }

    /// The step, s.
    pub fn step(&self) -> f64 {
        self.dt
    }

    /// The last step with a force, counted from 1; 0 where there is none.
    pub fn last(&self) -> usize {
        self.forces.len()
    }

    /// After `step` steps.
    pub fn after(&self, step: usize) -> f64 {
        step.checked_sub(1).and_then(|k| self.forces.get(k)).copied().unwrap_or(0.0)
    }

    /// At time `t`, s, between two steps by a straight line.
    pub fn at(&self, t: f64) -> f64 {
        let time = |step: usize| step as f64 * self.dt;
        // The quotient may lie a step off by rounding.
        let near = (t / self.dt) as usize;
        let next = (near.saturating_sub(1)..).find(|step| time(*step) >= t).unwrap_or(near).max(1);
        let (before, after) = (time(next - 1), time(next));
        let low = self.after(next - 1);
        low + (t - before) / (after - before) * (self.after(next) - low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn touch(force: f64, deflection: f64) -> Touch {
        Touch { indentation: force, force, velocity: 0.0, deflection, radius: 0.0 }
    }

    #[test]
    fn extremes_counts_and_times_are_those_of_the_steps() {
        let mut follower = Follower::new(Some([5.0, 9.0]));
        let steps = [(0.0, 0.0), (4.0, 1.0), (8.0, -3.0), (0.0, 2.0), (2.0, 2.5), (0.0, -4.0), (0.0, 1.0)];
        for (k, (force, deflection)) in steps.into_iter().enumerate() {
            follower.take((k + 1) as f64, touch(force, deflection));
        }
        let record = follower.finish();
        assert_eq!((record.count, record.duration, record.force), (2, 3.0, (8.0, 3.0)));
        assert_eq!((record.deepest, record.deflection), (8.0, 2.5));
        assert_eq!(record.threshold_times, [Some(2.25), None]);
        assert_eq!(record.growth, [(1.0, 0.0), (2.0, 1.0), (3.0, 3.0), (5.0, 2.5), (6.0, 4.0)]);
    }

    #[test]
    fn half_a_sine_has_the_frequency_of_the_whole() {
        let mut follower = Follower::new(None);
        for k in 1..=1500 {
            let t = f64::from(k) * 1e-7;
            follower.take(t, touch((TAU * 5e3 * t).sin().max(0.0), 0.0));
        }
        let frequency = follower.finish().frequency();
        assert!(frequency.is_some_and(|f| (f / 5e3 - 1.0).abs() < 1e-3), "{frequency:?}");
        assert_eq!(Follower::new(None).finish().frequency(), None);
    }

    #[test]
    fn a_force_is_known_at_every_time() {
        let mut forces = StepForces::new(0.1);
        for (step, force) in [(1, 0.0), (2, 2.0), (3, 0.0), (4, 0.0), (5, 6.0), (6, 0.0)] {
            forces.take(step, force);
        }
        assert_eq!(
            (forces.last(), forces.after(0), forces.after(2), forces.after(5), forces.after(99)),
            (5, 0.0, 2.0, 6.0, 0.0)
        );
        for (t, force) in
            [(0.0, 0.0), (0.05, 0.0), (0.15, 1.0), (0.25, 1.0), (0.35, 0.0), (0.5, 6.0), (0.55, 3.0), (7.0, 0.0)]
        {
            assert!((forces.at(t) - force).abs() < 1e-12, "{t}: {}", forces.at(t));
        }
        for step in 0..200_u32 {
            let t = f64::from(step) * 0.1;
            assert_eq!(forces.at(t), forces.after(step as usize), "{step}");
        }
    }
}
