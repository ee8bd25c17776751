//! Plane cells by the positions of their corners, m.

use super::{Corners, Domain, QUADRILATERAL};

/// The map from (r, s) to (x, y) at a point of a plane cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneMap {
    /// `[[x,r  y,r], [x,s  y,s]]`
    pub jacobian: [[f64; 2]; 2],
    /// Its determinant.
    pub det: f64,
    /// `[[r,x  r,y], [s,x  s,y]]`
    pub inverse: [[f64; 2]; 2],
}

impl PlaneMap {
    /// Of this Jacobian.
    pub(super) fn of(j: [[f64; 2]; 2]) -> Self {
        let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        Self { jacobian: j, det, inverse: [[j[1][1] / det, -j[1][0] / det], [-j[0][1] / det, j[0][0] / det]] }
    }
}

impl Domain {
    /// The point itself if it lies in the domain, or the nearest in it if that is not farther than `near`.
    pub(super) fn inside(self, [r, s]: [f64; 2], near: f64) -> Option<[f64; 2]> {
        match self {
            Self::Quadrilateral => {
                let inside = r.abs() <= 1.0 + near && s.abs() <= 1.0 + near;
                inside.then(|| [r.clamp(-1.0, 1.0), s.clamp(-1.0, 1.0)])
            }
            Self::Triangle => {
                if !(r >= -1.0 - near && s >= -1.0 - near && r + s <= near) {
                    return None;
                }
                let [r, s] = [r.max(-1.0), s.max(-1.0)];
                let beyond = (r + s).max(0.0);
                Some([r - 0.5 * beyond, s - 0.5 * beyond])
            }
        }
    }
}

/// Shape measures of a plane cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellQuality {
    /// Area, m².
    pub area: f64,
    /// Largest inner angle, radians.
    pub largest_angle: f64,
    /// Longest over shortest edge.
    pub aspect: f64,
    /// Smallest sine of an inner angle over that of a regular cell: 1 for a rectangle and an equilateral triangle, not
    /// positive where a cell is not convex.
    pub scaled_jacobian: f64,
}

/// How far outside a cell a point still counts as in it, of the cell's size.
pub(super) const NEAR: f64 = 1e-9;

impl Corners<[f64; 2]> {
    /// The bilinear or linear map at (r, s).
    pub fn plane_map(&self, r: f64, s: f64) -> PlaneMap {
        let mut j = [[0.0; 2]; 2];
        match self.domain() {
            Domain::Quadrilateral => {
                for ([ri, si], p) in QUADRILATERAL.iter().zip(&self.of) {
                    let (by_r, by_s) = (0.25 * ri * (1.0 + s * si), 0.25 * si * (1.0 + r * ri));
                    for d in 0..2 {
                        j[0][d] += by_r * p[d];
                        j[1][d] += by_s * p[d];
                    }
                }
            }
            Domain::Triangle => {
                let [a, b, c, _] = self.of;
                j = [b, c].map(|p| [0.5 * (p[0] - a[0]), 0.5 * (p[1] - a[1])]);
            }
        }
        PlaneMap::of(j)
    }

    /// Position of a natural point.
    pub fn position(&self, at: [f64; 2]) -> [f64; 2] {
        let functions = self.domain().vertex_functions(at);
        [0, 1].map(|d| functions.iter().zip(self).map(|(n, p)| n * p[d]).sum())
    }

    /// Natural coordinates of `p` if it lies in the convex cell (to 1e-9 of its size).
    pub fn locate(&self, p: [f64; 2]) -> Option<[f64; 2]> {
        if self.is_beside(p) {
            return None;
        }
        match self.domain() {
            Domain::Quadrilateral => self.locate_bilinear(p),
            Domain::Triangle => {
                let PlaneMap { inverse, .. } = self.plane_map(0.0, 0.0);
                let [x, y] = [0, 1].map(|d| p[d] - self[0][d]);
                self.domain().inside(inverse.map(|row| row[0] * x + row[1] * y - 1.0), NEAR)
            }
        }
    }

