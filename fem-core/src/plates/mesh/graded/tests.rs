use super::*;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

const DISC: Graded = Graded {
    outline: Outline::Disc { radius: 25e-3 },
    support: None,
    window: None,
    impact: [0.0; 2],
    size: 1e-3,
    edge_size: 3e-3,
};
const RINGED: Graded = Graded { support: Some(20e-3), ..DISC };
const SQUARE: Graded = Graded { outline: Outline::Rectangle { sides: [50e-3; 2] }, ..RINGED };
const GRID: Graded = Graded { outline: Outline::Rectangle { sides: [100e-3, 60e-3] }, ..DISC };

fn radius(p: [f64; 2]) -> f64 {
    p[0].hypot(p[1])
}

fn lengths(mesh: &PlaneMesh, edges: &[[u32; 2]]) -> Vec<f64> {
    let at = |n: u32| mesh.points[n as usize];
    edges.iter().map(|[a, b]| (at(*a)[0] - at(*b)[0]).hypot(at(*a)[1] - at(*b)[1])).collect()
}

/// Smallest sine of an inner angle.
fn worst(mesh: &PlaneMesh) -> f64 {
    (0..mesh.quads.len()).map(|q| mesh.quality(q).scaled_jacobian).fold(1.0, f64::min)
}

/// What holds of every plate.
fn sound(plate: Graded) -> PlaneMesh {
    let mesh = plate.mesh().unwrap();
    assert_eq!(plate.cells(), Ok(mesh.quads.len()));
    assert_eq!(mesh.groups["plate"].quads.len(), mesh.quads.len());
    // No holes, no cracks: Euler's formula with the edges inside counted twice by cells.
    let boundary: BTreeSet<_> = mesh.boundary().into_iter().map(|[a, b]| [a.min(b), a.max(b)]).collect();
    assert_eq!(2 * mesh.points.len(), 2 * mesh.quads.len() + boundary.len() + 2, "{plate:?}");
    let edge: BTreeSet<_> = mesh.groups["edge"].edges.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
    assert_eq!(edge, boundary, "{plate:?}");
    let [struck] = mesh.groups["impact"].nodes[..] else { panic!("one node is struck") };
    let [x, y] = mesh.points[struck as usize];
    assert!((x - plate.impact[0]).hypot(y - plate.impact[1]) < 1e-12, "{plate:?}: {x}, {y}");
    let beside = mesh.quads.iter().filter(|quad| quad.contains(&struck));
    let beside: Vec<[u32; 2]> = beside.flat_map(|q| [0, 1, 2, 3].map(|i| [q[i], q[(i + 1) % 4]])).collect();
    let longest = |edges: &[[u32; 2]]| lengths(&mesh, edges).into_iter().fold(0.0, f64::max);
    // Off the middle, cells grow within those beside the node.
    let slack = 1.0 + 1e-9 + 0.15 * radius(plate.impact) / 12e-3;
    assert!(longest(&beside) <= plate.size * slack, "{plate:?}: {}", longest(&beside));
    if let Outline::Disc { .. } = plate.outline {
        assert!(longest(&mesh.groups["edge"].edges) <= plate.edge_size * (1.0 + 1e-9), "{plate:?}");
    }
    for group in mesh.groups.values() {
        assert!(group.nodes.is_sorted_by(|a, b| a < b));
    }
    mesh
}

#[test]
fn a_disc_has_its_area_circle_and_groups() {
    for (plate, names) in [(DISC, &["edge", "impact", "plate"][..]), (RINGED, &["edge", "impact", "plate", "support"])]
    {
        let mesh = sound(plate);
        assert_eq!(mesh.groups.keys().collect::<Vec<_>>(), names);
        let around = mesh.groups["edge"].edges.len() as f64;
        let polygon = 0.5 * around * 25e-3_f64.powi(2) * (TAU / around).sin();
        assert!((mesh.area() / polygon - 1.0).abs() < 1e-12);
        for (name, r) in [("edge", 25e-3), ("support", 20e-3)] {
            for node in mesh.groups.get(name).iter().flat_map(|group| &group.nodes) {
                assert!((radius(mesh.points[*node as usize]) / r - 1.0).abs() < 1e-14, "{name}");
            }
        }
        assert!(worst(&mesh) > 0.855, "{}", worst(&mesh));
        // At most 7.5 degrees from edge to edge.
        assert!(mesh.curved_turn() <= TAU / 48.0 * (1.0 + 1e-9), "{}", mesh.curved_turn());
    }
    let around = |edge_size: f64| sound(Graded { edge_size, ..DISC }).groups["edge"].edges.len();
    assert_eq!([around(50e-3), around(3.2e-3), around(2e-3)], [48, 56, 80], "multiples of 8 from 48 on");
}

