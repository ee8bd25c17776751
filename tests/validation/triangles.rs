//! Triangles, alone and among quadrilaterals, within the bounds that quadrilaterals are held to.

use super::pagano::{EIGHT, FOUR, Mesh, THREE, check_cells};
use super::scene::Cells;

#[test]
fn three_plies_thick_moderately_thick_and_thin() {
    // Quadrilaterals need 8, 8 and 10 cells a side.
    for (ratio, mesh) in [(4.0, Mesh(8, 2)), (10.0, Mesh(10, 1)), (100.0, Mesh(24, 1))] {
        check_cells(&THREE, ratio, mesh, Cells::Triangles);
    }
}

#[test]
fn eight_plies_thick() {
    check_cells(&EIGHT, 4.0, Mesh(6, 1), Cells::Triangles);
}

#[test]
fn four_plies_moderately_thick_of_both_shapes() {
    check_cells(&FOUR, 10.0, Mesh(10, 1), Cells::Mixed);
}
