//! Chains of edges, and where they follow a curve.

use std::collections::HashMap;

/// Turns between two edges of a chain that follow a curve, radians: less is straight, more a corner.
const SMOOTH: std::ops::Range<f64> = 1e-4..0.7;

/// Ratios of the curvatures at neighbouring nodes of one curve.
const ALIKE: std::ops::Range<f64> = 0.5..2.0;

/// Edges in their chains: the boundary of a mesh, or a group of edges inside it.
pub(super) struct Chains<'a> {
    points: &'a [[f64; 2]],
    edges: Vec<[u32; 2]>,
    neighbours: HashMap<u32, Vec<u32>>,
}

/// How a chain goes on at a node.
#[derive(Clone, Copy)]
enum Course {
    /// Not at all, at several edges or round a corner.
    Ends,
    Straight,
    Bends(Bend),
}

/// Turn from one edge to the next, positive to the left.
#[derive(Clone, Copy)]
pub(super) struct Bend {
    /// Radians.
    pub(super) turn: f64,
    /// Of the circle through the node and its neighbours, 1/m.
    pub(super) curvature: f64,
}

impl<'a> Chains<'a> {
    pub(super) fn of(points: &'a [[f64; 2]], edges: Vec<[u32; 2]>) -> Self {
        let mut neighbours: HashMap<u32, Vec<u32>> = HashMap::new();
        for [a, b] in &edges {
            neighbours.entry(*a).or_default().push(*b);
            neighbours.entry(*b).or_default().push(*a);
        }
        Self { points, edges, neighbours }
    }

    pub(super) fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// The node after `b`, coming from `a`.
    fn after(&self, a: u32, b: u32) -> Option<u32> {
        match self.neighbours.get(&b)?[..] {
            [p, q] if p == a => Some(q),
            [p, q] if q == a => Some(p),
            _ => None,
        }
    }

    /// The course at `b`, coming from `a`.
    fn course(&self, a: u32, b: u32) -> Course {
        let Some(c) = self.after(a, b) else { return Course::Ends };
        let [a, b, c] = [a, b, c].map(|n| self.points[n as usize]);
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
        let cross = u[0] * v[1] - u[1] * v[0];
        let turn = cross.atan2(u[0] * v[0] + u[1] * v[1]);
        let lengths = [u[0].hypot(u[1]), v[0].hypot(v[1]), (c[0] - a[0]).hypot(c[1] - a[1])];
        match turn.abs() {
            t if t <= SMOOTH.start => Course::Straight,
            t if t < SMOOTH.end => {
                Course::Bends(Bend { turn, curvature: 2.0 * cross / lengths.iter().product::<f64>() })
            }
            _ => Course::Ends,
        }
    }

    /// The bend at `b`, coming from `a`, if the chain follows a curve there: the circle through a neighbour has the same
    /// sense and about the same size, and no straight line begins.
    fn follows(&self, a: u32, b: u32) -> Option<Bend> {
        let Course::Bends(own) = self.course(a, b) else { return None };
        let c = self.after(a, b)?;
        // The neighbour behind is looked at backwards, where the same turn has the other sign.
        let neighbours = [(self.course(b, c), 1.0), (self.course(b, a), -1.0)];
        let alike = |(course, sign): &(Course, f64)| match course {
            Course::Bends(bend) => ALIKE.contains(&(sign * bend.curvature / own.curvature)),
            _ => false,
        };
        let joins_line = neighbours.iter().any(|(course, _)| matches!(course, Course::Straight));
        // A node where arc and line meet says half of the arc's curvature.
        (!joins_line && neighbours.iter().any(alike)).then_some(own)
    }

    /// The bends at those ends of an edge where its chain follows a curve, seen along the edge; none along a line.
    pub(super) fn bends(&self, [a, b]: [u32; 2]) -> impl Iterator<Item = Bend> {
        let straight = [(a, b), (b, a)].iter().any(|(a, b)| matches!(self.course(*a, *b), Course::Straight));
        let back = self.follows(b, a).map(|bend| Bend { turn: -bend.turn, curvature: -bend.curvature });
        [back, self.follows(a, b)].into_iter().flatten().filter(move |_| !straight)
    }

    /// From the middle of an edge to the curve that its chain follows, m; `None` where it follows none.
    pub(super) fn sagitta(&self, [a, b]: [u32; 2]) -> Option<[f64; 2]> {
        let bends: Vec<_> = self.bends([a, b]).map(|bend| bend.curvature).collect();
        if bends.is_empty() {
            return None;
        }
        let curvature = bends.iter().sum::<f64>() / bends.len() as f64;
        let [p, q] = [a, b].map(|n| self.points[n as usize]);
        let edge = [q[0] - p[0], q[1] - p[1]];
        // Half the edge over the radius: the sine of half the arc.
        let sine = 0.5 * curvature * edge[0].hypot(edge[1]);
        let height = 0.5 * sine / (1.0 + (1.0 - sine * sine).max(0.0).sqrt());
        // Away from the centre: to the right of a turn to the left.
        Some([height * edge[1], -height * edge[0]])
    }
}
