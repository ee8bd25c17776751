//! Plane cells whose sides may be bent.

use super::geometry::{CellQuality, NEAR, PlaneMap};
use super::{Corners, Domain};
use std::ops::Deref;

/// A plane cell by the positions of its corners and, where sides are bent, of their middles, m; reads as its corners.
///
/// Sides are parabolas: with b the way from the middle of a chord to that of its side and φ the function of that side, quadratic
/// along it and 0 on the others,
///
/// x(r, s) = Σ Nᵢ xᵢ + Σ φⱼ bⱼ,  φ = (1 − r²)(1 ± s)/2, (1 ± r)(1 − s²)/2 in a quadrilateral, 4 λᵢ λⱼ in a triangle:
///
/// the geometry of the 8-node quadrilateral and of the 6-node triangle. Without bends it is the bilinear or linear map to the bit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneCell {
    corners: Corners<[f64; 2]>,
    /// Of each side, in the place of the corner that it begins at.
    bends: Option<Corners<[f64; 2]>>,
}

impl PlaneCell {
    /// With sides whose middles lie so far off those of their chords, m.
    pub fn bent(corners: Corners<[f64; 2]>, bends: Corners<[f64; 2]>) -> Self {
        Self { corners, bends: bends.iter().flatten().any(|b| *b != 0.0).then_some(bends) }
    }

    /// From the middle of the chord of each side to that of the side, m, where any side is bent.
    pub fn bends(&self) -> Option<Corners<[f64; 2]>> {
        self.bends
    }

    /// The map at (r, s).
    pub fn plane_map(&self, r: f64, s: f64) -> PlaneMap {
        let straight = self.corners.plane_map(r, s);
        let Some(bends) = self.bends else { return straight };
        let mut j = straight.jacobian;
        for (bend, [_, by_r, by_s]) in bends.iter().zip(bubbles(self.domain(), r, s)) {
            for d in 0..2 {
                j[0][d] += by_r * bend[d];
                j[1][d] += by_s * bend[d];
            }
        }
        PlaneMap::of(j)
    }

    /// Position of a natural point.
    pub fn position(&self, at: [f64; 2]) -> [f64; 2] {
        let mut position = self.corners.position(at);
        for (bend, [value, ..]) in self.bends.iter().flatten().zip(bubbles(self.domain(), at[0], at[1])) {
            for d in 0..2 {
                position[d] += value * bend[d];
            }
        }
        position
    }

    /// Natural coordinates of `p` if it lies in the cell (to 1e-9 of its size).
    pub fn locate(&self, p: [f64; 2]) -> Option<[f64; 2]> {
        if self.bends.is_none() {
            return self.corners.locate(p);
        }
        if self.is_far(p) {
            return None;
        }
        let [mut r, mut s] = self.domain().centre();
        for _ in 0..50 {
            let x = self.position([r, s]);
            let PlaneMap { inverse, .. } = self.plane_map(r, s);
            let [dx, dy] = [0, 1].map(|d| p[d] - x[d]);
            let [dr, ds] = [0, 1].map(|d| inverse[d][0] * dx + inverse[d][1] * dy);
            // Far outside, the map need not be invertible: stay near the cell.
            r = (r + dr).clamp(-2.0, 2.0);
            s = (s + ds).clamp(-2.0, 2.0);
            if dr.abs().max(ds.abs()) < 1e-14 {
                break;
            }
        }
        self.domain().inside([r, s], NEAR)
    }

