//! Chains of edges, and where they follow a curve.

use std::collections::HashMap;

/// Turns between two edges of a chain that follow a curve, radians: less is straight, more a corner.
const SMOOTH: std::ops::Range<f64> = 1e-4..0.7;

/// Sine of the angle between two lines through a node that are one.
const SAME_LINE: f64 = 1e-4;

/// Ratios of the curvatures at neighbouring nodes of one curve.
const ALIKE: std::ops::Range<f64> = 0.5..2.0;

/// Distances of nodes from the middle of the circle that they lie on, relative to each other.
const ROUND: f64 = 1e-6;

/// Direction and curvature of a curve at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Angle of the tangent from the x axis, radians.
    pub angle: f64,
    /// Of the circle through the node and its neighbours, positive where it turns to the left of the tangent, 1/m; 0 on a line.
    pub curvature: f64,
}

impl Course {
    /// Of a line at this angle, radians.
    pub const fn straight(angle: f64) -> Self {
        Self { angle, curvature: 0.0 }
    }
}

/// Edges in their chains: the boundary of a mesh, or a group of edges inside it.
pub(super) struct Chains<'a> {
    points: &'a [[f64; 2]],
    edges: Vec<[u32; 2]>,
    neighbours: HashMap<u32, Vec<u32>>,
}

/// How a chain goes on at a node.
#[derive(Clone, Copy)]
enum Onward {
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

    /// The closed chain from `a` to `b` and on to `a` again; `None` where it ends, or other chains touch it.
    fn ring(&self, [a, b]: [u32; 2]) -> Option<Vec<u32>> {
        let mut ring = vec![a, b];
        while let [.., before, last] = ring[..] {
            match self.after(before, last)? {
                next if next == a => break,
                next => ring.push(next),
            }
        }
        Some(ring)
    }

    /// Middles and numbers of sides of closed chains whose nodes lie on a circle and whose turns count as corners, because so few edges
    /// stand for it; no triangles and rectangles, which are hardly meant to.
    pub(super) fn coarse_circles(&self) -> Vec<([f64; 2], usize)> {
        let circle = |edge: &[u32; 2]| {
            let ring = self.ring(*edge).filter(|ring| edge[0] == ring.iter().copied().fold(u32::MAX, u32::min))?;
            let sides = ring.len();
            let corner = |pair: &[u32]| matches!(self.course(pair[0], pair[1]), Onward::Ends);
            let points: Vec<[f64; 2]> = ring.iter().map(|node| self.points[*node as usize]).collect();
            let middle = [0, 1].map(|d| points.iter().map(|p| p[d]).sum::<f64>() / sides as f64);
            let radii = || points.iter().map(|p| (p[0] - middle[0]).hypot(p[1] - middle[1]));
            let (least, most) = radii().fold((f64::INFINITY, 0.0_f64), |(least, most), r| (least.min(r), most.max(r)));
            (sides > 4 && ring.windows(2).all(corner) && most - least <= ROUND * most).then_some((middle, sides))
        };
        self.edges.iter().filter_map(circle).collect()
    }

    /// The course at `b`, coming from `a`.
    fn course(&self, a: u32, b: u32) -> Onward {
        let Some(c) = self.after(a, b) else { return Onward::Ends };
        let [a, b, c] = [a, b, c].map(|n| self.points[n as usize]);
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
        let cross = u[0] * v[1] - u[1] * v[0];
        let turn = cross.atan2(u[0] * v[0] + u[1] * v[1]);
        let lengths = [u[0].hypot(u[1]), v[0].hypot(v[1]), (c[0] - a[0]).hypot(c[1] - a[1])];
        match turn.abs() {
            t if t <= SMOOTH.start => Onward::Straight,
            t if t < SMOOTH.end => {
                Onward::Bends(Bend { turn, curvature: 2.0 * cross / lengths.iter().product::<f64>() })
            }
            _ => Onward::Ends,
        }
    }

