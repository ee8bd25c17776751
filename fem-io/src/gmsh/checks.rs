//! What must hold of cells and nodes before they are a mesh.

use fem_core::domain::Corners;
use std::collections::BTreeMap;

use super::elements::Element;
use super::error::{MeshError, MeshFault};
use super::nodes::{Node, NodeTable};
use super::source::{Item, Source};

/// Largest inner angle of a cell, degrees. Beyond, a cell is all but a triangle: the map onto it is nearly singular at the
/// blunt corner, and what is made of its derivatives there is no stress of the plate.
pub(super) const BLUNTEST: f64 = 175.0;

/// Lengths below this fraction of the mesh's size count as nothing.
const NOTHING: f64 = 1e-9;

/// Turns clockwise cells round, refuses those that are not convex or nearly so. Returns the tags of the turned ones.
pub(super) fn orient(
    source: &Source<'_>,
    nodes: &NodeTable,
    cells: &mut [Element<'_, Corners<u32>>],
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
            return Err(source.error(source.find(Item::Element(cell.tag)), fault));
        }
        let corners = cell.nodes.map(|n| nodes.plane(n));
        if let Some((node, degrees)) = cell.nodes.into_iter().zip(angles(corners)).find(|(_, angle)| *angle > BLUNTEST)
        {
            let fault = MeshFault::Blunt { cell: cell.tag, node: nodes.tag(node), degrees };
            return Err(source.error(source.find(Item::Element(cell.tag)), fault));
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

/// Directed edges of anticlockwise cells, each with its cell, sorted. In a sound mesh each occurs once, since a second
/// cell runs along the edge the other way.
#[derive(Debug)]
pub(super) struct Edges(Vec<(u64, u32)>);

impl Edges {
    pub(super) fn new(
        source: &Source<'_>,
        nodes: &NodeTable,
        cells: &[Element<'_, Corners<u32>>],
    ) -> Result<Self, MeshError> {
        let mut edges = Vec::with_capacity(4 * cells.len());
        for (i, cell) in (0_u32..).zip(cells) {
            edges.extend(cell.nodes.sides().map(|[a, b]| (direct_edge(a, b), i)));
        }
        edges.sort_unstable();
        if let Some(pair) = edges.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let tags = [pair[0].1, pair[1].1].map(|i| cells[i as usize].tag);
            let ends = [pair[0].0 >> 32, pair[0].0 & u64::from(u32::MAX)].map(|n| nodes.tag(n as u32));
            let fault = MeshFault::Overlap { cells: tags, nodes: ends };
            return Err(source.error(source.find(Item::Element(tags[1])), fault));
        }
        Ok(Self(edges))
    }

    fn contains(&self, [a, b]: [u32; 2]) -> bool {
        [direct_edge(a, b), direct_edge(b, a)].iter().any(|edge| self.0.binary_search_by_key(edge, |e| e.0).is_ok())
    }

    /// Refuses elements of edge groups that are not an edge of a cell, or the same edge as another of the group.
    pub(super) fn check_groups(
        &self,
        source: &Source<'_>,
        nodes: &NodeTable,
        elements: &[Element<'_, [u32; 2]>],
    ) -> Result<(), MeshError> {
        let mut seen = BTreeMap::new();
        for element in elements {
            let [a, b] = element.nodes;
            let is_edge = self.contains(element.nodes);
            for group in element.groups {
                let first = *seen.entry((group, [a.min(b), a.max(b)])).or_insert(element.tag);
                let fault = if !is_edge {
                    let nodes = element.nodes.map(|n| nodes.tag(n));
                    MeshFault::NotAnEdge { element: element.tag, group: group.clone(), nodes }
                } else if first != element.tag {
                    MeshFault::RepeatedEdge { elements: [first, element.tag], group: group.clone() }
                } else {
                    continue;
                };
                return Err(source.error(source.find(Item::Element(element.tag)), fault));
            }
        }
        Ok(())
    }
}

/// Refuses nodes off the plane of the first, and pairs of nodes at one place.
pub(super) fn check_flat_and_joined(source: &Source<'_>, nodes: &NodeTable, used: &[u32]) -> Result<(), MeshError> {
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
        return Err(source.error(source.find(Item::Coordinates(off.tag)), fault));
    }
    // Along an oblique line the nodes of regular meshes lie apart, so that nodes at one place are neighbours.
    let oblique = |n: &u32| {
        let [x, y] = nodes.plane(*n);
        x + 0.618_033_988_749_894_9 * y
    };
    let mut sorted = used.to_vec();
    sorted.sort_by(|a, b| oblique(a).total_cmp(&oblique(b)));
    for pair in sorted.windows(2) {
        let [a, b] = [nodes.plane(pair[0]), nodes.plane(pair[1])];
        if (b[0] - a[0]).hypot(b[1] - a[1]) <= nothing {
            let mut tags = [nodes.tag(pair[0]), nodes.tag(pair[1])];
            tags.sort_unstable();
            return Err(source.error(source.find(Item::Node(tags[1])), MeshFault::NotJoined { nodes: tags }));
        }
    }
    Ok(())
}

/// An edge as one number, which sorts faster than a pair.
fn direct_edge(from: u32, to: u32) -> u64 {
    u64::from(from) << 32 | u64::from(to)
}
