//! Load-dependent Ritz vectors.

use super::{columns, refused, solve, static_responses};
use crate::lanczos::Lanczos;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::reduction::{Functional, Reduction, ReductionError};
use fem_core::structure::Structure;

/// The Krylov space {X, A X, A² X, …} of A = K⁻¹ M from the static responses X = K⁻¹ P to the contact loads.
///
/// It holds the exact static flexibility at the contacts and, m vectors deep, the first 2m moments of their dynamic
/// flexibility; modes that no contact can excite never enter. Each vector costs one solve, where a converged mode
/// costs two or three. No more vectors than unknowns are made.
#[derive(Debug, Clone)]
pub struct Ritz {
    vectors: usize,
}

impl Reduction for Ritz {
    fn basis(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        _: &[usize],
    ) -> Result<Vec<f64>, ReductionError> {
        let vectors = columns(structure, self.vectors.max(keep.len()), 0)?;
        let start = static_responses(structure, keep)?;
        let mut space = Lanczos::new(structure, solve, &start);
        for _ in 0..vectors {
            if !space.grow().map_err(refused)? {
                break;
            }
        }
        Ok(space.into_basis())
    }
}

impl Plugin for Ritz {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Reduction,
        name: "ritz",
        summary: "Krylov vectors of the contact loads; exact static flexibility at the contact, one solve a vector",
        source: "Wilson, Yuan, Dickens 1982",
        params: &[ParamInfo { name: "vectors", doc: "vectors in all; default 40" }],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Reduction(Box::new(Self { vectors: params.count("vectors", 1, Some(40))? })))
    }
}
