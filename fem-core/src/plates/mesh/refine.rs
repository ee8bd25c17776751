//! Uniform refinement.

use super::curve::Chains;
use super::{Group, PlaneMesh};
use crate::words::domain::{Corners, Domain};
use std::collections::HashMap;
use std::f64::consts::PI;

/// What becomes of edges that follow a curve when they are halved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Curves {
    /// The new node lies on the curve.
    Kept,
    /// The new node lies on the edge: a polygon stays what it is.
    Straight,
}

impl Curves {
    /// Both by name.
    pub const ALL: [(&'static str, Self); 2] = [("kept", Self::Kept), ("straight", Self::Straight)];
}

/// Largest inner angle of a cell that an edge on a curve may lead to, radians.
const FLATTEST: f64 = PI * 179.0 / 180.0;

/// An edge without its direction.
fn key([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn mean(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|d| 0.5 * (p[d] + q[d]))
}

impl PlaneMesh {
    /// The mesh with every cell divided into four: a quadrilateral by the middles of its edges and its own, a triangle by those
    /// of its edges alone.
    ///
    /// With [`Curves::Kept`] the middle of an edge that follows a curve (see [`PlaneMesh::curved_turn`]), on the boundary,
    /// in a group of edges or around one of cells, is put on it, at the height s = κ (c/2)² / (1 + √(1 − (κ c/2)²)) above the chord c. The
    /// curvature κ is that of the circle through three nodes in a row, the mean over both ends of the edge, or over the
    /// one whose neighbours go on with the curve: exact for circles, of fourth order in c for evenly divided curves. The
    /// centre of a cell is that of its transfinite (Coons) patch, half the sum of its middles less a quarter of that of
    /// its corners. Edges of a cell that would no longer be convex (thin, beside a coarse curve) stay straight.
    ///
    /// Sides that the mesh itself says are bent stay what they are, with either: the parts cover the same places.
    ///
    /// Groups keep their meaning: of nodes the same nodes, of edges their halves, of cells their quarters, each with all
    /// nodes. Old nodes keep their place and tag, new ones count on from the largest. The quarters of the cell with tag t
    /// have the tags 10 t + 1 to 10 t + 4, in the order of its corners, so that they name the cell they come from; tags
    /// that would not fit stay at the largest number there is.
    pub fn refined(&self, curves: Curves) -> Self {
        let bends = match curves {
            _ if !self.bends.is_empty() => self.bends.iter().map(|(ends, bend)| (*ends, *bend)).collect(),
            Curves::Kept => self.convex_bends(),
            Curves::Straight => HashMap::new(),
        };
        let mut fine = Self { points: self.points.clone(), node_tags: self.node_tags.clone(), ..Self::default() };
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        for (quad, tag) in self.quads.iter().zip(&self.quad_tags) {
            let middle = |edge| {
                *middles.entry(key(edge)).or_insert_with(|| {
                    fine.points.push(self.middle(edge, &bends));
                    fine.points.len() as u32 - 1
                })
            };
            let middles = quad.map_sides(middle);
            let quarters = quad.quarters(middles, || {
                let corners = quad.map(|n| self.points[n as usize]);
                fine.points.push(corners.coons_centre(middles.map(|n| fine.points[n as usize])));
                fine.points.len() as u32 - 1
            });
            if !self.bends.is_empty() {
                fine.bends.extend(self.bends_of_parts(quad, middles, &quarters));
            }
            fine.quads.extend(quarters);
            fine.quad_tags.extend((1..=4).map(|k| tag.saturating_mul(10).saturating_add(k)));
        }
        let largest = self.node_tags.iter().copied().max().unwrap_or(0);
        let new = fine.points.len() - self.points.len();
        fine.node_tags.extend((1..=new as u64).map(|k| largest.saturating_add(k)));
        let groups = self.groups.iter().map(|(name, group)| (name.clone(), group.refined(&middles, &fine.quads)));
        fine.groups = groups.collect();
        fine
    }

    /// How the sides of the quarters of a cell are bent: those on a side as a part of its parabola, those inside as the map of the
    /// cell bends them.
    fn bends_of_parts(
        &self,
        quad: &Corners<u32>,
        middles: Corners<u32>,
        quarters: &[Corners<u32>; 4],
    ) -> Vec<([u32; 2], [f64; 2])> {
        let bends = quad.map_sides(|edge| self.bends.get(&key(edge)).copied().unwrap_or_default());
        let n = quad.len();
        let mut parts = Vec::new();
        let mut put = |ends: [u32; 2], bend: [f64; 2]| {
            // Half of a parabola is bent by a quarter.
            if bend != [0.0; 2] {
                parts.push((key(ends), bend.map(|b| 0.25 * b)));
            }
        };
        for (i, [a, b]) in quad.sides().enumerate() {
            put([a, middles[i]], bends[i]);
            put([middles[i], b], bends[i]);
        }
        match quad.domain() {
            Domain::Quadrilateral => {
                let centre = quarters[0][2];
                for i in 0..n {
                    // The line from the middle of a side to that across runs along the sides between.
                    put([middles[i], centre], mean(bends[(i + 1) % n], bends[(i + 3) % n]));
                }
            }
            Domain::Triangle => {
                for i in 0..n {
                    // Beside corner i + 2: parallel to the side across, number i.
                    put([middles[(i + 1) % n], middles[(i + 2) % n]], bends[i]);
                }
            }
        }
        parts
    }

    /// The middle of an edge, on its curve where `bends` says how far that is.
    fn middle(&self, edge: [u32; 2], bends: &HashMap<[u32; 2], [f64; 2]>) -> [f64; 2] {
        let [a, b] = key(edge).map(|n| self.points[n as usize]);
        let middle = mean(a, b);
        bends.get(&key(edge)).map_or(middle, |bend| [middle[0] + bend[0], middle[1] + bend[1]])
    }

    /// From the middles of edges to the curves that they follow, as far as the quarters of all cells stay convex.
    fn convex_bends(&self) -> HashMap<[u32; 2], [f64; 2]> {
        let mut bends = HashMap::new();
        let curves = self.groups.values().filter(|g| g.dim == 1).map(|g| g.edges.clone());
        let rims = self.groups.values().filter(|g| g.dim == 2).map(|g| self.rim_of(g));
        for edges in std::iter::once(self.boundary()).chain(curves).chain(rims) {
            let chains = Chains::of(&self.points, edges);
            for edge in chains.edges().iter().map(|edge| key(*edge)) {
                if let Some(bend) = chains.sagitta(edge) {
                    bends.entry(edge).or_insert(bend);
                }
            }
        }
        loop {
            let bent = |quad: &&Corners<u32>| quad.sides().any(|edge| bends.contains_key(&key(edge)));
            let flat = |quad: &&Corners<u32>| {
                let corners = quad.map(|n| self.points[n as usize]);
                let middles = quad.map_sides(|edge| self.middle(edge, &bends));
                let quarters = corners.quarters(middles, || corners.coons_centre(middles));
                !quarters.iter().all(|quarter| quarter.quality().largest_angle < FLATTEST)
            };
            let flat: Vec<_> = self.quads.iter().filter(bent).filter(flat).collect();
            if flat.is_empty() {
                return bends;
            }
            flat.into_iter().flat_map(|quad| quad.sides()).for_each(|edge| {
                bends.remove(&key(edge));
            });
        }
    }
}

impl Group {
    fn refined(&self, middles: &HashMap<[u32; 2], u32>, quads: &[Corners<u32>]) -> Self {
        let halves = |[a, b]: &[u32; 2]| match middles.get(&key([*a, *b])) {
            Some(middle) => vec![[*a, *middle], [*middle, *b]],
            None => vec![[*a, *b]],
        };
        let edges: Vec<[u32; 2]> = self.edges.iter().flat_map(halves).collect();
        let own: Vec<u32> = self.quads.iter().flat_map(|quad| (0..4).map(move |k| 4 * quad + k)).collect();
        let mut nodes = self.nodes.clone();
        nodes.extend(edges.iter().flatten());
        nodes.extend(own.iter().flat_map(|quad| quads[*quad as usize]));
        nodes.sort_unstable();
        nodes.dedup();
        Self { dim: self.dim, nodes, edges, quads: own }
    }
}
