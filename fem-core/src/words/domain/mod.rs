//! Shapes of plane cells: the reference domain, and all that follows from the number of corners.
//!
//! This is the only place that counts corners. An element names its [`Domain`]; a cell's [`Corners`], of node numbers or of
//! positions, know theirs. Map, quadrature, sides, area, quality, division and search for a point follow.

mod corners;
mod geometry;
mod plane_cell;
mod rule;

pub use corners::Corners;
pub use geometry::{CellQuality, PlaneMap};
pub use plane_cell::PlaneCell;

/// Reference domain of a plane cell, in the natural coordinates (r, s).
///
/// ```text
///     3---------2          2
///     |    s    |          | \          corners (±1, ±1), anticlockwise from (−1, −1);
///     |    |    |          |   \        a triangle has no corner at (1, 1), its hypotenuse
///     |    o--r |          |  o  \      has its middle at (0, 0)
///     0---------1          0-------1
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Domain {
    /// −1 ≤ r, s ≤ 1, mapped bilinearly.
    #[default]
    Quadrilateral,
    /// −1 ≤ r, s and r + s ≤ 0, mapped linearly.
    Triangle,
}

/// A quadrature point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Natural coordinates.
    pub at: [f64; 2],
    /// Factors of its weight: one of each coordinate on a quadrilateral.
    pub factors: [f64; 2],
}

impl Point {
    /// Its weight; all add up to the area of the domain, 4 or 2.
    pub fn weight(&self) -> f64 {
        self.factors[0] * self.factors[1]
    }
}

const QUADRILATERAL: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
const TRIANGLE: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]];

