//! O-grids: a square core about the impact in rings of cells.

use super::{Graded, Group, Outline, PlaneMesh, edges, node};
use crate::words::domain::Corners;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Fewest cells along a side of the core.
const FEWEST: f64 = 12.0;

/// Half the width of the core over the radius of the circle around it, at most.
const WIDEST_CORE: f64 = 0.5;

/// Bulge of the sides of the core over half its width between corners, (2 - √3)/2: the inner angles of its corners are
/// 90° + 2 atan(2 BULGE) = 120°.
const BULGE: f64 = 0.133_974_596_215_561_35;

/// Core and rings. They are laid out in a circle about their middle, and then mapped by w = (z + a)/(1 + a* z), z and w
/// complex places over its radius, a that of the impact: the circle stays what it is, its middle goes to the impact,
/// angles are kept. Cells become smaller on the near side and larger on the far side.
pub(super) struct Rings {
    outline: Outline,
    /// Radius of the support or of the edge, and whether the plate goes on outside.
    circle: f64,
    overhang: bool,
    /// Place of the impact over that radius.
    impact: [f64; 2],
    /// Cells along a side of the core; a ring has four times as many.
    side: usize,
    /// Half the width of the core between the middles of its sides, before the map.
    half: f64,
    /// Rings from the core to the circle, and on to the edge.
    rings: [usize; 2],
}

impl Rings {
    /// Of a plate that has been checked.
    pub(super) fn new(plate: &Graded) -> Self {
        let (round, edge) = match plate.outline {
            Outline::Disc { radius } => (TAU * radius, radius),
            Outline::Rectangle { sides: [x, y] } => (2.0 * (x + y), 0.25 * (x + y)),
        };
        let circle = plate.support.unwrap_or(edge);
        let impact = plate.impact.map(|x| x / circle);
        let off = impact[0].hypot(impact[1]);
        // By what the map stretches edges along the circle opposite to the impact.
        let stretch = (1.0 + off) / (1.0 - off);
        let around = (round / plate.edge_size).max(4.0 * FEWEST) * stretch;
        let side = 2.0 * (around / 8.0 - 1e-9).ceil();
        let half = (0.5 * side * plate.size / (1.0 - off * off)).min(WIDEST_CORE * circle);
        // About as thick as their cells are wide. Casts saturate, so that what is too large still is.
        let rings = |from: f64, to: f64| ((to / from).ln() * side / FRAC_PI_2).round().max(1.0) as usize;
        let outside = plate.support.map_or(0, |support| rings(support, edge));
        Self {
            outline: plate.outline,
            circle,
            overhang: plate.support.is_some(),
            impact,
            side: side as usize,
            half,
            rings: [rings(core_radius(half), circle), outside],
        }
    }

    pub(super) fn cells(&self) -> usize {
        let rings = self.rings[0].saturating_add(self.rings[1]).saturating_mul(4);
        self.side.saturating_add(rings).saturating_mul(self.side)
    }

    pub(super) fn mesh(&self) -> PlaneMesh {
        let n = self.side;
        let core = |i: usize, j: usize| (j * (n + 1) + i) as u32;
        let cells = (0..n * n).map(|k| (k % n, k / n));
        let mut mesh = PlaneMesh {
            points: self.core(),
            quads: cells
                .map(|(i, j)| [core(i, j), core(i + 1, j), core(i + 1, j + 1), core(i, j + 1)].into())
                .collect(),
            ..PlaneMesh::default()
        };
        let rim = (0..4 * n).map(|k| match (k / n, k % n) {
            (0, i) => core(i, 0),
            (1, j) => core(n, j),
            (2, i) => core(n - i, n),
            (_, j) => core(0, n - j),
        });
        let angle = |k: usize| FRAC_PI_2 * (k as f64 / n as f64 - 1.5);
        let circle = (0..4 * n).map(|k| [self.circle * angle(k).cos(), self.circle * angle(k).sin()]);
        let circle =
            lay_rings(&mut mesh, rim.collect(), circle.collect(), [core_radius(self.half), self.circle], self.rings[0]);
        mesh.points.iter_mut().for_each(|p| *p = self.mapped(*p));
        let mut groups = vec![("impact", node(core(n / 2, n / 2)))];
        let mut outer = circle.clone();
        let mut corners = None;
        if self.overhang {
            groups.push(("support", edges(closed(&circle))));
            let from: Vec<[f64; 2]> = circle.iter().map(|k| mesh.points[*k as usize]).collect();
            let (edge, radius) = match self.outline {
                Outline::Disc { radius } => {
                    (from.iter().map(|p| p.map(|x| x * radius / self.circle)).collect(), radius)
                }
                Outline::Rectangle { sides } => {
                    let at = corners.insert(corners_at(&from, sides));
                    (along(&from, *at, sides), 0.25 * (sides[0] + sides[1]))
                }
            };
            outer = lay_rings(&mut mesh, circle, edge, [self.circle, radius], self.rings[1]);
        }
        let mut edge = closed(&outer);
        if let Some(corners) = corners {
            groups.extend(
                SIDES
                    .into_iter()
                    .zip(parts(corners, edge.len()))
                    .map(|(name, part)| (name, edges(part.map(|k| edge[k]).collect()))),
            );
            // Side by side, as the groups of the sides have them.
            edge.rotate_left(corners[0]);
        }
        groups.push(("edge", edges(edge)));
        groups.push((
            "plate",
            Group {
                dim: 2,
                nodes: (0..mesh.points.len() as u32).collect(),
                quads: (0..mesh.quads.len() as u32).collect(),
                ..Group::default()
            },
        ));
        mesh.groups = groups.into_iter().map(|(name, group)| (name.to_owned(), group)).collect();
        mesh.node_tags = (1..=mesh.points.len() as u64).collect();
        mesh.quad_tags = (1..=mesh.quads.len() as u64).collect();
        mesh
    }

