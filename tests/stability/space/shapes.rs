//! Cells that are not squares.

use crate::case::{Case, Room};
use crate::plates::{
    HEX, SHELL, SOLIDS, cut, jiggled, middles, model, moved, on, probe, rectangle, said, solve, worst,
};
use crate::scene::{AS4, PAGANO, Plate, QUARTER, Side};
use fem::core::mesh::PlaneMesh;
use std::f64::consts::PI;

pub(super) fn cases() -> Vec<Case> {
    vec![
        Room::Space.case(
            "patch test on slender cells",
            "sides of cells to 1:1000, beside square ones; every element of plates",
            "error of a uniform stress, oblique to the fibres, in the middle of every cell",
            1e-5,
            || stretched(&slender(), &[SOLIDS[0], SOLIDS[1], SOLIDS[2], HEX, SHELL]),
        ),
        Room::Space.case(
            "patch test on shaken meshes",
            "inner nodes moved by up to 0.1 to 0.4 of the distance to the next; every element for such cells",
            "error of a uniform stress, oblique to the fibres, in the middle of every cell",
            1e-9,
            || worst([0.1, 0.2, 0.3, 0.4].map(|share| stretched(&jiggled(square(8), share), &GENERAL))),
        ),
        Room::Space.case(
            "patch test on nearly degenerate cells",
            "largest inner angle of every fourth cell from 90 to 174.9 degrees; every element for such cells",
            "error of a uniform stress, oblique to the fibres, in the middle of every cell",
            1e-9,
            || worst(ANGLES.map(|degrees| stretched(&pinched(square(8), degrees), &GENERAL))),
        ),
        Room::Space.case(
            "bending on slender cells",
            "sides of cells to 1:1000, beside square ones; every element of plates",
            "change of the deflection of a laminate that square cells give",
            1e-2,
            || bent(&slender(), &[SOLIDS[0], SOLIDS[1], SOLIDS[2], HEX, SHELL]),
        ),
        Room::Space.case(
            "bending on shaken meshes",
            "inner nodes moved by up to 0.1 to 0.4 of the distance to the next; every element for such cells",
            "change of the deflection of a laminate that square cells give",
            2e-2,
            || worst([0.1, 0.2, 0.3, 0.4].map(|share| bent(&jiggled(square(8), share), &GENERAL))),
        ),
        Room::Space.case(
            "bending on nearly degenerate cells",
            "largest inner angle of every fourth cell from 90 to 174.9 degrees; every element for such cells",
            "change of the deflection of a laminate that square cells give",
            5e-2,
            || worst(ANGLES.map(|degrees| bent(&pinched(square(8), degrees), &GENERAL))),
        ),
        Room::Space.case(
            "patch test on triangles among quadrilaterals",
            "cells cut in two or left whole, inner nodes moved by up to 0.1 and 0.4 of the distance to the next; every solid for cells of any shape",
            "error of a uniform stress, oblique to the fibres, in the middle of every cell",
            1e-9,
            || worst([0.1, 0.4].map(|share| stretched(&cut(jiggled(square(8), share)), &SOLIDS))),
        ),
        Room::Space.case(
            "bending on triangles among quadrilaterals",
            "cells cut in two or left whole, inner nodes moved by up to 0.1 and 0.4 of the distance to the next; every solid for cells of any shape",
            "change of the deflection of a laminate that square cells give",
            2e-2,
            || worst([0.1, 0.4].map(|share| bent(&cut(jiggled(square(8), share)), &SOLIDS))),
        ),
        Room::Space.case(
            "bending on slender triangles",
            "sides of cells to 1:1000, beside square ones, cut in two or left whole; every solid for cells of any shape",
            "change of the deflection of a laminate that square cells give",
            1e-2,
            || bent(&cut(slender()), &SOLIDS),
        ),
        Room::Space.case(
            "degenerate cells",
            "an inner angle from 176 to 270 degrees, nodes in one place or on one line, edges that cross",
            "meshes that are not refused with the number of the cell, or of the nodes in one place",
            0.0,
            degenerate,
        ),
    ]
}

/// Elements for cells of any shape.
const GENERAL: [&str; 4] = [SOLIDS[0], SOLIDS[1], SOLIDS[2], SHELL];
const ANGLES: [f64; 6] = [90.0, 120.0, 150.0, 165.0, 172.0, 174.9];

/// mm.
const SIDE: f64 = 20.0;

fn square(cells: usize) -> PlaneMesh {
    rectangle([SIDE; 2], [cells; 2])
}

