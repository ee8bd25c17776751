//! Load-dependent Ritz vectors.

use super::krylov::Krylov;
use super::solve;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::reduction::{Functional, Reduction, ReductionError};
use fem_core::structure::Structure;

/// The Krylov space {x, A x, A² x, …} of A = K⁻¹ M from the static response x = K⁻¹ p to each contact load.
///
/// It holds the exact static flexibility at the contact and, m vectors deep, the first 2m moments of its dynamic
/// flexibility; modes that the contact cannot excite never enter. Each vector costs one solve, where a converged mode
/// costs two or three.
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
        let mut basis = Vec::new();
        for contact in keep {
            let mut x = vec![0.0; structure.ndof()];
            contact.add_to(1.0, &mut x);
            solve(structure, &mut x)?;
            let mut krylov = Krylov::new(structure, solve, x)?;
            for _ in 0..self.vectors.div_ceil(keep.len()) {
                if !krylov.grow()? {
                    break;
                }
            }
            basis.extend(krylov.into_basis());
        }
        Ok(basis)
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
