//! The form of the report's solid on triangles: a wedge with twelve unknowns a node.

use crate::hermite::{NodeFunctions, Quartet};
use crate::hermite_solid::{Functions, HermiteSolid, Mass};
use fem_core::dof::Dof;
use fem_core::domain::Domain;
use fem_core::element::ElementInfo;

/// Natural coordinates of the six corners: bottom face anticlockwise, then the top face in the same order.
const CORNERS: [[f64; 3]; 6] =
    [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0]];

/// ∂/∂r and ∂/∂s of the vertex functions.
const SLOPES: [[f64; 2]; 3] = [[-0.5, -0.5], [0.5, 0.0], [0.0, 0.5]];

/// Wedge with plane, parallel faces and upright edges, twelve unknowns a node.
///
/// In the plane the cubic of Bazeley, Cheung, Irons and Zienkiewicz (1965), whose tenth function L₁L₂L₃ is given up so that all
/// quadratics stay; through the thickness the functions of the prism. With the vertex functions L of the triangle, j and k the
/// other two corners, q₀ = q qᵢ, and b = L₁L₂L₃:
///
/// * value:             ½ V (1 + q₀) + ¼ Lᵢ (q₀ − q₀³), V = Lᵢ² (3 − 2 Lᵢ) + 2 b
/// * derivative ∂ₐ:     ½ (1 + q₀) Σ over j of (aⱼ − aᵢ) (Lᵢ² Lⱼ + ½ b), a = r, s
/// * derivative ∂q:     −¼ qᵢ Lᵢ (1 + q₀)² (1 − q₀)
///
/// Along a side they are those of the prism, so that meshes of both conform. Reproduces complete quadratics in the plane times
/// {1, z}, and {1, x, y} × {1, z, z², z³}, on every triangle.
pub type HermiteWedge = HermiteSolid<24, 12>;

impl HermiteWedge {
    /// In-plane order 4 is exact for K and M on every triangle: higher ones are taken as 4.
    pub(crate) fn of_order(mass: Mass, in_plane_order: usize) -> Self {
        let in_plane_order = in_plane_order.min(4);
        let info =
            ElementInfo { domain: Domain::Triangle, nodes: &CORNERS, dofs: &Dof::SOLID, in_plane_order, ply_order: 4 };
        Self::of(info, mass, None)
    }
}

/// A function at a point with its derivatives along r and s.
type Jet = [f64; 3];

fn product(a: Jet, b: Jet) -> Jet {
    [a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + a[0] * b[2]]
}

fn sum(a: Jet, b: Jet, factor: f64) -> Jet {
    [0, 1, 2].map(|d| a[d] + factor * b[d])
}

impl Functions for HermiteWedge {
    fn node_functions(i: usize, r: f64, s: f64) -> NodeFunctions {
        let vertex = Domain::Triangle.vertex_functions([r, s]);
        let l: [Jet; 3] = [0, 1, 2].map(|a| [vertex[a], SLOPES[a][0], SLOPES[a][1]]);
        let (a, q) = (i % 3, CORNERS[i][2]);
        let square = product(l[a], l[a]);
        let bubble = product(product(l[0], l[1]), l[2]);
        let value = sum(product(square, [3.0 - 2.0 * l[a][0], -2.0 * l[a][1], -2.0 * l[a][2]]), bubble, 2.0);
        let mut slopes = [Jet::default(); 2];
        for j in (0..3).filter(|j| *j != a) {
            let side = sum(product(square, l[j]), bubble, 0.5);
            for (d, slope) in slopes.iter_mut().enumerate() {
                *slope = sum(*slope, side, CORNERS[j][d] - CORNERS[a][d]);
            }
        }
        let of = |d: usize| {
            let (v, l) = (0.5 * value[d], 0.25 * l[a][d]);
            let linear = |c: f64| [0.5 * c, 0.5 * c * q, 0.0, 0.0];
            [[v, (v + l) * q, 0.0, -l * q], linear(slopes[0][d]), linear(slopes[1][d]), [-l * q, -l, l * q, l]]
        };
        NodeFunctions { n: of(0), n_r: of(1), n_s: of(2) }
    }

    fn linear(i: usize, r: f64, s: f64) -> Quartet {
        let l = 0.5 * Domain::Triangle.vertex_functions([r, s])[i % 3];
        [l, l * CORNERS[i][2], 0.0, 0.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hermite::{at, derivative};

    #[test]
    fn values_and_derivatives_interpolate() {
        for i in 0..6 {
            for (j, [r, s, q]) in CORNERS.into_iter().enumerate() {
                let f = HermiteWedge::node_functions(i, r, s);
                for k in 0..4 {
                    let got = [at(&f.n[k], q), at(&f.n_r[k], q), at(&f.n_s[k], q), at(&derivative(&f.n[k]), q)];
                    for (d, v) in got.into_iter().enumerate() {
                        assert_eq!(v, f64::from(u8::from(i == j && d == k)), "node {i} function {k} at node {j}");
                    }
                }
            }
        }
    }

    #[test]
    fn along_a_side_they_are_those_of_the_prism() {
        // The side from corner 1 to corner 2 is the lower one of both domains.
        for (i, quad) in [(0, 0), (1, 1), (3, 4), (4, 5)] {
            for t in [-0.9, -0.3, 0.2, 0.8] {
                let wedge = HermiteWedge::node_functions(i, t, -1.0);
                let prism = crate::HermitePrism::node_functions(quad, t, -1.0);
                for (m, k) in (0..16).map(|k| (k / 4, k % 4)) {
                    assert!((wedge.n[m][k] - prism.n[m][k]).abs() < 1e-15, "node {i} function {m}");
                }
            }
        }
    }
}
