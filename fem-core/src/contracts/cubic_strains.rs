//! Strains that are cubic through the height of a cell.

use super::element::{Cell, ElementError, Part, Point};
use super::stack::Stack;

/// Coefficients ε(k) of strains Σ ε(k) qᵏ, k = 0 … 3: six of each power, one power after the other.
pub const COEFFICIENTS: usize = 24;

/// An element whose strains are Σ ε(k) qᵏ through the height of a cell, of any number of plies: what any part of any ply feels
/// follows from their [`COEFFICIENTS`].
pub trait CubicStrains: Send + Sync {
    /// Operator `b` ([`COEFFICIENTS`] × ndof, column-major) of the coefficients: area means over the points `plane`.
    ///
    /// # Errors
    /// A Jacobian that is not positive at a point.
    fn coefficients(&self, cell: &Cell<'_>, plane: &[Point], b: &mut [f64]) -> Result<(), ElementError>;

    /// Share of each coefficient in each mean strain of a part of a cell with these plies; the same on triangles and quadrilaterals.
    fn shares(&self, stack: &Stack, part: &Part) -> [[f64; COEFFICIENTS]; 6];
}
