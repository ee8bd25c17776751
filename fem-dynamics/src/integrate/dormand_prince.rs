//! The embedded Runge-Kutta pair 5(4).

use super::stages::{Rows, Stages};
use super::{accelerate, accept};
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit, Substeps};

/// Dormand and Prince's pair: it divides a step into parts whose estimated error is within tolerance.
///
/// The estimate, the difference of the results of order 5 and 4, is the root mean square over all components of
/// `e_u/(atol + rtol |u|)` and `h e_v/(atol + rtol h |v|)`, h the length of the part; a part is accepted up to 1.
/// Every part is a step of its own and commits the contacts, so a contact shorter than the step is not missed. Each
/// step tries itself whole first: nothing but the state passes from step to step.
#[derive(Debug, Clone)]
pub struct DormandPrince {
    rtol: f64,
    atol: f64,
    stages: Stages,
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
    /// Estimated error of the part `h` that the stages hold, 1 at the tolerance.
    fn error(&self, s: &State, h: f64) -> f64 {
        let Stages { u, v, a } = &self.stages;
        let estimate = |x: &[Vec<f64>], i: usize| h * ERROR.iter().zip(x).map(|(w, x)| w * x[i]).sum::<f64>();
        let scale = |before: f64, after: f64| self.rtol * before.abs().max(after.abs());
        let mut squares = 0.0;
        for i in 0..u.len() {
            squares += (estimate(v, i) / (self.atol + scale(s.u[i], u[i]))).powi(2);
            squares += (h * estimate(a, i) / (self.atol + h * scale(s.v[i], v[LAST][i]))).powi(2);
        }
        (squares / (2 * u.len()).max(1) as f64).sqrt()
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
            let error = self.error(s, h);
            if error <= 1.0 {
                left -= h;
                let part = Substeps::new(1, h);
                self.parts = Some(self.parts.map_or(part, |parts| parts.and(part)));
                self.stages.take(s, end - left);
                accept(sys, s)?;
                if left <= 0.0 {
                    return Ok(());
                }
            } else if !error.is_finite() && (h.is_nan() || h <= 1e-12 * dt) {
                return Err(StepError::NotFinite { t: s.t });
            }
            let factor = if error.is_finite() { (0.9 * error.powf(-0.2)).clamp(0.2, 5.0) } else { 0.2 };
            h = left.min(factor * h);
        }
        let what = format!("more than {MOST_PARTS} parts of one step; loosen rtol or atol");
        Err(StepError::NoConvergence { t: s.t, what })
    }
}

const RTOL: ParamInfo =
    ParamInfo::number("rtol", "relative tolerance of a part of a step").above(0.0).at_most(0.1).default(1e-6);
const ATOL: ParamInfo =
    ParamInfo::quantity("atol", "absolute tolerance of displacements", Dimension::LENGTH).above(0.0).default(1e-12);

impl Plugin for DormandPrince {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "dormand-prince",
        summary: "Runge-Kutta pair 5(4) that divides its steps by error control",
        source: "Dormand and Prince 1980",
        params: &[RTOL, ATOL],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let (rtol, atol) = (params.number(&RTOL)?, params.number(&ATOL)?);
        Ok(Built::Integrator(Box::new(Self { rtol, atol, stages: Stages::default(), parts: None })))
    }
}
