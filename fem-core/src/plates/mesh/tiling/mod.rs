//! Whether the cells of a mesh tile one plate.

#[cfg(test)]
mod tests;

use crate::plates::mesh::boxes::{Box2, Boxes};
use crate::plates::mesh::{PlaneMesh, Side, Sides};
use crate::words::domain::Corners;
use std::collections::BTreeSet;

/// A node within this fraction of the size of a cell lies on its side: far above what rounding moves, even that of six digits
/// in a file, and far below any gap that a cell beside it could resolve.
const TOUCH: f64 = 1e-3;

/// The width of a slender cell, of that: its nodes are at one place below.
const SLENDER: f64 = 1e-6;

/// Most flaws whose cells are searched for one by one.
const MOST: usize = 20;

/// Where cells do not tile a plate; nodes and cells are indices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flaw {
    /// What is wrong.
    pub kind: FlawKind,
    /// Where, m.
    pub at: [f64; 2],
}

/// What may be wrong where cells meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FlawKind {
    /// Two cells lie on the same side of the edge between two nodes.
    SameSide {
        /// The cells.
        cells: [u32; 2],
        /// Ends of the edge.
        nodes: [u32; 2],
    },
    /// A node lies on a side of a cell and is not a corner of it.
    Hanging {
        /// The node.
        node: u32,
        /// The cell.
        cell: u32,
        /// Ends of its side.
        side: [u32; 2],
    },
    /// Two nodes lie at one place, so that the cells at either are not joined.
    Doubled {
        /// The nodes.
        nodes: [u32; 2],
    },
    /// Two cells lie over each other.
    Overlap {
        /// The cells.
        cells: [u32; 2],
    },
    /// Cells have no more than a node in common: a hinge.
    Pinched {
        /// The node.
        node: u32,
    },
}

impl FlawKind {
    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SameSide { .. } | Self::Overlap { .. } => "cells over each other",
            Self::Hanging { .. } => "node on a side",
            Self::Doubled { .. } => "two nodes at one place",
            Self::Pinched { .. } => "joined by one node",
        }
    }
}

impl PlaneMesh {
    /// Where the cells do not tile a plate, the worst first; empty for a sound mesh. Cells must be convex and anticlockwise.
    ///
    /// Sound is a mesh whose sides belong to one cell or to two on either side of it, whose free sides (those of one cell)
    /// touch nothing but their neighbours, in which no point is covered twice and no two cells have but a corner in common.
    /// Holes and notches are free sides like others. Nodes of the groups `cuts` may lie at the same place as others: the
    /// plate is cut there on purpose. Of flaws of a kind that hide others, those alone are found. The search takes n log n.
    pub fn flaws(&self, cuts: &[String]) -> Vec<Flaw> {
        let sides = Sides::of(self);
        let mut flaws = self.on_the_same_side(&sides);
        flaws.extend(self.without_length(&sides));
        if flaws.is_empty() {
            let free = FreeSides::of(self, &sides);
            let (touched, crossed) = free.meetings(cuts);
            flaws = touched;
            if flaws.is_empty() {
                flaws = self.covered_around(&sides);
                flaws.extend(crossed);
            }
            if flaws.is_empty() {
                flaws = free.nested(&self.pieces_by(&sides));
            }
            if flaws.is_empty() {
                flaws = free.pinched();
            }
        }
        flaws.sort_by_key(|flaw| flaw.kind);
        flaws.dedup_by_key(|flaw| flaw.kind);
        flaws
    }

    /// The piece that each cell belongs to, counted from 0 in the order of their first cells: cells of a piece are joined by
    /// sides.
    pub fn pieces(&self) -> Vec<u32> {
        self.pieces_by(&Sides::of(self))
    }

    fn pieces_by(&self, sides: &Sides) -> Vec<u32> {
        let mut pieces = vec![u32::MAX; self.quads.len()];
        let mut count = 0;
        for first in 0..self.quads.len() {
            if pieces[first] != u32::MAX {
                continue;
            }
            let mut open = vec![first as u32];
            pieces[first] = count;
            while let Some(cell) = open.pop() {
                for beside in self.quads[cell as usize].sides().filter_map(|side| sides.opposite(side)) {
                    if pieces[beside.cell as usize] == u32::MAX {
                        pieces[beside.cell as usize] = count;
                        open.push(beside.cell);
                    }
                }
            }
            count += 1;
        }
        pieces
    }

    fn point(&self, node: u32) -> [f64; 2] {
        self.points[node as usize]
    }

    fn on_the_same_side(&self, sides: &Sides) -> Vec<Flaw> {
        let mut flaws = Vec::new();
        for side in sides.all() {
            let first = sides.find(side.nodes).unwrap_or(side);
            if first.cell != side.cell {
                let [a, b] = side.nodes.map(|n| self.point(n));
                let kind = FlawKind::SameSide { cells: [first.cell, side.cell], nodes: side.nodes };
                flaws.push(Flaw { kind, at: middle(a, b) });
            }
        }
        flaws
    }

