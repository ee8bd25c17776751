//! The shell of Bathe and Dvorkin on a flat quadrilateral, laminated.

use crate::lamination::{self, Lamination, PlyStrain};
use fem_core::dof::Dof;
use fem_core::domain::Domain;
use fem_core::element::{Cell, Element, ElementError, ElementInfo, Part, Point, Scratch, Stack, positive};
use fem_core::large::LargeDeflection;
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
use nalgebra::{Matrix2, Matrix4, Matrix5, SMatrix, SVector, Vector4};

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
        Self {
            info: ElementInfo {
                domain: Domain::Quadrilateral,
                nodes: &NODES,
                dofs: &DOFS,
                in_plane_order: 2,
                ply_order: 3,
            },
        }
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
        plane: &[Point],
        _scratch: &mut Scratch,
        b: &mut [f64],
    ) -> Result<(), ElementError> {
        let h = cell.half_height();
        let lamination = Lamination::new(cell.stack)?;
        let (mut mean, mut volume) = (SectionOperator::zeros(), 0.0);
        for point in plane {
            let (operator, jacobian) = section_operator(cell, point.at[0], point.at[1]);
            let dv = positive(jacobian)? * point.weight();
            mean += operator * dv;
            volume += dv;
        }
        mean /= volume;
        for (part, b) in parts.iter().zip(b.chunks_exact_mut(6 * N)) {
            b.copy_from_slice((mean_ply_strain(&lamination, part, h) * mean).as_slice());
        }
        Ok(())
    }

    fn held_stress(&self, stack: &Stack, part: &Part) -> [f64; 6] {
        lamination::held_stress(&stack.slices[part.slice])
    }

    fn large_deflections(&self) -> Option<&dyn LargeDeflection> {
        Some(self)
    }
}

/// Section strains of displacements, with what w adds to those of the middle (von Kármán): ½ w,x², ½ w,y², w,x w,y.
struct Bent {
    strain: SVector<f64, 8>,
    /// Their derivatives by the unknowns.
    operator: SectionOperator,
    /// w,x and w,y from the unknowns.
    slopes: SMatrix<f64, 2, N>,
    /// |∂x/∂ξ|
    jacobian: f64,
}

impl Bent {
    fn new(cell: &Cell<'_>, r: f64, s: f64, u: &SVector<f64, N>) -> Self {
        let (mut operator, jacobian) = section_operator(cell, r, s);
        let mut strain = operator * u;
        // The operator has the derivatives of the bilinear functions in its first row, as those of u by x, and its second.
        let mut slopes = SMatrix::<f64, 2, N>::zeros();
        for i in 0..4 {
            slopes[(0, 5 * i + 2)] = operator[(0, 5 * i)];
            slopes[(1, 5 * i + 2)] = operator[(1, 5 * i + 1)];
        }
        let [x, y]: [f64; 2] = (slopes * u).into();
        for (row, half, by_x, by_y) in [(0, 0.5 * x * x, x, 0.0), (1, 0.5 * y * y, 0.0, y), (2, x * y, y, x)] {
            strain[row] += half;
            let mut derivative = operator.row_mut(row);
            derivative += slopes.row(0) * by_x + slopes.row(1) * by_y;
        }
        Self { strain, operator, slopes, jacobian }
    }
}

/// Von Kármán's strains: slopes of the deflection enter squared, the rotations of normals do not. Right for rotations up to
/// some 0.2; Green and Lagrange's other terms are of the fourth order.
impl LargeDeflection for Mitc4 {
    fn internal(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        _scratch: &mut Scratch,
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, ElementError> {
        let h = cell.half_height();
        let lamination = Lamination::new(cell.stack)?;
        let section = lamination.section(h) / h;
        let (held, at_rest) = lamination.held(h);
        let held = held / h;
        let u = SVector::<f64, N>::from_column_slice(u);
        let (mut sum, mut matrix, mut energy) = (SVector::<f64, N>::zeros(), SMatrix::<f64, N, N>::zeros(), 0.0);
        for (r, s, w) in self.info.plane_points() {
            let bent = Bent::new(cell, r, s, &u);
            let dv = positive(bent.jacobian)? * w;
            let moved = section * bent.strain;
            let forces = moved + held;
            energy += dv * (0.5 * bent.strain.dot(&moved) + bent.strain.dot(&held) + at_rest / h);
            sum += bent.operator.tr_mul(&forces) * dv;
            if tangent.is_some() {
                let membrane = Matrix2::new(forces[0], forces[2], forces[2], forces[1]);
                matrix += bent.operator.tr_mul(&(section * bent.operator * dv));
                matrix += bent.slopes.tr_mul(&(membrane * bent.slopes * dv));
            }
        }
        force.copy_from_slice(sum.as_slice());
        if let Some(tangent) = tangent {
            tangent.copy_from_slice(matrix.as_slice());
        }
        Ok(energy)
    }

    fn geometric_stiffness(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        _scratch: &mut Scratch,
        kg: &mut [f64],
    ) -> Result<(), ElementError> {
        let h = cell.half_height();
        let lamination = Lamination::new(cell.stack)?;
        let (section, held) = (lamination.section(h) / h, lamination.held(h).0 / h);
        let (u, rest) = (SVector::<f64, N>::from_column_slice(u), SVector::zeros());
        let mut sum = SMatrix::<f64, N, N>::zeros();
        for (r, s, w) in self.info.plane_points() {
            let Bent { operator, slopes, jacobian, .. } = Bent::new(cell, r, s, &rest);
            let forces = section * (operator * u) + held;
            let membrane = Matrix2::new(forces[0], forces[2], forces[2], forces[1]);
            sum += slopes.tr_mul(&(membrane * slopes * (positive(jacobian)? * w)));
        }
        kg.copy_from_slice(sum.as_slice());
        Ok(())
    }

    fn large_strain(
        &self,
        cell: &Cell<'_>,
        slice: usize,
        [r, s, q]: [f64; 3],
        u: &[f64],
    ) -> Result<[f64; 6], ElementError> {
        let bent = Bent::new(cell, r, s, &SVector::from_column_slice(u));
        positive(bent.jacobian)?;
        Ok((Lamination::new(cell.stack)?.strain(slice, q, cell.half_height()) * bent.strain).into())
    }

    fn mean_large_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        u: &[f64],
        strains: &mut [f64],
    ) -> Result<(), ElementError> {
        let h = cell.half_height();
        let lamination = Lamination::new(cell.stack)?;
        for (u, strains) in u.chunks_exact(N).zip(strains.chunks_exact_mut((6 * parts.len()).max(1))) {
            let u = SVector::<f64, N>::from_column_slice(u);
            let (mut mean, mut volume) = (SVector::<f64, 8>::zeros(), 0.0);
            for point in plane {
                let bent = Bent::new(cell, point.at[0], point.at[1], &u);
                let dv = positive(bent.jacobian)? * point.weight();
                mean += bent.strain * dv;
                volume += dv;
            }
            mean /= volume;
            for (part, strains) in parts.iter().zip(strains.chunks_exact_mut(6)) {
                strains.copy_from_slice((mean_ply_strain(&lamination, part, h) * mean).as_slice());
            }
        }
        Ok(())
    }
}

/// Mean of the strains within a part of a ply from the section strains, by Simpson's rule: exact for the second degree.
fn mean_ply_strain(lamination: &Lamination<'_>, Part { slice, q: [low, high] }: &Part, h: f64) -> PlyStrain {
    let at = |q: f64| lamination.strain(*slice, q, h);
    (at(*low) + at(0.5 * (low + high)) * 4.0 + at(*high)) / 6.0
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
