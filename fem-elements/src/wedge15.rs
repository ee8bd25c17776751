//! The 15-node serendipity wedge.

use crate::serendipity::{DOFS, Functions, Serendipity};
use fem_core::domain::Domain;
use fem_core::element::ElementInfo;
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

/// 15-node serendipity wedge, three translations a node.
///
/// Complete quadratics on every triangle. Integrated exactly in the plane and through the thickness, so that a matrix costs
/// the same for any number of plies.
pub type Wedge15 = Serendipity<15>;

impl Default for Wedge15 {
    fn default() -> Self {
        // Six points in the plane are exact to the fourth degree, that of K and M on straight sides; three points through a
        // ply as well: strains are quadratic in q.
        let domain = Domain::Triangle;
        Self {
            info: ElementInfo { domain, nodes: &NODES, dofs: &DOFS, in_plane_order: 2, ply_order: 3 },
            triangular: None,
        }
    }
}

impl Functions for Wedge15 {
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
