//! The improved reduced system.

use super::governors::Governors;
use super::{Reduced, solve};
use fem_core::functional::Functional;
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
use fem_core::reduction::{Reduction, ReductionError};
use fem_core::structure::Structure;
use nalgebra::{Cholesky, DMatrix};

/// Guyan's shapes T corrected by the static response to the inertia that they neglect:
/// `T_irs = T + S M T M_r⁻¹ K_r`, with S the inverse stiffness while contacts and governors are held, K_r = TᵀKT,
/// M_r = TᵀMT.
///
/// Low frequencies gain several digits over `guyan` with the same governors. The force of an impact gains nothing by
/// that: static responses to the contact loads lie in the span of T but not of T_irs, so the static flexibility at the
/// contact, on which the force hangs, is no longer exact. On a laminate of 16 plies with 38 governors it is 1.5 % off, and
/// the force differs from that of the unreduced plate by 17 % (`guyan`: 6 %; forty vectors of `ritz` or `modal`: 0.3 %).
/// On a chain that is struck for a short time it loses as well, on one that is struck for long it can win. It is here to
/// be compared; for impacts take a reduction that keeps the flexibility.
#[derive(Debug, Clone)]
pub struct Irs {
    governors: Governors,
}

/// By how much, relative, the lowest frequency may lie above Guyan's.
const SLACK: f64 = 1e-2;

impl Reduction for Irs {
    fn basis(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        candidates: &[usize],
    ) -> Result<Vec<f64>, ReductionError> {
        let shapes = self.governors.condense(structure, keep, candidates)?;
        let (k, m) = shapes.condensed(structure);
        shapes.check_independence(&m).map_err(|dependent| dependent.named(structure))?;
        let mut basis = shapes.shapes();
        let n = structure.ndof();
        let accelerations = Cholesky::new(m).ok_or(ReductionError::SingularMass)?.solve(&k);
        let moved = DMatrix::from_column_slice(n, k.nrows(), &basis) * accelerations;
        let mut correction = vec![0.0; basis.len()];
        structure.add_mass(1.0, moved.as_slice(), &mut correction);
        solve(structure, &mut correction)?;
        for (t, x) in basis.chunks_exact_mut(n).zip(correction.chunks_exact_mut(n)) {
            shapes.hold(x);
            t.iter_mut().zip(x).for_each(|(t, x)| *t += *x);
        }
        // M_r⁻¹ loses what governors next to each other have in common, and nothing above notices. Frequencies do: those of more
        // shapes than Guyan's own are lower.
        let lowest = |basis: &[f64]| -> Result<f64, ReductionError> {
            Ok(Reduced::project(structure, basis)?.modal.lowest_frequency().unwrap_or(0.0))
        };
        if lowest(&basis)? <= (1.0 + SLACK) * lowest(&shapes.shapes())? {
            Ok(basis)
        } else {
            Err(shapes.nearest().named(structure))
        }
    }
}

impl Plugin for Irs {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Reduction,
        name: "irs",
        summary: "guyan with one term of inertia; better frequencies, but the flexibility at the contact is not exact",
        source: "O'Callahan 1989",
        params: &Governors::PARAMS,
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Reduction(Box::new(Self { governors: Governors::of(params)? })))
    }
}
