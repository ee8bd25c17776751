//! Explicit Runge-Kutta stages of a second-order system.

use fem_core::time::{SecondOrderSystem, State, StepError};

/// Weights of the earlier stages in each stage after the first. The first stage is the state itself, the last one the
/// result: its acceleration opens the next step.
pub(super) type Rows = &'static [&'static [f64]];

/// Slopes of u and v at every stage, and u at the last.
#[derive(Debug, Clone, Default)]
pub(super) struct Stages {
    pub(super) u: Vec<f64>,
    pub(super) v: Vec<Vec<f64>>,
    pub(super) a: Vec<Vec<f64>>,
}

impl Stages {
    pub(super) fn size(&mut self, rows: Rows, ndof: usize) {
        self.u.resize(ndof, 0.0);
        for slopes in [&mut self.v, &mut self.a] {
            slopes.resize_with(rows.len() + 1, Vec::new);
            slopes.iter_mut().for_each(|x| x.resize(ndof, 0.0));
        }
    }

    /// Evaluates the stages of a step `h` from `s`.
    pub(super) fn run(
        &mut self,
        rows: Rows,
        sys: &mut dyn SecondOrderSystem,
        s: &State,
        h: f64,
    ) -> Result<(), StepError> {
        self.size(rows, sys.ndof());
        self.v[0].copy_from_slice(&s.v);
        self.a[0].copy_from_slice(&s.a);
        for (stage, row) in (1..).zip(rows) {
            let (earlier_v, v) = self.v.split_at_mut(stage);
            let (earlier_a, a) = self.a.split_at_mut(stage);
            advance(&mut self.u, &s.u, h, row, earlier_v);
            advance(&mut v[0], &s.v, h, row, earlier_a);
            sys.force(s.t + h * row.iter().sum::<f64>(), &self.u, &v[0], &s.histories, &mut a[0]);
            sys.solve_mass(0.0, &mut a[0])?;
        }
        Ok(())
    }

    /// Moves `s` to the last stage, at time `t`.
    pub(super) fn take(&self, s: &mut State, t: f64) {
        let last = self.v.len() - 1;
        s.u.copy_from_slice(&self.u);
        s.v.copy_from_slice(&self.v[last]);
        s.a.copy_from_slice(&self.a[last]);
        s.t = t;
    }
}

/// `y ← y₀ + h Σ wᵢ xᵢ`.
fn advance(y: &mut [f64], y0: &[f64], h: f64, weights: &[f64], slopes: &[Vec<f64>]) {
    y.copy_from_slice(y0);
    for (w, slope) in weights.iter().zip(slopes) {
        for (y, x) in y.iter_mut().zip(slope) {
            *y += h * w * x;
        }
    }
}
