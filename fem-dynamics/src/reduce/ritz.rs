//! Load-dependent Ritz vectors.

use super::{columns, solve, static_responses};
use crate::lanczos::Lanczos;
use fem_core::functional::Functional;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo, Role};
use fem_core::reduction::{Reduction, ReductionError};

use fem_core::structure::{Coarse, SolveError, Structure};

/// Fine unknowns per coarse one, and coarse ones per vector, at least, for a coarse model to pay.
const COARSENING: usize = 2;
const ROOM: usize = 4;

/// The Krylov space {X, A X, A² X, …} of A = K⁻¹ M from the static responses X = K⁻¹ P to the contact loads, exactly or
/// nearly so.
///
/// `space = "krylov"`: exactly. m vectors deep it holds the first 2m moments of the dynamic flexibility at the contacts;
/// modes that no contact can excite never enter. Every vector takes a solve of its own, after the one before it, and each
/// solve reads the whole factor.
///
/// `space = "two-level"` (the default): the space is built on the coarse model of the structure (u = P y, for a plate the
/// displacements that are linear in z), with Y_k the Krylov vectors of PᵀKP and PᵀMP, and taken to the fine one by a single
/// step A P Y_k of all vectors at once, which reads the factor once. What is wrong with P Y_k is stiff, and A wears it down
/// by the square of the ratio of frequencies. X itself is exact, and with it the static flexibility at the contacts. On a
/// laminate of 16 plies the force is as near to that of the full model as from the exact space of equal size. Structures
/// without a coarse model, or with one that is hardly smaller or not positive definite, take the exact space.
///
/// No more vectors than unknowns are made.
#[derive(Debug, Clone)]
pub struct Ritz {
    vectors: usize,
    two_level: bool,
}

impl Ritz {
    /// So many vectors of the exact space.
    pub(super) fn krylov(vectors: usize) -> Self {
        Self { vectors, two_level: false }
    }
}

impl Reduction for Ritz {
    fn basis(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        candidates: &[usize],
    ) -> Result<Vec<f64>, ReductionError> {
        Ok(self.basis_and_forces(structure, keep, candidates)?.0)
    }

    fn basis_and_forces(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        _: &[usize],
    ) -> Result<(Vec<f64>, Option<Vec<f64>>), ReductionError> {
        let vectors = columns(structure, self.vectors.max(keep.len()), 0)?;
        if self.two_level
            && let Some(coarse) = structure.coarse()?
            && (ROOM * vectors..=structure.ndof() / COARSENING).contains(&coarse.prolongation.columns())
        {
            match two_level(structure, coarse, keep, vectors) {
                // Of cells a thousand times as wide as thick rounding leaves nothing of a stiffness that is projected.
                Err(ReductionError::Solve(SolveError::NotPositive { .. })) => {}
                made => return made.map(|(basis, forces)| (basis, Some(forces))),
            }
        }
        let start = static_responses(structure, keep)?;
        Ok((krylov(structure, &start, vectors)?, None))
    }
}

fn krylov(structure: &mut dyn Structure, start: &[f64], vectors: usize) -> Result<Vec<f64>, ReductionError> {
    let mut space = Lanczos::new(structure, solve, start);
    for _ in 0..vectors {
        if !space.grow()? {
            break;
        }
    }
    Ok(space.into_basis())
}

/// K⁻¹ [P, M P_c Y], P_c the prolongation, and what K⁻¹ is applied to.
fn two_level(
    structure: &mut dyn Structure,
    Coarse { structure: mut small, prolongation }: Coarse,
    keep: &[Functional],
    vectors: usize,
) -> Result<(Vec<f64>, Vec<f64>), ReductionError> {
    let n = structure.ndof();
    let mut forces = vec![0.0; n * keep.len()];
    for (w, column) in keep.iter().zip(forces.chunks_exact_mut(n)) {
        w.add_to(1.0, column);
    }
    let mut start = prolongation.restrict(&forces);
    solve(&mut *small, &mut start)?;
    let rough = prolongation.expand(&krylov(&mut *small, &start, vectors - keep.len())?);
    let contacts = forces.len();
    forces.resize(contacts + rough.len(), 0.0);
    structure.add_mass(1.0, &rough, &mut forces[contacts..]);
    let mut basis = forces.clone();
    solve(structure, &mut basis)?;
    Ok((basis, forces))
}

const VECTORS: ParamInfo = ParamInfo::count("vectors", "vectors in all").at_least(1.0).default(60.0).role(Role::Size);
const SPACE: ParamInfo = ParamInfo::word(
    "space",
    "how they are found",
    &[("two-level", "by way of a coarse model"), ("krylov", "exactly, a solve each")],
)
.role(Role::Way);

impl Plugin for Ritz {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Reduction,
        name: "ritz",
        summary: "Krylov vectors of the contact loads; exact static flexibility at the contact, few solves",
        source: "Wilson, Yuan, Dickens 1982",
        params: &[VECTORS, SPACE],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let two_level = params.word(&SPACE)? == "two-level";
        Ok(Built::Reduction(Box::new(Self { vectors: params.count(&VECTORS)?, two_level })))
    }
}