    /// The bend at `b`, coming from `a`, if the chain follows a curve there: the circle through a neighbour has the same
    /// sense and about the same size, and no straight line begins.
    fn follows(&self, a: u32, b: u32) -> Option<Bend> {
        let Onward::Bends(own) = self.course(a, b) else { return None };
        let c = self.after(a, b)?;
        // The neighbour behind is looked at backwards, where the same turn has the other sign.
        let neighbours = [(self.course(b, c), 1.0), (self.course(b, a), -1.0)];
        let alike = |(course, sign): &(Onward, f64)| match course {
            Onward::Bends(bend) => ALIKE.contains(&(sign * bend.curvature / own.curvature)),
            _ => false,
        };
        let joins_line = neighbours.iter().any(|(course, _)| matches!(course, Onward::Straight));
        // A node where arc and line meet says half of the arc's curvature.
        (!joins_line && neighbours.iter().any(alike)).then_some(own)
    }

    /// The bends at those ends of an edge where its chain follows a curve, seen along the edge; none along a line.
    pub(super) fn bends(&self, [a, b]: [u32; 2]) -> impl Iterator<Item = Bend> {
        let straight = [(a, b), (b, a)].iter().any(|(a, b)| matches!(self.course(*a, *b), Onward::Straight));
        let back = self.follows(b, a).map(|bend| Bend { turn: -bend.turn, curvature: -bend.curvature });
        [back, self.follows(a, b)].into_iter().flatten().filter(move |_| !straight)
    }

    /// How the chain runs through `b`: along one line where it is smooth, along each of its edges at a corner. A tangent is that of
    /// the circle through a node and its neighbours, at the end of a curve that of the circle beside it; where a line and a curve
    /// meet, the line.
    pub(super) fn courses(&self, b: u32) -> Vec<Course> {
        let line = |from: u32, to: u32| Course::straight(self.angle(from, to));
        let is_straight = |from: u32, at: u32| matches!(self.course(from, at), Onward::Straight);
        match self.neighbours.get(&b).map_or(&[][..], Vec::as_slice) {
            [a] => match self.smooth(*a) {
                // The chord lies midway between the tangents at its ends.
                Some(next) if next.curvature != 0.0 => {
                    let chord = if self.neighbours[a][0] == b { self.angle(b, *a) } else { self.angle(*a, b) };
                    vec![Course { angle: 2.0 * chord - next.angle, ..next }]
                }
                _ => vec![line(*a, b)],
            },
            [a, c] => match (self.smooth(b), is_straight(b, *a), is_straight(b, *c)) {
                (Some(own), false, false) => vec![own],
                (Some(own), ..) if own.curvature == 0.0 => vec![own],
                (Some(_), true, false) => vec![line(*a, b)],
                (Some(_), false, true) => vec![line(b, *c)],
                _ => vec![line(*a, b), line(b, *c)],
            },
            several => {
                let mut found: Vec<Course> = Vec::new();
                for course in several.iter().map(|a| line(*a, b)) {
                    if found.iter().all(|other| (course.angle - other.angle).sin().abs() > SAME_LINE) {
                        found.push(course);
                    }
                }
                found
            }
        }
    }

    /// The circle through `b` and its two neighbours, from the first to the second, or their line; none at a corner or an end.
    fn smooth(&self, b: u32) -> Option<Course> {
        let [a, c] = *self.neighbours.get(&b)?.first_chunk()?;
        match self.course(a, b) {
            Onward::Ends => None,
            Onward::Straight => Some(Course::straight(self.angle(a, c))),
            Onward::Bends(Bend { turn, curvature }) => {
                let [before, after] = [(a, b), (b, c)].map(|(p, q)| self.length(p, q));
                Some(Course { angle: self.angle(a, b) + turn * before / (before + after), curvature })
            }
        }
    }

    fn between(&self, from: u32, to: u32) -> [f64; 2] {
        let [p, q] = [from, to].map(|n| self.points[n as usize]);
        [q[0] - p[0], q[1] - p[1]]
    }

    fn angle(&self, from: u32, to: u32) -> f64 {
        let [x, y] = self.between(from, to);
        y.atan2(x)
    }

    fn length(&self, from: u32, to: u32) -> f64 {
        let [x, y] = self.between(from, to);
        x.hypot(y)
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
