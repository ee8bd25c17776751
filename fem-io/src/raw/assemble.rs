//! From checked nodes and elements to the mesh.

use std::collections::BTreeMap;

use fem_core::mesh::{Group, PlaneMesh};

use super::checks::check_flat;
use super::error::{MeshError, MeshFault};
use super::{Item, Places, Raw};

/// Stands for the number of a node that no cell uses.
const UNUSED: u32 = u32::MAX;

/// How far the middle of a straight side may lie off it, of its length: above the rounding of coordinates.
const STRAIGHT: f64 = 1e-6;

/// How far two nodes in the middle of one side may lie apart, of its length.
const ALIKE: f64 = 1e-6;

/// Numbers nodes and cells and fills the groups. Cells must be anticlockwise; elements of edges that no cell has both nodes of
/// are left for [`check_edges`](super::checks::check_edges) to refuse.
pub(super) fn mesh(places: &dyn Places, raw: &Raw, unit_metres: f64) -> Result<PlaneMesh, MeshError> {
    let nodes = &raw.nodes;
    // 0 marks a node as used until the numbers are given out.
    let mut number = vec![UNUSED; nodes.0.len()];
    for node in raw.cells.iter().flat_map(|cell| cell.nodes) {
        number[node as usize] = 0;
    }
    let used: Vec<u32> = (0..).zip(&number).filter(|(_, n)| **n != UNUSED).map(|(old, _)| old).collect();
    let middles: Vec<u32> = raw.middles.iter().map(|middle| middle.node).collect();
    check_flat(places, nodes, &[&used[..], &middles].concat())?;

    let mut mesh = PlaneMesh::default();
    for (new, old) in (0..).zip(&used) {
        number[*old as usize] = new;
        let point = nodes.plane(*old).map(|x| x * unit_metres);
        if let Some(value) = point.into_iter().find(|x| !x.is_finite()) {
            let fault = MeshFault::Coordinate { node: nodes.tag(*old), value };
            return Err(places.error_at(None, fault));
        }
        mesh.points.push(point);
        mesh.node_tags.push(nodes.tag(*old));
    }
    mesh.bends = bends(places, raw, &number, unit_metres)?;
    let groups = |set: u32| &raw.groups[set as usize];
    let mut members = BTreeMap::new();
    let number = |old: u32| number[old as usize];
    for (i, cell) in (0..).zip(&raw.cells) {
        let corners = cell.nodes.map(number);
        mesh.quads.push(corners);
        mesh.quad_tags.push(cell.tag);
        for name in groups(cell.groups) {
            let group = member(&mut members, name, 2);
            group.quads.push(i);
            group.nodes.extend(corners);
        }
    }
    for edge in &raw.edges {
        let ends = edge.nodes.map(number);
        for name in groups(edge.groups).iter().filter(|_| !ends.contains(&UNUSED)) {
            let group = member(&mut members, name, 1);
            group.edges.push(ends);
            group.nodes.extend(ends);
        }
    }
    for point in &raw.points {
        let [old] = point.nodes;
        for name in groups(point.groups) {
            if number(old) == UNUSED {
                let fault = MeshFault::NotACorner { node: nodes.tag(old), group: name.clone() };
                return Err(places.error_at(Some(Item::Node(nodes.tag(old))), fault));
            }
            member(&mut members, name, 0).nodes.push(number(old));
        }
    }
    for (name, mut group) in members {
        group.nodes.sort_unstable();
        group.nodes.dedup();
        mesh.groups.insert(name.to_owned(), group);
    }
    Ok(mesh)
}

/// How sides are bent. Middles must be sorted by their sides.
fn bends(
    places: &dyn Places,
    raw: &Raw,
    number: &[u32],
    unit_metres: f64,
) -> Result<BTreeMap<[u32; 2], [f64; 2]>, MeshError> {
    let mut bends = BTreeMap::new();
    for alike in raw.middles.chunk_by(|a, b| a.side == b.side) {
        let [p, q] = alike[0].side.map(|n| raw.nodes.plane(n));
        let chord = (q[0] - p[0]).hypot(q[1] - p[1]);
        let [first, other] = [&alike[0], &alike[alike.len() - 1]].map(|middle| raw.nodes.plane(middle.node));
        if (first[0] - other[0]).hypot(first[1] - other[1]) > ALIKE * chord {
            let [node, other] = [alike[0].node, alike[alike.len() - 1].node].map(|n| raw.nodes.tag(n));
            let side = alike[0].side.map(|n| raw.nodes.tag(n));
            let fault = MeshFault::Middles { side, nodes: [node, other] };
            return Err(places.error_at(Some(Item::Element(alike[alike.len() - 1].cell)), fault));
        }
        let bend = [0, 1].map(|d| first[d] - 0.5 * (p[d] + q[d]));
        // A node off the middle of a straight side bends nothing, and would only make the element worse.
        let off = (bend[0] * (q[1] - p[1]) - bend[1] * (q[0] - p[0])).abs() / chord;
        if off > STRAIGHT * chord {
            // Numbers are given out in order.
            bends.insert(alike[0].side.map(|n| number[n as usize]), bend.map(|x| x * unit_metres));
        }
    }
    Ok(bends)
}

fn member<'m, 'g>(groups: &'m mut BTreeMap<&'g str, Group>, name: &'g str, dim: u8) -> &'m mut Group {
    groups.entry(name).or_insert_with(|| Group { dim, ..Group::default() })
}
