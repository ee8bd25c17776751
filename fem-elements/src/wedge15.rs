//! The 15-node serendipity wedge.

use crate::large::{Gradients, Solid};
use crate::prism::{self, Prism};
use fem_core::dof::Dof;
use fem_core::domain::Domain;
use fem_core::element::{Cell, Element, ElementError, ElementInfo, Part, PlaneMap, Scratch};
use fem_core::large::LargeDeflection;
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};

/// Corners, bottom face first and anticlockwise; middles of the sides of the bottom face, of the top face, and of the
/// upright edges.
///
/// ```text
///            6
///          / | \             q  s
///       12   |   11          | /
///      /    15     \         |/
///     4------10------5       o--- r
///     |      |       |
///     |      3       |
///    13    /   \    14
///     |  9       8   |
///     |/           \ |
///     1-------7------2
/// ```
const NODES: [[f64; 3]; 15] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [0.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [0.0, 0.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

/// Translations.
const DOFS: [Dof; 3] = [Dof::SOLID[0], Dof::SOLID[4], Dof::SOLID[8]];

/// The function of node `i` at an in-plane point and its derivatives along r and s, as coefficients of q⁰ q¹ q².
///
/// With the vertex functions L of the triangle and q₀ = q qᵢ:
///
/// * corner: ½ Lₐ ((2 Lₐ − 1)(1 + q₀) − (1 − q²))
/// * middle of a side of a face: 2 Lₐ L_b (1 + q₀)
/// * middle of an upright edge: Lₐ (1 − q²)
fn node_functions(i: usize, r: f64, s: f64) -> [[f64; 3]; 3] {
    const BY: [[f64; 3]; 2] = [[-0.5, 0.5, 0.0], [-0.5, 0.0, 0.5]];
    let vertex = Domain::Triangle.vertex_functions([r, s]);
    let (a, q) = (i % 3, NODES[i][2]);
    // Lₐ and its derivatives, of these and of a function of Lₐ.
    let l = [vertex[a], BY[0][a], BY[1][a]];
    let of = |value: f64, slope: f64| [value, slope * l[1], slope * l[2]];
    match i {
        0..6 => {
            let (constant, linear) =
                (of(l[0] * (l[0] - 1.0), 2.0 * l[0] - 1.0), of(l[0] * (l[0] - 0.5), 2.0 * l[0] - 0.5));
            [0, 1, 2].map(|d| [constant[d], linear[d] * q, 0.5 * l[d]])
        }
        6..12 => {
            let b = (a + 1) % 3;
            let m = [vertex[b], BY[0][b], BY[1][b]];
            let product = [l[0] * m[0], l[1] * m[0] + l[0] * m[1], l[2] * m[0] + l[0] * m[2]];
            product.map(|p| [2.0 * p, 2.0 * p * q, 0.0])
        }
        _ => l.map(|l| [l, 0.0, -l]),
    }
}

/// 15-node serendipity wedge with straight edges, three translations a node.
///
/// Complete quadratics on every triangle. Integrated exactly in the plane and through the thickness, so that a matrix costs
/// the same for any number of plies.
#[derive(Debug, Clone)]
pub struct Wedge15 {
    info: ElementInfo,
}

impl Default for Wedge15 {
    fn default() -> Self {
        // Six points in the plane are exact to the fourth degree, that of K and M on straight sides; three points through a
        // ply as well: strains are quadratic in q.
        let domain = Domain::Triangle;
        Self { info: ElementInfo { domain, nodes: &NODES, dofs: &DOFS, in_plane_order: 2, ply_order: 3 } }
    }
}

impl Prism<15, 3> for Wedge15 {
    fn values(&self, _cell: &Cell<'_>, r: f64, s: f64) -> [[f64; 3]; 15] {
        std::array::from_fn(|node| node_functions(node, r, s)[0])
    }

    fn gradients(&self, cell: &Cell<'_>, r: f64, s: f64, plane: &PlaneMap, mut each: impl FnMut(usize, [[f64; 3]; 3])) {
        let h = cell.half_height();
        for f in 0..NODES.len() {
            let [n, n_r, n_s] = node_functions(f, r, s);
            let by = |d: usize| std::array::from_fn(|k| plane.inverse[0][d] * n_r[k] + plane.inverse[1][d] * n_s[k]);
            each(f, [by(0), by(1), [n[1] / h, 2.0 * n[2] / h, 0.0]]);
        }
    }

    fn unknown(component: usize, function: usize) -> usize {
        3 * function + component
    }
}

impl Element for Wedge15 {
    fn info(&self) -> &ElementInfo {
        &self.info
    }

    fn strain_operator(&self, cell: &Cell<'_>, _slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        prism::strain_operator(self, cell, xi, b)
    }

    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        prism::shape(self, cell, xi, n)
    }

    fn stiffness(&self, cell: &Cell<'_>, scratch: &mut Scratch, ke: &mut [f64]) -> Result<(), ElementError> {
        prism::stiffness(self, cell, scratch, ke)
    }

    fn mass(&self, cell: &Cell<'_>, scratch: &mut Scratch, me: &mut [f64]) -> Result<(), ElementError> {
        prism::mass(self, cell, scratch, me)
    }

    fn mean_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        _scratch: &mut Scratch,
        b: &mut [f64],
    ) -> Result<(), ElementError> {
        prism::mean_strains(self, cell, parts, b)
    }

    fn large_deflections(&self) -> Option<&dyn LargeDeflection> {
        Some(self)
    }
}

