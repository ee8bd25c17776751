//! Natural frequencies against exact elasticity and thin-plate theory.

use super::scene::Side::{self, Supported, Symmetric};
use super::scene::{AS4, Cells, PAGANO, Plate, gmsh_cells, isotropic, reference};

/// The first frequencies of a plate, relative.
const FREQUENCY: f64 = 1e-3;
/// The same on coarse meshes and against thin-plate theory.
const COARSE: f64 = 5e-3;
/// The report's trilinear inertia functions.
const LINEAR_MASS: f64 = 2e-2;
/// Frequencies that a symmetry makes equal, and those of a scaled plate; what is zero, relative to the first that is not.
const SAME: f64 = 1e-6;
const ZERO: f64 = 1e-3;

/// Compares the `ranks` lowest frequencies of a plate of side a = `ratio` h with a table. Each class of symmetry is a
/// quarter of the plate: planes in the middle are ones of symmetry for an odd number of half-waves, else of antisymmetry.
///
/// The tables hold m, n ≤ 3, so that only so many ranks are known: (1,4) comes next.
fn check(table: &str, plies: &str, ply: f64, layers: usize, ratio: f64, cells: usize, ranks: usize) {
    let plate = Plate::new(PAGANO, plies, ply, vec![1; layers]).rectangle([0.5 * ratio; 2], [cells; 2]);
    check_plate(&plate, table, ratio, ranks);
}

fn check_plate(plate: &Plate, table: &str, ratio: f64, ranks: usize) {
    let classes = [Symmetric, Supported].map(|x| [Symmetric, Supported].map(|y| [Supported, x, Supported, y]));
    let found = |sides: &[Side; 4]| plate.clone().sides(*sides).frequencies(6);
    let mut omega: Vec<f64> = classes.as_flattened().iter().flat_map(found).collect();
    omega.sort_by(f64::total_cmp);
    let rows = reference(table);
    for row in rows.iter().filter(|r| r["a_over_h"] == ratio && r["rank"] <= ranks as f64) {
        let got = omega[row["rank"] as usize - 1];
        let want = row["omega_rad_per_s"];
        assert!((got / want - 1.0).abs() < FREQUENCY, "({}, {}): {got} {want}", row["m"], row["n"]);
    }
}

#[test]
fn three_plies_thick() {
    check("vib3d_0_90_0_pag25.csv", "[0/90/0]", 1.0 / 3.0, 3, 4.0, 6, 10);
}

#[test]
fn three_plies_moderately_thick() {
    check("vib3d_0_90_0_pag25.csv", "[0/90/0]", 1.0 / 3.0, 3, 10.0, 5, 10);
}

#[test]
fn three_plies_by_cells_of_both_shapes() {
    for (ratio, cells) in [(4.0, Cells::Triangles), (10.0, Cells::Triangles), (10.0, Cells::Mixed)] {
        let lines: Vec<f64> = (0..=8).map(|i| 0.5 * ratio * f64::from(i) / 8.0).collect();
        let mesh = gmsh_cells(&lines, &lines, 0.1, cells);
        let plate = Plate::new(PAGANO, "[0/90/0]", 1.0 / 3.0, vec![1; 3]).rectangle([0.5 * ratio; 2], [8; 2]);
        check_plate(&plate.on(&mesh), "vib3d_0_90_0_pag25.csv", ratio, 10);
    }
}

#[test]
fn three_plies_rather_thin() {
    check("vib3d_0_90_0_pag25.csv", "[0/90/0]", 1.0 / 3.0, 3, 20.0, 5, 8);
}

#[test]
#[ignore = "three seconds"]
fn four_plies_thick() {
    check("vib3d_0_90_90_0_pag25.csv", "[0_2/90_2]s", 0.125, 8, 4.0, 5, 10);
}

#[test]
fn four_plies_moderately_thick() {
    check("vib3d_0_90_90_0_pag25.csv", "[0/90]s", 0.25, 4, 10.0, 5, 10);
}

