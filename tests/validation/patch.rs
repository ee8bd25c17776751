//! A smooth load on a small square in the middle of a plate of eight plies, against harmonics of exact elasticity.

use super::scene::{AS4, MeshFile, Plate, Row, farthest, gmsh_grid, largest, reference};
use std::f64::consts::PI;

/// Every displacement and stress at every station, relative to the largest of its column.
const STATION: f64 = 2e-2;

const SIDE: f64 = 25.0;
const LOADED: f64 = 4.0;

/// Half the side: the middle of the plate.
pub(super) const HALF: f64 = 0.5 * SIDE;
/// Edge of the load.
const EDGE: f64 = 0.5 * (SIDE - LOADED);

pub(super) fn exact() -> Vec<Row> {
    reference("patch3d_xply8_as4_25x25_c4.csv")
}

/// Lines of cells at `outside` and equal cells in the loaded square.
pub(super) fn mesh(outside: &[f64], inside: usize) -> MeshFile {
    let fine = (0..=inside).map(|i| EDGE + (HALF - EDGE) * i as f64 / inside as f64);
    let lines: Vec<f64> = outside.iter().copied().chain(fine).collect();
    gmsh_grid(&lines, &lines, 0.0)
}

/// A quarter of the plate under its load.
pub(super) fn plate(mesh: &MeshFile) -> Plate {
    let wave = PI / LOADED;
    let bump = |x: &str| format!("({x} > {EDGE})*cos({wave}*({x} - {HALF}))^2");
    let formula = format!("100*{}*{}", bump("x"), bump("y"));
    Plate::new(AS4, "[0/90/0/90]s", 0.13, vec![1; 8]).on(mesh).pressure(&formula)
}

/// A quarter of the plate: lines of cells at `outside` and equal cells in the loaded square. Per column of the table,
/// the largest error.
///
/// | cells a side | unknowns | σ₁₁ | σ₂₂ | σ₃₃ | σ₁₂ | τ₁₃ | τ₂₃ |
/// |---|---|---|---|---|---|---|---|
/// | 12, equal | 18 792 | 1.3e-2 | 9.9e-3 | 2.1e-2 | 9.4e-3 | 1.1e-1 | 8.0e-2 |
/// | 7 outside, 4 of 0.50 mm inside | 15 807 | 1.8e-3 | 1.8e-3 | 4.5e-3 | 5.0e-3 | 2.0e-2 | 1.4e-2 |
/// | 8 outside, 6 of 0.33 mm inside | 25 536 | 7.6e-4 | 7.5e-4 | 2.3e-3 | 3.3e-3 | 8.0e-3 | 5.3e-3 |
/// | 9 outside, 8 of 0.25 mm inside | 37 587 | 4.3e-4 | 4.2e-4 | 1.8e-3 | 2.4e-3 | 4.7e-3 | 3.1e-3 |
///
/// Transverse shear from equilibrium is far off here (7e-2 on the third mesh): its cubic fit is wider than the load.
fn errors(outside: &[f64], inside: usize) -> Vec<(&'static str, f64)> {
    let rows = exact();
    let mesh = mesh(outside, inside);
    let mut stations: Vec<[f64; 2]> = rows.iter().map(|r| [r["x_mm"], r["y_mm"]]).collect();
    stations.dedup();
    // The stations lie in another quarter.
    let mirrored = |plate: Plate, s: &[f64; 2]| plate.profile([SIDE - s[0], SIDE - s[1]], 5);
    let solution = stations.iter().fold(plate(&mesh), mirrored).solve();
    let columns = [
        ("w_mm", 1e3, 0),
        ("sx_MPa", 1e-6, 0),
        ("sy_MPa", 1e-6, 1),
        ("sz_MPa", 1e-6, 2),
        ("txy_MPa", 1e-6, 3),
        ("tyz_MPa", -1e-6, 4),
        ("txz_MPa", -1e-6, 5),
    ];
    let worst = |(column, unit, k): (&'static str, f64, usize)| {
        let at = |(station, profile): (&[f64; 2], _)| {
            let rows = rows.iter().filter(|r| *station == [r["x_mm"], r["y_mm"]]);
            farthest(rows, column, ("z_mm", 1.0), 1, profile, |p| {
                unit * if column == "w_mm" { p.displacement[2] } else { p.global.0[k] }
            })
        };
        let each = stations.iter().zip(solution.profiles.iter().map(Vec::as_slice)).map(at);
        (column, each.fold(0.0, f64::max) / largest(&rows, column))
    };
    columns.map(worst).to_vec()
}

#[test]
#[ignore = "five seconds"]
fn every_station_of_a_smooth_patch_load() {
    let e = errors(&[0.0, 2.0, 4.0, 6.0, 7.5, 8.5, 9.25, 10.0], 6);
    assert!(e.iter().all(|(_, e)| *e < STATION), "{e:?}");
}

#[test]
fn deflection_and_in_plane_stress_of_a_smooth_patch_load() {
    let e = errors(&[0.0, 3.0, 6.0, 8.0, 9.5], 4);
    assert!(e.iter().filter(|(column, _)| !column.starts_with('t')).all(|(_, e)| *e < STATION), "{e:?}");
}
