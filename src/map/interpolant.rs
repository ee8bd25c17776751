//! Numbers at scattered points, and what lies between them.

use nalgebra::{DMatrix, DVector};

/// A smooth function through numbers at scattered points p of a plane or a line: Σ wᵢ |p − pᵢ|³ + a + b·p with weights that are
/// orthogonal to linear functions (Duchon 1977); on a line the natural cubic spline.
#[derive(Debug)]
pub(super) struct Interpolant {
    points: Vec<[f64; 2]>,
    weights: Vec<f64>,
    /// a, b₁, b₂.
    linear: [f64; 3],
}

impl Interpolant {
    /// One for each list of values at `points`, which lie in so many `dimensions`; none where two points are one, or all lie on
    /// one line of a plane.
    pub(super) fn through(points: &[[f64; 2]], values: &[Vec<f64>], dimensions: usize) -> Option<Vec<Self>> {
        let (n, tail) = (points.len(), dimensions + 1);
        let polynomial = |k: usize, of: usize| if of == 0 { 1.0 } else { points[k][of - 1] };
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) => distance(points[i], points[j]).powi(3),
            (true, false) => polynomial(i, j - n),
            (false, true) => polynomial(j, i - n),
            (false, false) => 0.0,
        };
        let factor = DMatrix::from_fn(n + tail, n + tail, entry).lu();
        let solve = |values: &Vec<f64>| {
            let right = DVector::from_fn(n + tail, |i, _| values.get(i).copied().unwrap_or(0.0));
            let found = factor.solve(&right)?;
            let linear = std::array::from_fn(|k| if k < tail { found[n + k] } else { 0.0 });
            let of = Self { points: points.to_vec(), weights: found.as_slice()[..n].to_vec(), linear };
            of.weights.iter().chain(&of.linear).all(|weight| weight.is_finite()).then_some(of)
        };
        values.iter().map(solve).collect()
    }

    pub(super) fn value(&self, p: [f64; 2]) -> f64 {
        let [a, b, c] = self.linear;
        let cubes = self.points.iter().zip(&self.weights).map(|(q, w)| w * distance(p, *q).powi(3));
        a + b * p[0] + c * p[1] + cubes.sum::<f64>()
    }

    pub(super) fn gradient(&self, p: [f64; 2]) -> [f64; 2] {
        let [_, b, c] = self.linear;
        let each = self.points.iter().zip(&self.weights);
        each.fold([b, c], |sum, (q, w)| {
            let slope = 3.0 * w * distance(p, *q);
            [sum[0] + slope * (p[0] - q[0]), sum[1] + slope * (p[1] - q[1])]
        })
    }

    /// Root of the sum of squares of the second derivatives, over the gradient.
    pub(super) fn bend(&self, p: [f64; 2]) -> f64 {
        let [xx, yy, xy] = self.points.iter().zip(&self.weights).fold([0.0; 3], |sum, (q, w)| {
            let ([x, y], r) = ([p[0] - q[0], p[1] - q[1]], distance(p, *q));
            let over = if r > 0.0 { 3.0 * w / r } else { 0.0 };
            [sum[0] + over * (r * r + x * x), sum[1] + over * (r * r + y * y), sum[2] + over * x * y]
        });
        let [x, y] = self.gradient(p);
        ((xx * xx + yy * yy + 2.0 * xy * xy) / (x * x + y * y)).sqrt()
    }
}

pub(super) fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn linear_functions_come_out_exactly_and_smooth_ones_closely() {
        let points: Vec<[f64; 2]> = (0..25).map(|k| [f64::from(k % 5) / 4.0, f64::from(k / 5) / 4.0]).collect();
        let linear = |p: [f64; 2]| 3.0 - 2.0 * p[0] + 0.5 * p[1];
        let smooth = |p: [f64; 2]| (1.0 + p[0] + 2.0 * p[1]).ln();
        let at = |f: &dyn Fn([f64; 2]) -> f64| points.iter().map(|p| f(*p)).collect::<Vec<f64>>();
        let found = Interpolant::through(&points, &[at(&linear), at(&smooth)], 2).unwrap();
        for p in [[0.3, 0.4], [0.9, 0.1], [0.55, 0.85]] {
            assert!((found[0].value(p) - linear(p)).abs() < 1e-12);
            assert!((found[1].value(p) - smooth(p)).abs() < 2e-3);
            let slope = found[0].gradient(p);
            assert!((slope[0] + 2.0).abs() < 1e-10 && (slope[1] - 0.5).abs() < 1e-10);
            assert!(found[0].bend(p) < 1e-9);
            let difference = |k: usize| {
                let at = |s: f64| found[1].gradient(std::array::from_fn(|j| p[j] + if j == k { s } else { 0.0 }));
                [0, 1].map(|j| (at(1e-6)[j] - at(-1e-6)[j]) / 2e-6)
            };
            let ([xx, xy], [_, yy], [x, y]) = (difference(0), difference(1), found[1].gradient(p));
            let bend = (xx.hypot(yy)).hypot(xy * 2.0_f64.sqrt()) / x.hypot(y);
            assert!((found[1].bend(p) / bend - 1.0).abs() < 1e-6, "{bend}");
        }
        assert!(Interpolant::through(&[[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]], &[vec![1.0, 2.0, 3.0]], 1).is_none());
    }
}
