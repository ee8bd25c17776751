//! Plane meshes of quadrilaterals and triangles with named groups.

mod boxes;
mod course;
mod curve;
mod graded;
mod refine;
mod sides;
#[cfg(test)]
mod tests;
mod tiling;
mod without;

pub use curve::Course;
pub use graded::{Graded, MAX_CELLS, Outline};
pub use refine::Curves;
pub use sides::{Side, Sides};
pub use tiling::{Flaw, FlawKind};

use crate::words::domain::{CellQuality, Corners, Domain, PlaneCell};
use curve::Chains;
use std::collections::BTreeMap;

/// Distance over the diagonal of a mesh within which a node and a place that is named, or that a symmetry gives, are one: above
/// the rounding of coordinates, and below what [`crate::plates::support::FreeMotions`] takes for a hold.
const SAME_PLACE: f64 = 1e-8;

/// Straight parts that a bent side is drawn in.
const PARTS: u32 = 8;

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

/// A flat mesh of quadrilaterals and triangles in the x-y plane, metres. Node and cell numbers are indices; `*_tags` keep the
/// numbers of the file for messages.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlaneMesh {
    /// Node positions.
    pub points: Vec<[f64; 2]>,
    /// Corner nodes of each cell, anticlockwise.
    pub quads: Vec<Corners<u32>>,
    /// Groups by physical name.
    pub groups: BTreeMap<String, Group>,
    /// Number of each node in the file.
    pub node_tags: Vec<u64>,
    /// Number of each cell in the file.
    pub quad_tags: Vec<u64>,
    /// From the middle of the chord of a side to that of the side, m, by the ends of the side, the lower number first: a parabola.
    /// Other sides are straight.
    pub bends: BTreeMap<[u32; 2], [f64; 2]>,
}

impl PlaneMesh {
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
                mesh.quads.push([node(i - 1, j - 1), node(i, j - 1), node(i, j), node(i - 1, j)].into());
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

    /// One cell alone.
    pub fn single(corners: Corners<[f64; 2]>) -> Self {
        let mut next = 0..;
        Self {
            points: corners.to_vec(),
            quads: vec![corners.map(|_| next.next().unwrap_or_default())],
            groups: BTreeMap::new(),
            node_tags: (1..=corners.len() as u64).collect(),
            quad_tags: vec![1],
            bends: BTreeMap::new(),
        }
    }

