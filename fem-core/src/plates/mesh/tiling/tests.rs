use crate::plates::mesh::{Curves, Flaw, FlawKind, Group, PlaneMesh};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

fn line(from: f64, to: f64, cells: usize) -> Vec<f64> {
    (0..=cells).map(|i| from + (to - from) * i as f64 / cells as f64).collect()
}

/// A rectangle from `low` to `high`.
fn rectangle(low: [f64; 2], high: [f64; 2], cells: [usize; 2]) -> PlaneMesh {
    PlaneMesh::rectangle(&line(low[0], high[0], cells[0]), &line(low[1], high[1], cells[1]))
}

/// Both meshes in one, not joined.
fn beside(mut a: PlaneMesh, b: &PlaneMesh) -> PlaneMesh {
    let [nodes, cells] = [a.points.len() as u32, a.quads.len() as u32];
    a.points.extend(&b.points);
    a.quads.extend(b.quads.iter().map(|quad| quad.map(|n| n + nodes)));
    a.node_tags = (1..=a.points.len() as u64).collect();
    a.quad_tags = (1..=u64::from(cells) + b.quads.len() as u64).collect();
    a.groups.clear();
    a
}

/// The same with nodes at one place made one.
fn joined(mut mesh: PlaneMesh) -> PlaneMesh {
    let place = |p: [f64; 2]| p.map(|x| (x * 1e9).round() as i64);
    let places: Vec<_> = mesh.points.iter().map(|p| place(*p)).collect();
    let first = |n: u32| places.iter().position(|p| *p == places[n as usize]).unwrap() as u32;
    mesh.quads.iter_mut().for_each(|quad| *quad = quad.map(first));
    let used: Vec<u32> = mesh.quads.iter().flatten().copied().collect::<BTreeSet<u32>>().into_iter().collect();
    mesh.quads.iter_mut().for_each(|quad| *quad = quad.map(|n| used.binary_search(&n).unwrap() as u32));
    mesh.points = used.iter().map(|n| mesh.points[*n as usize]).collect();
    mesh.node_tags = (1..=mesh.points.len() as u64).collect();
    mesh
}

fn flaws(mesh: &PlaneMesh) -> Vec<Flaw> {
    mesh.flaws(&[])
}

fn kinds(mesh: &PlaneMesh) -> Vec<&'static str> {
    flaws(mesh).iter().map(|flaw| flaw.kind.name()).collect()
}

/// 10 cells against 11 along a side of which only the ends are shared.
#[test]
fn hanging_nodes_are_found_with_their_places() {
    let halves = |right: usize, y: f64| {
        let left = rectangle([0.0, 0.0], [1.0, 1.0], [10, 10]);
        joined(beside(left, &rectangle([1.0, y], [2.0, y + 1.0], [11, right])))
    };
    let found = flaws(&halves(11, 0.0));
    assert_eq!(found.len(), 9 + 10);
    assert!(found.iter().all(|flaw| matches!(flaw.kind, FlawKind::Hanging { .. }) && flaw.at[0] == 1.0));
    let heights: BTreeSet<i64> = found.iter().map(|flaw| (flaw.at[1] * 110.0).round() as i64).collect();
    let want = (1..10).map(|i| 11 * i).chain((1..11).map(|i| 10 * i));
    assert_eq!(heights, want.collect());
    assert_eq!(flaws(&halves(10, 0.0)), []);
    // With one end apart, and with coordinates of six digits.
    assert!(flaws(&halves(10, 0.03)).iter().all(|flaw| matches!(flaw.kind, FlawKind::Hanging { .. })));
    let mut rounded = halves(11, 0.0);
    rounded.points.iter_mut().flatten().for_each(|x| *x = (*x * 1e5).round() * 1e-5);
    assert_eq!(flaws(&rounded).len(), 19);
    // Half as many cells: only the finer ones have nodes between.
    assert_eq!(flaws(&halves(5, 0.0)).len(), 5);
}

