//! The linear contact spring.

use super::Hertz;
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};

/// `F = k α` for α > 0, no force otherwise: [`Hertz`] with n = 1.
#[derive(Debug, Clone, Copy)]
pub struct Linear;

const K: ParamInfo = ParamInfo::quantity("k", "contact stiffness", Dimension::contact_stiffness(1.0)).above(0.0);

impl Plugin for Linear {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Contact,
        name: "linear",
        summary: "one-sided linear spring F = k a",
        source: "Hooke",
        params: &[K],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Contact(Box::new(Hertz::new(params.number(&K)?, 1.0))))
    }
}
