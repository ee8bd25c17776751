//! Plane meshes of quadrilaterals with named groups.

mod curve;
mod graded;
mod refine;
#[cfg(test)]
mod tests;

pub use graded::{Graded, MAX_CELLS, Outline};
pub use refine::Curves;

use curve::Chains;
use std::collections::{BTreeMap, HashSet};

/// A named group of a mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Group {
    /// 0 nodes, 1 edges, 2 cells.
    pub dim: u8,
    /// Nodes of the group, ascending, each once.
    pub nodes: Vec<u32>,
    /// Edges of a group of dimension 1.
    pub edges: Vec<[u32; 2]>,
    /// Cells of a group of dimension 2.
    pub quads: Vec<u32>,
}

/// A flat mesh of quadrilaterals in the x-y plane, metres. Node and cell numbers are indices; `*_tags` keep the
/// numbers of the file for messages.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct QuadMesh {
    /// Node positions.
    pub points: Vec<[f64; 2]>,
    /// Corner nodes of each cell, anticlockwise.
    pub quads: Vec<[u32; 4]>,
    /// Groups by physical name.
    pub groups: BTreeMap<String, Group>,
    /// Number of each node in the file.
    pub node_tags: Vec<u64>,
    /// Number of each cell in the file.
    pub quad_tags: Vec<u64>,
}

/// Shape measures of a quadrilateral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadQuality {
    /// Area, m².
    pub area: f64,
    /// Largest inner angle, radians.
    pub largest_angle: f64,
    /// Longest over shortest edge.
    pub aspect: f64,
    /// Smallest sine of an inner angle: 1 for a rectangle, not positive where a cell is not convex.
    pub scaled_jacobian: f64,
}

impl QuadMesh {
    /// A rectangle with nodes at all pairs of the ascending `x` and `y`, m. Groups: the edges `x-min`, `x-max`, `y-min`,
    /// `y-max`, the cells `plate`; nodes and cells count along x first.
    pub fn rectangle(x: &[f64], y: &[f64]) -> Self {
        let (nx, ny) = (x.len(), y.len());
        let node = |i: usize, j: usize| (j * nx + i) as u32;
        let mut mesh = Self {
            points: y.iter().flat_map(|y| x.iter().map(move |x| [*x, *y])).collect(),
            node_tags: (1..=(nx * ny) as u64).collect(),
            ..Self::default()
        };
        for j in 1..ny {
            for i in 1..nx {
                mesh.quads.push([node(i - 1, j - 1), node(i, j - 1), node(i, j), node(i - 1, j)]);
            }
        }
        mesh.quad_tags = (1..=mesh.quads.len() as u64).collect();
        let (along_x, along_y) =
            (|j: usize| (0..nx).map(move |i| node(i, j)), |i: usize| (0..ny).map(move |j| node(i, j)));
        let edge = |nodes: Vec<u32>| Group {
            dim: 1,
            edges: nodes.windows(2).map(|n| [n[0], n[1]]).collect(),
            nodes,
            ..Group::default()
        };
        let plate = Group {
            dim: 2,
            nodes: (0..mesh.points.len() as u32).collect(),
            quads: (0..mesh.quads.len() as u32).collect(),
            ..Group::default()
        };
        mesh.groups = [
            ("x-min", edge(along_y(0).collect())),
            ("x-max", edge(along_y(nx - 1).collect())),
            ("y-min", edge(along_x(0).collect())),
            ("y-max", edge(along_x(ny - 1).collect())),
            ("plate", plate),
        ]
        .map(|(name, group)| (name.to_owned(), group))
        .into();
        mesh
    }

    /// Corner positions of a cell.
    pub fn corners(&self, quad: usize) -> [[f64; 2]; 4] {
        self.quads[quad].map(|n| self.points[n as usize])
    }

    /// Quality of a cell.
    pub fn quality(&self, quad: usize) -> QuadQuality {
        quality(self.corners(quad))
    }

    /// Edges of one cell alone, which lies to their left.
    pub(crate) fn boundary(&self) -> Vec<[u32; 2]> {
        let edges = || self.quads.iter().flat_map(|q| (0..4).map(move |i| [q[i], q[(i + 1) % 4]]));
        let all: HashSet<[u32; 2]> = edges().collect();
        edges().filter(|[a, b]| !all.contains(&[*b, *a])).collect()
    }

    /// Largest angle by which the boundary turns from edge to edge where it follows a curve, radians: turns of less than
    /// 0.7 between edges that neither begin nor end a straight line, where the circles through three nodes in a row have
    /// one sense and about one size. 0 for a boundary of straight lines and sharp corners.
    pub fn curved_turn(&self) -> f64 {
        let chains = Chains::of(&self.points, self.boundary());
        chains.edges().iter().flat_map(|edge| chains.bends(*edge)).fold(0.0, |m, bend| m.max(bend.turn.abs()))
    }

    /// Lower and upper corner of the bounding box.
    pub fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for p in &self.points {
            for d in 0..2 {
                low[d] = low[d].min(p[d]);
                high[d] = high[d].max(p[d]);
            }
        }
        (low, high)
    }

    /// Sum of the cell areas, m².
    pub fn area(&self) -> f64 {
        (0..self.quads.len()).map(|q| self.quality(q).area).sum()
    }
}

fn quality(p: [[f64; 2]; 4]) -> QuadQuality {
    let (mut largest_angle, mut scaled_jacobian) = (0.0_f64, 1.0_f64);
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    for i in 0..4 {
        let [a, b, c] = [p[(i + 3) % 4], p[i], p[(i + 1) % 4]];
        let (u, v) = ([c[0] - b[0], c[1] - b[1]], [a[0] - b[0], a[1] - b[1]]);
        let cross = u[0] * v[1] - u[1] * v[0];
        let angle = cross.atan2(u[0] * v[0] + u[1] * v[1]);
        scaled_jacobian = scaled_jacobian.min(cross / (u[0].hypot(u[1]) * v[0].hypot(v[1])));
        largest_angle = largest_angle.max(angle.rem_euclid(std::f64::consts::TAU));
        let edge = u[0].hypot(u[1]);
        shortest = shortest.min(edge);
        longest = longest.max(edge);
    }
    let area = 0.5 * ((p[2][0] - p[0][0]) * (p[3][1] - p[1][1]) - (p[3][0] - p[1][0]) * (p[2][1] - p[0][1]));
    QuadQuality { area, largest_angle, aspect: longest / shortest, scaled_jacobian }
}
