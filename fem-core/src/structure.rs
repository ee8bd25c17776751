//! What the dynamic half may ask of a linear structure, sparse or reduced.

use std::fmt;

/// A matrix that could not be factorised.
#[derive(Debug, Clone, PartialEq)]
pub struct SolveError(pub String);

impl fmt::Display for SolveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
impl std::error::Error for SolveError {}

/// A linear structure with stiffness K (symmetric, positive definite) and mass M (symmetric, semi-definite).
pub trait Structure: fmt::Debug + Send {
    /// Number of unknowns.
    fn ndof(&self) -> usize;

    /// `y ← y + scale · K x`.
    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]);

    /// `y ← y + scale · M x`.
    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]);

    /// `X ← (K + shift · M)⁻¹ X`, X of `ndof × columns`, column-major. The last factorisation is kept.
    ///
    /// # Errors
    /// A matrix that is not positive definite; the message names the unknown.
    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError>;

    /// `x ← M⁻¹ x`.
    ///
    /// # Errors
    /// A singular mass.
    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError>;
}
