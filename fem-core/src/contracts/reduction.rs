//! The contract of a reduction.

use crate::contracts::structure::{SolveError, Structure};
use crate::words::functional::Functional;
use dyn_clone::DynClone;
use std::fmt::{self, Debug};

/// Why a basis could not be made.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ReductionError {
    /// The structure has no answer; what else a reduction of its own kind refuses is a [`SolveError::other`].
    Solve(SolveError),
    /// The basis has no vectors.
    NoVectors,
    /// More vectors than dense matrices are good for.
    TooManyVectors {
        /// Vectors asked for.
        asked: usize,
        /// As many as there may be.
        largest: usize,
        /// Unknowns of the structure.
        unknowns: usize,
    },
    /// Fewer governors than are asked for.
    FewGovernors {
        /// Governors asked for.
        asked: usize,
        /// Candidates that the model offers.
        offered: usize,
        /// Whether only those with inertia count.
        with_inertia: bool,
    },
    /// Neither a contact nor a governor.
    NoGovernors,
    /// Governors that follow from those before them, whatever the load.
    DependentGovernors {
        /// Their names.
        names: Vec<String>,
    },
    /// A reduced matrix, named, is not finite.
    NotFinite(&'static str),
    /// The reduced stiffness is singular.
    SingularStiffness,
    /// The mass condensed on the governors is singular.
    SingularMass,
}

impl From<SolveError> for ReductionError {
    fn from(why: SolveError) -> Self {
        Self::Solve(why)
    }
}

impl fmt::Display for ReductionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Solve(why) => write!(f, "{why}"),
            Self::NoVectors => f.write_str("the basis has no vectors"),
            Self::TooManyVectors { asked, largest, unknowns } => write!(
                f,
                "{asked} vectors are asked for, more than {largest}: dense matrices of that size cost more than the \
                 {unknowns} unknowns do; ask for fewer, or for no reduction"
            ),
            Self::FewGovernors { asked, offered, with_inertia } => {
                let with = if *with_inertia { " with inertia" } else { "" };
                write!(f, "{asked} governors are asked for, but the model offers only {offered}{with}: ask for fewer")
            }
            Self::NoGovernors => f.write_str("there is neither a contact nor a governor to condense on"),
            Self::DependentGovernors { names } => write!(
                f,
                "some governors follow from those before them, whatever the load: {}; leave them out, or ask for fewer",
                names.join(", ")
            ),
            Self::NotFinite(what) => write!(f, "{what} is not finite"),
            Self::SingularStiffness => {
                f.write_str("the reduced stiffness is singular: take fewer vectors, or hold the plate")
            }
            Self::SingularMass => f.write_str("the mass condensed on the governors is singular: ask for fewer"),
        }
    }
}

impl std::error::Error for ReductionError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Solve(why) => why.source(),
            _ => None,
        }
    }
}

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

    /// The same with K T, where it is known from the solves that made T.
    ///
    /// # Errors
    /// As [`Reduction::basis`].
    fn basis_and_forces(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        candidates: &[usize],
    ) -> Result<(Vec<f64>, Option<Vec<f64>>), ReductionError> {
        Ok((self.basis(structure, keep, candidates)?, None))
    }
}
// ANCHOR_END: contract
dyn_clone::clone_trait_object!(Reduction);
