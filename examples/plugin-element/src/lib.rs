//! The trilinear brick of eight nodes: a plug-in in one file.
//!
//! What to look at: [`NODES`] and [`Element::info`] are all that the mesh, the supports and the assembly know of an
//! element; [`Element::strain_operator`] is its theory, and [`Element::shape`] its displacements. Stiffness, mass and
//! mean strains are provided. [`Plugin`] gives it a name and a parameter in scenes.
use fem_core::dof::Dof;
use fem_core::domain::Domain;
use fem_core::element::{Cell, Element, ElementInfo};
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};

// ANCHOR: table
/// Corners (r, s, q), bottom face first, anticlockwise.
pub const NODES: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Translations: U10 U20 U30.
const DOFS: [Dof; 3] = [Dof::SOLID[0], Dof::SOLID[4], Dof::SOLID[8]];
// ANCHOR_END: table

/// Brick with functions N = (1 + r rᵢ)(1 + s sᵢ)(1 + q qᵢ)/8 of eight nodes, on any quadrilateral.
///
/// ```text
///        8-----7
///       /|    /|     q  s
///      5-----6 |     | /
///      | 4---|-3     |/
///      |/    |/      o--- r
///      1-----2
/// ```
///
/// Limits: ε₃₃ is constant through a layer of cells, so bending needs several; bending in the plane of the plate meets
/// the parasitic shear of linear functions.
#[derive(Debug, Clone)]
pub struct Hex8 {
    /// Transverse shears are linear between the middles of opposite sides, so that a thin cell bends; otherwise they are
    /// those of the displacements, and it locks.
    pub assumed_shear: bool,
}

impl Element for Hex8 {
    // ANCHOR: info
    fn info(&self) -> &ElementInfo {
        &ElementInfo { domain: Domain::Quadrilateral, nodes: &NODES, dofs: &DOFS, in_plane_order: 2, ply_order: 2 }
    }
    // ANCHOR_END: info

    // ANCHOR: strain
    fn strain_operator(&self, cell: &Cell<'_>, _slice: usize, [r, s, q]: [f64; 3], b: &mut [f64]) -> f64 {
        let (plane, h) = (cell.plane(r, s), cell.half_height());
        let cartesian = |by_r: f64, by_s: f64| [0, 1].map(|d| plane.inverse[0][d] * by_r + plane.inverse[1][d] * by_s);
        for ([ri, si, qi], b) in NODES.into_iter().zip(b.chunks_exact_mut(18)) {
            let [fr, fs, fq] = [(r, ri), (s, si), (q, qi)].map(|(a, ai)| 0.5 * (1.0 + a * ai));
            let [x, y] = cartesian(0.5 * ri * fs * fq, 0.5 * si * fr * fq);
            let z = 0.5 * qi * fr * fs / h;
            // Where U10 and U20 make the covariant shears γ(rq) and γ(sq): in the middles of the sides, or in place.
            let [rq, sq] = if self.assumed_shear { [[0.0, si], [ri, 0.0]] } else { [[r, s]; 2] };
            let (along_r, along_s) = (cell.plane(rq[0], rq[1]).jacobian[0], cell.plane(sq[0], sq[1]).jacobian[1]);
            let [by_rq, by_sq] = [(rq[0] * ri, fs), (sq[1] * si, fr)].map(|(a, f)| 0.25 * qi * (1.0 + a) * f / h);
            let [[u31, u23], [v31, v23]] = [0, 1].map(|d| cartesian(by_rq * along_r[d], by_sq * along_s[d]));
            b.copy_from_slice(&[
                x, 0.0, 0.0, y, u23, u31, //
                0.0, y, 0.0, x, v23, v31, //
                0.0, 0.0, z, 0.0, y, x,
            ]);
        }
        plane.det * h
    }
    // ANCHOR_END: strain

    // ANCHOR: shape
    fn shape(&self, cell: &Cell<'_>, [r, s, q]: [f64; 3], n: &mut [f64]) -> f64 {
        for ([ri, si, qi], n) in NODES.into_iter().zip(n.chunks_exact_mut(9)) {
            let f = 0.125 * (1.0 + r * ri) * (1.0 + s * si) * (1.0 + q * qi);
            n.copy_from_slice(&[f, 0.0, 0.0, 0.0, f, 0.0, 0.0, 0.0, f]);
        }
        cell.plane(r, s).det * cell.half_height()
    }
    // ANCHOR_END: shape
}

// ANCHOR: plugin
const SHEAR: ParamInfo =
    ParamInfo::word("shear", "transverse shear strains", &[("assumed", "thin cells bend"), ("full", "they lock")]);

impl Plugin for Hex8 {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Element,
        name: "hex8",
        summary: "8-node brick, 3 unknowns a node, any number of plies through one cell",
        source: "transverse shears: Bathe and Dvorkin, Int. J. Numer. Meth. Eng. 21 (1985) 367",
        params: &[SHEAR],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let assumed_shear = params.word(&SHEAR)? == "assumed";
        Ok(Built::Element(Box::new(Self { assumed_shear })))
    }
}
// ANCHOR_END: plugin
