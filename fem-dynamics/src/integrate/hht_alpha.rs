//! The α-method of Hilber, Hughes and Taylor.

use super::GeneralizedAlpha;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};

/// The HHT-α method: [`GeneralizedAlpha`] with α_m = 0, α_f = −α, β = (1 − α)²/4, γ = 1/2 − α.
///
/// α from −1/3 to 0; ρ∞ = (1 + α)/(1 − α). Second order, stable for every step; 0 is average acceleration.
#[derive(Debug, Clone, Copy)]
pub struct HhtAlpha;

const ALPHA: ParamInfo = ParamInfo::number("alpha", "numerical damping: the least value damps most, 0 not at all")
    .at_least(-1.0 / 3.0)
    .at_most(0.0)
    .default(-0.1);

impl Plugin for HhtAlpha {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Integrator,
        name: "hht-alpha",
        summary: "implicit, second order; damps high modes",
        source: "Hilber, Hughes and Taylor 1977",
        params: &[ALPHA],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let alpha = params.number(&ALPHA)?;
        let scheme = GeneralizedAlpha::new(0.0, -alpha, 0.25 * (1.0 - alpha) * (1.0 - alpha), 0.5 - alpha);
        Ok(Built::Integrator(Box::new(scheme)))
    }
}
