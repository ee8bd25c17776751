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

const BETA: ParamInfo = ParamInfo::number("beta", "weight of the new acceleration in u; `central-difference` has 0")
    .above(0.0)
    .at_most(1.0)
    .default(0.25);
const GAMMA: ParamInfo =
    ParamInfo::number("gamma", "weight of the new acceleration in v").at_least(0.5).at_most(1.0).default(0.5);

impl Plugin for Newmark {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "newmark",
        summary: "implicit; average acceleration by default, without numerical damping",
        source: "Newmark 1959",
        params: &[BETA, GAMMA],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let (beta, gamma) = (params.number(&BETA)?, params.number(&GAMMA)?);
        Ok(Built::Integrator(Box::new(GeneralizedAlpha::new(0.0, 0.0, beta, gamma))))
    }
}