#[test]
fn doubled_nodes_and_gaps() {
    let apart = |gap: f64| {
        let left = rectangle([0.0, 0.0], [1.0, 1.0], [4, 4]);
        beside(left, &rectangle([1.0 + gap, 0.0], [2.0 + gap, 1.0], [4, 4]))
    };
    for gap in [0.0, 1e-12, -1e-12, 1e-6, -1e-6, 1e-4] {
        assert_eq!(kinds(&apart(gap)), ["two nodes at one place"; 5], "{gap:e}");
    }
    // A gap that cells beside it resolve is one, and so is an overlap.
    assert_eq!(kinds(&apart(1e-2)), [""; 0]);
    assert!(!kinds(&apart(-1e-2)).is_empty());
}

#[test]
fn holes_notches_and_slits() {
    let square = rectangle([0.0, 0.0], [1.0, 1.0], [6, 6]);
    let without = |cells: &[usize]| {
        let mut mesh = square.clone();
        let mut k = 0;
        mesh.quads.retain(|_| {
            k += 1;
            !cells.contains(&(k - 1))
        });
        mesh.quad_tags.truncate(mesh.quads.len());
        mesh
    };
    for legal in [&[][..], &[14], &[14, 15, 20, 21], &[2, 8], &[0], &[14, 16]] {
        assert_eq!(kinds(&without(legal)), [""; 0], "{legal:?}");
    }
    let found = flaws(&without(&[14, 21]));
    assert_eq!(found.len(), 1);
    assert!(matches!(found[0].kind, FlawKind::Pinched { node: 24 }), "{found:?}");
    // A slit from the edge to the middle along y = 1/2: nodes 21 to 23 are doubled for the cells above, 24 is its tip.
    let mut slit = square.clone();
    let above = |n: u32| if (21..24).contains(&n) { n + 28 } else { n };
    slit.quads[18..].iter_mut().for_each(|quad| *quad = quad.map(above));
    slit.points.extend_from_within(21..24);
    slit.node_tags = (1..=52).collect();
    assert_eq!(kinds(&slit), ["two nodes at one place"; 3]);
    slit.groups.insert("slit".into(), Group { dim: 1, nodes: vec![21, 22, 23, 24], ..Group::default() });
    assert_eq!(slit.flaws(&["slit".into()]), []);
    assert_eq!(slit.refined(Curves::Kept).boundary().len(), 2 * slit.boundary().len());
}

#[test]
fn cells_over_each_other() {
    let square = rectangle([0.0, 0.0], [1.0, 1.0], [4, 4]);
    // A cell twice, whichever corner it begins with.
    let mut twice = square.clone();
    twice.quads.push(square.quads[5]);
    twice.quads[16].rotate_left(2);
    twice.quad_tags.push(17);
    let found = flaws(&twice);
    assert_eq!(found.len(), 4);
    assert!(found.iter().all(|flaw| matches!(flaw.kind, FlawKind::SameSide { cells: [5, 16], .. })), "{found:?}");
    // A small plate on a large one, within a cell of it and over several, and on a corner.
    for (low, high) in [([0.3, 0.3], [0.4, 0.45]), ([0.1, 0.2], [0.77, 0.9]), ([0.9, 0.9], [1.2, 1.3])] {
        for (under, over) in [(0, 1), (1, 0)] {
            let plates = [square.clone(), rectangle(low, high, [2, 3])];
            let found = kinds(&beside(plates[under].clone(), &plates[over]));
            assert!(!found.is_empty() && found.iter().all(|kind| *kind == "cells over each other"), "{found:?}");
        }
    }
    // Eight right angles around a node, as on a winding stair.
    let ring =
        |r: f64| (0..16).map(move |i| [r * (TAU * f64::from(i) / 8.0).cos(), r * (TAU * f64::from(i) / 8.0).sin()]);
    let mut stair = PlaneMesh { points: ring(1.0).chain([[0.0; 2]]).collect(), ..PlaneMesh::default() };
    stair.quads = (0..8).map(|i| [16, 2 * i, 2 * i + 1, (2 * i + 2) % 16].into()).collect();
    // The upper flight wider than the lower one, so that nothing else meets.
    stair.points.iter_mut().enumerate().for_each(|(i, p)| *p = p.map(|x| x * if i < 8 { 1.0 } else { 1.5 }));
    assert!(!kinds(&stair).is_empty());
}

