//! The central difference method.

use super::{MARGIN, accelerate, accept};
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit};

/// Central differences in one-step form (velocity Verlet); second order, without numerical damping.
///
/// ```text
/// v½ = v + Δt/2 a      u₁ = u + Δt v½      (M + Δt/2 C) a₁ = f(t + Δt, u₁, v½)      v₁ = v½ + Δt/2 a₁
/// ```
///
/// The damping force acts with v₁, as in the two-step form with C (u₊ − u₋)/(2 Δt), so damping leaves order and
/// stability limit ω Δt = 2 as they are.
#[derive(Debug, Clone, Copy, Default)]
pub struct CentralDifference;

impl Integrator for CentralDifference {
    fn order(&self) -> u32 {
        2
    }

    fn limit(&self) -> StepLimit {
        StepLimit::OmegaDt(MARGIN * 2.0)
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        accelerate(sys, s)
    }

    fn resume(&mut self, _: &mut dyn SecondOrderSystem) {}

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        let half = 0.5 * dt;
        for i in 0..s.u.len() {
            s.v[i] += half * s.a[i];
            s.u[i] += dt * s.v[i];
        }
        s.t += dt;
        sys.force(s.t, &s.u, &s.v, &s.histories, &mut s.a);
        sys.solve_mass(half, &mut s.a)?;
        for (v, a) in s.v.iter_mut().zip(&s.a) {
            *v += half * a;
        }
        accept(sys, s)
    }
}

impl Plugin for CentralDifference {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "central-difference",
        summary: "explicit central differences (velocity Verlet)",
        source: "Courant, Friedrichs and Lewy 1928; Verlet 1967",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Integrator(Box::new(Self)))
    }
}
