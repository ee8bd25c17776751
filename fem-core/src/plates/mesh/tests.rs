use super::{Curves, Group, PlaneMesh};
use crate::words::domain::Corners;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

/// Cells between two rings of as many nodes, each closed, the inner ring first; groups `inner` and `outer` of edges.
fn ring(inner: &[[f64; 2]], outer: &[[f64; 2]]) -> PlaneMesh {
    let n = inner.len() as u32;
    let next = |i: u32| (i + 1) % n;
    let edges = |from: u32| Group {
        dim: 1,
        nodes: (from..from + n).collect(),
        edges: (0..n).map(|i| [from + i, from + next(i)]).collect(),
        ..Group::default()
    };
    PlaneMesh {
        points: [inner, outer].concat(),
        quads: (0..n).map(|i| [i, n + i, n + next(i), next(i)].into()).collect(),
        groups: [("inner".to_owned(), edges(0)), ("outer".to_owned(), edges(n))].into(),
        node_tags: (1..=2 * u64::from(n)).collect(),
        quad_tags: (1..=u64::from(n)).collect(),
        ..PlaneMesh::default()
    }
}

fn on_ellipse(radii: [f64; 2], angles: &[f64]) -> Vec<[f64; 2]> {
    angles.iter().map(|t| [radii[0] * t.cos(), radii[1] * t.sin()]).collect()
}

fn even(n: usize) -> Vec<f64> {
    (0..n).map(|i| TAU * i as f64 / n as f64).collect()
}

/// A disc of radius 1: a square of 3 x 3 cells in a ring, whose inner nodes lie nowhere special.
fn disc() -> PlaneMesh {
    let square = [-0.4, -0.15, 0.15, 0.4];
    let mut mesh = PlaneMesh::rectangle(&square, &square);
    let rim: Vec<u32> = vec![0, 1, 2, 3, 7, 11, 15, 14, 13, 12, 8, 4];
    let angles: Vec<f64> = even(12).iter().map(|t| t - 0.75 * PI).collect();
    mesh.points.extend(on_ellipse([1.0; 2], &angles));
    let outer = |i: usize| 16 + (i % 12) as u32;
    mesh.quads.extend((0..12).map(|i| [rim[i], outer(i), outer(i + 1), rim[(i + 1) % 12]]).map(Corners::from));
    mesh.node_tags = (1..=28).collect();
    mesh.quad_tags = (1..=21).collect();
    mesh
}

fn radius(p: &[f64; 2]) -> f64 {
    p[0].hypot(p[1])
}

fn times(mesh: PlaneMesh, curves: Curves, times: usize) -> PlaneMesh {
    (0..times).fold(mesh, |mesh, _| mesh.refined(curves))
}

fn boundary_nodes(mesh: &PlaneMesh) -> BTreeSet<u32> {
    mesh.boundary().into_iter().flatten().collect()
}

#[test]
fn a_circle_stays_a_circle_however_it_is_divided() {
    let angles = [0.0, 0.1, 0.5, 0.55, 1.1, 1.7, 1.75, 2.3, 2.9, 3.2, 3.9, 4.0, 4.6, 5.2, 5.25, 5.9];
    let mesh = ring(&on_ellipse([0.5; 2], &angles), &on_ellipse([1.0; 2], &angles));
    let fine = times(mesh, Curves::Kept, 3);
    for (group, r) in [("inner", 0.5), ("outer", 1.0)] {
        assert_eq!(fine.groups[group].nodes.len(), 8 * angles.len());
        for node in &fine.groups[group].nodes {
            let off = radius(&fine.points[*node as usize]) / r - 1.0;
            assert!(off.abs() < 1e-14, "{group}, node {node}: {off:e}");
        }
    }
}

#[test]
fn an_ellipse_is_met_at_fourth_order() {
    let radii = [2.0, 1.0];
    let distance = |n: usize| {
        let mesh = ring(&on_ellipse([1.0, 0.5], &even(n)), &on_ellipse(radii, &even(n)));
        let fine = mesh.refined(Curves::Kept);
        let off = |node: &u32| {
            let [x, y] = fine.points[*node as usize];
            let [gx, gy] = [x / radii[0].powi(2), y / radii[1].powi(2)];
            0.5 * (x * gx + y * gy - 1.0).abs() / gx.hypot(gy)
        };
        fine.groups["outer"].nodes.iter().map(off).fold(0.0, f64::max)
    };
    let [coarse, middle, fine] = [48, 96, 192].map(distance);
    assert!(coarse < 2e-4, "{coarse:e}");
    for (a, b) in [(coarse, middle), (middle, fine)] {
        assert!((a / b).log2() > 3.85, "{a:e} {b:e}: order {}", (a / b).log2());
    }
}