/// Lines of which some are close together.
fn slender() -> PlaneMesh {
    let mut line: Vec<f64> = (0..=8).map(|i| SIDE * f64::from(i) / 8.0).collect();
    line.extend([0.0, 3.0, 5.0].map(|i| SIDE * (i + 1e-3) / 8.0));
    line.sort_by(f64::total_cmp);
    PlaneMesh::rectangle(&line, &line)
}

/// Every second node along x and y drawn towards the origin, so that an angle of its lower left cell has so many degrees.
fn pinched(mesh: PlaneMesh, degrees: f64) -> PlaneMesh {
    let cell = mesh.points[1][0];
    // The corner (s, s) of a unit square: the smaller s, the larger its angle.
    let angle = |s: f64| 2.0 * ((2.0 * s - 1.0) / (2.0 * ((1.0 - s).powi(2) + s * s)).sqrt()).acos().to_degrees();
    let (mut low, mut high) = (0.3, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if angle(middle) > degrees { low = middle } else { high = middle }
    }
    moved(mesh, |p| {
        let odd = p.map(|x| (x / cell).round() as i64 % 2 == 1);
        if odd == [true; 2] { p.map(|x| x - (1.0 - low) * cell) } else { p }
    })
}

/// Largest error of the stresses of a plate pulled along x, relative.
fn stretched(mesh: &PlaneMesh, elements: &[&str]) -> f64 {
    let of = |element: &&str| {
        let layers = if *element == SHELL { vec![2] } else { vec![1, 1] };
        let pull =
            |n: f64, group: &str| format!("force_per_length = ['{n} N/mm', '0 N/mm', '0 N/mm']\ngroup = '{group}'");
        let plate = Plate::new(AS4, "[30_2]", 0.5, layers).element(element).sides([Side::Free; 4]);
        let plate = plate.load(&pull(10.0, "x-max")).load(&pull(-10.0, "x-min"));
        let meshed = on(middles(mesh).into_iter().fold(plate, probe), mesh);
        let (_, solution) = solve(&meshed.plate.text("static")).unwrap();
        let points = solution.profiles.iter().flatten();
        // 10 N/mm over 1 mm.
        let off = points.flat_map(|p| [0, 1, 2, 3, 4, 5].map(|k| (p.global.0[k] * 1e-6 - [10.0, 0.0][k.min(1)]).abs()));
        worst(off) / 10.0
    };
    worst(elements.iter().map(of))
}

/// Change of the deflection in the middle of a quarter of a laminate under a sine pressure, against square cells.
fn bent(mesh: &PlaneMesh, elements: &[&str]) -> f64 {
    let of = |element: &&str| {
        let layers = if *element == SHELL { vec![3] } else { vec![1; 3] };
        let wave = PI / (2.0 * SIDE);
        let deflection = |mesh: &PlaneMesh| {
            let plate = Plate::new(PAGANO, "[0/90/0]", 2.0 * SIDE / 60.0, layers.clone())
                .element(element)
                .sides(QUARTER)
                .pressure(&format!("-sin({wave}*x)*sin({wave}*y)"));
            let meshed = on(probe(plate, [SIDE; 2]), mesh);
            solve(&meshed.plate.text("static")).unwrap().1.profiles[0][0].displacement[2]
        };
        (deflection(mesh) / deflection(&square(8)) - 1.0).abs()
    };
    worst(elements.iter().map(of))
}

fn degenerate() -> f64 {
    let one =
        |corner: [f64; 2]| moved(square(2), |p| if p == [0.5 * SIDE; 2] { corner.map(|x| x * 0.5 * SIDE) } else { p });
    let angles = [176.0, 178.0, 179.0, 179.99, 180.0, 190.0, 225.0, 250.0];
    let mut meshes: Vec<PlaneMesh> = angles.map(|degrees| pinched(square(2), degrees)).to_vec();
    // A cell without area, edges that cross.
    meshes.extend([one([0.0, 0.5]), one([0.5, 0.0]), one([-0.5, -0.5]), one([2.5, 1.0])]);
    // Two nodes in one place, or nearly so.
    let together = [one([0.0, 0.0]), one([1e-12, 1.0])];
    let refused = |mesh: &PlaneMesh, words: &str| {
        let meshed = on(Plate::new(AS4, "[0]", 1.0, vec![1]).pressure("1"), mesh);
        match model(&meshed.plate.text("static")) {
            Ok(_) => false,
            Err(error) => [words, "plate.msh", "mesh"].iter().all(|words| said(&error).contains(words)),
        }
    };
    let cell = |mesh: &&PlaneMesh| !refused(mesh, "cell ") && !refused(mesh, "cells ");
    let nodes = |mesh: &&PlaneMesh| !refused(mesh, "nodes ") && !refused(mesh, "cell ");
    (meshes.iter().filter(cell).count() + together.iter().filter(nodes).count()) as f64
}
