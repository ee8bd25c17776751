//! What a cell adds to matrices and vectors of the independent unknowns.

use super::Symmetric;
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;

/// The independent unknowns of a cell, and how its own depend on them.
#[derive(Debug, Clone, Default)]
pub(crate) struct CellMap {
    dofs: Vec<usize>,
    /// Independent unknowns, ascending.
    pub(crate) reduced: Vec<usize>,
    /// (unknown of the cell, position in `reduced`, factor)
    terms: Vec<(usize, usize, f64)>,
    /// Every unknown of the cell is one independent unknown or none.
    plain: bool,
    /// Where the matrix to be added has the rows of `reduced`.
    places: Vec<usize>,
    work: Vec<f64>,
}

impl CellMap {
    pub(crate) fn set(&mut self, plate: &Plate, constraints: &Constraints, cell: usize) {
        plate.cell_dofs(cell, &mut self.dofs);
        self.number(constraints);
    }

    /// The same for the unknowns `dofs`.
    pub(super) fn set_unknowns(&mut self, dofs: &[usize], constraints: &Constraints) {
        self.dofs.clear();
        self.dofs.extend_from_slice(dofs);
        self.number(constraints);
    }

    fn number(&mut self, constraints: &Constraints) {
        self.reduced.clear();
        self.terms.clear();
        self.plain = true;
        for (local, dof) in self.dofs.iter().enumerate() {
            let (terms, _) = constraints.row(*dof);
            self.plain &= terms.len() < 2 && terms.iter().all(|t| t.1 == 1.0);
            for (i, c) in terms {
                self.reduced.push(*i);
                self.terms.push((local, *i, *c));
            }
        }
        self.reduced.sort_unstable();
        let before = self.reduced.len();
        self.reduced.dedup();
        self.plain &= before == self.reduced.len();
        for term in &mut self.terms {
            term.1 = self.reduced.partition_point(|i| *i < term.1);
        }
        self.places.resize(self.reduced.len(), 0);
        for (local, position, _) in &self.terms {
            self.places[*position] = *local;
        }
    }

    /// The cell's part of the displacements of a plate.
    pub(super) fn gather(&self, all: &[f64], u: &mut [f64]) {
        for (u, dof) in u.iter_mut().zip(&self.dofs) {
            *u = all[*dof];
        }
    }

    /// Adds `weight` Tᵀ f of a cell to a vector of the independent unknowns.
    pub(super) fn scatter_vector(&self, f: &[f64], weight: f64, to: &mut [f64]) {
        for (local, position, factor) in &self.terms {
            to[self.reduced[*position]] += weight * factor * f[*local];
        }
    }

    /// Tᵀ A T of a cell matrix, lower triangle of the ascending independent unknowns, `n × n` column-major.
    fn transform(&self, a: &[f64], out: &mut Vec<f64>) {
        let (m, n) = (self.dofs.len(), self.reduced.len());
        out.clear();
        out.resize(n * n, 0.0);
        for (j, jr, cj) in &self.terms {
            let column = &a[j * m..(j + 1) * m];
            let out = &mut out[jr * n..(jr + 1) * n];
            for (i, ir, ci) in &self.terms {
                out[*ir] += ci * cj * column[*i];
            }
        }
    }

    /// Adds the lower triangle of `weight` times a cell matrix to `sum`.
    pub(crate) fn scatter(&mut self, a: &[f64], weight: f64, sum: &mut Symmetric) {
        if self.plain {
            self.add_plain(a, weight, sum);
            return;
        }
        let mut work = std::mem::take(&mut self.work);
        self.transform(a, &mut work);
        self.places.clear();
        self.places.extend(0..self.reduced.len());
        self.add_plain(&work, weight, sum);
        self.work = work;
    }

    /// Adds the lower triangle of a matrix whose row and column `places[i]` belong to the independent unknown `reduced[i]`.
    ///
    /// Runs of consecutive unknowns are consecutive in every column that holds them: one search per run.
    ///
    /// Why not through faer's once-sorted order of triplets: it keeps 24 bytes for each entry of each cell, sorting it
    /// takes ten times as long as the pattern does here, and its sums come in another order, so that results would
    /// differ in their last bits. The sum itself is no slower there (`cargo bench --bench assembly`).
    fn add_plain(&self, a: &[f64], weight: f64, sum: &mut Symmetric) {
        let (symbolic, values) = sum.lower_mut().parts_mut();
        let (n, m) = (self.reduced.len(), a.len().isqrt());
        let (starts, rows) = (symbolic.col_ptr(), symbolic.row_idx());
        for (j, column) in self.reduced.iter().enumerate() {
            let start = starts[*column];
            let rows = &rows[start..starts[column + 1]];
            let from = &a[self.places[j] * m..(self.places[j] + 1) * m];
            let (mut i, mut at) = (j, 0);
            while i < n {
                let first = self.reduced[i];
                at += rows[at..].partition_point(|r| *r < first);
                let mut length = 1;
                while i + length < n && self.reduced[i + length] == first + length {
                    length += 1;
                }
                for (v, place) in values[start + at..start + at + length].iter_mut().zip(&self.places[i..i + length]) {
                    *v += weight * from[*place];
                }
                i += length;
            }
        }
    }
}