#[test]
fn the_area_of_a_disc_converges_or_stays_that_of_its_polygon() {
    let polygon = disc().area();
    let mut before = PI - polygon;
    for n in 1..5 {
        let kept = times(disc(), Curves::Kept, n);
        // Chords of half the length leave a quarter of the gap.
        let gap = PI - kept.area();
        assert!((before / gap - 4.0).abs() < 0.06, "{n}: {before} {gap}");
        before = gap;
        let straight = times(disc(), Curves::Straight, n);
        assert!((straight.area() / polygon - 1.0).abs() < 1e-13, "{n}");
        for mesh in [kept, straight] {
            // Of a disc, one node more than cells and half the edges along the boundary, by Euler's formula.
            assert_eq!((mesh.quads.len(), mesh.points.len()), (21 << (2 * n), (21 << (2 * n)) + 1 + (6 << n)));
            let worst = (0..mesh.quads.len()).map(|q| mesh.quality(q)).fold(0.0_f64, |m, q| m.max(q.largest_angle));
            assert!(worst < PI, "{n}: {worst}");
        }
    }
}

#[test]
fn lines_and_polygons_stay_straight() {
    let octagon = |r: f64| on_ellipse([r; 2], &even(8));
    let mesh = ring(&octagon(0.5), &octagon(1.0));
    assert_eq!(mesh.curved_turn(), 0.0);
    // They may stand for circles all the same, but not where a side has two edges, or on an ellipse.
    let circles = mesh.coarse_circles();
    let [inner, outer] = &circles[..] else { panic!("{circles:?}") };
    assert!([inner, outer].iter().all(|(middle, sides)| *sides == 8 && middle[0].hypot(middle[1]) < 1e-15));
    assert!(mesh.refined(Curves::Straight).coarse_circles().is_empty() && disc().coarse_circles().is_empty());
    assert!(ring(&on_ellipse([0.5, 0.4], &even(8)), &on_ellipse([1.0, 0.8], &even(8))).coarse_circles().is_empty());
    assert_eq!(mesh.refined(Curves::Kept), mesh.refined(Curves::Straight));

    // A slot with round ends, lines of two edges and arcs of `parts`.
    let slot = |half: f64, parts: u32, r: f64| -> Vec<[f64; 2]> {
        let arc = |side: f64| {
            let angles = (0..=parts).map(move |i| PI * (f64::from(i) / f64::from(parts) - 0.5));
            angles.map(move |t| [side * (half + r * t.cos()), side * r * t.sin()])
        };
        arc(1.0).chain([[0.0, r]]).chain(arc(-1.0)).chain([[0.0, -r]]).collect()
    };
    // The edges of the lines shorter than those of the arcs, as long and longer.
    for half in [0.2, (PI / 12.0).sin() * 2.0, 1.5] {
        // Turns of an eighth of a circle are corners.
        let coarse = ring(&slot(half, 4, 0.5), &slot(half, 4, 1.0));
        assert_eq!(coarse.refined(Curves::Kept), coarse.refined(Curves::Straight));
        let fine = times(ring(&slot(half, 6, 0.5), &slot(half, 6, 1.0)), Curves::Kept, 2);
        for (group, r) in [("inner", 0.5), ("outer", 1.0)] {
            for node in &fine.groups[group].nodes {
                let [x, y] = fine.points[*node as usize];
                let off = (x.abs() - half).max(0.0).hypot(y) - r;
                assert!(off.abs() < 1e-14, "{half} {group}: {off:e} at {x}, {y}");
            }
        }
    }
}

#[test]
fn curves_inside_are_those_of_groups_of_edges_and_around_groups_of_cells() {
    let angles = even(16);
    let rings = |names: &[&str]| {
        let [a, b, c] = [0.5, 1.0, 1.5].map(|r| on_ellipse([r; 2], &angles));
        let (mut mesh, outer) = (ring(&a, &b), ring(&b, &c));
        mesh.quads.extend(outer.quads.iter().map(|quad| quad.map(|n| n + 16)));
        mesh.points.extend(&outer.points[16..]);
        mesh.node_tags = (1..=48).collect();
        mesh.quad_tags = (1..=32).collect();
        let cells = Group { dim: 2, quads: (0..16).collect(), nodes: (0..32).collect(), ..Group::default() };
        mesh.groups.insert("cells".into(), cells);
        mesh.groups.retain(|name, _| names.contains(&&**name));
        mesh.refined(Curves::Kept)
    };
    let radii =
        |mesh: &PlaneMesh| -> BTreeSet<i64> { mesh.points.iter().map(|p| (radius(p) * 1e9).round() as i64).collect() };
    let without = radii(&rings(&[]));
    let chord = ((TAU / 32.0).cos() * 1e9).round() as i64;
    for group in ["outer", "cells"] {
        let with = radii(&rings(&[group]));
        assert!(with.contains(&1_000_000_000) && !with.contains(&chord), "{group} {with:?}");
    }
    assert!(without.contains(&chord), "{without:?}");
    // The middle of an arc that ends, by the end where it goes on.
    let mut arc = ring(&on_ellipse([0.5; 2], &angles), &on_ellipse([1.0; 2], &angles));
    arc.quads.truncate(5);
    arc.quad_tags.truncate(5);
    let fine = arc.refined(Curves::Kept);
    let ends = boundary_nodes(&fine);
    let on = |r: f64| ends.iter().filter(|n| (radius(&fine.points[**n as usize]) - r).abs() < 1e-14).count();
    assert_eq!((on(0.5), on(1.0)), (11, 11));
}