    /// Sides that are nothing beside their cell.
    fn without_length(&self, sides: &Sides) -> Vec<Flaw> {
        let nothing = |side: &&Side| {
            let [a, b] = side.nodes.map(|n| self.point(n));
            distance(a, b) <= SLENDER * TOUCH * height(self.corners(side.cell as usize))
        };
        let doubled = |side: &Side| {
            let [a, b] = side.nodes;
            Flaw { kind: FlawKind::Doubled { nodes: [a.min(b), a.max(b)] }, at: self.point(a) }
        };
        sides.all().iter().filter(nothing).map(doubled).collect()
    }

    /// Nodes around which cells lie over each other: more than one of them covers the direction of x.
    fn covered_around(&self, sides: &Sides) -> Vec<Flaw> {
        let covers = |node: u32, side: &&Side| {
            let corners = self.quads[side.cell as usize];
            let from = corners.sides().find(|[_, to]| *to == node).map_or(node, |[from, _]| from);
            let [at, next, last] = [node, side.nodes[1], from].map(|n| self.point(n));
            // Anticlockwise from the side that leaves the node to the one that arrives, by less than half a turn.
            let leaves_below = next[1] < at[1] || (next[1] == at[1] && next[0] > at[0]);
            leaves_below && last[1] > at[1]
        };
        let at = |node: u32| {
            let mut covering = sides.from(node).iter().filter(|side| covers(node, side));
            let (first, second) = (covering.next()?, covering.next()?);
            let kind = FlawKind::Overlap { cells: [first.cell, second.cell] };
            Some(Flaw { kind, at: self.point(node) })
        };
        (0..self.points.len() as u32).filter_map(at).collect()
    }
}

/// Sides of one cell alone.
struct FreeSides<'a> {
    mesh: &'a PlaneMesh,
    all: &'a Sides,
    sides: Vec<Side>,
    /// How near to a side a node is on it, m.
    reach: Vec<f64>,
    boxes: Boxes,
}

impl<'a> FreeSides<'a> {
    fn of(mesh: &'a PlaneMesh, sides: &'a Sides) -> Self {
        let free: Vec<Side> = sides.all().iter().filter(|side| sides.opposite(side.nodes).is_none()).copied().collect();
        let reach: Vec<f64> = free.iter().map(|side| TOUCH * height(mesh.corners(side.cell as usize))).collect();
        let around = |(side, reach): (&Side, &f64)| -> Box2 {
            let [a, b] = side.nodes.map(|n| mesh.point(n));
            [[0, 1].map(|d| a[d].min(b[d]) - reach), [0, 1].map(|d| a[d].max(b[d]) + reach)]
        };
        let boxes = Boxes::new(free.iter().zip(&reach).map(around).collect());
        Self { mesh, all: sides, sides: free, reach, boxes }
    }

    fn ends(&self, k: usize) -> [[f64; 2]; 2] {
        self.sides[k].nodes.map(|n| self.mesh.point(n))
    }

    /// Nodes on sides of others but for those of `cuts`, and sides that cross each other.
    fn meetings(&self, cuts: &[String]) -> (Vec<Flaw>, Vec<Flaw>) {
        let named = cuts.iter().filter_map(|name| self.mesh.groups.get(name));
        let cut: BTreeSet<u32> = named.flat_map(|group| group.nodes.iter().copied()).collect();
        let pardoned = |kind: &FlawKind| match kind {
            FlawKind::Doubled { nodes } => nodes.iter().any(|n| cut.contains(n)),
            FlawKind::Hanging { node, side, .. } => cut.contains(node) || side.iter().all(|n| cut.contains(n)),
            _ => false,
        };
        let (mut touched, mut crossed) = (Vec::new(), Vec::new());
        for k in 0..self.sides.len() {
            let [a, b] = self.ends(k);
            let place = [[0, 1].map(|d| a[d].min(b[d])), [0, 1].map(|d| a[d].max(b[d]))];
            self.boxes.near(place, |other| {
                touched.extend(self.touch(k, other as usize).filter(|flaw| !pardoned(&flaw.kind)));
                crossed.extend(self.cross(k, other as usize));
            });
        }
        (touched, crossed)
    }