#[test]
fn an_impact_off_the_middle_keeps_circles_and_angles() {
    for plate in [DISC, RINGED] {
        for impact in [[5e-3, 0.0], [-6e-3, 8e-3], [0.0, -12e-3]] {
            let mesh = sound(Graded { impact, ..plate });
            assert!(worst(&mesh) > 0.84, "{impact:?}: {}", worst(&mesh));
            assert!(mesh.area() / (PI * 25e-3_f64.powi(2)) > 0.997);
            for node in mesh.groups.get("support").iter().flat_map(|group| &group.nodes) {
                assert!((radius(mesh.points[*node as usize]) / 20e-3 - 1.0).abs() < 1e-14);
            }
        }
    }
}

#[test]
fn plates_over_a_ring() {
    let mesh = sound(SQUARE);
    assert!(worst(&mesh) > 0.7, "{}", worst(&mesh));
    assert!((mesh.area() / 25e-4 - 1.0).abs() < 1e-12);
    let support = &mesh.groups["support"];
    assert!(support.nodes.iter().all(|n| (radius(mesh.points[*n as usize]) / 20e-3 - 1.0).abs() < 1e-14));
    for (name, axis, at) in [("x-min", 0, -25e-3), ("x-max", 0, 25e-3), ("y-min", 1, -25e-3), ("y-max", 1, 25e-3)] {
        let side = &mesh.groups[name];
        assert!(side.nodes.iter().all(|n| (mesh.points[*n as usize][axis] - at).abs() < 1e-15), "{name}");
        assert!((lengths(&mesh, &side.edges).iter().sum::<f64>() - 50e-3).abs() < 1e-14, "{name}");
    }
}

#[test]
fn grids_grow_from_the_impact() {
    let mesh = sound(Graded { impact: [10e-3, -20e-3], ..GRID });
    assert!((worst(&mesh) - 1.0).abs() < 1e-12);
    assert!((mesh.area() / 60e-4 - 1.0).abs() < 1e-12);
    assert_eq!(mesh.bounds(), ([-50e-3, -30e-3], [50e-3, 30e-3]));
    for side in ["y-min", "y-max", "x-min", "x-max"] {
        let lengths = lengths(&mesh, &mesh.groups[side].edges);
        assert!(lengths.windows(2).all(|l| (1.0 / 1.3..1.3).contains(&(l[1] / l[0]))), "{side}: {lengths:?}");
        assert!(lengths.iter().all(|l| *l <= 3e-3 * (1.0 + 1e-9)), "{side}: {lengths:?}");
    }
    assert_eq!(sound(Graded { size: 5e-3, edge_size: 5e-3, ..GRID }).quads.len(), 20 * 12);
    sound(Graded { impact: [49.5e-3, 0.0], ..GRID });
}

/// Places of nodes and corners of cells in nanometres.
type Places = (BTreeSet<[i64; 2]>, BTreeSet<BTreeSet<[i64; 2]>>);

fn places(mesh: &PlaneMesh, map: impl Fn([f64; 2]) -> [f64; 2]) -> Places {
    let place = |p: [f64; 2]| map(p).map(|x| (x * 1e9).round() as i64);
    let cells = (0..mesh.quads.len()).map(|q| mesh.corners(q).map(place).into_iter().collect());
    (mesh.points.iter().map(|p| place(*p)).collect(), cells.collect())
}

#[test]
fn what_is_struck_in_the_middle_is_symmetric() {
    let long = Graded { outline: Outline::Rectangle { sides: [82e-3, 50e-3] }, ..SQUARE };
    for (plate, turns) in [(DISC, true), (RINGED, true), (SQUARE, true), (long, false), (GRID, false)] {
        let mesh = plate.mesh().unwrap();
        let own = places(&mesh, |p| p);
        assert_eq!(own.0.len(), mesh.points.len());
        assert_eq!(places(&mesh, |[x, y]| [-x, y]), own, "{plate:?}");
        assert_eq!(places(&mesh, |[x, y]| [x, -y]), own, "{plate:?}");
        assert_eq!(places(&mesh, |[x, y]| [-y, x]) == own, turns, "{plate:?}");
    }
    assert_eq!(DISC.mesh(), DISC.mesh());
}

