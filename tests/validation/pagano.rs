//! Cross-ply plates under a sine pressure (Pagano 1970): a quarter of the plate, derivatives along z layer by layer.

use super::scene::{AS4, Cells, MeshFile, PAGANO, Plate, Row, farthest, gmsh_cells, largest, order, reference};
use fem::core::profile::ProfilePoint;
use std::f64::consts::PI;

/// Deflection, relative to the largest.
const DEFLECTION: f64 = 1e-4;
/// σ₁₁, σ₂₂ and σ₁₂, relative to the largest of the column.
const IN_PLANE: f64 = 5e-3;
/// τ₁₃ and τ₂₃ at interfaces and in the middles of plies, relative to the largest of the column.
const SHEAR: f64 = 5e-3;
/// What is left of interlaminar shear's error where layers share derivatives along z, whatever the mesh.
const SHARED_SHEAR: f64 = 0.25;

/// Order in the size of cells of deflection and, at nodes, of in-plane stress: 4, not yet or more than reached by the
/// coarsest mesh.
const ORDER: std::ops::Range<f64> = 3.5..4.5;

/// A laminate of the reference tables.
pub(super) struct Laminate {
    pub(super) table: &'static str,
    pub(super) material: &'static str,
    pub(super) angles: &'static [u32],
    pub(super) ply: f64,
}

pub(super) const THREE: Laminate =
    Laminate { table: "pagano_bidir_0_90_0_pag25.csv", material: PAGANO, angles: &[0, 90, 0], ply: 1.0 / 3.0 };
pub(super) const FOUR: Laminate =
    Laminate { table: "pagano_bidir_0_90_90_0_pag25.csv", material: PAGANO, angles: &[0, 90, 90, 0], ply: 0.25 };
pub(super) const EIGHT: Laminate =
    Laminate { table: "pagano_bidir_xply8_as4.csv", material: AS4, angles: &[0, 90, 0, 90, 90, 0, 90, 0], ply: 0.13 };
pub(super) const SIXTEEN: Laminate = Laminate {
    table: "pagano_bidir_xply16_as4.csv",
    material: AS4,
    angles: &[0, 90, 0, 90, 0, 90, 0, 90, 90, 0, 90, 0, 90, 0, 90, 0],
    ply: 0.13,
};

/// Cells a side of the quarter, and layers of cells per ply.
#[derive(Clone, Copy)]
pub(super) struct Mesh(pub(super) usize, pub(super) usize);

/// Largest errors of a solution, each relative to the largest value of its column.
#[derive(Debug)]
struct Errors {
    deflection: f64,
    in_plane: f64,
    /// From strains.
    shear: f64,
    /// From equilibrium.
    equilibrium: f64,
}

impl Laminate {
    /// The exact solution for a plate of this ratio of side to height.
    pub(super) fn exact(&self, ratio: f64) -> Vec<Row> {
        reference(self.table).into_iter().filter(|r| r["a_over_h"] == ratio).collect()
    }

    /// mm.
    pub(super) fn height(&self) -> f64 {
        self.ply * self.angles.len() as f64
    }

    /// A quarter of that plate, with profiles of `points` per ply in the middle of the plate, of a side along y, of a side
    /// along x and in a corner.
    pub(super) fn plate(&self, ratio: f64, Mesh(cells, split): Mesh, points: usize) -> Plate {
        let a = ratio * self.height();
        let plies: Vec<String> = self.angles.iter().map(|angle| format!("{angle}_{split}")).collect();
        let (half, wave, layers) = (0.5 * a, PI / a, vec![1; self.angles.len() * split]);
        Plate::new(self.material, &format!("[{}]", plies.join("/")), self.ply / split as f64, layers)
            .rectangle([half; 2], [cells; 2])
            .pressure(&format!("-sin({wave}*x)*sin({wave}*y)"))
            .profile([half, half], points)
            .profile([0.0, half], points)
            .profile([half, 0.0], points)
            .profile([0.0, 0.0], points)
    }
}

fn errors(laminate: &Laminate, ratio: f64, mesh: Mesh, z_derivatives: &str) -> Errors {
    errors_on(laminate, ratio, (mesh, None), z_derivatives)
}

/// On a mesh of a file in place of equal rectangles, where there is one.
fn errors_on(laminate: &Laminate, ratio: f64, (mesh, file): (Mesh, Option<&MeshFile>), z_derivatives: &str) -> Errors {
    let (rows, h, split) = (laminate.exact(ratio), laminate.height(), mesh.1);
    let points = (rows.len() / laminate.angles.len() - 1) / split + 1;
    let plate = laminate.plate(ratio, mesh, points).element(&format!("z_derivatives = '{z_derivatives}'"));
    let solution = file.map_or(plate.clone(), |file| plate.on(file)).solve();
    let worst = |column: &str, profile: usize, value: &dyn Fn(&ProfilePoint) -> f64| {
        farthest(&rows, column, ("z_over_h", h), split, &solution.profiles[profile], value) / largest(&rows, column)
    };
    let stress = |column: &str, profile, k: usize| worst(column, profile, &|p| p.global.0[k] * 1e-6);
    let balance = |column: &str, profile, k: usize| worst(column, profile, &|p| p.equilibrium.unwrap()[k] * 1e-6);
    Errors {
        deflection: worst("W", 0, &|p| p.displacement[2] * 1e3),
        in_plane: stress("sx", 0, 0).max(stress("sy", 0, 1)).max(stress("txy", 3, 3)),
        shear: stress("txz", 1, 5).max(stress("tyz", 2, 4)),
        equilibrium: balance("txz", 1, 2).max(balance("tyz", 2, 1)),
    }
}