impl Wedge15 {
    fn solid<T>(&self, cell: &Cell<'_>, with: impl FnOnce(&Solid<'_, 15, 3>) -> T) -> T {
        let fill = |r: f64, s: f64, plane: &PlaneMap, out: &mut Gradients<15, 3>| {
            self.gradients(cell, r, s, plane, |f, gradient| out[f] = gradient);
        };
        with(&Solid { info: &self.info, gradients: &fill, unknown: |n, f| Some(Self::unknown(n, f)) })
    }
}

impl LargeDeflection for Wedge15 {
    fn internal(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, ElementError> {
        self.solid(cell, |solid| solid.internal(cell, u, scratch, force, tangent))
    }

    fn large_strain(&self, cell: &Cell<'_>, _slice: usize, xi: [f64; 3], u: &[f64]) -> Result<[f64; 6], ElementError> {
        self.solid(cell, |solid| solid.strain(cell, xi, u))
    }

    fn mean_large_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        u: &[f64],
        strains: &mut [f64],
    ) -> Result<(), ElementError> {
        self.solid(cell, |solid| solid.mean_strains(cell, parts, u, strains))
    }
}

impl Plugin for Wedge15 {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Element,
        name: "wedge15",
        summary: "15-node serendipity wedge for meshes of triangles, 3 unknowns a node, any number of plies through one cell",
        source: "Zienkiewicz and Taylor, The Finite Element Method, vol. 1, 5th ed. (2000), ch. 8",
        params: &[],
    };

    fn build(_params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Element(Box::new(Self::default())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_interpolate_and_their_derivatives_are_those_of_the_functions() {
        for i in 0..NODES.len() {
            for (j, [r, s, q]) in NODES.iter().enumerate() {
                let [c0, c1, c2] = node_functions(i, *r, *s)[0];
                assert_eq!(c0 + q * (c1 + q * c2), f64::from(u8::from(i == j)), "function {i} at node {j}");
            }
            let (r, s, d) = (0.31, -0.57, 1e-6);
            let [_, by_r, by_s] = node_functions(i, r, s);
            for k in 0..3 {
                let value = |r, s| node_functions(i, r, s)[0][k];
                assert!((by_r[k] - (value(r + d, s) - value(r - d, s)) / (2.0 * d)).abs() < 1e-9);
                assert!((by_s[k] - (value(r, s + d) - value(r, s - d)) / (2.0 * d)).abs() < 1e-9);
            }
        }
    }
}
