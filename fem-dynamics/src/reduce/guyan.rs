//! Guyan reduction.

use super::governors::Governors;
use fem_core::functional::Functional;
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
use fem_core::reduction::{Reduction, ReductionError};
use fem_core::structure::Structure;

/// Static condensation on the contacts and a number of governors (report eqs 27-32): u = T u_g with the static shapes T,
/// K* = TᵀKT, M* = TᵀMT.
///
/// Condensing in one stage or in several gives the same matrices (quotient property of Schur complements). The
/// governors are spread over the plate, or chosen by eliminating the largest ratios of stiffness to mass.
#[derive(Debug, Clone)]
pub struct Guyan {
    governors: Governors,
}

impl Reduction for Guyan {
    fn basis(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        candidates: &[usize],
    ) -> Result<Vec<f64>, ReductionError> {
        Ok(self.governors.condense(structure, keep, candidates)?.shapes())
    }
}

impl Plugin for Guyan {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Reduction,
        name: "guyan",
        summary: "static condensation on the contacts and governing deflections",
        source: "AFWAL-TR-87-4117, eqs 27-32; Guyan 1965; ratios after Henshell, Ong 1975",
        params: &Governors::PARAMS,
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Reduction(Box::new(Self { governors: Governors::of(params)? })))
    }
}
