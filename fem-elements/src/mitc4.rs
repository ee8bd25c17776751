//! The shell of Bathe and Dvorkin on a flat quadrilateral, laminated.

use crate::lamination::Lamination;
use fem_core::dof::Dof;
use fem_core::element::{Cell, Element, ElementError, ElementInfo, Part, Scratch, positive};
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
use nalgebra::{Matrix4, Matrix5, SMatrix, Vector4};

/// Corners, anticlockwise.
const NODES: [[f64; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];

/// Translations and the slopes of the normal.
const DOFS: [Dof; 5] = [Dof::SOLID[0], Dof::SOLID[4], Dof::SOLID[8], Dof::SOLID[3], Dof::SOLID[7]];

/// Unknowns of a cell.
const N: usize = 20;

/// Section strains (see [`Lamination`]) from the unknowns.
type SectionOperator = SMatrix<f64, 8, N>;

/// First-order-shear shell on a flat quadrilateral, whole laminate in one cell, free of shear locking.
///
/// u = U10 + z U13, v = U20 + z U23, w = U30, bilinear in the plane; z from the middle of the cell. The slopes of the normal
/// are its rotations: γ₃₁ = U13 + w,x. Transverse shears are interpolated from the middles of the edges in covariant
/// components (Bathe and Dvorkin, Int. J. Numer. Meth. Eng. 21 (1985) 367-383); their course through the plies, and the
/// shear stiffness, come from equilibrium (Rolfes and Rohwer, Int. J. Numer. Meth. Eng. 40 (1997) 51-60), so shear stresses
/// are continuous between plies and vanish at the faces. σ₃₃ = 0.
///
/// Reproduces constant membrane strain, curvature and transverse shear on any quadrilateral.
/// Limit: shear stiffness and shear stresses of laminates assume bending about the axes x and y.
#[derive(Debug, Clone)]
pub struct Mitc4 {
    info: ElementInfo,
}

impl Default for Mitc4 {
    fn default() -> Self {
        // Three points through a ply are exact: shear strains are quadratic in z.
        Self { info: ElementInfo { nodes: &NODES, dofs: &DOFS, in_plane_order: 2, ply_order: 3 } }
    }
}

/// Bilinear functions.
fn bilinear(r: f64, s: f64) -> Vector4<f64> {
    Vector4::from_fn(|i, _| 0.25 * (1.0 + r * NODES[i][0]) * (1.0 + s * NODES[i][1]))
}

/// Section strains at (r, s), and |∂x/∂ξ|.
fn section_operator(cell: &Cell<'_>, r: f64, s: f64) -> (SectionOperator, f64) {
    let plane = cell.plane(r, s);
    let mut operator = SectionOperator::zeros();
    // From covariant components to x and y.
    let cartesian = |by_r: f64, by_s: f64| [0, 1].map(|d| plane.inverse[0][d] * by_r + plane.inverse[1][d] * by_s);
    for (i, [ri, si, _]) in NODES.into_iter().enumerate() {
        let [u, v, w, a, b] = [0, 1, 2, 3, 4].map(|k| 5 * i + k);
        let (along_r, along_s) = (0.5 * (1.0 + r * ri), 0.5 * (1.0 + s * si));
        let [x, y] = cartesian(0.5 * ri * along_s, 0.5 * si * along_r);
        for (row, first, second) in [(0, u, v), (3, a, b)] {
            operator[(row, first)] = x;
            operator[(row + 1, second)] = y;
            operator[(row + 2, first)] = y;
            operator[(row + 2, second)] = x;
        }
        // γᵣ = w,r + x,r a + y,r b in the middles of the edges s = ±1, γₛ in those of r = ±1; linear between.
        let (edge_r, edge_s) = (cell.plane(0.0, si).jacobian[0], cell.plane(ri, 0.0).jacobian[1]);
        let covariant = [(w, ri, si), (a, edge_r[0], edge_s[0]), (b, edge_r[1], edge_s[1])];
        for (unknown, by_r, by_s) in covariant {
            let [x, y] = cartesian(0.5 * by_r * along_s, 0.5 * by_s * along_r);
            operator[(6, unknown)] = x;
            operator[(7, unknown)] = y;
        }
    }
    (operator, plane.det * cell.half_height())
}

impl Element for Mitc4 {
    fn info(&self) -> &ElementInfo {
        &self.info
    }

    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, [r, s, q]: [f64; 3], b: &mut [f64]) -> f64 {
        let (operator, jacobian) = section_operator(cell, r, s);
        match Lamination::new(cell.stack) {
            Ok(lamination) => {
                let strain = lamination.strain(slice, q, cell.half_height());
                b.copy_from_slice((strain * operator).as_slice());
                jacobian
            }
            Err(_) => {
                b.fill(f64::NAN);
                f64::NAN
            }
        }
    }

    fn shape(&self, cell: &Cell<'_>, [r, s, q]: [f64; 3], n: &mut [f64]) -> f64 {
        n.fill(0.0);
        let z = q * cell.half_height();
        for (f, n) in bilinear(r, s).iter().zip(n.chunks_exact_mut(15)) {
            for component in 0..3 {
                n[4 * component] = *f;
            }
            n[9] = z * f;
            n[13] = z * f;
        }
        cell.plane(r, s).det * cell.half_height()
    }

    fn stiffness(&self, cell: &Cell<'_>, _scratch: &mut Scratch, ke: &mut [f64]) -> Result<(), ElementError> {
        let h = cell.half_height();
        let section = Lamination::new(cell.stack)?.section(h) / h;
        let mut sum = SMatrix::<f64, N, N>::zeros();
        for (r, s, w) in self.info.plane_points() {
            let (operator, jacobian) = section_operator(cell, r, s);
            let dv = positive(jacobian)? * w;
            sum += operator.tr_mul(&(section * operator * dv));
        }
        ke.copy_from_slice(sum.as_slice());
        Ok(())
    }

    fn mass(&self, cell: &Cell<'_>, _scratch: &mut Scratch, me: &mut [f64]) -> Result<(), ElementError> {
        let h = cell.half_height();
        let mut plane = Matrix4::zeros();
        for (r, s, w) in self.info.plane_points() {
            let n = bilinear(r, s);
            plane += n * n.transpose() * (positive(cell.plane(r, s).det * h)? * w);
        }
        let [m, mz, mzz] = [0, 1, 2].map(|k| cell.stack.density_moments[k] * h.powi(k as i32));
        let inertia = Matrix5::new(
            m, 0.0, 0.0, mz, 0.0, //
            0.0, m, 0.0, 0.0, mz, //
            0.0, 0.0, m, 0.0, 0.0, //
            mz, 0.0, 0.0, mzz, 0.0, //
            0.0, mz, 0.0, 0.0, mzz,
        );
        me.copy_from_slice(plane.kronecker(&inertia).as_slice());
        Ok(())
    }

    fn mean_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        _scratch: &mut Scratch,
        b: &mut [f64],
    ) -> Result<(), ElementError> {
        let h = cell.half_height();
        let lamination = Lamination::new(cell.stack)?;
        let (mut mean, mut volume) = (SectionOperator::zeros(), 0.0);
        for (r, s, w) in self.info.plane_points() {
            let (operator, jacobian) = section_operator(cell, r, s);
            let dv = positive(jacobian)? * w;
            mean += operator * dv;
            volume += dv;
        }
        mean /= volume;
        for (Part { slice, q: [low, high] }, b) in parts.iter().zip(b.chunks_exact_mut(6 * N)) {
            // Simpson's rule is exact for the second degree.
            let at = |q: f64| lamination.strain(*slice, q, h);
            let strain = (at(*low) + at(0.5 * (low + high)) * 4.0 + at(*high)) / 6.0;
            b.copy_from_slice((strain * mean).as_slice());
        }
        Ok(())
    }
}

impl Plugin for Mitc4 {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Element,
        name: "mitc4",
        summary: "4-node laminated shell, first-order shear by equilibrium, 5 unknowns a node, one layer of cells",
        source: "Bathe and Dvorkin 1985; Rolfes and Rohwer 1997",
        params: &[],
    };

    fn build(_params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Element(Box::new(Self::default())))
    }
}