proptest! {
    /// Rectangles anywhere, not joined: cells lie over each other if a point has two of them.
    #[test]
    fn cells_overlap_where_points_say_so(
        places in prop::collection::vec((0.0..8.0_f64, 0.0..8.0_f64, 0.5..4.0_f64, 0.5..4.0_f64), 2..5),
        turn in 0.0..1.5_f64,
    ) {
        let (s, c) = turn.sin_cos();
        let plates = places.iter().enumerate().map(|(k, (x, y, a, b))| {
            let mut plate = rectangle([*x, *y], [x + a, y + b], [1 + k, 2]);
            plate.points.iter_mut().filter(|_| k % 2 == 1).for_each(|p| *p = [c * p[0] - s * p[1], s * p[0] + c * p[1]]);
            plate
        });
        let mesh = plates.reduce(|a, b| beside(a, &b)).unwrap();
        let covered = |p: [f64; 2]| (0..mesh.quads.len()).filter(|q| mesh.corners(*q).locate(p).is_some()).count();
        // Points off the edges of cells.
        let inside = mesh.quads.iter().enumerate().flat_map(|(q, _)| {
            let mesh = &mesh;
            [-0.97, -0.5, 0.03, 0.51, 0.98].into_iter().flat_map(move |r| {
                [-0.96, -0.4, 0.02, 0.52, 0.99].into_iter().map(move |s| mesh.corners(q).position([r, s]))
            })
        });
        let over = inside.filter(|p| covered(*p) > 1).count();
        let found = kinds(&mesh);
        if over > 0 {
            prop_assert!(!found.is_empty(), "{over} points are covered twice");
        }
        let touching = found.iter().any(|kind| *kind != "cells over each other");
        if !found.is_empty() && !touching {
            // What was found is covered twice, right there.
            let found = flaws(&mesh);
            // Sectors between edges have their bisectors, however narrow they are.
            let bisectors = [0.5 * turn, 0.5 * turn + 0.25 * PI].map(|t| [0, 1, 2, 3].map(|k| t + 0.5 * PI * f64::from(k)));
            let directions: Vec<f64> =
                (0..40).map(|k| TAU * f64::from(k) / 40.0 + 0.0123).chain(bisectors.into_iter().flatten()).collect();
            let near = |flaw: &Flaw| {
                (1..=10).map(|k| 1e-6 * f64::from(k)).any(|r| {
                    let at = |t: &f64| [flaw.at[0] + r * t.cos(), flaw.at[1] + r * t.sin()];
                    directions.iter().map(at).any(|p| covered(p) > 1)
                })
            };
            prop_assert!(found.iter().all(near), "{found:?}");
        }
    }

    /// Any mesh of convex cells that was made of one is sound, and one node moved into another cell is not.
    #[test]
    fn shaken_meshes_are_sound(jiggle in prop::collection::vec((-0.24..0.24_f64, -0.24..0.24_f64), 30)) {
        let mut mesh = rectangle([0.0, 0.0], [5.0, 4.0], [5, 4]);
        for (p, (dx, dy)) in mesh.points.iter_mut().zip(&jiggle) {
            *p = [p[0] + dx, p[1] + dy];
        }
        prop_assert_eq!(kinds(&mesh), [""; 0]);
        prop_assert_eq!(mesh.pieces(), vec![0; 20]);
        prop_assert_eq!(kinds(&mesh.refined(Curves::Kept)), [""; 0]);
    }
}

#[test]
fn pieces_are_counted_in_the_order_of_their_cells() {
    let mut mesh = beside(rectangle([0.0; 2], [1.0; 2], [2, 1]), &rectangle([2.0, 0.0], [3.0, 1.0], [1, 1]));
    assert_eq!(mesh.pieces(), [0, 0, 1]);
    mesh.quads.swap(0, 2);
    assert_eq!(mesh.pieces(), [0, 1, 1]);
}
