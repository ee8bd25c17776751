//! The α-method of Hilber, Hughes and Taylor.

use super::GeneralizedAlpha;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};

/// The HHT-α method: [`GeneralizedAlpha`] with α_m = 0, α_f = −α, β = (1 − α)²/4, γ = 1/2 − α.
///
/// α from −1/3 to 0; ρ∞ = (1 + α)/(1 − α). Second order, stable for every step; 0 is average acceleration.
#[derive(Debug, Clone, Copy)]
pub struct HhtAlpha;

impl Plugin for HhtAlpha {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "hht-alpha",
        summary: "implicit, second order; damps high modes",
        source: "Hilber, Hughes and Taylor 1977",
        params: &[ParamInfo { name: "alpha", doc: "-1/3 (most damping) to 0 (none), default -0.1" }],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let alpha = params.number("alpha", Some(-0.1))?;
        if !(-1.0 / 3.0..=0.0).contains(&alpha) {
            return Err(ParamError::new("alpha", format!("must lie between -1/3 and 0, got {alpha}")));
        }
        let scheme = GeneralizedAlpha::new(0.0, -alpha, 0.25 * (1.0 - alpha) * (1.0 - alpha), 0.5 - alpha);
        Ok(Built::Integrator(Box::new(scheme)))
    }
}