    /// The node that another side begins at, where it is on side `k`. Each node of free sides begins one.
    fn touch(&self, k: usize, other: usize) -> Option<Flaw> {
        let (side, node) = (&self.sides[k], self.sides[other].nodes[0]);
        if side.nodes.contains(&node) {
            return None;
        }
        let p = self.mesh.point(node);
        let reach = self.reach[k].min(self.reach[other]);
        let kind = match side.nodes.into_iter().find(|end| distance(self.mesh.point(*end), p) <= reach) {
            Some(end) if self.are_apart(end, node, reach) => return None,
            Some(end) => FlawKind::Doubled { nodes: [end.min(node), end.max(node)] },
            None if off(self.ends(k), p) <= reach => FlawKind::Hanging { node, cell: side.cell, side: side.nodes },
            None => return None,
        };
        Some(Flaw { kind, at: p })
    }

    /// Whether two nodes so near to each other are the width of a slender cell.
    fn are_apart(&self, a: u32, b: u32, reach: f64) -> bool {
        let joined = self.all.find([a, b]).or(self.all.find([b, a])).is_some();
        joined && distance(self.mesh.point(a), self.mesh.point(b)) > SLENDER * reach
    }

    /// Where side `k` crosses a later one, by more than a touch.
    fn cross(&self, k: usize, other: usize) -> Option<Flaw> {
        let [one, two] = [k, other].map(|k| &self.sides[k]);
        if other <= k || one.nodes.iter().any(|n| two.nodes.contains(n)) {
            return None;
        }
        let ([a, b], [c, d]) = (self.ends(k), self.ends(other));
        let reach = self.reach[k].min(self.reach[other]);
        let apart = |line, p, q| {
            let (p, q) = (height_over(line, p), height_over(line, q));
            p * q < 0.0 && p.abs().min(q.abs()) > reach
        };
        if !(apart([a, b], c, d) && apart([c, d], a, b)) {
            return None;
        }
        let (p, q) = (height_over([c, d], a), height_over([c, d], b));
        let at = [0, 1].map(|i| a[i] + p / (p - q) * (b[i] - a[i]));
        Some(Flaw { kind: FlawKind::Overlap { cells: [one.cell, two.cell] }, at })
    }

    /// Pieces within others: how often the free sides run round a place is how many cells cover it.
    fn nested(&self, pieces: &[u32]) -> Vec<Flaw> {
        let count = pieces.iter().max().map_or(0, |last| last + 1);
        if count < 2 {
            return Vec::new();
        }
        let mut firsts: Vec<usize> = Vec::new();
        for (cell, piece) in pieces.iter().enumerate() {
            if *piece as usize == firsts.len() {
                firsts.push(cell);
            }
        }
        let covered = |at: [f64; 2]| {
            let mut rounds = 0;
            self.boxes.near([at, [at[0], f64::INFINITY]], |k| {
                let [a, b] = self.ends(k as usize);
                let above = |from: [f64; 2], to: [f64; 2]| {
                    (from[0]..to[0]).contains(&at[0])
                        && from[1] + (to[1] - from[1]) * (at[0] - from[0]) / (to[0] - from[0]) > at[1]
                };
                // Above a place within, the outline runs against x.
                rounds += i32::from(above(b, a)) - i32::from(above(a, b));
            });
            rounds
        };
        let centres = firsts.into_iter().map(|cell| (cell, self.mesh.corners(cell).centroid()));
        let nested = centres.filter(|(_, at)| covered(*at) != 1).take(MOST);
        let under = |cell: usize, at: [f64; 2]| {
            let other = |c: &usize| *c != cell && self.mesh.corners(*c).locate(at).is_some();
            (0..self.mesh.quads.len()).find(other).unwrap_or(cell)
        };
        nested
            .map(|(cell, at)| Flaw { kind: FlawKind::Overlap { cells: [cell as u32, under(cell, at) as u32] }, at })
            .collect()
    }

    /// Nodes at which more than one free side begins.
    fn pinched(&self) -> Vec<Flaw> {
        let twice = self.sides.windows(2).filter(|pair| pair[0].nodes[0] == pair[1].nodes[0]);
        let node = twice.map(|pair| pair[0].nodes[0]);
        node.map(|node| Flaw { kind: FlawKind::Pinched { node }, at: self.mesh.point(node) }).collect()
    }
}

/// The smallest extent of a cell, about: its area over its longest side, m.
fn height(corners: Corners<[f64; 2]>) -> f64 {
    corners.area().abs() / corners.sides().map(|[a, b]| distance(a, b)).fold(0.0, f64::max)
}

fn middle(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|d| 0.5 * (a[d] + b[d]))
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// How far `p` lies to the left of the line from `a` to `b`, m.
fn height_over([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / distance(a, b)
}

/// How far `p` is from the line between `a` and `b`; infinite beyond its ends.
fn off([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    let along = (b[0] - a[0]) * (p[0] - a[0]) + (b[1] - a[1]) * (p[1] - a[1]);
    let within = (0.0..=(b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2)).contains(&along);
    if within { height_over([a, b], p).abs() } else { f64::INFINITY }
}