    /// What its cells are called: "quads", "triangles", or "cells" where there are both.
    pub fn name_of_cells(&self) -> &'static str {
        let has = |domain| self.quads.iter().any(|corners| corners.domain() == domain);
        match (has(Domain::Quadrilateral), has(Domain::Triangle)) {
            (_, false) => "quads",
            (false, true) => "triangles",
            (true, true) => "cells",
        }
    }

    /// Corner positions of a cell; without its bent sides.
    pub fn corners(&self, quad: usize) -> Corners<[f64; 2]> {
        self.quads[quad].map(|n| self.points[n as usize])
    }

    /// A cell with its sides, which may be bent.
    pub fn cell(&self, quad: usize) -> PlaneCell {
        let corners = self.corners(quad);
        if self.bends.is_empty() {
            return corners.into();
        }
        let bend = |[a, b]: [u32; 2]| self.bends.get(&[a.min(b), a.max(b)]).copied().unwrap_or_default();
        PlaneCell::bent(corners, self.quads[quad].map_sides(bend))
    }

    /// Places along a side from end to end, m: the ends, and places that divide it into short straight parts where it is bent.
    pub fn along(&self, [a, b]: [u32; 2]) -> Vec<[f64; 2]> {
        let [start, end] = [a, b].map(|n| self.points[n as usize]);
        let Some(bend) = self.bends.get(&[a.min(b), a.max(b)]) else { return vec![start, end] };
        let place = |part: u32| {
            let t = f64::from(part) / f64::from(PARTS);
            [0, 1].map(|d| (1.0 - t) * start[d] + t * end[d] + 4.0 * t * (1.0 - t) * bend[d])
        };
        std::iter::once(start).chain((1..PARTS).map(place)).chain([end]).collect()
    }

    /// A cell as a polygon, m: its corners, and places along its bent sides.
    pub fn outline(&self, quad: usize) -> Vec<[f64; 2]> {
        self.quads[quad]
            .sides()
            .flat_map(|side| self.along(side).into_iter().rev().skip(1).rev().collect::<Vec<_>>())
            .collect()
    }

    /// All cells as polygons, by numbers of places: the nodes, m, and behind them those that divide bent sides.
    pub fn outlines(&self) -> (Vec<[f64; 2]>, Vec<Vec<u32>>) {
        let mut places = self.points.clone();
        let mut firsts = BTreeMap::new();
        for side in self.bends.keys() {
            firsts.insert(side, places.len() as u32);
            let along = self.along(*side);
            places.extend(&along[1..along.len() - 1]);
        }
        let from = |[a, b]: [u32; 2]| {
            let first = firsts.get(&[a.min(b), a.max(b)]);
            let inside = first
                .into_iter()
                .flat_map(move |first| (1..PARTS).map(move |part| first + if a < b { part } else { PARTS - part } - 1));
            std::iter::once(a).chain(inside)
        };
        let polygons = self.quads.iter().map(|quad| quad.sides().flat_map(from).collect()).collect();
        (places, polygons)
    }

    /// CellQuality of a cell.
    pub fn quality(&self, quad: usize) -> CellQuality {
        self.cell(quad).quality()
    }

    /// Edges of one cell alone, which lies to their left.
    pub fn boundary(&self) -> Vec<[u32; 2]> {
        self.rim(|_| true)
    }

    /// Edges of the cells `within` that no other of them has.
    fn rim(&self, within: impl Fn(usize) -> bool) -> Vec<[u32; 2]> {
        let sides = Sides::of(self);
        let beyond = |side: &[u32; 2]| !sides.opposite(*side).is_some_and(|side| within(side.cell as usize));
        let own = (0..self.quads.len()).filter(|quad| within(*quad));
        own.flat_map(|quad| self.quads[quad].sides()).filter(beyond).collect()
    }

    /// Edges around the cells of a group.
    fn rim_of(&self, group: &Group) -> Vec<[u32; 2]> {
        let mut within = vec![false; self.quads.len()];
        group.quads.iter().for_each(|quad| within[*quad as usize] = true);
        self.rim(|quad| within[quad])
    }

    /// Which nodes lie inside, on no edge of one cell alone.
    pub fn inside(&self) -> Vec<bool> {
        let mut inside = vec![true; self.points.len()];
        self.boundary().iter().flatten().for_each(|node| inside[*node as usize] = false);
        inside
    }

    /// Largest angle by which the boundary turns from edge to edge where it follows a curve, radians: turns of less than
    /// 0.7 between edges that neither begin nor end a straight line, where the circles through three nodes in a row have
    /// one sense and about one size. 0 for a boundary of straight lines and sharp corners; bent sides do not count.
    pub fn curved_turn(&self) -> f64 {
        let chains = Chains::of(&self.points, self.boundary());
        let straight = chains.edges().iter().filter(|[a, b]| !self.bends.contains_key(&[*a.min(b), *a.max(b)]));
        straight.flat_map(|edge| chains.bends(*edge)).fold(0.0, |m, bend| m.max(bend.turn.abs()))
    }

    /// Middles, m, and numbers of sides of the parts of the boundary that are polygons in a circle, a cell a side, and turn as corners do:
    /// most likely circles that are divided too coarsely to be seen as such.
    pub fn coarse_circles(&self) -> Vec<([f64; 2], usize)> {
        let straight = |[a, b]: &[u32; 2]| !self.bends.contains_key(&[*a.min(b), *a.max(b)]);
        Chains::of(&self.points, self.boundary().into_iter().filter(straight).collect()).coarse_circles()
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

    /// Distance within which places are one, m.
    pub fn reach(&self) -> f64 {
        let (low, high) = self.bounds();
        SAME_PLACE * (high[0] - low[0]).hypot(high[1] - low[1])
    }

    /// Sum of the cell areas, m².
    pub fn area(&self) -> f64 {
        (0..self.quads.len()).map(|q| self.quality(q).area).sum()
    }
}
