//! From checked nodes and elements to the mesh.

use std::collections::BTreeMap;

use fem_core::mesh::{Group, PlaneMesh};

use super::checks::check_flat;
use super::elements::Grouped;
use super::error::{FilePlace, MeshError, MeshFault};
use super::nodes::NodeTable;
use super::source::{Item, Source};

/// Stands for the number of a node that no cell uses.
const UNUSED: u32 = u32::MAX;

/// Numbers nodes and cells and fills the groups. Cells must be anticlockwise; elements of edges that no cell has both nodes of
/// are left for [`check_edges`](super::checks::check_edges) to refuse.
pub(super) fn mesh(
    source: &Source<'_>,
    nodes: &NodeTable,
    grouped: &Grouped<'_>,
    unit_metres: f64,
) -> Result<PlaneMesh, MeshError> {
    // 0 marks a node as used until the numbers are given out.
    let mut number = vec![UNUSED; nodes.0.len()];
    for node in grouped.cells.iter().flat_map(|cell| cell.nodes) {
        number[node as usize] = 0;
    }
    let used: Vec<u32> = (0..).zip(&number).filter(|(_, n)| **n != UNUSED).map(|(old, _)| old).collect();
    check_flat(source, nodes, &used)?;

    let mut mesh = PlaneMesh::default();
    for (new, old) in (0..).zip(&used) {
        number[*old as usize] = new;
        let point = nodes.plane(*old).map(|x| x * unit_metres);
        if let Some(value) = point.into_iter().find(|x| !x.is_finite()) {
            let fault = MeshFault::Coordinate { node: nodes.tag(*old), value };
            return Err(source.error(FilePlace::File, fault));
        }
        mesh.points.push(point);
        mesh.node_tags.push(nodes.tag(*old));
    }
    let mut groups = BTreeMap::new();
    let number = |old: u32| number[old as usize];
    for (i, cell) in (0..).zip(&grouped.cells) {
        let corners = cell.nodes.map(number);
        mesh.quads.push(corners);
        mesh.quad_tags.push(cell.tag);
        for name in cell.groups {
            let group = member(&mut groups, name, 2);
            group.quads.push(i);
            group.nodes.extend(corners);
        }
    }
    for edge in &grouped.edges {
        let ends = edge.nodes.map(number);
        for name in edge.groups.iter().filter(|_| !ends.contains(&UNUSED)) {
            let group = member(&mut groups, name, 1);
            group.edges.push(ends);
            group.nodes.extend(ends);
        }
    }
    for point in &grouped.points {
        let [old] = point.nodes;
        for name in point.groups {
            if number(old) == UNUSED {
                let fault = MeshFault::NotACorner { node: nodes.tag(old), group: name.clone() };
                return Err(source.error(source.find(Item::Node(nodes.tag(old))), fault));
            }
            member(&mut groups, name, 0).nodes.push(number(old));
        }
    }
    for (name, mut group) in groups {
        group.nodes.sort_unstable();
        group.nodes.dedup();
        mesh.groups.insert(name.to_owned(), group);
    }
    Ok(mesh)
}

fn member<'m, 'g>(groups: &'m mut BTreeMap<&'g str, Group>, name: &'g str, dim: u8) -> &'m mut Group {
    groups.entry(name).or_insert_with(|| Group { dim, ..Group::default() })
}
