//! The contract of an element under large deflections.

use crate::contracts::element::{Cell, ElementError, Part, Point, Scratch};
use std::fmt::Debug;

/// What an element offers besides its linear matrices where membrane stiffening is asked for.
///
/// Strains are Green and Lagrange's, E = ½ (H + Hᵀ + Hᵀ H) with H = ∂u/∂X in the plate's frame before deformation; stresses
/// S = C (E − ε₀), ε₀ the free strains, are the second ones of Piola and Kirchhoff, on the plies' axes as they turn with the cell. Strains are small,
/// displacements and rotations are not.
///
/// At u = 0 without free strains the tangent is the stiffness of [`crate::contracts::element::Element::stiffness`] up to the quadrature
/// through the plies.
pub trait LargeDeflection: Debug {
    /// Internal force f = ∂W/∂u (N, conjugate to the unknowns) at the displacements `u` (both ndof), W = Σ over plies
    /// ∫ ½ (E − ε₀)ᵀ C (E − ε₀) dV; and the tangent ∂f/∂u (ndof × ndof, symmetric) where it is asked for. Returns W, J.
    ///
    /// # Errors
    /// A Jacobian that is not positive at a Gauss point.
    fn internal(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, ElementError>;

    /// Geometric stiffness `kg` (ndof × ndof, symmetric) of the stresses σ = C (ε − ε₀) of small displacements `u`: what they add to
    /// the stiffness of small displacements on top, Σ over plies ∫ σ : ∇δuᵀ ∇δu dV, J per unknown squared.
    ///
    /// A solid has the gradients of all displacements in it; a shell those of its deflection alone, which is von Kármán's.
    ///
    /// # Errors
    /// As [`LargeDeflection::internal`].
    fn geometric_stiffness(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        kg: &mut [f64],
    ) -> Result<(), ElementError>;

    /// E in the ply `slice` at natural point `xi`, engineering shears.
    ///
    /// # Errors
    /// As [`LargeDeflection::internal`].
    fn large_strain(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], u: &[f64]) -> Result<[f64; 6], ElementError>;

    /// Means of E over parts of the cell (report eqs 12, 14) and, in the plane, over the points `plane`, for the displacements `u` of
    /// one field or of several, one after the other; engineering shears: `strains` holds six per part, field by field.
    ///
    /// # Errors
    /// As [`LargeDeflection::internal`].
    fn mean_large_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        u: &[f64],
        strains: &mut [f64],
    ) -> Result<(), ElementError>;
}

/// E of a displacement gradient `h[i][j]` = ∂uᵢ/∂Xⱼ, in the order 11 22 33 12 23 31, engineering shears.
#[inline]
pub fn green_lagrange(h: &[[f64; 3]; 3]) -> [f64; 6] {
    let product = |a: usize, b: usize| (0..3).map(|i| h[i][a] * h[i][b]).sum::<f64>();
    let normal = |a: usize| h[a][a] + 0.5 * product(a, a);
    let shear = |a: usize, b: usize| h[a][b] + h[b][a] + product(a, b);
    [normal(0), normal(1), normal(2), shear(0, 1), shear(1, 2), shear(2, 0)]
}
