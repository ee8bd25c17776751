//! The contract of a reduction.

use crate::contracts::structure::Structure;
use crate::words::functional::Functional;
use dyn_clone::DynClone;
use std::fmt::Debug;

/// Why a basis could not be made.
#[derive(Debug, Clone, PartialEq)]
pub struct ReductionError(pub String);

impl std::fmt::Display for ReductionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}
impl std::error::Error for ReductionError {}

// ANCHOR: contract
/// A reduction u ≈ T q: it chooses the columns of T; projection and expansion are common to all.
pub trait Reduction: DynClone + Debug + Send + Sync {
    /// The basis T, `ndof × m` column-major, columns linearly independent.
    ///
    /// * `keep`: functionals that must stay exact under static loads (the contacts)
    /// * `candidates`: dofs that may serve as governors, best first
    ///
    /// # Errors
    /// Too few candidates, or an eigenproblem without convergence.
    fn basis(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        candidates: &[usize],
    ) -> Result<Vec<f64>, ReductionError>;
}
// ANCHOR_END: contract
dyn_clone::clone_trait_object!(Reduction);