/// A whole strip of the section element: its first frequency is the slide along x, which nothing holds. Tables hold up to
/// five half-waves.
fn strip(table: &str, state: &str, plate: Plate, thickness: f64, ratio: f64, ranks: usize) {
    let element = format!("kind = 'webster-beam', state = '{state}', z_derivatives = 'layer-wise'");
    let plate = plate.element(&element).rectangle([ratio * thickness, 1.0], [30, 1]);
    let omega = plate.sides([Supported, Supported, Side::Free, Side::Free]).frequencies(ranks + 1);
    assert!(omega[0] < ZERO * omega[1], "{omega:?}");
    for row in reference(table).iter().filter(|r| r["a_over_h"] == ratio && r["rank"] <= ranks as f64) {
        let (got, want) = (omega[row["rank"] as usize], row["omega_rad_per_s"]);
        assert!((got / want - 1.0).abs() < FREQUENCY, "{state}, {} half-waves: {got} {want}", row["m"]);
    }
}

#[test]
fn strips_in_plane_strain_and_plane_stress() {
    // At a/h = 4 the shear without a half-wave comes next, which the tables leave out.
    for (ratio, ranks) in [(4.0, 3), (10.0, 5)] {
        let three = Plate::new(PAGANO, "[0_2/90_2/0_2]", 1.0 / 6.0, vec![1; 6]);
        strip("vib2d_cylbend_0_90_0_pag25.csv", "plane-strain", three, 1.0, ratio, ranks);
        let eight = Plate::new(AS4, "[0/90/0/90]s", 0.13, vec![1; 8]);
        strip("vib2d_planestress_xply8_as4.csv", "plane-stress", eight, 1.04, ratio, ranks);
    }
}

/// A steel plate of 80 x 80 x 8 mm on supports all around.
fn steel() -> Plate {
    Plate::new(&isotropic(206.0, 0.3, 7.9), "[0]", 8.0, vec![1]).rectangle([80.0; 2], [6; 2]).sides([Supported; 4])
}

#[test]
fn equal_frequencies_of_a_square_plate_are_all_found() {
    let omega = steel().frequencies(6);
    let rows = reference("vib3d_iso_steel.csv");
    for (got, row) in omega.iter().zip(rows.iter().filter(|r| r["a_over_h"] == 10.0)) {
        assert!((got / row["omega_rad_per_s"] - 1.0).abs() < COARSE, "{omega:?}");
    }
    for [a, b] in [[1, 2], [3, 4]] {
        assert!((omega[a] / omega[b] - 1.0).abs() < SAME, "{omega:?}");
    }
}

#[test]
fn linear_inertia_functions_leave_few_modes_and_those_right() {
    let exact = reference("vib3d_iso_steel.csv")[0]["omega_rad_per_s"];
    let fine =
        |keys: &str| steel().rectangle([40.0; 2], [6; 2]).element(keys).sides(super::scene::QUARTER).frequencies(4);
    let (linear, cubic) = (fine("mass = 'linear'"), fine("mass = 'cubic'"));
    assert!(linear.iter().all(|omega| omega.is_finite() && *omega > 0.0), "{linear:?}");
    assert!((linear[0] / exact - 1.0).abs() < LINEAR_MASS, "{linear:?} {exact}");
    assert!(linear[0] > cubic[0], "{linear:?} {cubic:?}");
}

#[test]
fn a_free_plate_has_six_rigid_motions_and_then_bends() {
    // ω a² √(ρh/D) = 13.468 for a thin free square plate, ν = 0.3.
    let (side, gpa, density) = (100.0, 70.0, 2.7);
    let free = |scale: f64, stiffer: f64| {
        Plate::new(&isotropic(stiffer * gpa, 0.3, density), "[0]", scale, vec![1])
            .rectangle([scale * side; 2], [6; 2])
            .sides([Side::Free; 4])
            .frequencies(7)
    };
    let omega = free(1.0, 1.0);
    assert!(omega[..6].iter().all(|rigid| *rigid < ZERO * omega[6]), "{omega:?}");
    let d = gpa * 1e9 * 1e-9 / (12.0 * (1.0 - 0.09));
    let want = 13.468 / 0.01 * (d / (density * 1e3 * 1e-3)).sqrt();
    assert!((omega[6] / want - 1.0).abs() < COARSE, "{} {want}", omega[6]);
    // A thousand times as large, a million times as stiff: ω ∝ √(E/ρ)/L.
    let scaled = free(1e3, 1e6);
    assert!(scaled[..6].iter().all(|rigid| *rigid < ZERO * scaled[6]), "{scaled:?}");
    assert!((scaled[6] / omega[6] - 1.0).abs() < SAME, "{} {}", scaled[6], omega[6]);
}
