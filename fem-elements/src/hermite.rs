//! Cubic shape functions with derivative unknowns (report eqs 3 and 19).
//!
//! In d dimensions, with a₀ = a·aᵢ for each natural coordinate a of node i:
//!
//! * value:          Nᵢ  = Π(1 + a₀) · (2 + Σ a₀(1 − a₀)) / 2^(d+1)
//! * derivative ∂ₐ:  Nₐᵢ = −aᵢ (1 + a₀)²(1 − a₀) · Π over the others (1 + b₀) / 2^(d+1)
//!
//! Their span is the trilinear functions plus {r², r³, s², s³, q², q³} times the bilinear functions of the other two
//! coordinates: 32 terms (eq. 17), complete cubics among them.
//!
//! A prism is straight through its thickness, so the functions are kept as polynomials in q: coefficients of
//! q⁰ … q³ at an in-plane point.

/// Natural coordinates of the eight corners: bottom face anticlockwise, then the top face in the same order.
///
/// ```text
///        8-------7          q  s
///       /|      /|          | /
///      5-------6 |          |/
///      | 4-----|-3          o--- r
///      |/      |/
///      1-------2
/// ```
pub const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Coefficients of q⁰ … q³.
pub type Quartet = [f64; 4];

/// The four functions of one node (value, ∂r, ∂s, ∂q) at an in-plane point, each as a polynomial in q, with its
/// in-plane derivatives.
#[derive(Debug, Clone, Copy)]
pub struct NodeFunctions {
    /// The functions.
    pub n: [Quartet; 4],
    /// Their derivatives along r.
    pub n_r: [Quartet; 4],
    /// Their derivatives along s.
    pub n_s: [Quartet; 4],
}

/// The functions of the node at `corner` (eq. 19 a-d) at the in-plane point (`r`, `s`).
pub fn node_functions(corner: [f64; 3], r: f64, s: f64) -> NodeFunctions {
    let [ri, si, qi] = corner;
    let (r0, s0) = (r * ri, s * si);
    let (fr, fs) = (1.0 + r0, 1.0 + s0);
    let a = 2.0 + r0 * (1.0 - r0) + s0 * (1.0 - s0);
    let (a_r, a_s) = (ri * (1.0 - 2.0 * r0), si * (1.0 - 2.0 * s0));
    let (l, l_r, l_s) = (fr * fs, ri * fs, si * fr);
    // (1 + q0)(A + q0(1 − q0)) = A + (A + 1) q0 − q0³
    let value = |l: f64, la: f64| [la, la + l, 0.0, -l];
    let bump = |x0: f64| (1.0 + x0) * (1.0 + x0) * (1.0 - x0);
    let bump_slope = |x0: f64| (1.0 + x0) * (1.0 - 3.0 * x0);
    let linear = |c: f64| [c, c, 0.0, 0.0];
    // (1 + q0)²(1 − q0) = 1 + q0 − q0² − q0³
    let cubic = |c: f64| [c, c, -c, -c];
    let finish = |f: [Quartet; 4]| f.map(|p| std::array::from_fn(|k| p[k] * qi.powi(k as i32) / 16.0));
    NodeFunctions {
        n: finish([value(l, l * a), linear(-ri * bump(r0) * fs), linear(-si * bump(s0) * fr), cubic(-qi * l)]),
        n_r: finish([
            value(l_r, l_r * a + l * a_r),
            linear(-bump_slope(r0) * fs),
            linear(-si * bump(s0) * ri),
            cubic(-qi * l_r),
        ]),
        n_s: finish([
            value(l_s, l_s * a + l * a_s),
            linear(-ri * bump(r0) * si),
            linear(-bump_slope(s0) * fr),
            cubic(-qi * l_s),
        ]),
    }
}

/// The trilinear function of the node at `corner`, as a polynomial in q: the report's inertia shape.
pub fn trilinear(corner: [f64; 3], r: f64, s: f64) -> Quartet {
    let l = (1.0 + r * corner[0]) * (1.0 + s * corner[1]) / 8.0;
    [l, l * corner[2], 0.0, 0.0]
}

/// A polynomial's value at q.
pub fn at(p: &Quartet, q: f64) -> f64 {
    p[0] + q * (p[1] + q * (p[2] + q * p[3]))
}

/// A polynomial's derivative along q.
pub fn derivative(p: &Quartet) -> Quartet {
    [p[1], 2.0 * p[2], 3.0 * p[3], 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_derivatives_interpolate() {
        for (j, cj) in CORNERS.iter().enumerate() {
            for (i, ci) in CORNERS.iter().enumerate() {
                let f = node_functions(*ci, cj[0], cj[1]);
                for k in 0..4 {
                    let got = [
                        at(&f.n[k], cj[2]),
                        at(&f.n_r[k], cj[2]),
                        at(&f.n_s[k], cj[2]),
                        at(&derivative(&f.n[k]), cj[2]),
                    ];
                    for (d, v) in got.iter().enumerate() {
                        assert_eq!(*v, f64::from(u8::from(i == j && d == k)), "node {i} function {k} at node {j}");
                    }
                }
            }
        }
    }

    #[test]
    fn partition_of_unity_and_slopes() {
        let (r, s, q, d) = (0.31, -0.57, 0.83, 1e-6);
        let mut sum = 0.0;
        for c in CORNERS {
            let f = node_functions(c, r, s);
            sum += at(&f.n[0], q);
            let (right, left) = (node_functions(c, r + d, s), node_functions(c, r - d, s));
            let (up, down) = (node_functions(c, r, s + d), node_functions(c, r, s - d));
            for k in 0..4 {
                let by_r = (at(&right.n[k], q) - at(&left.n[k], q)) / (2.0 * d);
                let by_s = (at(&up.n[k], q) - at(&down.n[k], q)) / (2.0 * d);
                assert!((by_r - at(&f.n_r[k], q)).abs() < 1e-9);
                assert!((by_s - at(&f.n_s[k], q)).abs() < 1e-9);
            }
        }
        assert!((sum - 1.0).abs() < 1e-15);
    }
}