    /// Whether `p` is clearly outside the box around the corners: of many cells that are asked for a point all but a few are soon done.
    fn is_beside(&self, p: [f64; 2]) -> bool {
        (0..2).any(|d| {
            let [low, high] =
                self.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |b, x| [b[0].min(x[d]), b[1].max(x[d])]);
            let margin = 1e3 * NEAR * (high - low);
            p[d] < low - margin || p[d] > high + margin
        })
    }

    /// Newton's method.
    fn locate_bilinear(&self, p: [f64; 2]) -> Option<[f64; 2]> {
        let (mut r, mut s) = (0.0, 0.0);
        for _ in 0..50 {
            let (mut f, mut j) = ([-p[0], -p[1]], [[0.0; 2]; 2]);
            for (c, x) in QUADRILATERAL.iter().zip(&self.of) {
                let (a, b) = (1.0 + r * c[0], 1.0 + s * c[1]);
                for d in 0..2 {
                    f[d] += 0.25 * a * b * x[d];
                    j[d][0] += 0.25 * c[0] * b * x[d];
                    j[d][1] += 0.25 * c[1] * a * x[d];
                }
            }
            let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
            let (dr, ds) = ((j[1][1] * f[0] - j[0][1] * f[1]) / det, (j[0][0] * f[1] - j[1][0] * f[0]) / det);
            // Far outside, the bilinear map need not be invertible: stay near the cell.
            r = (r - dr).clamp(-3.0, 3.0);
            s = (s - ds).clamp(-3.0, 3.0);
            if dr.abs().max(ds.abs()) < 1e-14 {
                break;
            }
        }
        self.domain().inside([r, s], NEAR)
    }

    /// Area, m²: negative for a clockwise cell.
    pub fn area(&self) -> f64 {
        let p = self.four();
        0.5 * ((p[2][0] - p[0][0]) * (p[3][1] - p[1][1]) - (p[3][0] - p[1][0]) * (p[2][1] - p[0][1]))
    }

    /// Centroid of the area.
    pub fn centroid(&self) -> [f64; 2] {
        // Relative to a corner, so that a plate far from the origin loses nothing.
        let p = self;
        let (mut area, mut sum) = (0.0, [0.0; 2]);
        for i in 1..p.len() - 1 {
            let (a, b) = ([p[i][0] - p[0][0], p[i][1] - p[0][1]], [p[i + 1][0] - p[0][0], p[i + 1][1] - p[0][1]]);
            let cross = a[0] * b[1] - a[1] * b[0];
            area += cross;
            for d in 0..2 {
                sum[d] += cross * (a[d] + b[d]) / 3.0;
            }
        }
        std::array::from_fn(|d| p[0][d] + sum[d] / area)
    }

    /// Shape measures.
    pub fn quality(&self) -> CellQuality {
        let (p, n) = (self, self.len());
        let regular = match self.domain() {
            Domain::Quadrilateral => 1.0,
            Domain::Triangle => 0.75_f64.sqrt(),
        };
        let (mut largest_angle, mut scaled_jacobian) = (0.0_f64, 1.0_f64);
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
        for i in 0..n {
            let [a, b, c] = [p[(i + n - 1) % n], p[i], p[(i + 1) % n]];
            let (u, v) = ([c[0] - b[0], c[1] - b[1]], [a[0] - b[0], a[1] - b[1]]);
            let cross = u[0] * v[1] - u[1] * v[0];
            let angle = cross.atan2(u[0] * v[0] + u[1] * v[1]);
            scaled_jacobian = scaled_jacobian.min(cross / (u[0].hypot(u[1]) * v[0].hypot(v[1])) / regular);
            largest_angle = largest_angle.max(angle.rem_euclid(std::f64::consts::TAU));
            let edge = u[0].hypot(u[1]);
            shortest = shortest.min(edge);
            longest = longest.max(edge);
        }
        CellQuality { area: self.area(), largest_angle, aspect: longest / shortest, scaled_jacobian }
    }

    /// Where the middle of the cell goes when the middles of its sides are these: centre of the transfinite (Coons) patch,
    /// half the sum of the middles less a quarter of that of the corners.
    pub(crate) fn coons_centre(self, middles: Self) -> [f64; 2] {
        [0, 1].map(|d| {
            let sum = |p: Self| p.iter().map(|p| p[d]).sum::<f64>();
            0.5 * sum(middles) - 0.25 * sum(self)
        })
    }

    /// Area within the square |x − c| ≤ half, m².
    pub(crate) fn overlap(&self, c: [f64; 2], half: f64) -> f64 {
        self.clip(c, half).iter().map(|triangle| triangle.area()).sum()
    }

    /// Areas for which the values at [`Domain::samples`] stand in a mean over the square |x − c| ≤ half, m².
    pub(crate) fn overlap_of_samples(&self, c: [f64; 2], half: f64) -> Corners<f64> {
        let mut areas = self.map(|_| 0.0);
        for triangle in self.clip(c, half) {
            let share = triangle.area() / 3.0;
            for [a, b] in triangle.sides() {
                let middle = [0, 1].map(|d| c[d] + 0.5 * (a[d] + b[d]));
                let functions = self.domain().sample_functions(self.locate(middle).unwrap_or(self.domain().centre()));
                areas.iter_mut().zip(functions.iter()).for_each(|(area, f)| *area += share * f);
            }
        }
        areas
    }

    /// What lies within the square |x − c| ≤ half (Sutherland, Hodgman 1974), as triangles relative to c.
    fn clip(&self, c: [f64; 2], half: f64) -> Vec<Self> {
        // Four cuts add at most four corners.
        let mut polygon = [[0.0; 2]; 9];
        let mut n = self.len();
        for (to, from) in polygon.iter_mut().zip(self) {
            *to = [from[0] - c[0], from[1] - c[1]];
        }
        for (d, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
            let inside = |p: &[f64; 2]| half - sign * p[d];
            let mut cut = [[0.0; 2]; 9];
            let mut m = 0;
            for i in 0..n {
                let (a, b) = (polygon[i], polygon[(i + 1) % n]);
                let (da, db) = (inside(&a), inside(&b));
                if da >= 0.0 {
                    cut[m] = a;
                    m += 1;
                }
                if (da >= 0.0) != (db >= 0.0) && m < 9 {
                    let t = da / (da - db);
                    cut[m] = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
                    m += 1;
                }
            }
            polygon = cut;
            n = m;
            if n < 3 {
                return Vec::new();
            }
        }
        (1..n - 1).map(|i| [polygon[0], polygon[i], polygon[i + 1]].into()).collect()
    }
}
