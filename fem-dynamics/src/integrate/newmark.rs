//! Newmark's family.

use super::GeneralizedAlpha;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};

/// Newmark's family: [`GeneralizedAlpha`] with equilibrium at the end of the step, α_m = α_f = 0.
///
/// The default β = 1/4, γ = 1/2 (average acceleration) is second order and keeps the energy of a linear system; 1/6,
/// 1/2 is the linear acceleration method. γ above 1/2 damps and is of first order; below, no step is stable. With
/// 2β ≥ γ every step is stable, otherwise ω Δt ≤ (γ/2 − β)^(−1/2). β = 0 is `central-difference`.
#[derive(Debug, Clone, Copy)]
pub struct Newmark;

impl Plugin for Newmark {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "newmark",
        summary: "implicit; average acceleration by default, without numerical damping",
        source: "Newmark 1959",
        params: &[
            ParamInfo { name: "beta", doc: "weight of the new acceleration in u, above 0 to 1, default 0.25" },
            ParamInfo { name: "gamma", doc: "weight of the new acceleration in v, 0.5 to 1, default 0.5" },
        ],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let beta = params.number("beta", Some(0.25))?;
        if !(beta > 0.0 && beta <= 1.0) {
            let why = format!("must lie above 0 and not above 1, got {beta}; for 0 take `central-difference`");
            return Err(ParamError::new("beta", why));
        }
        let gamma = params.number("gamma", Some(0.5))?;
        if !(0.5..=1.0).contains(&gamma) {
            return Err(ParamError::new("gamma", format!("must lie between 0.5 and 1, got {gamma}")));
        }
        Ok(Built::Integrator(Box::new(GeneralizedAlpha::new(0.0, 0.0, beta, gamma))))
    }
}
