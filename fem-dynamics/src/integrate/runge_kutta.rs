//! Explicit Runge-Kutta schemes of fixed step.

use super::stages::{Rows, Stages};
use super::{accelerate, accept};
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit};

/// The explicit Runge-Kutta scheme of `ORDER` stages and that order, 1 to 4.
///
/// On the oscillator the amplification is `Σ zᵏ/k!` up to k = ORDER, z = i ω Δt. Its modulus stays within 1 up to
/// ω Δt = √3 (order 3) and 2√2 (order 4); 1.5 is demanded of both, because marches through contact have blown up from
/// there on; the half of that disc where motions decay lies within the stable region of both, so that it holds of the roots of a
/// damped oscillator as well. Orders 1 and 2 have no stable step without damping, their fastest mode grows by (ω Δt)²/2 and (ω Δt)⁴/8 a
/// step: their limit holds that to 10⁻⁶, one part in a hundred over ten thousand steps.
#[derive(Debug, Clone, Default)]
pub struct RungeKutta<const ORDER: usize> {
    stages: Stages,
}

/// Euler's scheme.
pub type Rk1 = RungeKutta<1>;
/// Heun's scheme.
pub type Rk2 = RungeKutta<2>;
/// Kutta's third-order scheme.
pub type Rk3 = RungeKutta<3>;
/// The classical fourth-order scheme.
pub type Rk4 = RungeKutta<4>;

struct Scheme {
    name: &'static str,
    summary: &'static str,
    source: &'static str,
    limit: f64,
    rows: Rows,
}

const SCHEMES: [Scheme; 4] = [
    Scheme {
        name: "rk1",
        summary: "explicit Euler; no stable step without damping",
        source: "Euler 1768; AFWAL-TR-87-4117, INTALG 1",
        limit: 1.414e-3,
        rows: &[&[1.0]],
    },
    Scheme {
        name: "rk2",
        summary: "Heun's second-order Runge-Kutta scheme; no stable step without damping",
        source: "Heun 1900; AFWAL-TR-87-4117, INTALG 2",
        limit: 0.05318,
        rows: &[&[1.0], &[0.5, 0.5]],
    },
    Scheme {
        name: "rk3",
        summary: "Kutta's third-order Runge-Kutta scheme",
        source: "Kutta 1901; AFWAL-TR-87-4117, INTALG 3",
        limit: 1.5,
        rows: &[&[0.5], &[-1.0, 2.0], &[1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0]],
    },
    Scheme {
        name: "rk4",
        summary: "the classical fourth-order Runge-Kutta scheme",
        source: "Kutta 1901; AFWAL-TR-87-4117, INTALG 4",
        limit: 1.5,
        rows: &[&[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0], &[1.0 / 6.0, 2.0 / 6.0, 2.0 / 6.0, 1.0 / 6.0]],
    },
];

impl<const ORDER: usize> RungeKutta<ORDER> {
    const SCHEME: &Scheme = &SCHEMES[ORDER - 1];
}

impl<const ORDER: usize> Integrator for RungeKutta<ORDER> {
    fn order(&self) -> u32 {
        ORDER as u32
    }

    fn limit(&self) -> StepLimit {
        StepLimit::RootDt(Self::SCHEME.limit)
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        self.resume(sys);
        accelerate(sys, s)
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        self.stages.size(Self::SCHEME.rows, sys.ndof());
    }

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        self.stages.run(Self::SCHEME.rows, sys, s, dt)?;
        self.stages.take(s, s.t + dt);
        accept(sys, s)
    }
}

impl<const ORDER: usize> Plugin for RungeKutta<ORDER> {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: Self::SCHEME.name,
        summary: Self::SCHEME.summary,
        source: Self::SCHEME.source,
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Integrator(Box::new(Self::default())))
    }
}
