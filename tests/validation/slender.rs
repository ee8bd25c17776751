//! Thin plates of wide, flat cells: a quarter, simply supported, under sin(πx/a) sin(πy/a).

use super::scene::{PAGANO, Plate, isotropic};
use fem::analyses::statics;
use fem::{Error, output};
use std::f64::consts::PI;
use std::num::NonZeroUsize;

/// Deflection against Kirchhoff's theory (Navier's solution).
const KIRCHHOFF: f64 = 5e-3;

/// Deflection in the middle over that of a thin plate with bending stiffnesses `d` (11, 12, 22, 66; N m); thickness 1 mm.
fn ratio(plate: Plate, side: f64, cells: usize, d: [f64; 4]) -> f64 {
    quarter(plate, side, cells).solve().profiles[0][0].displacement[2] / navier(side, d)
}

fn quarter(plate: Plate, side: f64, cells: usize) -> Plate {
    let (half, wave) = (0.5 * side, PI / side);
    plate.rectangle([half; 2], [cells; 2]).pressure(&format!("-sin({wave}*x)*sin({wave}*y)")).profile([half; 2], 2)
}

fn navier(side: f64, [d11, d12, d22, d66]: [f64; 4]) -> f64 {
    1e6 * (side * 1e-3).powi(4) / (PI.powi(4) * (d11 + 2.0 * (d12 + 2.0 * d66) + d22))
}

/// Young's modulus, Pa, and Poisson's ratio.
const ALUMINIUM: [f64; 2] = [70e9, 0.3];

fn sheet(element: &str) -> Plate {
    let [e, nu] = ALUMINIUM;
    Plate::new(&isotropic(e * 1e-9, nu, 2.7), "[0]", 1.0, vec![1]).element(element)
}

fn sheet_bending() -> [f64; 4] {
    let [e, nu] = ALUMINIUM;
    let d = e * 1e-9 / (12.0 * (1.0 - nu * nu));
    [d, nu * d, d, 0.5 * (1.0 - nu) * d]
}

fn aluminium(element: &str, side: f64, cells: usize) -> f64 {
    ratio(sheet(element), side, cells, sheet_bending())
}

fn cross_ply(element: &str, side: f64, cells: usize) -> f64 {
    // Of a bending stiffness, seven eighths are of the outer half of the thickness.
    let (q11, q22, q12, q66) = (25e6 / 0.9975, 1e6 / 0.9975, 0.25e6 / 0.9975, 0.5e6);
    let (outer, inner) = (7.0 / 8.0, 1.0 / 8.0);
    let d = [outer * q11 + inner * q22, q12, outer * q22 + inner * q11, q66].map(|q| q * 1e-9 / 12.0);
    ratio(Plate::new(PAGANO, "[0/90]s", 0.25, vec![4]).element(element), side, cells, d)
}

#[track_caller]
fn near_one(ratio: f64) {
    assert!((ratio - 1.0).abs() < KIRCHHOFF, "{ratio}");
}

// Solids lock where cells are far wider than thick, the error ∝ (width/thickness)² (width/side)⁴: at a/h = 1000 and 4
// cells it is 18 %. From a/h ≈ 10 000 on, rounding alone is 1 % of the deflection (εa⁴/h⁴), on any mesh.

#[test]
fn solids_a_thousand_times_as_wide_as_thick() {
    near_one(aluminium("kind = 'hermite-prism'", 1e3, 8));
    near_one(aluminium("kind = 'hex20'", 1e3, 8));
    near_one(cross_ply("kind = 'hermite-prism'", 1e3, 12));
}

#[test]
fn shells_of_cells_a_thousand_times_as_wide_as_thick() {
    near_one(aluminium("kind = 'mitc4'", 2e4, 8));
    near_one(cross_ply("kind = 'mitc4'", 2e4, 8));
}

#[test]
fn a_plate_too_thin_for_solids_is_refused_or_warned_of() {
    for element in ["kind = 'hermite-prism'", "kind = 'hex20'"] {
        for (side, cells) in [(1e3, 4), (1e4, 8), (1e4, 16), (1e4, 24)] {
            let model = quarter(sheet(element), side, cells).model("static");
            match statics::solve(&model, NonZeroUsize::MIN) {
                Err(Error::IllConditioned { .. }) => {}
                Ok(solution) => {
                    let ratio = solution.profiles[0][0].displacement[2] / navier(side, sheet_bending());
                    let warnings = output::statics::StaticSummary::new(&model, &solution).warnings.join("; ");
                    let said = warnings.contains("bend too stiffly") || warnings.contains("ill-conditioned");
                    assert!(said || (ratio - 1.0).abs() < KIRCHHOFF, "{element}, {side} mm, {cells} cells: {ratio}");
                }
                Err(other) => panic!("{element}, {side} mm, {cells} cells: {other}"),
            }
        }
    }
}
