//! The linear contact spring.

use super::Hertz;
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};

/// `F = k α` for α > 0, no force otherwise: [`Hertz`] with n = 1.
#[derive(Debug, Clone, Copy)]
pub struct Linear;

impl Plugin for Linear {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Contact,
        name: "linear",
        summary: "one-sided linear spring F = k a",
        source: "Hooke",
        params: &[ParamInfo { name: "k", doc: "contact stiffness, N/m" }],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let k = params.positive("k", Dimension::contact_stiffness(1.0), None)?;
        Ok(Built::Contact(Box::new(Hertz::new(k, 1.0))))
    }
}
