//! Guyan reduction.

use super::StaticShapes;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::reduction::{Functional, Reduction, ReductionError};
use fem_core::structure::Structure;

/// Static condensation on the contacts and a number of governors (report eqs 27-32): u = T u_g with the static shapes T,
/// K* = TᵀKT, M* = TᵀMT.
///
/// Condensing in one stage or in several gives the same matrices (quotient property of Schur complements).
#[derive(Debug, Clone)]
pub struct Guyan {
    governors: usize,
}

impl Reduction for Guyan {
    fn basis(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        candidates: &[usize],
    ) -> Result<Vec<f64>, ReductionError> {
        let kept = |dof: &usize| keep.iter().any(|w| matches!(w.0[..], [(d, _)] if d == *dof));
        let free = candidates.iter().filter(|d| !kept(d));
        let governors: Vec<_> =
            keep.iter().cloned().chain(free.take(self.governors).map(|d| Functional::dof(*d))).collect();
        if governors.len() < keep.len() + self.governors {
            return Err(ReductionError(format!(
                "{} governors are asked for, but the model offers only {}",
                self.governors,
                governors.len() - keep.len()
            )));
        }
        Ok(StaticShapes::new(structure, &governors)?.shapes())
    }
}

impl Plugin for Guyan {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Reduction,
        name: "guyan",
        summary: "static condensation on the contacts and deflections spread over the plate",
        source: "AFWAL-TR-87-4117, eqs 27-32; Guyan 1965",
        params: &[ParamInfo { name: "governors", doc: "deflections kept beside the contacts; default 38" }],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Reduction(Box::new(Self { governors: params.count("governors", 0, Some(38))? })))
    }
}
