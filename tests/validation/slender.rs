//! Plates ten thousand times as wide as thick, of cells a thousand times as wide as thick.

use super::scene::{PAGANO, Plate, isotropic};
use std::f64::consts::PI;

/// Deflection against Kirchhoff's theory (Navier's solution): nothing locks.
const KIRCHHOFF: f64 = 5e-3;

/// Thickness 1 mm, side 10 m, a quarter of 4 x 4 cells of 1.25 m: deflection in the middle under
/// sin(πx/a) sin(πy/a) MPa, m.
fn deflection(material: &str, plies: &str, ply_mm: f64) -> f64 {
    let (half, wave) = (5e3, PI / 1e4);
    let count = (1.0 / ply_mm).round() as usize;
    let plate = Plate::new(material, plies, ply_mm, vec![count])
        .rectangle([half; 2], [4, 4])
        .pressure(&format!("-sin({wave}*x)*sin({wave}*y)"))
        .profile([half; 2], 2);
    plate.solve().profiles[0][0].displacement[2]
}

/// q a⁴ / (π⁴ (D₁₁ + 2 (D₁₂ + 2 D₆₆) + D₂₂)) with q = 1 MPa, a = 10 m; D in N m.
fn navier([d11, d12, d22, d66]: [f64; 4]) -> f64 {
    1e6 * 1e16 / (PI.powi(4) * (d11 + 2.0 * (d12 + 2.0 * d66) + d22))
}

#[test]
fn an_isotropic_plate_does_not_lock() {
    let (e, nu) = (70e9, 0.3);
    let d = e * 1e-9 / (12.0 * (1.0 - nu * nu));
    let ratio = deflection(&isotropic(70.0, nu, 2.7), "[0]", 1.0) / navier([d, nu * d, d, 0.5 * (1.0 - nu) * d]);
    assert!((ratio - 1.0).abs() < KIRCHHOFF, "{ratio}");
}

#[test]
fn a_cross_ply_plate_does_not_lock() {
    // Reduced stiffnesses of Pagano's material; seven eighths of the bending stiffness are of the outer half.
    let (q11, q22, q12, q66) = (25e6 / 0.9975, 1e6 / 0.9975, 0.25e6 / 0.9975, 0.5e6);
    let (outer, inner) = (7.0 / 8.0, 1.0 / 8.0);
    let d = [outer * q11 + inner * q22, q12, outer * q22 + inner * q11, q66].map(|q| q * 1e-9 / 12.0);
    let ratio = deflection(PAGANO, "[0/90]s", 0.25) / navier(d);
    assert!((ratio - 1.0).abs() < KIRCHHOFF, "{ratio}");
}
