//! What must hold of cells and nodes before they are a mesh.

use fem_core::domain::Corners;
use fem_core::mesh::{PlaneMesh, Sides};
use std::collections::BTreeMap;

use super::error::{MeshError, MeshFault};
use super::nodes::{Node, NodeTable};
use super::{Element, Item, Places, Raw};

/// Largest inner angle of a cell, degrees. Beyond, a cell is all but a triangle: the map onto it is nearly singular at the
/// blunt corner, and what is made of its derivatives there is no stress of the plate.
pub(super) const BLUNTEST: f64 = 175.0;

/// Lengths below this fraction of the mesh's size count as nothing.
const NOTHING: f64 = 1e-9;

/// Turns clockwise cells round, refuses those that are not convex or nearly so. Returns the tags of the turned ones.
pub(super) fn orient(
    places: &dyn Places,
    nodes: &NodeTable,
    cells: &mut [Element<Corners<u32>>],
) -> Result<Vec<u64>, MeshError> {
    let mut turned = Vec::new();
    for cell in cells {
        let sines = sines(cell.nodes.map(|n| nodes.plane(n)));
        if sines.iter().all(|s| *s < -NOTHING) {
            cell.nodes[1..].reverse();
            turned.push(cell.tag);
        } else if !sines.iter().all(|s| *s > NOTHING) {
            let sense = if sines.iter().sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
            let badness = |i: &usize| if sines[*i].is_nan() { f64::INFINITY } else { -sense * sines[*i] };
            let worst = (0..sines.len()).max_by(|i, j| badness(i).total_cmp(&badness(j))).unwrap_or_default();
            let fault = MeshFault::Folded { cell: cell.tag, node: nodes.tag(cell.nodes[worst]) };
            return Err(places.error_at(Some(Item::Element(cell.tag)), fault));
        }
        let corners = cell.nodes.map(|n| nodes.plane(n));
        if let Some((node, degrees)) = cell.nodes.into_iter().zip(angles(corners)).find(|(_, angle)| *angle > BLUNTEST)
        {
            let fault = MeshFault::Blunt { cell: cell.tag, node: nodes.tag(node), degrees };
            return Err(places.error_at(Some(Item::Element(cell.tag)), fault));
        }
    }
    Ok(turned)
}

/// Sines of the inner angles; all positive only for an anticlockwise convex cell, not a number where an edge
/// has no length.
fn sines(p: Corners<[f64; 2]>) -> Corners<f64> {
    edges(p).map(|[u, v]| cross(u, v) / (u[0].hypot(u[1]) * v[0].hypot(v[1])))
}

/// Inner angles of a convex cell, degrees.
fn angles(p: Corners<[f64; 2]>) -> Corners<f64> {
    edges(p).map(|[u, v]| cross(u, v).atan2(u[0] * v[0] + u[1] * v[1]).abs().to_degrees())
}

/// At each corner the edges to the next one and to the one before.
fn edges(p: Corners<[f64; 2]>) -> Corners<[[f64; 2]; 2]> {
    let (n, mut i) = (p.len(), 0..);
    p.map(|at| {
        let i = i.next().unwrap_or_default();
        [p[(i + 1) % n], p[(i + n - 1) % n]].map(|end| [end[0] - at[0], end[1] - at[1]])
    })
}

fn cross(u: [f64; 2], v: [f64; 2]) -> f64 {
    u[0] * v[1] - u[1] * v[0]
}

/// Straightens the sides of cells that they bend so far that the cell folds, or nearly so. Returns the numbers of these cells.
pub(super) fn straighten(mesh: &mut PlaneMesh) -> Vec<u64> {
    let mut all = Vec::new();
    while !mesh.bends.is_empty() {
        let folds = |quad: &usize| {
            let cell = mesh.cell(*quad);
            cell.bends().is_some() && (!cell.is_regular() || cell.quality().largest_angle.to_degrees() > BLUNTEST)
        };
        let folded: Vec<usize> = (0..mesh.quads.len()).filter(folds).collect();
        if folded.is_empty() {
            break;
        }
        for quad in folded {
            all.push(mesh.quad_tags[quad]);
            for [a, b] in mesh.quads[quad].sides() {
                mesh.bends.remove(&[a.min(b), a.max(b)]);
            }
        }
    }
    all
}

/// Refuses elements of edge groups that are not a side of a cell, or the same side as another of the group.
pub(super) fn check_edges(places: &dyn Places, raw: &Raw, mesh: &PlaneMesh) -> Result<(), MeshError> {
    let sides = Sides::of(mesh);
    let number = |tag: u64| mesh.node_tags.binary_search(&tag).ok().map(|n| n as u32);
    let mut seen = BTreeMap::new();
    for element in &raw.edges {
        let tags = element.nodes.map(|n| raw.nodes.tag(n));
        let ends = number(tags[0]).zip(number(tags[1]));
        let is_side = ends.is_some_and(|(a, b)| sides.find([a, b]).or(sides.find([b, a])).is_some());
        for group in &raw.groups[element.groups as usize] {
            let first = *seen.entry((group, [tags[0].min(tags[1]), tags[0].max(tags[1])])).or_insert(element.tag);
            let fault = if !is_side {
                MeshFault::NotAnEdge { element: element.tag, group: group.clone(), nodes: tags }
            } else if first != element.tag {
                MeshFault::RepeatedEdge { elements: [first, element.tag], group: group.clone() }
            } else {
                continue;
            };
            return Err(places.error_at(Some(Item::Element(element.tag)), fault));
        }
    }
    Ok(())
}

/// Refuses nodes off the plane of the first.
pub(super) fn check_flat(places: &dyn Places, nodes: &NodeTable, used: &[u32]) -> Result<(), MeshError> {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for p in used.iter().map(|n| nodes.plane(*n)) {
        for d in 0..2 {
            low[d] = low[d].min(p[d]);
            high[d] = high[d].max(p[d]);
        }
    }
    let nothing = NOTHING * (high[0] - low[0]).hypot(high[1] - low[1]);
    let node = |n: u32| &nodes.0[n as usize];
    let off_plane = |[a, b]: [&Node; 2]| !((b.x[2] - a.x[2]).abs() <= nothing);
    if let Some([first, off]) = used.iter().map(|n| [node(used[0]), node(*n)]).find(|pair| off_plane(*pair)) {
        let fault = MeshFault::NotFlat { node: off.tag, z: off.x[2], other: first.tag, other_z: first.x[2] };
        return Err(places.error_at(Some(Item::Coordinates(off.tag)), fault));
    }
    Ok(())
}
