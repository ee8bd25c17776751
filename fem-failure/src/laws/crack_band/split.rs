//! What a ply keeps that is split as often as it will be.

use fem_core::material::Elastic;

/// Shares of σ11, σ22, σ33 and of the shears 12, 23, 13 that cracks take which run through a ply and stand as far apart as it is thick,
/// between plies that hold it.
///
/// Along the ply and across it, what a crack takes comes back by shear (parabolic shear lag; Tan and Nuismer 1989): tanh(x)/x is
/// missing, x² = 3 G23/E2 of σ22 and 3 G13/G12 of τ12. Under τ23 what stands between two cracks is a column as wide as high, clamped
/// at both ends, with the compliance 6/(5 G23) + 1/E2 in place of 1/G23 (Timoshenko).
pub(super) fn shares(e: &Elastic) -> ([f64; 3], [f64; 3]) {
    let missing = |square: f64| square.sqrt().tanh() / square.sqrt();
    let column = 1.0 - 1.0 / (1.2 + e.g23 / e.e2);
    ([1.0, missing(3.0 * e.g23 / e.e2), 0.0], [missing(3.0 * e.g13 / e.g12), column, 0.0])
}
