//! The generalized-α method, of which Newmark's and the HHT-α method are special cases.

use super::{MARGIN, accelerate, accept};
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit};
use fem_core::vectorised::vectorised;

/// Equilibrium between the ends of the step, Newmark's interpolation inside it.
///
/// ```text
/// M [(1 − α_m) a₁ + α_m a₀] = (1 − α_f) f₁ + α_f f₀        f = p − C v − K u + contact(u; h), h as committed at t₀
/// u₁ = ũ + β Δt² a₁        ũ = u₀ + Δt v₀ + (1/2 − β) Δt² a₀
/// v₁ = ṽ + γ Δt a₁         ṽ = v₀ + (1 − γ) Δt a₀
/// ```
///
/// Loads and contact forces are weighted like the internal ones. Division by 1 − α_f leaves one implicit equation in
/// d = u₁ − ũ with contact at full weight, `(cm M + cc C) d + K (ũ + d) = r + p₁ + contact(ũ + d; h)`:
///
/// ```text
/// cm = (1 − α_m)/((1 − α_f) β Δt²)        cc = γ/(β Δt)
/// r  = α_f/(1 − α_f) f₀ − α_m/(1 − α_f) M a₀ − C ṽ
/// ```
///
/// With ρ∞, the spectral radius for ω Δt → ∞, from 0 to 1: α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1),
/// γ = 1/2 − α_m + α_f, β = (1 − α_m + α_f)²/4: second order, stable for every step of a
/// linear system.
///
/// A contact that opens and closes is none: at each bounce a mode may gain some (ω Δt)³ of its energy, ω with the stiffness
/// of the contact. Where step and period are commensurate it does so every time, and from ω Δt of about 1/3 on a light mode
/// that chatters under a heavy impactor may grow without bound. Numerical damping does not prevent it; the energy shows it.
#[derive(Debug, Clone)]
pub struct GeneralizedAlpha {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
    /// ũ.
    predicted: Vec<f64>,
    /// r, then d.
    d: Vec<f64>,
}

impl GeneralizedAlpha {
    pub(super) fn new(alpha_m: f64, alpha_f: f64, beta: f64, gamma: f64) -> Self {
        Self { alpha_m, alpha_f, beta, gamma, predicted: Vec::new(), d: Vec::new() }
    }
}

impl Integrator for GeneralizedAlpha {
    fn order(&self) -> u32 {
        // γ = 1/2 − α_m + α_f makes it second.
        if (self.gamma - 0.5 + self.alpha_m - self.alpha_f).abs() < 1e-12 { 2 } else { 1 }
    }

    fn limit(&self) -> StepLimit {
        let shortfall = 0.5 * self.gamma - self.beta;
        if shortfall > 0.0 { StepLimit::OmegaDt(MARGIN / shortfall.sqrt()) } else { StepLimit::None }
    }

    /// Of the roots −α_f/(1 − α_f) and those of β λ² + (1/2 + γ − 2β) λ + 1/2 − γ + β = 0.
    fn radius_of_long_steps(&self) -> f64 {
        let Self { alpha_f, beta, gamma, .. } = *self;
        let (half, product) = (0.5 * (0.5 + gamma - 2.0 * beta) / beta, (0.5 - gamma + beta) / beta);
        let square = half * half - product;
        let pair = if square > 0.0 { half.abs() + square.sqrt() } else { product.sqrt() };
        pair.max(alpha_f / (1.0 - alpha_f))
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        self.resume(sys);
        accelerate(sys, s)
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        for work in [&mut self.predicted, &mut self.d] {
            work.resize(sys.ndof(), 0.0);
        }
    }

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        self.resume(sys);
        let Self { alpha_m, alpha_f, beta, gamma, predicted, d } = self;
        let weight = 1.0 / (1.0 - *alpha_f);
        let (cm, cc) = ((1.0 - *alpha_m) * weight / (*beta * dt * dt), *gamma / (*beta * dt));

        d.fill(0.0);
        if *alpha_f != 0.0 {
            sys.force(s.t, &s.u, &s.v, &s.histories, d);
            d.iter_mut().for_each(|f| *f *= *alpha_f * weight);
        }
        if *alpha_m != 0.0 {
            sys.add_mass(-*alpha_m * weight, &s.a, d);
        }
        let (of_u, of_v) = ((0.5 - *beta) * dt * dt, (1.0 - *gamma) * dt);
        vectorised(|| {
            for (((predicted, u), v), a) in predicted.iter_mut().zip(&s.u).zip(&mut s.v).zip(&s.a) {
                *predicted = u + dt * *v + of_u * a;
                *v += of_v * a;
            }
        });
        sys.add_damping(-1.0, &s.v, d);
        s.t += dt;
        sys.solve_implicit(cm, cc, s.t, &s.histories, predicted, d)?;
        let (of_a, of_v) = (*beta * dt * dt, *gamma * dt);
        vectorised(|| {
            for ((((predicted, d), u), v), a) in predicted.iter().zip(&*d).zip(&mut s.u).zip(&mut s.v).zip(&mut s.a) {
                *u = predicted + d;
                *a = d / of_a;
                *v += of_v * *a;
            }
        });
        accept(sys, s)
    }
}

const RHO: ParamInfo = ParamInfo::number("rho", "spectral radius for long steps: 0 damps them all, 1 none")
    .at_least(0.0)
    .at_most(1.0)
    .default(0.9);

impl Plugin for GeneralizedAlpha {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "generalized-alpha",
        summary: "implicit, second order; damps high modes as chosen, low ones least",
        source: "Chung and Hulbert 1993",
        params: &[RHO],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let rho = params.number(&RHO)?;
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let shift = alpha_f - alpha_m;
        let scheme = Self::new(alpha_m, alpha_f, 0.25 * (1.0 + shift) * (1.0 + shift), 0.5 + shift);
        Ok(Built::Integrator(Box::new(scheme)))
    }
}
