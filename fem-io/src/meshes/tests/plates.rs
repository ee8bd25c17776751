//! The plates of the examples, and the finer one for errors of geometry.

use std::f64::consts::{PI, TAU};

use super::*;

/// Largest inner angle, degrees.
const LARGEST_ANGLE: f64 = 135.0;

/// Cells, edges of the support.
fn circle(name: &str, radius: f64, cells: usize, edges: usize) {
    let mesh = plate(name, cells, edges);
    for n in &mesh.groups["support"].nodes {
        let [x, y] = mesh.points[*n as usize];
        assert!((x.hypot(y) / radius - 1.0).abs() < 1e-9, "{name}: node at {x}, {y}");
    }
    let n = edges as f64;
    let polygon = 0.5 * n * radius.powi(2) * (TAU / n).sin();
    assert!((mesh.area() / polygon - 1.0).abs() < 1e-9, "{name}: {} m2, polygon {polygon}", mesh.area());
    assert!((1.0 - mesh.area() / (PI * radius.powi(2))) < 0.003);
}

fn rectangle(name: &str) {
    let mesh = plate(name, 520, 92);
    assert!((mesh.area() / (0.127 * 0.0762) - 1.0).abs() < 1e-9, "{name}: {}", mesh.area());
    for n in &mesh.groups["support"].nodes {
        let [x, y] = mesh.points[*n as usize];
        let off = (x.abs() - 0.0635).abs().min((y.abs() - 0.0381).abs());
        assert!(off < 1e-12, "{name}: node at {x}, {y}");
    }
}

fn plate(name: &str, cells: usize, edges: usize) -> PlaneMesh {
    let file = if name.ends_with(".msh") { path(name) } else { path("../../../examples").join(name).join("plate.msh") };
    let FileMesh { mesh, warnings } = read(&file, 1e-3).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(warnings, [""; 0]);
    assert_eq!(mesh.groups.keys().collect::<Vec<_>>(), ["impact", "plate", "support"]);
    assert_eq!((mesh.quads.len(), mesh.groups["support"].edges.len()), (cells, edges), "{name}");
    let impact = &mesh.groups["impact"];
    assert_eq!((impact.dim, impact.nodes.len()), (0, 1));
    assert_eq!(mesh.points[impact.nodes[0] as usize], [0.0, 0.0]);
    for q in 0..cells {
        let quality = mesh.quality(q);
        assert!(quality.largest_angle.to_degrees() < LARGEST_ANGLE, "{name}: {quality:?}");
    }
    mesh
}

/// Longest and shortest edge of the cells at the impact point.
fn at_impact(mesh: &PlaneMesh) -> [f64; 2] {
    let node = mesh.groups["impact"].nodes[0];
    let mut range = [f64::INFINITY, 0.0];
    for q in (0..mesh.quads.len()).filter(|q| mesh.quads[*q].contains(&node)) {
        let p = mesh.corners(q);
        for i in 0..4 {
            let edge = (p[(i + 1) % 4][0] - p[i][0]).hypot(p[(i + 1) % 4][1] - p[i][1]);
            range = [edge.min(range[0]), edge.max(range[1])];
        }
    }
    range
}

#[test]
fn examples_on_a_circle() {
    circle("as4-3502-16ply-50mm", 0.025, 288, 48);
    circle("as4-3502-16ply-75mm", 0.0375, 384, 48);
    circle("as4-3502-8ply-25mm", 0.0125, 240, 48);
    circle("as4-3502-8ply-50mm", 0.025, 288, 48);
    circle("as4-3502-8ply-75mm", 0.0375, 384, 48);
    circle("circle-fine.msh", 0.025, 4 * 288, 96);
}

#[test]
fn examples_on_a_rectangle() {
    rectangle("im6-934-32ply-drop-weight");
    rectangle("im6-934-32ply-large-mass");
    rectangle("im6-934-32ply-small-mass");
}

#[test]
fn cells_at_the_impact_point_are_as_long_as_promised() {
    let names =
        [("as4-3502-16ply-75mm", 384, 48), ("as4-3502-8ply-25mm", 240, 48), ("im6-934-32ply-small-mass", 520, 92)];
    for (name, cells, edges) in names {
        let [short, long] = at_impact(&plate(name, cells, edges));
        assert!(short > 2.5e-3 && long < 2.545e-3, "{name}: {short} to {long}");
    }
    let [short, long] = at_impact(&plate("circle-fine.msh", 1152, 96));
    assert!(short > 1.26e-3 && long < 1.275e-3, "{short} to {long}");
}
