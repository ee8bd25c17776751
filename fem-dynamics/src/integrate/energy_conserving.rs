//! The midpoint rule with forces that are discrete gradients.

use super::accept;
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit};

/// The midpoint rule; its contact forces and internal forces are discrete gradients of their energies.
///
/// ```text
/// M (v₁ − v₀)/Δt + C v_m + f̄ = p(t_m) + Σ F̄ p        u₁ − u₀ = Δt v_m        v_m = (v₀ + v₁)/2
/// f̄ᵀ (u₁ − u₀) = V(u₁) − V(u₀)        F̄ (α₁ − α₀) = W(α₁; h) − W(α₀; h)
/// ```
///
/// Times Δt v_m the equation of motion is a balance: kinetic energy, V of the plate and W of the contacts, which is what they
/// store and have dissipated, change together by −Δt v_mᵀ C v_m and the work of p. That holds to rounding whatever the step, in contacts
/// that open and close and under large deflections too: energy never grows. F̄ is never negative, as W grows with α.
///
/// Second order. Of a linear system it is Newmark's average acceleration. A step that is too long for a motion still gives
/// it a wrong period: the energy does not show that, compare with a shorter step.
///
/// The unknown is d, the change of the middle from where it would be in free flight:
///
/// ```text
/// (4/Δt² M + 2/Δt C) d + f̄ = −C v₀ + p(t_m) + Σ F̄ p        u₁ = u₀ + Δt v₀ + 2 d        v₁ = v₀ + 4 d/Δt
/// ```
///
/// The acceleration of the state is the mean of the step; the next does not ask for it, nor does a start ask for M⁻¹.
#[derive(Debug, Clone, Default)]
pub struct EnergyConserving {
    /// The middle in free flight.
    predicted: Vec<f64>,
    /// r, then d.
    d: Vec<f64>,
}

impl Integrator for EnergyConserving {
    fn order(&self) -> u32 {
        2
    }

    fn limit(&self) -> StepLimit {
        StepLimit::None
    }

    fn conserves_energy(&self) -> bool {
        true
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, _: &mut State) -> Result<(), StepError> {
        self.resume(sys);
        Ok(())
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        for work in [&mut self.predicted, &mut self.d] {
            work.resize(sys.ndof(), 0.0);
        }
    }

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        self.resume(sys);
        let Self { predicted, d } = self;
        let half = 0.5 * dt;
        for ((predicted, u), v) in predicted.iter_mut().zip(&s.u).zip(&s.v) {
            *predicted = u + half * v;
        }
        d.fill(0.0);
        sys.add_damping(-1.0, &s.v, d);
        sys.solve_midpoint(1.0 / (half * half), 1.0 / half, s.t + half, s, predicted, d)?;
        for (i, d) in d.iter().enumerate() {
            s.u[i] += dt * s.v[i] + 2.0 * d;
            s.v[i] += 2.0 / half * d;
            s.a[i] = d / (half * half);
        }
        s.t += dt;
        accept(sys, s)
    }
}

impl Plugin for EnergyConserving {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "energy-conserving",
        summary: "implicit midpoint rule, forces as discrete gradients; no step makes energy grow, in contact neither",
        source: "Simo and Tarnow 1992; Gonzalez 1996; Laursen and Chawla 1997",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Integrator(Box::new(Self::default())))
    }
}