/// Shear from strains is good in thick plates; in thin ones, where it is small beside what strains can resolve, that
/// from equilibrium needs fewer cells.
#[track_caller]
fn check(laminate: &Laminate, ratio: f64, mesh: Mesh) {
    judge(ratio, &errors(laminate, ratio, mesh, "layer-wise"));
}

/// The same on triangles, or on triangles among quadrilaterals, of irregular shape.
#[track_caller]
pub(super) fn check_cells(laminate: &Laminate, ratio: f64, mesh: Mesh, cells: Cells) {
    let half = 0.5 * ratio * laminate.height();
    let lines: Vec<f64> = (0..=mesh.0).map(|i| half * i as f64 / mesh.0 as f64).collect();
    let file = gmsh_cells(&lines, &lines, 0.05, cells);
    judge(ratio, &errors_on(laminate, ratio, (mesh, Some(&file)), "layer-wise"));
}

#[track_caller]
fn judge(ratio: f64, e: &Errors) {
    assert!(e.deflection < DEFLECTION, "{e:?}");
    assert!(e.in_plane < IN_PLANE, "{e:?}");
    let shear = if ratio < 50.0 { e.shear } else { e.equilibrium };
    assert!(shear < SHEAR, "{e:?}");
}

#[test]
fn three_plies_thick() {
    check(&THREE, 4.0, Mesh(8, 2));
}

#[test]
fn three_plies_moderately_thick() {
    check(&THREE, 10.0, Mesh(8, 1));
}

#[test]
fn three_plies_thin() {
    check(&THREE, 100.0, Mesh(10, 1));
}

#[test]
fn four_plies_thick() {
    check(&FOUR, 4.0, Mesh(6, 2));
}

#[test]
fn four_plies_moderately_thick() {
    check(&FOUR, 10.0, Mesh(8, 1));
}

#[test]
fn four_plies_thin() {
    check(&FOUR, 100.0, Mesh(10, 1));
}

#[test]
fn eight_plies_thick() {
    check(&EIGHT, 4.0, Mesh(6, 1));
}

#[test]
fn eight_plies_moderately_thick() {
    check(&EIGHT, 10.0, Mesh(6, 1));
}

#[test]
fn eight_plies_thin() {
    check(&EIGHT, 100.0, Mesh(10, 1));
}

#[test]
fn sixteen_plies_thick() {
    check(&SIXTEEN, 4.0, Mesh(6, 1));
}

#[test]
fn sixteen_plies_moderately_thick() {
    check(&SIXTEEN, 10.0, Mesh(6, 1));
}

#[test]
#[ignore = "twelve seconds"]
fn sixteen_plies_thin() {
    check(&SIXTEEN, 100.0, Mesh(10, 1));
}

#[test]
fn thin_plates_have_good_shear_from_strains_too_on_finer_meshes() {
    let e = errors(&THREE, 100.0, Mesh(14, 1), "layer-wise");
    assert!(e.shear < SHEAR, "{e:?}");
}

#[test]
fn shared_derivatives_along_z_leave_an_error_of_interlaminar_shear_that_layer_wise_ones_remove() {
    for mesh in [Mesh(6, 1), Mesh(6, 2)] {
        let shared = errors(&FOUR, 10.0, mesh, "shared");
        assert!(shared.shear > SHARED_SHEAR, "{shared:?}");
        let own = errors(&FOUR, 10.0, mesh, "layer-wise");
        assert!(own.shear < 2.0 * SHEAR, "{own:?}");
    }
}

#[test]
fn errors_of_deflection_and_in_plane_stress_fall_at_fourth_order() {
    let n = [3, 4, 6, 8];
    let all: Vec<Errors> = n.iter().map(|n| errors(&THREE, 10.0, Mesh(*n, 2), "layer-wise")).collect();
    let slope = |e: fn(&Errors) -> f64| order(&n, &all.iter().map(e).collect::<Vec<_>>());
    let (deflection, in_plane) = (slope(|e| e.deflection), slope(|e| e.in_plane));
    assert!(ORDER.contains(&deflection), "deflection: order {deflection}, {all:?}");
    assert!(ORDER.contains(&in_plane), "in-plane stress: order {in_plane}, {all:?}");
}
