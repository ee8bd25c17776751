//! The embedded Runge-Kutta pair 5(4).

use super::change::Change;
use super::stages::{Rows, Stages};
use super::{accelerate, accept, copy};
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit, Substeps};

/// Dormand and Prince's pair: it divides a step into parts whose estimated error is within tolerance.
///
/// The estimate is the difference of the results of order 5 and 4 over what a part changes of velocities and indentations, as that of
/// `march.tolerance` is (`Change::error`), so that it knows no units and no scale of the motion. Every part is a step of its own and
/// commits the contacts, so a contact shorter than the step is not missed. Each step tries itself whole first: nothing but the state passes
/// from step to step.
#[derive(Debug, Clone)]
pub struct DormandPrince {
    tolerance: f64,
    stages: Stages,
    /// Results of a part, of order 4 and 5.
    results: [State; 2],
    change: Change,
    parts: Option<Substeps>,
}

#[rustfmt::skip]
const ROWS: Rows = &[
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
const LAST: usize = ROWS.len();
/// Weights of order 5 less weights of order 4.
const ERROR: [f64; LAST + 1] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];
const MOST_PARTS: usize = 100_000;

impl DormandPrince {
    /// Takes the results of a part `h` that ends at `t` from the stages; its estimated error, 1 at the tolerance.
    fn take(&mut self, sys: &dyn SecondOrderSystem, s: &State, h: f64, t: f64) -> f64 {
        let [worse, better] = &mut self.results;
        copy(s, better);
        self.stages.take(better, t);
        copy(better, worse);
        let Stages { v, a, .. } = &self.stages;
        for (x, slopes) in [(&mut worse.u, v), (&mut worse.v, a)] {
            for (weight, slope) in ERROR.iter().zip(slopes) {
                x.iter_mut().zip(slope).for_each(|(x, slope)| *x -= h * weight * slope);
            }
        }
        self.change.error(sys, s, worse, better) / self.tolerance
    }
}

impl Integrator for DormandPrince {
    fn order(&self) -> u32 {
        5
    }

    fn limit(&self) -> StepLimit {
        StepLimit::None
    }

    fn take_substeps(&mut self) -> Option<Substeps> {
        self.parts.take()
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        self.resume(sys);
        accelerate(sys, s)
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        self.stages.size(ROWS, sys.ndof());
    }

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        let end = s.t + dt;
        let (mut left, mut h) = (dt, dt);
        for _ in 0..MOST_PARTS {
            self.stages.run(ROWS, sys, s, h)?;
            let rest = left - h;
            let error = self.take(sys, s, h, end - rest);
            if error <= 1.0 {
                left = rest;
                let part = Substeps::new(1, h);
                self.parts = Some(self.parts.map_or(part, |parts| parts.and(part)));
                let from = s.t;
                copy(&self.results[1], s);
                accept(sys, s)?;
                sys.note(from, s);
                if left <= 0.0 {
                    return Ok(());
                }
            } else if !error.is_finite() && (h.is_nan() || h <= 1e-12 * dt) {
                return Err(StepError::NotFinite { t: s.t });
            }
            let factor = if error.is_finite() { (0.9 * error.powf(-0.2)).clamp(0.2, 5.0) } else { 0.2 };
            h = left.min(factor * h);
        }
        let what = format!("more than {MOST_PARTS} parts of one step; loosen its tolerance");
        Err(StepError::NoConvergence { t: s.t, what })
    }
}

const TOLERANCE: ParamInfo = ParamInfo::number("tolerance", "error of a part of a step over what it changes")
    .above(0.0)
    .at_most(0.1)
    .default(1e-5);

impl Plugin for DormandPrince {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "dormand-prince",
        summary: "Runge-Kutta pair 5(4) that divides its steps by error control",
        source: "Dormand and Prince 1980",
        params: &[TOLERANCE],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Integrator(Box::new(Self {
            tolerance: params.number(&TOLERANCE)?,
            stages: Stages::default(),
            results: [State::default(), State::default()],
            change: Change::default(),
            parts: None,
        })))
    }
}
