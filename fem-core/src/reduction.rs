//! The contract of a reduction.

use crate::structure::Structure;
use dyn_clone::DynClone;
use std::fmt::Debug;

/// A linear functional of the displacements, `d = Σ wᵢ uᵢ`: one dof, or the weighted mean over a contact patch.
///
/// ```
/// use fem_core::reduction::Functional;
///
/// // The deflection under a patch that covers two unknowns, and the load of 10 N on that patch: their work agrees.
/// let patch = Functional(vec![(1, 0.25), (2, 0.75)]);
/// let (u, mut load) = ([0.0, 4e-3, 8e-3], [0.0; 3]);
/// patch.add_to(10.0, &mut load);
/// let work: f64 = load.iter().zip(&u).map(|(f, u)| f * u).sum();
/// assert!((patch.of(&u) - 7e-3).abs() < 1e-15 && (work - 10.0 * patch.of(&u)).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Functional(pub Vec<(usize, f64)>);

impl Functional {
    /// A single dof.
    pub fn dof(i: usize) -> Self {
        Self(vec![(i, 1.0)])
    }

    /// The functional's value at `u`.
    pub fn of(&self, u: &[f64]) -> f64 {
        self.0.iter().map(|&(i, w)| w * u[i]).sum()
    }

    /// `y ← y + scale · w`.
    pub fn add_to(&self, scale: f64, y: &mut [f64]) {
        for &(i, w) in &self.0 {
            y[i] += scale * w;
        }
    }
}

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
