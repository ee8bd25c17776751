//! The 20-node serendipity hexahedron.

use crate::large::{Gradients, Solid};
use crate::prism::{self, Prism};
use fem_core::dof::Dof;
use fem_core::domain::Domain;
use fem_core::element::{Cell, Element, ElementError, ElementInfo, Part, PlaneMap, Scratch};
use fem_core::large::LargeDeflection;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo, Role};
use fem_core::quadrature::MAX_POINTS;

/// Corners, bottom face first and anticlockwise; middles of the edges of the bottom face, of the top face, and of the
/// upright edges.
///
/// ```text
///            8-----15----7
///           /|          /|        q  s
///         16 |        14 |        | /
///         /  20       /  19       |/
///        5-----13----6   |        o--- r
///        |   |       |   |
///        |   4-----11|---3
///       17  /       18  /
///        | 12        | 10
///        |/          |/
///        1-----9-----2
/// ```
const NODES: [[f64; 3]; 20] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

/// Translations.
const DOFS: [Dof; 3] = [Dof::SOLID[0], Dof::SOLID[4], Dof::SOLID[8]];

/// The function of a node at an in-plane point and its derivatives along r and s, as coefficients of q⁰ q¹ q².
///
/// With a₀ = a·aᵢ:
///
/// * corner: (1 + r₀)(1 + s₀)(1 + q₀)(r₀ + s₀ + q₀ − 2) / 8
/// * middle of an edge along r: (1 − r²)(1 + s₀)(1 + q₀) / 4, along s and q likewise
fn node_functions([ri, si, qi]: [f64; 3], r: f64, s: f64) -> [[f64; 3]; 3] {
    let factor = |a: f64, ai: f64| if ai == 0.0 { (1.0 - a * a, -2.0 * a) } else { (1.0 + a * ai, ai) };
    let ((fr, by_r), (fs, by_s)) = (factor(r, ri), factor(s, si));
    let plane = [fr * fs, by_r * fs, fr * by_s];
    if ri * si * qi == 0.0 {
        let along_q = if qi == 0.0 { [1.0, 0.0, -1.0] } else { [1.0, qi, 0.0] };
        return plane.map(|l| along_q.map(|c| l * c / 4.0));
    }
    // l (1 + q₀)(c + q₀) = l c + (l c + l) q₀ + l q²
    let (c, slopes) = (r * ri + s * si - 2.0, [0.0, ri, si]);
    std::array::from_fn(|d| {
        let (l, lc) = (plane[d], plane[d] * c + plane[0] * slopes[d]);
        [lc / 8.0, (lc + l) * qi / 8.0, l / 8.0]
    })
}

/// 20-node serendipity hexahedron with straight edges, three translations a node.
///
/// Complete quadratics where the quadrilateral is a parallelogram; {1, x, y} × {1, z, z²} on every other. Integrated
/// exactly through the thickness, so that a matrix costs the same for any number of plies.
#[derive(Debug, Clone)]
pub struct Hex20 {
    info: ElementInfo,
}

impl Hex20 {
    /// In-plane order 3 is exact on parallelograms.
    pub const IN_PLANE_ORDER: usize = 3;

    /// # Errors
    /// In-plane orders below 3, which leave zero-energy modes, and above [`MAX_POINTS`].
    pub fn new(in_plane_order: usize) -> Result<Self, ElementError> {
        if !(3..=MAX_POINTS).contains(&in_plane_order) {
            return Err(ElementError(format!(
                "in-plane order {in_plane_order}: at least 3 Gauss points a direction are needed (2 leave two \
                 zero-energy modes), at most {MAX_POINTS} are offered"
            )));
        }
        // Three points through a ply are exact: strains are quadratic in q.
        Ok(Self {
            info: ElementInfo {
                domain: Domain::Quadrilateral,
                nodes: &NODES,
                dofs: &DOFS,
                in_plane_order,
                ply_order: 3,
            },
        })
    }
}

impl Prism<20, 3> for Hex20 {
    fn values(&self, _cell: &Cell<'_>, r: f64, s: f64) -> [[f64; 3]; 20] {
        NODES.map(|node| node_functions(node, r, s)[0])
    }

    fn gradients(&self, cell: &Cell<'_>, r: f64, s: f64, plane: &PlaneMap, mut each: impl FnMut(usize, [[f64; 3]; 3])) {
        let h = cell.half_height();
        for (f, node) in NODES.into_iter().enumerate() {
            let [n, n_r, n_s] = node_functions(node, r, s);
            let by = |d: usize| std::array::from_fn(|k| plane.inverse[0][d] * n_r[k] + plane.inverse[1][d] * n_s[k]);
            each(f, [by(0), by(1), [n[1] / h, 2.0 * n[2] / h, 0.0]]);
        }
    }

    fn unknown(component: usize, function: usize) -> usize {
        3 * function + component
    }
}

impl Element for Hex20 {
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

impl Hex20 {
    fn solid<T>(&self, cell: &Cell<'_>, with: impl FnOnce(&Solid<'_, 20, 3>) -> T) -> T {
        let fill = |r: f64, s: f64, plane: &PlaneMap, out: &mut Gradients<20, 3>| {
            self.gradients(cell, r, s, plane, |f, gradient| out[f] = gradient);
        };
        with(&Solid { info: &self.info, gradients: &fill, unknown: |n, f| Some(Self::unknown(n, f)) })
    }
}

impl LargeDeflection for Hex20 {
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

const ORDER: ParamInfo =
    ParamInfo::count("in_plane_order", "Gauss points per in-plane direction; the default is exact on parallelograms")
        .at_least(3.0)
        .at_most(MAX_POINTS as f64)
        .default(Hex20::IN_PLANE_ORDER as f64)
        .role(Role::Quadrature);

impl Plugin for Hex20 {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Element,
        name: "hex20",
        summary: "20-node serendipity hexahedron, 3 unknowns a node, any number of plies through one cell",
        source: "Zienkiewicz and Taylor, The Finite Element Method, vol. 1, 5th ed. (2000), ch. 8",
        params: &[ORDER],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let built = Self::new(params.count(&ORDER)?).map_err(|e| ParamError::new(ORDER.name, e.to_string()))?;
        Ok(Built::Element(Box::new(built)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_interpolate_and_their_derivatives_are_those_of_the_functions() {
        for (i, node) in NODES.iter().enumerate() {
            for (j, [r, s, q]) in NODES.iter().enumerate() {
                let [c0, c1, c2] = node_functions(*node, *r, *s)[0];
                assert_eq!(c0 + q * (c1 + q * c2), f64::from(u8::from(i == j)), "function {i} at node {j}");
            }
            let (r, s, d) = (0.31, -0.57, 1e-6);
            let [_, by_r, by_s] = node_functions(*node, r, s);
            for k in 0..3 {
                let value = |r, s| node_functions(*node, r, s)[0][k];
                assert!((by_r[k] - (value(r + d, s) - value(r - d, s)) / (2.0 * d)).abs() < 1e-9);
                assert!((by_s[k] - (value(r, s + d) - value(r, s - d)) / (2.0 * d)).abs() < 1e-9);
            }
        }
    }
}