#[test]
fn cells_stay_convex_where_a_curve_is_coarse() {
    for thickness in [0.4, 0.1, 0.03, 0.001] {
        let angles = even(10);
        // Outside thin cells along a hole nothing bends.
        let [a, b, c] = [1.0, 1.0 + thickness, 2.0].map(|r| on_ellipse([r; 2], &angles));
        let (mut mesh, outer) = (ring(&a, &b), ring(&b, &c));
        mesh.quads.extend(outer.quads.iter().map(|quad| quad.map(|n| n + 10)));
        mesh.points.extend(&outer.points[10..]);
        mesh.node_tags = (1..=30).collect();
        mesh.quad_tags = (1..=20).collect();
        mesh.groups.clear();
        let fine = mesh.refined(Curves::Kept);
        for quad in 0..fine.quads.len() {
            let quality = fine.quality(quad);
            assert!(quality.area > 0.0 && quality.largest_angle < PI, "{thickness}: {quality:?}");
        }
        let inside = fine.points.iter().filter(|p| (radius(p) - (PI / 10.0).cos()).abs() < 1e-9).count();
        let chords = if thickness < 0.05 { 10 } else { 0 };
        assert_eq!(inside, chords, "{thickness}: the hole stays a polygon where it must");
    }
}

#[test]
fn groups_and_tags_keep_their_meaning() {
    let lines = |n: u32| -> Vec<f64> { (0..=n).map(f64::from).map(|i| 6.0 * i / f64::from(n)).collect() };
    let mut mesh = PlaneMesh::rectangle(&lines(3), &lines(2));
    let corner = Group { dim: 0, nodes: vec![5], ..Group::default() };
    mesh.groups.insert("point".into(), corner.clone());
    let left = Group { dim: 2, nodes: vec![0, 1, 4, 5], quads: vec![0], ..Group::default() };
    mesh.groups.insert("left".into(), left);
    mesh.node_tags[3] = 700;
    let fine = mesh.refined(Curves::Kept);
    let want = PlaneMesh::rectangle(&lines(6), &lines(4));
    let place = |p: [f64; 2]| p.map(|x| (x * 1e6).round() as i64);
    let places = |mesh: &PlaneMesh, nodes: &[u32]| -> BTreeSet<_> {
        nodes.iter().map(|n| place(mesh.points[*n as usize])).collect()
    };
    let cells = |mesh: &PlaneMesh, quads: &[u32]| -> BTreeSet<_> {
        quads.iter().map(|q| mesh.corners(*q as usize).map(place).to_vec()).collect()
    };
    let edges = |mesh: &PlaneMesh, group: &Group| -> BTreeSet<_> {
        group.edges.iter().map(|e| e.map(|n| place(mesh.points[n as usize]))).collect()
    };
    for (name, group) in &want.groups {
        let own = &fine.groups[name];
        assert_eq!(own.dim, group.dim);
        assert_eq!(places(&fine, &own.nodes), places(&want, &group.nodes), "{name}");
        assert_eq!(cells(&fine, &own.quads), cells(&want, &group.quads), "{name}");
        assert_eq!(edges(&fine, own), edges(&want, group), "{name}");
        assert!(own.nodes.is_sorted_by(|a, b| a < b), "{name}");
    }
    assert_eq!(fine.groups["point"], corner);
    assert_eq!((&fine.groups["left"].quads[..], fine.groups["left"].nodes.len()), (&[0, 1, 2, 3][..], 9));
    assert_eq!(fine.points[..12], mesh.points);
    assert_eq!((&fine.node_tags[..12], fine.node_tags[12]), (&mesh.node_tags[..], 701));
    assert_eq!(fine.node_tags.iter().collect::<BTreeSet<_>>().len(), 35);
    assert_eq!(fine.quad_tags[..8], [11, 12, 13, 14, 21, 22, 23, 24]);
    // Corner k of a cell stays corner k of its quarter k.
    assert!((0..24).all(|q| fine.quads[q][q % 4] == mesh.quads[q / 4][q % 4]));

    mesh.quad_tags[0] = u64::MAX;
    mesh.node_tags[0] = u64::MAX;
    assert_eq!(mesh.refined(Curves::Kept).quad_tags[3], u64::MAX);
}

