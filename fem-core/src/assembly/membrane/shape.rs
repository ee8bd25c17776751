//! What cells of one shape and of the same plies have in common: their slopes, their stiffness, and what their stresses do.

use crate::contracts::cubic_strains::{COEFFICIENTS, CubicStrains};
use crate::contracts::element::{Cell, Element, ElementError, ElementInfo, Part, Point, Slice, form, positive};
use crate::plates::slopes::add_slopes;
use crate::words::quadrature::gauss_legendre;
use crate::words::tensor::Matrix6;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

/// Rows of the strains in the plane of the plate, 11, 22 and 12.
const PLANE: [usize; 3] = [0, 1, 3];

/// A stress that a theory takes as zero, relative to the others.
const ABSENT: f64 = 1e-12;

/// See the [module](self); with its work arrays.
#[derive(Debug, Default)]
pub(super) struct OfShape {
    /// ∂w/∂x and ∂w/∂y of each unknown at all in-plane points, `2 points × ndof` by rows.
    pub(super) gradients: Vec<f64>,
    /// A = ∫ C dz of the strains in the plane at each in-plane point, weighted by the area.
    pub(super) stiffness: Vec<[[f64; 3]; 3]>,
    /// ∫ Bᵀ C dz at all in-plane points, weighted by the area, `ndof × 3 points`; empty where none is asked for.
    pub(super) operator: Vec<f64>,
    /// C of the slices.
    known: Vec<Matrix6>,
    b: Vec<f64>,
    shape: Vec<f64>,
}

impl OfShape {
    /// Integrates `cell`; the operator where stresses `act`.
    pub(super) fn integrate(&mut self, element: &dyn Element, cell: &Cell<'_>, act: bool) -> Result<(), ElementError> {
        let element = form(element, cell.corners.domain());
        let info = element.info();
        self.gradients.clear();
        self.stiffness.clear();
        self.operator.clear();
        let through = self.through(element, cell);
        for (r, s, w) in info.plane_points() {
            add_slopes(element, cell, [r, s], &mut self.shape, &mut self.gradients);
            let area = positive(cell.plane(r, s).det * cell.half_height())? * w;
            self.stiffness.push(through.map(|row| row.map(|a| area * a)));
        }
        if act {
            self.operator.resize(3 * info.plane().len() * info.ndof(), 0.0);
            match element.cubic_strains() {
                Some(cubic) => self.act_of_cubics(cubic, info, cell)?,
                None => self.act(element, cell)?,
            }
        }
        Ok(())
    }

    /// Unknowns of a cell.
    pub(super) fn ndof(&self) -> usize {
        self.gradients.len() / (2 * self.stiffness.len())
    }

    /// ∫ C dq of the strains in the plane, where a theory takes stresses as zero without them.
    fn through(&mut self, element: &dyn Element, cell: &Cell<'_>) -> [[f64; 3]; 3] {
        let [r, s, _] = element.info().centre();
        let mut through = [[0.0; 3]; 3];
        self.known.clear();
        self.b.resize(6 * element.info().ndof(), 0.0);
        for (number, slice) in cell.stack.slices.iter().enumerate() {
            element.strain_operator(cell, number, [r, s, 0.5 * (slice.q[0] + slice.q[1])], &mut self.b);
            let c = reduced(&slice.c, &self.b);
            for (sum, i) in through.iter_mut().zip(PLANE) {
                sum.iter_mut().zip(PLANE).for_each(|(sum, j)| *sum += height(slice) * c[i][j]);
            }
            self.known.push(c);
        }
        through
    }

    /// Sums the operator over the points through each ply.
    fn act(&mut self, element: &dyn Element, cell: &Cell<'_>) -> Result<(), ElementError> {
        let (info, b) = (element.info(), &mut self.b);
        let local = info.ndof();
        for ((r, s, w), columns) in info.plane_points().zip(self.operator.chunks_exact_mut(3 * local)) {
            for (number, (slice, c)) in cell.stack.slices.iter().zip(&self.known).enumerate() {
                let (middle, half) = (0.5 * (slice.q[0] + slice.q[1]), 0.5 * height(slice));
                // The order is that of a product of two operators; for one, half of it is exact.
                for &(t, wt) in gauss_legendre(info.ply_order.div_ceil(2)) {
                    let det = element.strain_operator(cell, number, [r, s, middle + half * t], b);
                    let dv = positive(det)? * w * wt * half;
                    for (column, row) in columns.chunks_exact_mut(local).zip(PLANE) {
                        for (force, strain) in column.iter_mut().zip(b.as_chunks().0) {
                            *force += dv * product(&c[row], strain);
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// The same of strains that are cubic through the cell: what all plies make of their coefficients is one matrix.
    fn act_of_cubics(
        &mut self,
        element: &dyn CubicStrains,
        info: &ElementInfo,
        cell: &Cell<'_>,
    ) -> Result<(), ElementError> {
        let local = info.ndof();
        let mut stresses = [[0.0; COEFFICIENTS]; 3];
        for (number, (slice, c)) in cell.stack.slices.iter().zip(&self.known).enumerate() {
            let shares = element.shares(cell.stack, &Part { slice: number, q: slice.q });
            for (stress, row) in stresses.iter_mut().zip(PLANE) {
                for (shares, c) in shares.iter().zip(&c[row]) {
                    stress.iter_mut().zip(shares).for_each(|(stress, share)| *stress += height(slice) * c * share);
                }
            }
        }
        let stresses = MatRef::from_column_major_slice(stresses.as_flattened(), COEFFICIENTS, 3);
        self.b.resize(COEFFICIENTS * local, 0.0);
        for (point, columns) in info.plane().iter().zip(self.operator.chunks_exact_mut(3 * local)) {
            element.coefficients(cell, std::slice::from_ref::<Point>(point), &mut self.b)?;
            let [r, s] = point.at;
            let area = positive(cell.plane(r, s).det * cell.half_height())? * point.weight();
            let strains = MatRef::from_column_major_slice(&self.b, COEFFICIENTS, local);
            let columns = MatMut::from_column_major_slice_mut(columns, local, 3);
            matmul(columns, Accum::Replace, strains.transpose(), stresses, area, Par::Seq);
        }
        Ok(())
    }
}

/// ∫ dq of a ply.
fn height(slice: &Slice) -> f64 {
    slice.q[1] - slice.q[0]
}

fn product(row: &[f64; 6], strain: &[f64; 6]) -> f64 {
    row.iter().zip(strain).map(|(c, e)| c * e).sum()
}

/// C without the normal stresses that a theory takes as zero, known by its strain operator: they are condensed.
fn reduced(c: &Matrix6, b: &[f64]) -> Matrix6 {
    let mut c = *c;
    let strains: &[[f64; 6]] = b.as_chunks().0;
    for k in [2, 1] {
        let row = c[k];
        let parts = |strain: &[f64; 6]| row.iter().zip(strain).map(|(c, e)| (c * e).abs()).sum::<f64>();
        let stress = strains.iter().map(|strain| product(&row, strain).abs()).fold(0.0, f64::max);
        let size = strains.iter().map(parts).fold(0.0, f64::max);
        if stress <= ABSENT * size {
            for i in 0..6 {
                let factor = row[i] / row[k];
                c[i].iter_mut().zip(row).for_each(|(c, k)| *c -= factor * k);
            }
        }
    }
    c
}