    /// Whether `p` is clearly outside a box around the cell.
    fn is_far(&self, p: [f64; 2]) -> bool {
        let bends = self.bends.iter().flatten();
        let reach = bends.map(|b| b[0].hypot(b[1])).fold(0.0, f64::max);
        (0..2).any(|d| {
            let [low, high] =
                self.corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |b, x| [b[0].min(x[d]), b[1].max(x[d])]);
            p[d] < low - 1.5 * reach || p[d] > high + 1.5 * reach
        })
    }

    /// Area, m²: that between a chord c and its side is 2/3 |b × c|.
    pub fn area(&self) -> f64 {
        let chords = self.corners.sides().map(|[a, b]| [b[0] - a[0], b[1] - a[1]]);
        let beyond = self.bends.iter().flatten().zip(chords).map(|(b, c)| b[0] * c[1] - b[1] * c[0]);
        let beyond: f64 = beyond.sum();
        if self.bends.is_none() { self.corners.area() } else { self.corners.area() + 2.0 / 3.0 * beyond }
    }

    /// Centroid of the area.
    pub fn centroid(&self) -> [f64; 2] {
        if self.bends.is_none() {
            return self.corners.centroid();
        }
        // Polynomials of degree 8 and less along each direction.
        let (mut area, mut sum) = (0.0, [0.0; 2]);
        for point in self.domain().points(5) {
            let [r, s] = point.at;
            let da = self.plane_map(r, s).det * point.weight();
            let x = self.position([r, s]);
            area += da;
            (0..2).for_each(|d| sum[d] += da * (x[d] - self.corners[0][d]));
        }
        [0, 1].map(|d| self.corners[0][d] + sum[d] / area)
    }

    /// Shape measures; inner angles are those between the sides' tangents.
    pub fn quality(&self) -> CellQuality {
        let straight = self.corners.quality();
        let Some(bends) = self.bends else { return straight };
        let n = self.corners.len();
        let regular = if n == 3 { 0.75_f64.sqrt() } else { 1.0 };
        let (mut largest_angle, mut scaled_jacobian) = (0.0_f64, 1.0_f64);
        for i in 0..n {
            let before = (i + n - 1) % n;
            let [a, b, c] = [before, i, (i + 1) % n].map(|k| self.corners[k]);
            // A side leaves its ends along the chord and four times the bend.
            let u = [0, 1].map(|d| c[d] - b[d] + 4.0 * bends[i][d]);
            let v = [0, 1].map(|d| a[d] - b[d] + 4.0 * bends[before][d]);
            let cross = u[0] * v[1] - u[1] * v[0];
            let angle = cross.atan2(u[0] * v[0] + u[1] * v[1]);
            scaled_jacobian = scaled_jacobian.min(cross / (u[0].hypot(u[1]) * v[0].hypot(v[1])) / regular);
            largest_angle = largest_angle.max(angle.rem_euclid(std::f64::consts::TAU));
        }
        CellQuality { area: self.area(), largest_angle, scaled_jacobian, ..straight }
    }

    /// Whether the map turns nowhere over, as far as its Jacobian at a lattice of 9 × 9 points says.
    pub fn is_regular(&self) -> bool {
        let Some(bends) = self.bends else { return true };
        let n = 8;
        let at = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
        let within = |[r, s]: &[f64; 2]| bends.len() == 4 || r + s <= 1e-12;
        let lattice = (0..=n).flat_map(|i| (0..=n).map(move |j| [at(i), at(j)])).filter(within);
        lattice.into_iter().all(|[r, s]| self.plane_map(r, s).det > 0.0)
    }
}

/// Value, ∂r and ∂s of the function of each side.
fn bubbles(domain: Domain, r: f64, s: f64) -> impl Iterator<Item = [f64; 3]> {
    let along = |a: f64| (1.0 - a * a, -2.0 * a);
    let ((fr, dr), (fs, ds)) = (along(r), along(s));
    let all = match domain {
        Domain::Quadrilateral => [
            [0.5 * fr * (1.0 - s), 0.5 * dr * (1.0 - s), -0.5 * fr],
            [0.5 * fs * (1.0 + r), 0.5 * fs, 0.5 * ds * (1.0 + r)],
            [0.5 * fr * (1.0 + s), 0.5 * dr * (1.0 + s), 0.5 * fr],
            [0.5 * fs * (1.0 - r), -0.5 * fs, 0.5 * ds * (1.0 - r)],
        ],
        Domain::Triangle => {
            let [a, b, c] = [-0.5 * (r + s), 0.5 * (1.0 + r), 0.5 * (1.0 + s)];
            [
                [4.0 * a * b, 2.0 * (a - b), -2.0 * b],
                [4.0 * b * c, 2.0 * c, 2.0 * b],
                [4.0 * c * a, -2.0 * c, 2.0 * (a - c)],
                [0.0; 3],
            ]
        }
    };
    all.into_iter()
}

impl From<Corners<[f64; 2]>> for PlaneCell {
    fn from(corners: Corners<[f64; 2]>) -> Self {
        Self { corners, bends: None }
    }
}

impl From<[[f64; 2]; 4]> for PlaneCell {
    fn from(corners: [[f64; 2]; 4]) -> Self {
        Corners::from(corners).into()
    }
}

impl From<[[f64; 2]; 3]> for PlaneCell {
    fn from(corners: [[f64; 2]; 3]) -> Self {
        Corners::from(corners).into()
    }
}

impl Deref for PlaneCell {
    type Target = Corners<[f64; 2]>;
    fn deref(&self) -> &Corners<[f64; 2]> {
        &self.corners
    }
}
