//! How deflections stretch a plate: von Kármán's quadratic strains of given displacement fields.

use super::AssemblyError;
use super::cell_map::CellMap;
use crate::contracts::element::{Cell, Element, ElementError, form, positive};
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;
use crate::plates::slopes::add_slopes;
use crate::words::quadrature::gauss_legendre;
use crate::words::tensor::Matrix6;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

/// Rows of the strains in the plane of the plate, 11, 22 and 12.
const PLANE: [usize; 3] = [0, 1, 3];

/// A stress that a theory takes as zero, relative to the others.
const ABSENT: f64 = 1e-12;

/// The strains by which deflections w = Σ qᵢ wᵢ of a plate stretch it, ε(q) = Σ over pairs i ≤ j of qᵢ qⱼ ε_ij:
///
/// ε₁₁ = ½ w,x², ε₂₂ = ½ w,y², γ₁₂ = w,x w,y,
///
/// w taken in the middle of each cell; for any element, from its shape functions and its strain operator. Pairs count by rows
/// of the upper triangle.
#[derive(Debug)]
pub struct MembraneStrains<'a> {
    plate: &'a Plate,
    element: &'a dyn Element,
    constraints: &'a Constraints,
    /// The fields before elimination, `plate.ndof()` each.
    fields: Vec<f64>,
    count: usize,
}

/// Work arrays, and what is known of a cell.
#[derive(Debug, Default)]
struct OfCell {
    /// ε of all pairs at all in-plane points, `3 points × pairs`.
    strains: Vec<f64>,
    /// A ε, A = ∫ C dz, weighted by the area.
    stresses: Vec<f64>,
    /// ∫ Bᵀ C dz at all in-plane points, weighted by the area, `ndof × 3 points`.
    operator: Vec<f64>,
    /// C of the slices.
    known: Vec<Matrix6>,
    b: Vec<f64>,
    shape: Vec<f64>,
    /// ∂w/∂x and ∂w/∂y of each unknown at all in-plane points, `2 points × ndof` by rows.
    gradients: Vec<f64>,
    /// Unknowns of the fields, `ndof × fields`, and their slopes, `2 points × fields`.
    u: Vec<f64>,
    slopes: Vec<f64>,
}

impl<'a> MembraneStrains<'a> {
    /// `fields`: independent displacements, one after the other.
    pub fn new(plate: &'a Plate, element: &'a dyn Element, constraints: &'a Constraints, fields: &[f64]) -> Self {
        let (n, all) = (constraints.ndof(), plate.ndof());
        let count = fields.len() / n.max(1);
        let mut expanded = vec![0.0; all * count];
        for (field, expanded) in fields.chunks_exact(n.max(1)).zip(expanded.chunks_exact_mut(all.max(1))) {
            constraints.expand(field, expanded);
        }
        Self { plate, element, constraints, fields: expanded, count }
    }

    /// Number of pairs of fields.
    pub fn pairs(&self) -> usize {
        self.count * (self.count + 1) / 2
    }

    /// ∫ ε_pᵀ C ε_p′ dV of all pairs, `pairs × pairs`, J.
    ///
    /// # Errors
    /// A cell that is folded.
    pub fn gram(&self) -> Result<Vec<f64>, AssemblyError> {
        let pairs = self.pairs();
        let mut gram = vec![0.0; pairs * pairs];
        self.each(false, |weight, _, of| {
            let rows = of.strains.len() / pairs;
            matmul(
                MatMut::from_column_major_slice_mut(&mut gram, pairs, pairs),
                Accum::Add,
                MatRef::from_column_major_slice(&of.strains, rows, pairs).transpose(),
                MatRef::from_column_major_slice(&of.stresses, rows, pairs),
                weight,
                Par::Seq,
            );
        })?;
        Ok(gram)
    }

    /// The strains Σ over pairs of c_p ε_p in a cell at its in-plane points, for each column c of `combinations`, one after the other.
    ///
    /// # Errors
    /// A cell that is folded.
    pub(super) fn of_cell(&self, cell: usize, combinations: &[f64]) -> Result<Vec<f64>, ElementError> {
        let (pairs, mut map, mut of) = (self.pairs(), CellMap::default(), OfCell::default());
        map.set(self.plate, self.constraints, cell);
        self.integrate(&self.plate.cell(cell), &map, false, &mut of)?;
        let mut combined = Vec::new();
        product(&of.strains, combinations, pairs, &mut combined);
        Ok(combined)
    }

