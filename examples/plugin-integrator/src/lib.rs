//! The composite scheme TR-BDF2: a plug-in in one file.
//!
//! What to look at: both halves of [`Integrator::step`] end in one implicit equation, which the system solves itself. The
//! point between them is chosen so that the two have the same coefficients: one factorisation serves all steps.
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit};
use std::f64::consts::SQRT_2;

/// A trapezoidal step to t + γ Δt, then backward differences over both parts; second order, stable for every step, and what
/// is too fast for the step is gone after one.
///
/// ```text
/// v₁ = c d₁ − v₀    a₁ = c (v₁ − v₀) − a₀    d₁ = u₁ − u₀     at t + γ Δt, c = 2/(γ Δt)
/// v₂ = c d₂         a₂ = c (v₂ − v̄)          d₂ = u₂ − ū      at t + Δt
/// ū = e u₁ − (e − 1) u₀    v̄ = e v₁ − (e − 1) v₀              e = 1/(2 − 2γ)
/// ```
///
/// Both parts ask for (c² M + c C + K)⁻¹, because γ = 2 − √2.
#[derive(Debug, Clone, Default)]
pub struct TrBdf2 {
    /// d₁, then d₂.
    d: Vec<f64>,
    /// What M is applied to.
    x: Vec<f64>,
}

const GAMMA: f64 = 2.0 - SQRT_2;
const E: f64 = 0.5 / (1.0 - GAMMA);

// ANCHOR: solve
impl TrBdf2 {
    /// Solves `(c² M + c C) d + K (u + d) = M m + C v + p(t) + contact(u + d; h)` with u of `s`, and m of each unknown from
    /// `given`; the part C v only where it is `damped`.
    fn solve(
        &mut self,
        sys: &mut dyn SecondOrderSystem,
        s: &State,
        (t, c, damped): (f64, f64, f64),
        given: impl Fn(usize) -> f64,
    ) -> Result<(), StepError> {
        let Self { d, x } = self;
        d.fill(0.0);
        x.iter_mut().enumerate().for_each(|(i, x)| *x = given(i));
        sys.add_mass(1.0, x, d);
        sys.add_damping(damped, &s.v, d);
        sys.solve_implicit(c * c, c, t, &s.histories, &s.u, d)
    }
}
// ANCHOR_END: solve

impl Integrator for TrBdf2 {
    // ANCHOR: start
    fn order(&self) -> u32 {
        2
    }

    fn limit(&self) -> StepLimit {
        StepLimit::None
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        self.resume(sys);
        sys.force(s.t, &s.u, &s.v, &s.histories, &mut s.a);
        // A structure at rest may have unknowns without mass.
        if s.a.iter().any(|a| *a != 0.0) { sys.solve_mass(0.0, &mut s.a) } else { Ok(()) }
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        self.d.resize(sys.ndof(), 0.0);
        self.x.resize(sys.ndof(), 0.0);
    }
    // ANCHOR_END: start

    // ANCHOR: step
    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        let c = 2.0 / (GAMMA * dt);
        self.solve(sys, s, (s.t + GAMMA * dt, c, 1.0), |i| 2.0 * c * s.v[i] + s.a[i])?;
        // ū, v̄ in the place of u₀, v₀.
        for (i, d) in self.d.iter().enumerate() {
            s.u[i] += E * d;
            s.v[i] += E * (c * d - 2.0 * s.v[i]);
        }
        s.t += dt;
        self.solve(sys, s, (s.t, c, 0.0), |i| c * s.v[i])?;
        for (i, d) in self.d.iter().enumerate() {
            s.u[i] += d;
            s.a[i] = c * (c * d - s.v[i]);
            s.v[i] = c * d;
        }
        if [&s.u, &s.v, &s.a].into_iter().flatten().any(|x| !x.is_finite()) {
            return Err(StepError::NotFinite { t: s.t });
        }
        sys.commit(s)
    }
    // ANCHOR_END: step
}

// ANCHOR: plugin
impl Plugin for TrBdf2 {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "tr-bdf2",
        summary: "implicit, two solutions a step; second order, without what is too fast for the step",
        source: "Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992; Bathe and Baig, Comput. Struct. 83 (2005) 2513",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Integrator(Box::new(Self::default())))
    }
}
// ANCHOR_END: plugin