proptest! {
    #[test]
    fn any_convex_mesh_is_divided_without_gap(jiggle in prop::collection::vec((-0.24..0.24_f64, -0.24..0.24_f64), 20), kept: bool) {
        let mut mesh = PlaneMesh::rectangle(&[0.0, 1.0, 2.0, 3.0, 4.0], &[0.0, 1.0, 2.0, 3.0]);
        for (p, (dx, dy)) in mesh.points.iter_mut().zip(&jiggle) {
            *p = [p[0] + dx, p[1] + dy];
        }
        let fine = mesh.refined(if kept { Curves::Kept } else { Curves::Straight });
        if !kept {
            prop_assert!((fine.area() / mesh.area() - 1.0).abs() < 1e-13);
            for (quad, part) in (0..48).map(|part| (part / 4, part)) {
                let c = mesh.corners(quad);
                for p in fine.corners(part) {
                    for k in 0..4 {
                        let (a, b) = (c[k], c[(k + 1) % 4]);
                        let left = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                        prop_assert!(left > -1e-14, "part {part} of cell {quad}: {left:e}");
                    }
                }
            }
        }
        for quad in 0..fine.quads.len() {
            let quality = fine.quality(quad);
            prop_assert!(quality.area > 0.0 && quality.largest_angle < PI, "{quality:?}");
        }
        // Twice as many edges along the boundary, each in the place of half an old one.
        prop_assert_eq!(fine.boundary().len(), 2 * mesh.boundary().len());
        prop_assert_eq!(fine.points.len(), 9 * 7);
    }
}

/// Parts of cells with bent sides lie where the cells' maps put them.
#[test]
fn bent_sides_stay_the_same_curves_when_cells_are_divided() {
    let mut mesh = PlaneMesh {
        points: vec![[0.0, 0.0], [2.0, 0.1], [2.2, 1.9], [0.1, 2.0], [3.6, 1.0]],
        quads: vec![[0, 1, 2, 3].into(), [1, 4, 2].into()],
        node_tags: (1..=5).collect(),
        quad_tags: vec![1, 2],
        ..PlaneMesh::default()
    };
    mesh.bends = [([0, 1], [0.1, -0.2]), ([1, 2], [0.15, 0.05]), ([2, 4], [0.1, 0.1])].into();
    for curves in [Curves::Kept, Curves::Straight] {
        let fine = mesh.refined(curves);
        assert!((fine.area() / mesh.area() - 1.0).abs() < 1e-14);
        for (quad, part) in (0..2).flat_map(|quad| (0..4).map(move |k| (quad, 4 * quad + k))) {
            let (whole, part) = (mesh.cell(quad), fine.cell(part));
            for at in part.domain().points(3).iter().map(|point| point.at) {
                // The map of a part is that of the cell, of natural coordinates that are linear in its own.
                let corners = part.map(|p| whole.locate(p).unwrap());
                let expected = whole.position(corners.position(at));
                let got = part.position(at);
                assert!((0..2).all(|d| (got[d] - expected[d]).abs() < 1e-12), "{got:?} {expected:?}");
            }
        }
    }
    assert_eq!(mesh.refined(Curves::Kept).bends.len(), 6 + 2 + 4);
}

/// The outline of a cell passes through the middle of a bent side, seen from either cell; its places by number are the same.
#[test]
fn bent_sides_are_drawn_bent() {
    let mut mesh = PlaneMesh::rectangle(&[0.0, 1.0, 2.0], &[0.0, 1.0]);
    assert_eq!(mesh.outline(0), mesh.corners(0).to_vec());
    assert_eq!(mesh.outlines().0, mesh.points);
    mesh.bends.insert([1, 4], [0.25, 0.0]);
    let (places, polygons) = mesh.outlines();
    assert_eq!(places.len(), mesh.points.len() + 7);
    for (quad, polygon) in polygons.iter().enumerate() {
        let outline = mesh.outline(quad);
        assert_eq!(outline.len(), 11);
        assert!(outline.contains(&[1.25, 0.5]));
        let apart =
            |(p, n): (&[f64; 2], &u32)| (0..2).map(|d| (p[d] - places[*n as usize][d]).abs()).fold(0.0, f64::max);
        assert!(outline.iter().zip(polygon).map(apart).fold(0.0, f64::max) < 1e-15, "{quad}");
    }
}