    /// Forces ∫ Bᵀ C ε dV that the strains ε = Σ over pairs of c_p ε_p do on the independent unknowns, for each column c
    /// of `combinations` (`pairs × columns`); `ndof × columns`, N.
    ///
    /// # Errors
    /// As [`MembraneStrains::gram`].
    pub fn forces(&self, combinations: &[f64]) -> Result<Vec<f64>, AssemblyError> {
        let pairs = self.pairs();
        let columns = combinations.len() / pairs;
        let n = self.constraints.ndof();
        let mut forces = vec![0.0; n * columns];
        let (mut combined, mut of_cell) = (Vec::new(), Vec::new());
        self.each(true, |weight, map, of| {
            let rows = of.strains.len() / pairs;
            let local = of.operator.len() / rows;
            product(&of.strains, combinations, pairs, &mut combined);
            product(&of.operator, &combined, rows, &mut of_cell);
            for (force, total) in of_cell.chunks_exact(local).zip(forces.chunks_exact_mut(n)) {
                map.scatter_vector(force, weight, total);
            }
        })?;
        Ok(forces)
    }

    /// Forms B_t, `count × count` over the independent displacements `modes`, one after the other: b_t = qᵀ B_t q is the work
    /// of a membrane stress on the strains of the deflections w = Σ qᵢ wᵢ of `modes`, the stress C (ε + B s) of a combination
    /// ε = Σ c_p ε_p (`pairs × terms`) and of the displacements s (`ndof × terms`; none are zero). J.
    ///
    /// # Errors
    /// As [`MembraneStrains::gram`].
    pub fn forms(
        &self,
        combinations: &[f64],
        shapes: Option<&[f64]>,
        modes: &[f64],
    ) -> Result<Vec<f64>, AssemblyError> {
        let pairs = self.pairs();
        let terms = combinations.len() / pairs;
        let modes = Self::new(self.plate, self.element, self.constraints, modes);
        let shapes = shapes.map(|shapes| Self::new(self.plate, self.element, self.constraints, shapes).fields);
        let count = modes.count;
        let mut forms = vec![0.0; terms * count * count];
        let (mut stress, mut u, mut of_modes) = (Vec::new(), Vec::new(), Vec::new());
        let (mut x, mut y) = (Vec::new(), Vec::new());
        self.each(shapes.is_some(), |weight, map, of| {
            let rows = of.strains.len() / pairs;
            let (points, local) = (rows / 3, of.operator.len() / rows);
            u.resize(local, 0.0);
            product(&of.stresses, combinations, pairs, &mut stress);
            for (field, stress) in
                shapes.iter().flat_map(|s| s.chunks_exact(self.plate.ndof())).zip(stress.chunks_exact_mut(rows))
            {
                map.gather(field, &mut u);
                for (stress, column) in stress.iter_mut().zip(of.operator.chunks_exact(local)) {
                    *stress += column.iter().zip(&u).map(|(b, u)| b * u).sum::<f64>();
                }
            }
            modes.slopes(map, local, &of.gradients, &mut of_modes, &mut x);
            y.resize(x.len(), 0.0);
            for (stress, form) in stress.chunks_exact(rows).zip(forms.chunks_exact_mut(count * count)) {
                for (x, y) in x.chunks_exact(2 * points).zip(y.chunks_exact_mut(2 * points)) {
                    for ((x, y), n) in x.chunks_exact(2).zip(y.chunks_exact_mut(2)).zip(stress.chunks_exact(3)) {
                        y[0] = n[0] * x[0] + n[2] * x[1];
                        y[1] = n[2] * x[0] + n[1] * x[1];
                    }
                }
                matmul(
                    MatMut::from_column_major_slice_mut(form, count, count),
                    Accum::Add,
                    MatRef::from_column_major_slice(&x, 2 * points, count).transpose(),
                    MatRef::from_column_major_slice(&y, 2 * points, count),
                    0.5 * weight,
                    Par::Seq,
                );
            }
        })?;
        Ok(forms)
    }

    /// Slopes of the fields in a cell, two rows per point.
    fn slopes(&self, map: &CellMap, local: usize, gradients: &[f64], u: &mut Vec<f64>, slopes: &mut Vec<f64>) {
        let rows = gradients.len() / local;
        u.resize(local * self.count, 0.0);
        slopes.resize(rows * self.count, 0.0);
        for (field, u) in self.fields.chunks_exact(self.plate.ndof()).zip(u.chunks_exact_mut(local)) {
            map.gather(field, u);
        }
        matmul(
            MatMut::from_column_major_slice_mut(slopes, rows, self.count),
            Accum::Replace,
            MatRef::from_row_major_slice(gradients, rows, local),
            MatRef::from_column_major_slice(u, local, self.count),
            1.0,
            Par::Seq,
        );
    }

    /// Calls `take` with each cell that counts, and how much; the strain operator is integrated where `acts` wants it.
    fn each(&self, acts: bool, mut take: impl FnMut(f64, &CellMap, &OfCell)) -> Result<(), AssemblyError> {
        let (mut map, mut of) = (CellMap::default(), OfCell::default());
        for (cell, weight) in self.plate.kept_cells() {
            map.set(self.plate, self.constraints, cell);
            let view = self.plate.cell(cell);
            self.integrate(&view, &map, acts, &mut of).map_err(|error| {
                let (quad, layer) = self.plate.place(cell);
                AssemblyError { quad_tag: self.plate.plane.quad_tags[quad], layer, error }
            })?;
            take(weight, &map, &of);
        }
        Ok(())
    }

