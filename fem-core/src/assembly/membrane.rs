//! How deflections stretch a plate: von Kármán's quadratic strains of given displacement fields.

mod shape;

use super::AssemblyError;
use super::alike::Alike;
use super::cell_map::CellMap;
use crate::contracts::element::{Element, ElementError};
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, MatMut, MatRef, Par};
use shape::OfShape;

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

/// What is known of a cell.
#[derive(Debug, Default)]
struct OfCell {
    /// ε of all pairs at all in-plane points, `3 points × pairs`.
    strains: Vec<f64>,
    /// A ε, weighted by the area.
    stresses: Vec<f64>,
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
        self.each(false, |weight, _, _, of| {
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
        let (mut map, mut shape, mut of) = (CellMap::default(), OfShape::default(), OfCell::default());
        shape.integrate(self.element, &self.plate.cell(cell), false)?;
        map.set(self.plate, self.constraints, cell);
        self.stretch(&map, &shape, &mut of);
        let mut combined = Vec::new();
        product(&of.strains, combinations, self.pairs(), &mut combined);
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
        self.each(true, |weight, map, shape, of| {
            let rows = of.strains.len() / pairs;
            let local = shape.operator.len() / rows;
            product(&of.strains, combinations, pairs, &mut combined);
            product(&shape.operator, &combined, rows, &mut of_cell);
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
        let mut forms = FormsOf::new(modes.count, terms);
        let (mut stress, mut u, mut of_modes, mut slopes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        self.each(shapes.is_some(), |weight, map, shape, of| {
            let rows = of.strains.len() / pairs;
            let local = shape.ndof();
            u.resize(local, 0.0);
            product(&of.stresses, combinations, pairs, &mut stress);
            for (field, stress) in
                shapes.iter().flat_map(|s| s.chunks_exact(self.plate.ndof())).zip(stress.chunks_exact_mut(rows))
            {
                map.gather(field, &mut u);
                for (stress, column) in stress.iter_mut().zip(shape.operator.chunks_exact(local)) {
                    *stress += column.iter().zip(&u).map(|(b, u)| b * u).sum::<f64>();
                }
            }
            modes.slopes(map, shape, &mut of_modes, &mut slopes);
            stress.iter_mut().for_each(|stress| *stress *= 0.5 * weight);
            forms.take(&slopes, &stress);
        })?;
        Ok(forms.finish())
    }

    /// Slopes of the fields in a cell, those along x and along y of all fields at each point.
    fn slopes(&self, map: &CellMap, shape: &OfShape, u: &mut Vec<f64>, slopes: &mut Vec<f64>) {
        let (local, rows) = (shape.ndof(), 2 * shape.stiffness.len());
        u.resize(local * self.count, 0.0);
        slopes.resize(rows * self.count, 0.0);
        for (field, u) in self.fields.chunks_exact(self.plate.ndof()).zip(u.chunks_exact_mut(local)) {
            map.gather(field, u);
        }
        matmul(
            MatMut::from_row_major_slice_mut(slopes, rows, self.count),
            Accum::Replace,
            MatRef::from_row_major_slice(&shape.gradients, rows, local),
            MatRef::from_column_major_slice(u, local, self.count),
            1.0,
            Par::Seq,
        );
    }

    /// Calls `take` with each cell that counts, and how much; the strain operator is integrated where stresses `act`. Cells that are
    /// alike come one after the other, and their shape is integrated once.
    fn each(&self, act: bool, mut take: impl FnMut(f64, &CellMap, &OfShape, &OfCell)) -> Result<(), AssemblyError> {
        let (mut map, mut shape, mut of) = (CellMap::default(), OfShape::default(), OfCell::default());
        let alike = Alike::of(self.plate);
        for class in 0..alike.len() {
            let cells = alike.cells(class);
            let first = cells[0].0 as usize;
            shape.integrate(self.element, &self.plate.cell(first), act).map_err(|error| {
                let (quad, layer) = self.plate.place(first);
                AssemblyError { quad_tag: self.plate.plane.quad_tags[quad], layer, error }
            })?;
            for (cell, weight) in cells {
                map.set(self.plate, self.constraints, *cell as usize);
                self.stretch(&map, &shape, &mut of);
                take(*weight, &map, &shape, &of);
            }
        }
        Ok(())
    }

    /// Strains and stresses of all pairs in a cell.
    fn stretch(&self, map: &CellMap, shape: &OfShape, of: &mut OfCell) {
        let OfCell { strains, stresses, u, slopes } = of;
        let rows = 3 * shape.stiffness.len();
        strains.resize(rows * self.pairs(), 0.0);
        stresses.resize(rows * self.pairs(), 0.0);
        self.slopes(map, shape, u, slopes);
        let pairs = (0..self.count).flat_map(|i| (i..self.count).map(move |j| (i, j, if i == j { 0.5 } else { 1.0 })));
        let out = strains.chunks_exact_mut(rows).zip(stresses.chunks_exact_mut(rows));
        for ((i, j, share), (strains, stresses)) in pairs.zip(out) {
            let out = strains.as_chunks_mut::<3>().0.iter_mut().zip(stresses.as_chunks_mut::<3>().0);
            let slopes = slopes.chunks_exact(2 * self.count).map(|at| at.split_at(self.count));
            for (((along_x, along_y), stiffness), (strain, stress)) in slopes.zip(&shape.stiffness).zip(out) {
                let ([ax, ay], [bx, by]) = ([along_x[i], along_y[i]], [along_x[j], along_y[j]]);
                *strain = [ax * bx, ay * by, ax * by + ay * bx].map(|e| share * e);
                *stress = stiffness.map(|row| row.iter().zip(&*strain).map(|(c, e)| c * e).sum());
            }
        }
    }
}

/// Forms that are being summed over cells, some at a time.
#[derive(Debug)]
struct FormsOf {
    count: usize,
    /// Lower triangles, one form after the other.
    sums: Vec<f64>,
    /// Slopes at the points of some cells, those along x and along y of all modes at each; what they do under a stress.
    slopes: Vec<f64>,
    pulled: Vec<f64>,
    /// Stresses of each term at these points.
    stresses: Vec<Vec<f64>>,
}

impl FormsOf {
    /// Slopes that are multiplied at a time: products of fewer read and write the forms too often.
    const TOGETHER: usize = 256;

    fn new(count: usize, terms: usize) -> Self {
        let sums = vec![0.0; terms * count * count];
        Self { count, sums, slopes: Vec::new(), pulled: Vec::new(), stresses: vec![Vec::new(); terms] }
    }

    /// Adds a cell with these slopes and the stresses of each term, three at each point.
    fn take(&mut self, slopes: &[f64], stresses: &[f64]) {
        self.slopes.extend_from_slice(slopes);
        let each = stresses.chunks_exact((stresses.len() / self.stresses.len().max(1)).max(1));
        self.stresses.iter_mut().zip(each).for_each(|(all, stress)| all.extend_from_slice(stress));
        if self.slopes.len() >= Self::TOGETHER * self.count {
            self.add();
        }
    }

    fn add(&mut self) {
        let Self { count, sums, slopes, pulled, stresses } = self;
        let count = *count;
        let rows = slopes.len() / count.max(1);
        pulled.resize(slopes.len(), 0.0);
        for (stress, sum) in stresses.iter_mut().zip(sums.chunks_exact_mut((count * count).max(1))) {
            let points = slopes.chunks_exact(2 * count).zip(pulled.chunks_exact_mut(2 * count));
            for ((slopes, pulled), n) in points.zip(stress.as_chunks::<3>().0) {
                let ((x, y), (px, py)) = (slopes.split_at(count), pulled.split_at_mut(count));
                for (((x, y), px), py) in x.iter().zip(y).zip(px).zip(py) {
                    *px = n[0] * x + n[2] * y;
                    *py = n[2] * x + n[1] * y;
                }
            }
            triangular::matmul(
                MatMut::from_column_major_slice_mut(sum, count, count),
                BlockStructure::TriangularLower,
                Accum::Add,
                MatRef::from_column_major_slice(slopes, count, rows),
                BlockStructure::Rectangular,
                MatRef::from_row_major_slice(pulled, rows, count),
                BlockStructure::Rectangular,
                1.0,
                Par::Seq,
            );
            stress.clear();
        }
        slopes.clear();
    }

    /// The forms, whole.
    fn finish(mut self) -> Vec<f64> {
        self.add();
        for form in self.sums.chunks_exact_mut((self.count * self.count).max(1)) {
            for j in 0..self.count {
                (0..j).for_each(|i| form[i + self.count * j] = form[j + self.count * i]);
            }
        }
        self.sums
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
