//! How groups run through their nodes, and groups by place.

use super::curve::{Chains, Course};
use super::{Group, PlaneMesh};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

impl PlaneMesh {
    /// How `group` runs through its vertices: along one line where its edges are smooth, along the curve if they follow one; along
    /// several at corners; along x and y in cells. Nodes that stand alone have no entry.
    pub fn courses(&self, group: &Group) -> BTreeMap<u32, Vec<Course>> {
        let chains = Chains::of(&self.points, group.edges.clone());
        let edges = group.edges.iter().flatten().map(|node| (*node, chains.courses(*node)));
        let cells = group.quads.iter().flat_map(|quad| self.quads[*quad as usize]);
        edges.chain(cells.map(|node| (node, [0.0, FRAC_PI_2].map(Course::straight).to_vec()))).collect()
    }

    /// The nodes within `radius` of a place, m, with the sides and cells that lie between them.
    pub fn within(&self, centre: [f64; 2], radius: f64) -> Group {
        let reach = radius + self.reach();
        self.between(|p| (p[0] - centre[0]).hypot(p[1] - centre[1]) <= reach)
    }

    /// The nodes within a rectangle, m, with the sides and cells that lie between them: nodes alone where it is a point, sides where it
    /// is a line.
    pub fn within_rectangle(&self, low: [f64; 2], high: [f64; 2]) -> Group {
        let reach = self.reach();
        let group = self.between(|p| (0..2).all(|d| (low[d] - reach..=high[d] + reach).contains(&p[d])));
        let dim = match (&group.quads[..], &group.edges[..]) {
            ([], []) => 0,
            ([], _) => 1,
            _ => 2,
        };
        Group { dim, ..group }
    }

    /// The nodes at places that are `within`, with the sides and cells that lie between them.
    fn between(&self, within: impl Fn(&[f64; 2]) -> bool) -> Group {
        let inside: Vec<bool> = self.points.iter().map(within).collect();
        let nodes = (0..).zip(&inside).filter(|(_, inside)| **inside).map(|(node, _)| node).collect();
        let is_inside = |node: &u32| inside[*node as usize];
        let quads = (0..).zip(&self.quads).filter(|(_, corners)| corners.iter().all(is_inside)).map(|(quad, _)| quad);
        let sides = self.quads.iter().flat_map(|corners| corners.sides()).map(|[a, b]| [a.min(b), a.max(b)]);
        let mut edges: Vec<[u32; 2]> = sides.filter(|ends| ends.iter().all(is_inside)).collect();
        edges.sort_unstable();
        edges.dedup();
        Group { dim: 2, nodes, edges, quads: quads.collect() }
    }
}