impl Domain {
    /// "quadrilateral", "triangle".
    pub fn name(self) -> &'static str {
        match self {
            Self::Quadrilateral => "quadrilateral",
            Self::Triangle => "triangle",
        }
    }

    /// Natural coordinates of the corners, anticlockwise.
    pub fn corners(self) -> &'static [[f64; 2]] {
        match self {
            Self::Quadrilateral => &QUADRILATERAL,
            Self::Triangle => &TRIANGLE,
        }
    }

    /// Natural coordinates of the centroid.
    pub fn centre(self) -> [f64; 2] {
        match self {
            Self::Quadrilateral => [0.0; 2],
            Self::Triangle => [-1.0 / 3.0; 2],
        }
    }

    /// Vertex functions: 1 at their corner, 0 at the others, linear along each side.
    pub fn vertex_functions(self, [r, s]: [f64; 2]) -> Corners<f64> {
        match self {
            Self::Quadrilateral => QUADRILATERAL.map(|[ri, si]| 0.25 * (1.0 + r * ri) * (1.0 + s * si)).into(),
            Self::Triangle => [-0.5 * (r + s), 0.5 * (1.0 + r), 0.5 * (1.0 + s)].into(),
        }
    }

    /// The corners whose mean a place of a node table is: one for a corner, two for the middle of a side, all for the middle
    /// of a quadrilateral.
    pub fn corners_around(self, place: [f64; 2]) -> Vec<usize> {
        let functions = self.vertex_functions(place);
        (0..functions.len()).filter(|i| functions[*i] != 0.0).collect()
    }

    /// The point of a side, from corner `side` to the next, at −1 ≤ t ≤ 1.
    pub fn on_side(self, side: usize, t: f64) -> [f64; 2] {
        match (self, side) {
            (_, 0) => [t, -1.0],
            (Self::Quadrilateral, 1) => [1.0, t],
            (Self::Quadrilateral, 2) => [-t, 1.0],
            (Self::Triangle, 1) => [-t, t],
            _ => [-1.0, -t],
        }
    }

    /// Quadrature points: symmetric under the domain's own symmetries, exact to degree 2 `order` − 1 (of each
    /// coordinate on the quadrilateral, of both together on the triangle).
    pub fn points(self, order: usize) -> &'static [Point] {
        rule::points(self, order)
    }

    /// Points at which a field within the cell is sampled, one for each corner, where the strains of most elements are best: in a
    /// quadrilateral the Gauss points of order 2 (Barlow 1976).
    pub fn samples(self) -> Corners<Point> {
        let ([r0, s0], share) = (self.centre(), self.sample_share());
        let at = |[r, s]: [f64; 2]| Point { at: [r0 + share * (r - r0), s0 + share * (s - s0)], factors: [1.0; 2] };
        match self {
            Self::Quadrilateral => QUADRILATERAL.map(at).into(),
            Self::Triangle => TRIANGLE.map(at).into(),
        }
    }

    /// What the values at [`Domain::samples`] count for at a natural point: 1 at a sample, 0 at the others, linear between.
    pub fn sample_functions(self, [r, s]: [f64; 2]) -> Corners<f64> {
        let ([r0, s0], share) = (self.centre(), self.sample_share());
        self.vertex_functions([r0 + (r - r0) / share, s0 + (s - s0) / share])
    }

    /// How far from the centre samples are, of the way to the corner.
    fn sample_share(self) -> f64 {
        match self {
            Self::Quadrilateral => 3.0_f64.sqrt().recip(),
            Self::Triangle => 0.5,
        }
    }

    /// Quadrature points of the section of a strip, which varies along r alone.
    pub fn section_points(order: usize) -> &'static [Point] {
        rule::section_points(order)
    }

    /// Points that divide every side into `n` equal parts, by their numbers along r and s from the first corner; r runs
    /// fastest.
    pub fn lattice(self, n: usize) -> Vec<[usize; 2]> {
        (0..=n).flat_map(|j| (0..=self.row(n, j)).map(move |i| [i, j])).collect()
    }

    /// How many points [`Domain::lattice`] has.
    pub fn lattice_count(self, n: usize) -> usize {
        self.lattice_number(n, [0, n]) + self.row(n, n) + 1
    }

    /// Where a point is in [`Domain::lattice`].
    pub fn lattice_number(self, n: usize, [i, j]: [usize; 2]) -> usize {
        (0..j).map(|below| self.row(n, below) + 1).sum::<usize>() + i
    }

    /// The cells between the points of [`Domain::lattice`], all of the domain's own shape.
    pub fn lattice_cells(self, n: usize) -> Vec<Corners<[usize; 2]>> {
        let upright = |[i, j]: [usize; 2]| match self {
            Self::Quadrilateral => [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].into(),
            Self::Triangle => [[i, j], [i + 1, j], [i, j + 1]].into(),
        };
        let turned = |[i, j]: [usize; 2]| {
            (self == Self::Triangle && i + j + 1 < n).then(|| [[i + 1, j], [i + 1, j + 1], [i, j + 1]].into())
        };
        let first = self.lattice(n).into_iter().filter(|[i, j]| *j < n && *i < self.row(n, *j));
        first.flat_map(|at| [Some(upright(at)), turned(at)]).flatten().collect()
    }

    /// The two corners of a side that a point of [`Domain::lattice`] lies on, and how many parts it is from the first.
    pub fn lattice_side(self, n: usize, point: [usize; 2]) -> Option<([usize; 2], usize)> {
        match (self, point) {
            (_, [i, 0]) => Some(([0, 1], i)),
            (Self::Quadrilateral, [i, j]) if j == n => Some(([3, 2], i)),
            (Self::Quadrilateral, [0, j]) => Some(([0, 3], j)),
            (Self::Quadrilateral, [i, j]) if i == n => Some(([1, 2], j)),
            (Self::Triangle, [0, j]) => Some(([0, 2], j)),
            (Self::Triangle, [i, j]) if i + j == n => Some(([1, 2], j)),
            _ => None,
        }
    }

    /// Parts of the row of a lattice at height `j`.
    fn row(self, n: usize, j: usize) -> usize {
        match self {
            Self::Quadrilateral => n,
            Self::Triangle => n - j,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
