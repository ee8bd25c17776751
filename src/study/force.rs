//! Contact-force histories, compared.

use fem_io::tables::HistoryRow;
use serde::{Deserialize, Serialize};

/// A force over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Force {
    times: Vec<f64>,
    forces: Vec<f64>,
}

impl Force {
    pub(super) fn of(history: &[HistoryRow]) -> Self {
        let (times, forces) = history.iter().map(|r| (r.time_s, r.contact_force_n())).unzip();
        Self { times, forces }
    }

    /// ‖F − F_ref‖ / ‖F_ref‖ at the times of the reference.
    pub(super) fn difference(&self, reference: &Self) -> f64 {
        let square = |f: &dyn Fn(usize) -> f64| (0..reference.times.len()).map(|i| f(i).powi(2)).sum::<f64>();
        let difference = square(&|i| self.at(reference.times[i]) - reference.forces[i]);
        (difference / square(&|i| reference.forces[i])).sqrt()
    }

    /// By the cubic through the four samples around `t`.
    fn at(&self, t: f64) -> f64 {
        let last = self.times.len() - 1;
        let after = self.times.partition_point(|s| *s < t);
        let first = after.saturating_sub(2).min(last.saturating_sub(3));
        let near = first..(first + 4).min(last + 1);
        let weight = |i: usize| -> f64 {
            near.clone().filter(|j| *j != i).map(|j| (t - self.times[j]) / (self.times[i] - self.times[j])).product()
        };
        near.clone().map(|i| weight(i) * self.forces[i]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cubic(times: &[f64]) -> Force {
        Force { times: times.to_vec(), forces: times.iter().map(|t| t * t * (3.0 - t)).collect() }
    }

    #[test]
    fn cubics_agree_whatever_their_samples() {
        let (a, b) = (cubic(&[0.0, 0.5, 0.9, 1.0, 1.7, 2.0]), cubic(&[0.0, 0.3, 0.6, 1.1, 1.9, 2.0]));
        assert!(a.difference(&b) < 1e-14);
        let mut c = cubic(&[0.0, 0.5, 0.9, 1.0, 1.7, 2.0]);
        c.forces.iter_mut().for_each(|f| *f *= 1.01);
        assert!((c.difference(&b) - 0.01).abs() < 1e-12);
    }
}