    fn integrate(&self, cell: &Cell<'_>, map: &CellMap, acts: bool, of: &mut OfCell) -> Result<(), ElementError> {
        let element = form(self.element, cell.corners.domain());
        let info = element.info();
        let (local, pairs) = (info.ndof(), self.pairs());
        let rows = 3 * info.plane_points().count();
        let OfCell { strains, stresses, operator, known, b, shape, gradients, u, slopes } = of;
        strains.resize(rows * pairs, 0.0);
        stresses.resize(rows * pairs, 0.0);
        operator.clear();
        operator.resize(local * rows, 0.0);
        b.resize(6 * local, 0.0);
        gradients.clear();
        for (r, s, _) in info.plane_points() {
            add_slopes(element, cell, [r, s], shape, gradients);
        }
        self.slopes(map, local, gradients, u, slopes);
        // ∫ C dq of the strains in the plane, where a theory takes stresses as zero without them.
        known.clear();
        let mut through = [[0.0; 3]; 3];
        for (number, slice) in cell.stack.slices.iter().enumerate() {
            element.strain_operator(cell, number, [0.0, 0.0, 0.5 * (slice.q[0] + slice.q[1])], b);
            let c = reduced(&slice.c, b);
            for (sum, i) in through.iter_mut().zip(PLANE) {
                sum.iter_mut().zip(PLANE).for_each(|(sum, j)| *sum += (slice.q[1] - slice.q[0]) * c[i][j]);
            }
            known.push(c);
        }
        for (point, (r, s, w)) in info.plane_points().enumerate() {
            let area = positive(cell.plane(r, s).det * cell.half_height())? * w;
            let stiffness = through.map(|row| row.map(|a| area * a));
            if acts {
                let columns = &mut operator[local * 3 * point..local * 3 * (point + 1)];
                for (number, (slice, c)) in cell.stack.slices.iter().zip(&*known).enumerate() {
                    let (middle, half) = (0.5 * (slice.q[0] + slice.q[1]), 0.5 * (slice.q[1] - slice.q[0]));
                    // The order is that of a product of two operators; for one, half of it is exact.
                    for &(t, wt) in gauss_legendre(info.ply_order.div_ceil(2)) {
                        let det = element.strain_operator(cell, number, [r, s, middle + half * t], b);
                        let dv = positive(det)? * w * wt * half;
                        for (i, strain) in b.chunks_exact(6).enumerate() {
                            for (k, row) in PLANE.iter().enumerate() {
                                let stress = c[*row].iter().zip(strain).map(|(c, e)| c * e).sum::<f64>();
                                columns[local * k + i] += dv * stress;
                            }
                        }
                    }
                }
            }
            let mut pair = 0;
            let here = || slopes.chunks_exact(rows / 3 * 2).map(|slopes| &slopes[2 * point..]).enumerate();
            for (i, a) in here() {
                for (j, b) in here().skip(i) {
                    let twice = if i == j { 0.5 } else { 1.0 };
                    let strain = [a[0] * b[0], a[1] * b[1], a[0] * b[1] + a[1] * b[0]].map(|e| twice * e);
                    let at = rows * pair + 3 * point;
                    for (k, row) in stiffness.iter().enumerate() {
                        strains[at + k] = strain[k];
                        stresses[at + k] = row.iter().zip(strain).map(|(c, e)| c * e).sum();
                    }
                    pair += 1;
                }
            }
        }
        Ok(())
    }
}

/// `out ← A B`, column-major, A of `inner` columns.
fn product(a: &[f64], b: &[f64], inner: usize, out: &mut Vec<f64>) {
    let (rows, columns) = (a.len() / inner, b.len() / inner);
    out.resize(rows * columns, 0.0);
    matmul(
        MatMut::from_column_major_slice_mut(out, rows, columns),
        Accum::Replace,
        MatRef::from_column_major_slice(a, rows, inner),
        MatRef::from_column_major_slice(b, inner, columns),
        1.0,
        Par::Seq,
    );
}

/// C without the normal stresses that a theory takes as zero, known by its strain operator: they are condensed.
fn reduced(c: &Matrix6, b: &[f64]) -> Matrix6 {
    let mut c = *c;
    for k in [2, 1] {
        let product = |strain: &[f64]| c[k].iter().zip(strain).map(|(c, e)| c * e).sum::<f64>();
        let parts = |strain: &[f64]| c[k].iter().zip(strain).map(|(c, e)| (c * e).abs()).sum::<f64>();
        let stress = b.chunks_exact(6).map(|strain| product(strain).abs()).fold(0.0, f64::max);
        let size = b.chunks_exact(6).map(parts).fold(0.0, f64::max);
        if stress <= ABSENT * size {
            let row = c[k];
            for i in 0..6 {
                let factor = row[i] / row[k];
                c[i].iter_mut().zip(row).for_each(|(c, k)| *c -= factor * k);
            }
        }
    }
    c
}
