//! Built-in plates whose cells grow from the place of the impact.

mod grid;
mod rings;
#[cfg(test)]
mod tests;

use super::{Group, PlaneMesh};
use crate::contracts::plugin::ParamError;
use rings::Rings;

/// Cells that a generated mesh may have: more is a mistake.
pub const MAX_CELLS: usize = 4_000_000;

/// The impact's largest distance from the middle over the radius of the circle around it.
const OFF_CENTRE: f64 = 0.6;

/// Largest radius of a support over that of the largest circle in the plate.
const WIDEST_SUPPORT: f64 = 0.95;

/// Least width of what is left of a side beside a window, over the side.
const SLIGHT: f64 = 1e-3;

/// Largest ratio of the sides of a rectangle over a circular support.
const LONGEST: f64 = 2.0;

/// Edge of a plate about the origin, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outline {
    /// A circle.
    Disc {
        /// Its radius.
        radius: f64,
    },
    /// A rectangle along the axes.
    Rectangle {
        /// Lengths along x and y.
        sides: [f64; 2],
    },
}

/// A plate about the origin with a node at the place of the impact, around which its cells are smallest. Lengths in m.
///
/// A disc, and a plate on a circular support, are an O-grid: a square core of n x n cells about the impact, then rings
/// of 4 n cells out to the support and on to the edge. Three cells meet at 120 degrees in each corner of the core,
/// whose sides bulge for that. n is even, at least 12 (48 straight edges are 0.3 % short of a circle's area) and as
/// large as `edge_size` asks for; rings are about as thick as their cells are wide. An impact off the middle is reached
/// by a map of the circle onto itself that keeps angles; as edges opposite to it become longer, n is larger. A
/// rectangle without circular support is a grid of lines along the axes, whose distances grow by a fifth from cell to
/// cell up to `edge_size`; a window is a rectangle of such lines.
///
/// With the impact at the middle the mesh is its own image in both mirrors, and in quarter turns where the edge is. The
/// scaled Jacobian, the smallest sine of an inner angle of a cell, is at least 0.84 in a disc, 0.5 in a square over a
/// ring (0.7 with the impact at the middle and a ring of up to 0.8 of half the side), 0.35 in a rectangle, no more than
/// twice as long as wide, over a ring of up to 0.9 of half its width, 0.24 over one of up to 0.95, 1 in a grid.
///
/// Groups: `plate` (cells), `edge` and, where there are such, `support` and `window` (edges), `impact` (a node); of a rectangle also
/// its sides `x-min`, `x-max`, `y-min`, `y-max`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Graded {
    /// The edge.
    pub outline: Outline,
    /// Radius of a circular line of support about the origin.
    pub support: Option<f64>,
    /// Lengths along x and y of a rectangle of lines about the origin, the window of a frame.
    pub window: Option<[f64; 2]>,
    /// Place of the impact.
    pub impact: [f64; 2],
    /// Largest edge of the cells at the impact; those beside an impact off the middle may differ by a sixth.
    pub size: f64,
    /// Largest edge of the cells along the edge of the plate; the mean one of a rectangle over a ring.
    pub edge_size: f64,
}

/// How a plate is divided.
enum Division {
    Rings(Rings),
    Grid([Vec<f64>; 2]),
}

impl Graded {
    /// Number of its cells.
    ///
    /// # Errors
    /// As [`Graded::mesh`].
    pub fn cells(&self) -> Result<usize, ParamError> {
        self.divide().map(|division| division.cells())
    }

    /// The mesh; numbers of nodes and cells count from 1.
    ///
    /// # Errors
    /// Lengths that are not positive and finite, an impact too far from the middle or off the plate, a support that does
    /// not lie inside the edge, a strip over a circular support, more than [`MAX_CELLS`] cells. The key of the error is
    /// `radius`, `sides`, `support`, `window`, `impact`, `size` or `edge_size`.
    pub fn mesh(&self) -> Result<PlaneMesh, ParamError> {
        Ok(match self.divide()? {
            Division::Rings(rings) => rings.mesh(),
            Division::Grid([x, y]) => grid::mesh(&x, &y, self.impact, self.window),
        })
    }