#[test]
fn what_makes_no_plate_is_refused_by_its_key() {
    let sides = |x, y| Outline::Rectangle { sides: [x, y] };
    let cases = [
        (Graded { outline: Outline::Disc { radius: f64::NAN }, ..DISC }, "radius", "positive"),
        (Graded { outline: sides(0.1, -0.1), ..DISC }, "sides", "positive"),
        (Graded { outline: sides(0.11, 0.05), ..RINGED }, "sides", "at most 2 times"),
        (Graded { size: 0.0, ..DISC }, "size", "positive"),
        (Graded { edge_size: f64::INFINITY, ..DISC }, "edge_size", "positive"),
        (Graded { edge_size: 0.5e-3, ..DISC }, "edge_size", "smaller than `size`"),
        (Graded { support: Some(25e-3), ..DISC }, "support", "at most 23.75 mm"),
        (Graded { support: Some(24e-3), ..SQUARE }, "support", "hold the group `edge`"),
        (Graded { impact: [0.0, 16e-3], ..DISC }, "impact", "up to 15 mm"),
        (Graded { impact: [0.0, 13e-3], ..RINGED }, "impact", "lies 13 mm from the middle"),
        (Graded { impact: [f64::NAN, 0.0], ..DISC }, "impact", "NaN"),
        (Graded { impact: [f64::NAN, 0.0], ..GRID }, "impact", "off the plate"),
        (Graded { impact: [49.9e-3, 0.0], ..GRID }, "impact", "within half of `size`"),
        (Graded { size: 1e-6, edge_size: 1e-6, ..DISC }, "size", "more than 4000000"),
        (Graded { size: 1e-300, edge_size: 1e-290, ..DISC }, "edge_size", "more than 4000000"),
        (Graded { size: 1e-300, edge_size: 1e-300, ..GRID }, "edge_size", "more than 4000000"),
        (Graded { size: 1e-5, edge_size: 1e-5, ..GRID }, "size", "60000000 cells"),
    ];
    for (plate, key, words) in cases {
        let error = plate.mesh().unwrap_err();
        assert!(error.key == key && error.why.contains(words), "{plate:?}: {error}");
        assert_eq!(plate.cells(), Err(error));
    }
    assert!(Graded { size: 1e-300, ..DISC }.cells().is_ok_and(|n| n < 1_000_000), "few rings reach any size");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn any_plate_that_is_accepted_has_good_cells(
        round: bool, aspect in 0.5..2.0_f64, support in prop::option::of(0.1..0.95_f64),
        off in 0.0..0.6_f64, direction in 0.0..TAU, size in 1e-3..0.1_f64, growth in 1.0..8.0_f64,
    ) {
        let outline = if round { Outline::Disc { radius: 1.0 } } else { Outline::Rectangle { sides: [2.0, 2.0 * aspect] } };
        let inner = if round { 1.0 } else { aspect.min(1.0) };
        let close = support.is_some_and(|share| share > 0.9);
        let support = support.map(|share| share * inner);
        let off = off * support.unwrap_or(inner);
        let impact = [off * direction.cos(), off * direction.sin()];
        let plate = Graded { outline, support, window: None, impact, size: size.max(0.02), edge_size: growth * size.max(0.02) };
        if plate.cells().is_ok_and(|n| n < 100_000) {
            let mesh = plate.mesh().unwrap();
            // The smallest of 55 000 plates with rings close to the edge was 0.2496, of 28 000 with smaller ones 0.353.
            let least = if round {
                0.84
            } else if close {
                0.24
            } else {
                0.35
            };
            prop_assert!(worst(&mesh) > least, "{:?}: {}", plate, worst(&mesh));
            let inside = mesh.points.len() * 2 == 2 * mesh.quads.len() + mesh.boundary().len() + 2;
            prop_assert!(inside, "{:?}", plate);
        }
    }
}

#[test]
fn windows_are_lines_of_the_grid() {
    for impact in [[0.0; 2], [12e-3, -7e-3], [45e-3, 0.0]] {
        let mesh = sound(Graded { impact, window: Some([80e-3, 40e-3]), ..GRID });
        let window = &mesh.groups["window"];
        let on = |node: &u32| {
            let [x, y] = mesh.points[*node as usize];
            (x.abs() == 40e-3 && y.abs() <= 20e-3) || (y.abs() == 20e-3 && x.abs() <= 40e-3)
        };
        assert!(window.nodes.iter().all(on), "{impact:?}");
        let length = |[a, b]: &[u32; 2]| {
            let [p, q] = [a, b].map(|node| mesh.points[*node as usize]);
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        assert!((window.edges.iter().map(length).sum::<f64>() - 0.24).abs() < 1e-12, "{impact:?}");
    }
    for (plate, why) in [
        (Graded { window: Some([0.1, 0.04]), ..GRID }, "lies inside the plate"),
        (Graded { window: Some([0.01; 2]), ..DISC }, "is that of a rectangle"),
        (Graded { window: Some([0.01; 2]), ..SQUARE }, "exclude each other"),
    ] {
        let wrong = plate.mesh().unwrap_err();
        assert!(wrong.key == "window" && wrong.why.contains(why), "{wrong:?}");
    }
}
