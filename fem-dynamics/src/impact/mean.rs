//! The internal force of a step as the discrete gradient of its energy.

use super::newton::internal;
use crate::vector::dot;
use fem_core::energy::Energy;
use fem_core::structure::Structure;
use fem_core::time::StepError;

/// What Simpson's rule may miss of an energy before it is corrected, relative: rounding.
const ROUNDING: f64 = 1e-13;

/// Mean f̄ of the internal force along the way from u₀ to u₁ = 2 u_m − u₀, with Δ = u₁ − u₀:
///
/// ```text
/// f̄ = (f(u₀) + 4 f(u_m) + f(u₁))/6 + [V(u₁) − V(u₀) − f̄ᵀΔ] M Δ/(Δᵀ M Δ)
/// ```
///
/// Under large deflections f is cubic in u, and Simpson's rule exact; of other forces, laws of plies above all, the second
/// term makes the work what the energy says.
///
/// Gonzalez, J. Nonlinear Sci. 6 (1996) 449; McLachlan, Quispel and Robidoux, Phil. Trans. R. Soc. A 357 (1999) 1021.
#[derive(Debug, Default)]
pub(super) struct MeanForce {
    u: Vec<f64>,
    force: Vec<f64>,
    energy: f64,
    /// Δ.
    way: Vec<f64>,
    end: Vec<f64>,
    /// f(u₁), then M Δ.
    other: Vec<f64>,
}

impl MeanForce {
    /// The beginning of a step.
    pub(super) fn begin(&mut self, structure: &mut dyn Structure, u: &[f64], points: &[f64]) -> Result<(), StepError> {
        self.u.clear();
        self.u.extend_from_slice(u);
        self.force.resize(u.len(), 0.0);
        self.energy = internal(structure, u, points, &mut self.force)?.total();
        Ok(())
    }

    /// f̄ of the step with `middle` in its middle; returns the work done up to its end.
    pub(super) fn internal(
        &mut self,
        structure: &mut dyn Structure,
        middle: &[f64],
        points: &[f64],
        mean: &mut [f64],
    ) -> Result<Energy, StepError> {
        let Self { u, force, energy, way, end, other } = self;
        way.clear();
        way.extend(middle.iter().zip(&*u).map(|(m, u)| 2.0 * (m - u)));
        end.clear();
        end.extend(u.iter().zip(&*way).map(|(u, way)| u + way));
        other.resize(u.len(), 0.0);
        internal(structure, middle, points, mean)?;
        let after = internal(structure, end, points, other)?;
        for (mean, (before, after)) in mean.iter_mut().zip(force.iter().zip(&*other)) {
            *mean = (before + 4.0 * *mean + after) / 6.0;
        }
        let missing = after.total() - *energy - dot(mean, way);
        if missing.abs() > ROUNDING * (after.total().abs() + energy.abs()) {
            other.fill(0.0);
            structure.add_mass(1.0, way, other);
            let norm = dot(way, other);
            // Without inertia there is no norm.
            if norm > 0.0 {
                mean.iter_mut().zip(&*other).for_each(|(f, m)| *f += missing / norm * m);
            }
        }
        Ok(after)
    }
}
