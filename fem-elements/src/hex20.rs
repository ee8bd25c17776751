//! The 20-node serendipity hexahedron.

use crate::serendipity::{DOFS, Functions, Serendipity};
use fem_core::domain::Domain;
use fem_core::element::{ElementError, ElementInfo};
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

/// 20-node serendipity hexahedron, three translations a node.
///
/// Complete quadratics where the quadrilateral is a parallelogram; {1, x, y} × {1, z, z²} on every other. Integrated
/// exactly through the thickness, so that a matrix costs the same for any number of plies.
pub type Hex20 = Serendipity<20>;

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
            triangular: Some(Box::default()),
        })
    }
}

impl Functions for Hex20 {
    /// With a₀ = a·aᵢ:
    ///
    /// * corner: (1 + r₀)(1 + s₀)(1 + q₀)(r₀ + s₀ + q₀ − 2) / 8
    /// * middle of an edge along r: (1 − r²)(1 + s₀)(1 + q₀) / 4, along s and q likewise
    fn node_functions(i: usize, r: f64, s: f64) -> [[f64; 3]; 3] {
        let [ri, si, qi] = NODES[i];
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
        summary: "20-node serendipity hexahedron, on triangles the 15-node wedge, 3 unknowns a node, any number of plies through one cell",
        source: "Zienkiewicz and Taylor, The Finite Element Method, vol. 1, 5th ed. (2000), ch. 8",
        params: &[ORDER],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let built = Self::new(params.count(&ORDER)?).map_err(|e| ParamError::new(ORDER.name, e.to_string()))?;
        Ok(Built::Element(Box::new(built)))
    }
}
