//! Plates whose thickness steps from region to region.

mod doubler;
mod refused;
mod strips;

use crate::support::{Case, plate};
use fem::core::mesh::{Group, PlaneMesh};
use fem::io::gmsh::{self, Encoding};
use std::collections::BTreeSet;

/// Whether the cell around a place belongs to a group, m.
type Inside<'a> = &'a dyn Fn([f64; 2]) -> bool;

/// A rectangle with lines of cells at `x` and `y`, mm, with groups of cells, and those of its edges that lie beside them:
/// `x-max NAME` and so on.
fn mesh(x: &[f64], y: &[f64], groups: &[(&str, Inside<'_>)]) -> Vec<u8> {
    let metres = |lines: &[f64]| -> Vec<f64> { lines.iter().map(|v| v * 1e-3).collect() };
    let mut mesh = PlaneMesh::rectangle(&metres(x), &metres(y));
    for (name, inside) in groups {
        let quads: Vec<u32> =
            (0..mesh.quads.len() as u32).filter(|quad| inside(mesh.corners(*quad as usize).centroid())).collect();
        let nodes: BTreeSet<u32> = quads.iter().flat_map(|quad| mesh.quads[*quad as usize]).collect();
        for side in ["y-min", "y-max"] {
            let beside = |edge: &&[u32; 2]| edge.iter().all(|node| nodes.contains(node));
            let edges: Vec<[u32; 2]> = mesh.groups[side].edges.iter().filter(beside).copied().collect();
            let nodes: BTreeSet<u32> = edges.iter().flatten().copied().collect();
            let group = Group { dim: 1, nodes: nodes.into_iter().collect(), edges, quads: Vec::new() };
            mesh.groups.insert(format!("{side} {name}"), group);
        }
        let group = Group { dim: 2, nodes: nodes.into_iter().collect(), quads, ..Group::default() };
        mesh.groups.insert((*name).to_owned(), group);
    }
    let mut file = Vec::new();
    gmsh::write(&mut file, &mesh, 1e-3, Encoding::Ascii).unwrap();
    file
}

/// From 0 to the last of `ends`, mm, which lie on lines of cells no wider than `size`.
fn lines(ends: &[f64], size: f64) -> Vec<f64> {
    let (mut all, mut from) = (vec![0.0], 0.0);
    for end in ends {
        let n = ((end - from) / size).ceil().max(1.0);
        all.extend((1..=n as usize).map(|i| from + (end - from) * i as f64 / n));
        from = *end;
    }
    all
}

fn case(text: &str, mesh: Vec<u8>) -> Case {
    plate().text(text).mesh_bytes(mesh)
}

/// What a refused scene says, in one line.
#[track_caller]
fn refusal(text: &str, mesh: Vec<u8>) -> String {
    let said = case(text, mesh).fem("check", &[]);
    assert_eq!(said.status, 1, "{said:#?}");
    said.stderr.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}