    fn divide(&self) -> Result<Division, ParamError> {
        self.check()?;
        let division = match (self.outline, self.support) {
            (Outline::Rectangle { sides }, None) => {
                let window = |d: usize| self.window.map(|window| window[d]);
                let lines = |d: usize| grid::lines(sides[d], window(d), self.impact[d], [self.size, self.edge_size]);
                Division::Grid([lines(0)?, lines(1)?])
            }
            _ => Division::Rings(Rings::new(self)),
        };
        let cells = division.cells();
        if cells > MAX_CELLS {
            let key = if self.edge_size > 3.0 * self.size { "edge_size" } else { "size" };
            return Err(ParamError::new(key, format!("makes {cells} cells, more than {MAX_CELLS}: enlarge it")));
        }
        Ok(division)
    }

    fn check(&self) -> Result<(), ParamError> {
        let lengths = match self.outline {
            Outline::Disc { radius } => [("radius", radius); 2],
            Outline::Rectangle { sides } => sides.map(|side| ("sides", side)),
        };
        let sizes = [("size", self.size), ("edge_size", self.edge_size)];
        let support = self.support.map(|radius| ("support", radius));
        for (key, length) in lengths.into_iter().chain(sizes).chain(support) {
            if !(length > 0.0 && length.is_finite()) {
                return Err(ParamError::new(key, format!("{length} m is not a length: it must be positive")));
            }
        }
        if self.edge_size < self.size {
            return Err(ParamError::new("edge_size", "is smaller than `size`: cells grow from the impact to the edge"));
        }
        let inner = self.inner_radius();
        if self.support.is_some_and(|radius| radius > WIDEST_SUPPORT * inner) {
            let limit = WIDEST_SUPPORT * inner * 1e3;
            let why = format!(
                "a circular support lies inside the edge, with a radius of at most {limit} mm here; where it is the \
                 edge itself, leave it out and hold the group `edge`"
            );
            return Err(ParamError::new("support", why));
        }
        if let Some(window) = self.window {
            let Outline::Rectangle { sides } = self.outline else {
                return Err(ParamError::new("window", "is that of a rectangle"));
            };
            if self.support.is_some() {
                return Err(ParamError::new("window", "and `support` exclude each other"));
            }
            if !(0..2).all(|d| window[d] > 0.0 && window[d] <= (1.0 - SLIGHT) * sides[d]) {
                return Err(ParamError::new("window", "lies inside the plate, shorter than its sides along x and y"));
            }
        }
        match (self.outline, self.support) {
            (Outline::Rectangle { sides }, None) => {
                let inside = |d: usize| self.impact[d].abs() <= 0.5 * sides[d] - 0.5 * self.size.min(sides[d]);
                if !(inside(0) && inside(1)) {
                    let why = "lies on the edge, off the plate or within half of `size` of the edge: x and y count from \
                               the middle of the plate";
                    return Err(ParamError::new("impact", why));
                }
            }
            (outline, support) => {
                if let Outline::Rectangle { sides: [x, y] } = outline
                    && !(x.max(y) <= LONGEST * x.min(y))
                {
                    let why =
                        format!("over a circular support one side is at most {LONGEST} times as long as the other");
                    return Err(ParamError::new("sides", why));
                }
                let radius = support.unwrap_or(inner);
                let off = self.impact[0].hypot(self.impact[1]);
                if !(off <= OFF_CENTRE * radius) {
                    let why = format!(
                        "lies {} mm from the middle, and cells stay good up to {} mm, {OFF_CENTRE} of the circle's \
                         radius: x and y count from the middle",
                        off * 1e3,
                        OFF_CENTRE * radius * 1e3
                    );
                    return Err(ParamError::new("impact", why));
                }
            }
        }
        Ok(())
    }

    /// Radius of the largest circle in the plate.
    fn inner_radius(&self) -> f64 {
        match self.outline {
            Outline::Disc { radius } => radius,
            Outline::Rectangle { sides: [x, y] } => 0.5 * x.min(y),
        }
    }
}

impl Division {
    fn cells(&self) -> usize {
        match self {
            Self::Rings(rings) => rings.cells(),
            Self::Grid([x, y]) => (x.len() - 1).saturating_mul(y.len() - 1),
        }
    }
}

/// A group of edges with their nodes.
fn edges(edges: Vec<[u32; 2]>) -> Group {
    let mut nodes: Vec<u32> = edges.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    Group { dim: 1, nodes, edges, ..Group::default() }
}

/// The group of a single node.
fn node(node: u32) -> Group {
    Group { nodes: vec![node], ..Group::default() }
}