    /// Nodes of the core, along x first: the Coons patch between its bulged sides.
    fn core(&self) -> Vec<[f64; 2]> {
        let line: Vec<f64> = (0..=self.side).map(|i| 2.0 * i as f64 / self.side as f64 - 1.0).collect();
        let bulged = |u: f64, v: f64| self.half / (1.0 + BULGE) * u * (1.0 + BULGE * (1.0 - v * v));
        line.iter()
            .flat_map(|v| line.iter().map(move |u| [*u, *v]))
            .map(|[u, v]| [bulged(u, v), bulged(v, u)])
            .collect()
    }

    fn mapped(&self, p: [f64; 2]) -> [f64; 2] {
        let ([x, y], [a, b]) = (p.map(|x| x / self.circle), self.impact);
        let (top, bottom) = ([x + a, y + b], [1.0 + a * x + b * y, a * y - b * x]);
        let over = self.circle / (bottom[0] * bottom[0] + bottom[1] * bottom[1]);
        [over * (top[0] * bottom[0] + top[1] * bottom[1]), over * (top[1] * bottom[0] - top[0] * bottom[1])]
    }
}

/// Lays rings around the closed line of nodes `inner`, out to `target`, as many places, and gives the outermost nodes.
/// The thickness of rings grows as between circles of the two `radii`.
fn lay_rings(
    mesh: &mut PlaneMesh,
    mut inner: Vec<u32>,
    target: Vec<[f64; 2]>,
    [from, to]: [f64; 2],
    rings: usize,
) -> Vec<u32> {
    let start: Vec<[f64; 2]> = inner.iter().map(|k| mesh.points[*k as usize]).collect();
    for ring in 1..=rings {
        let share = (from * (to / from).powf(ring as f64 / rings as f64) - from) / (to - from);
        let share = if ring == rings { 1.0 } else { share };
        let first = mesh.points.len() as u32;
        let between = |(a, b): (&[f64; 2], &[f64; 2])| [0, 1].map(|d| (1.0 - share) * a[d] + share * b[d]);
        mesh.points.extend(start.iter().zip(&target).map(between));
        let outer: Vec<u32> = (first..).take(target.len()).collect();
        let sides = closed(&inner).into_iter().zip(closed(&outer));
        mesh.quads.extend(sides.map(|([a, b], [c, d])| Corners::from([a, c, d, b])));
        inner = outer;
    }
    inner
}

/// Edges of a closed line.
fn closed(nodes: &[u32]) -> Vec<[u32; 2]> {
    nodes.iter().zip(nodes.iter().cycle().skip(1)).map(|(a, b)| [*a, *b]).collect()
}

/// Sides of a rectangle in the order of its corners, each from a corner to the next.
const SIDES: [&str; 4] = ["y-min", "x-max", "y-max", "x-min"];
const CORNERS: [[f64; 2]; 4] = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];

fn angle(p: [f64; 2]) -> f64 {
    p[1].atan2(p[0])
}

/// The nodes of a circle that see the corners of a rectangle outside.
fn corners_at(circle: &[[f64; 2]], sides: [f64; 2]) -> [usize; 4] {
    CORNERS.map(|corner| {
        let corner = angle([corner[0] * sides[0], corner[1] * sides[1]]);
        // Of two nodes as near the one farther up or down: a choice that mirrors keep.
        let off = |p: &[f64; 2]| (angle(*p) - corner).abs() - 1e-9 * angle(*p).sin().abs();
        let nearest = (0..circle.len()).min_by(|i, j| off(&circle[*i]).total_cmp(&off(&circle[*j])));
        nearest.unwrap_or_default()
    })
}

/// Numbers from each of `corners` up to the next one, of `count` that go round.
fn parts(corners: [usize; 4], count: usize) -> [impl Iterator<Item = usize>; 4] {
    [0, 1, 2, 3].map(|side| {
        let (from, to) = (corners[side], corners[(side + 1) % 4]);
        (from..if to > from { to } else { to + count }).map(move |k| k % count)
    })
}

/// Places along a rectangle for nodes of a circle inside it, by their angles between those of its corners.
fn along(circle: &[[f64; 2]], corners: [usize; 4], sides: [f64; 2]) -> Vec<[f64; 2]> {
    let mut places = vec![[0.0; 2]; circle.len()];
    for (side, part) in parts(corners, circle.len()).into_iter().enumerate() {
        let [first, last] = [CORNERS[side], CORNERS[(side + 1) % 4]];
        let turn = |k: usize| (angle(circle[k]) - angle(circle[corners[side]])).rem_euclid(TAU);
        let whole = turn(corners[(side + 1) % 4]);
        for k in part {
            let share = turn(k) / whole;
            places[k] = [0, 1].map(|d| sides[d] * (first[d] + share * (last[d] - first[d])));
        }
    }
    places
}

/// Mean distance of the nodes of the core's sides from its middle.
fn core_radius(half: f64) -> f64 {
    0.5 * half * (1.0 + std::f64::consts::SQRT_2 / (1.0 + BULGE))
}
