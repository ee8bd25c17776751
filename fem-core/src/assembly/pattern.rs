//! The sparsity pattern of a plate, built once, and its values, filled as often as needed.

use crate::contracts::element::ElementError;
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;
use std::fmt;

/// Lower triangle of a symmetric matrix, compressed columns, rows ascending, the diagonal in every column.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// Start of each column, and the number of entries at the end.
    pub starts: Vec<usize>,
    /// Row of each entry.
    pub rows: Vec<usize>,
    /// First columns of the runs of columns that no row or column of the matrix tells apart, and the number of columns.
    groups: Vec<usize>,
}

impl Pattern {
    /// The pattern with these starts of columns and rows.
    pub fn new(starts: Vec<usize>, rows: Vec<usize>) -> Self {
        let n = starts.len() - 1;
        let column = |j: usize| &rows[starts[j]..starts[j + 1]];
        let mut first = vec![false; n + 1];
        first[0] = true;
        first[n] = true;
        for j in 0..n {
            let rows = column(j);
            if j > 0 && column(j - 1)[1..] != *rows {
                first[j] = true;
            }
            // A row above in only one of two columns shows as an end of a run of rows.
            for pair in rows.windows(2) {
                if pair[1] != pair[0] + 1 {
                    first[pair[0] + 1] = true;
                    first[pair[1]] = true;
                }
            }
            first[rows[rows.len() - 1] + 1] = true;
        }
        let groups = (0..=n).filter(|j| first[*j]).collect();
        Self { starts, rows, groups }
    }

    /// Number of columns.
    pub fn ndof(&self) -> usize {
        self.starts.len() - 1
    }

    /// First columns of the runs of columns with equal neighbours, and the number of columns at the end.
    pub(crate) fn groups(&self) -> &[usize] {
        &self.groups
    }

    /// `Y ← Y + scale · A X` for the symmetric matrix A with this pattern and `values`, column by column of X and Y; columns
    /// go together in fours, which reads the matrix once.
    pub fn add_product(&self, values: &[f64], scale: f64, x: &[f64], y: &mut [f64]) {
        let n = self.ndof();
        if n == 0 {
            return;
        }
        let (fours, rest) = (x.chunks_exact(4 * n), x.chunks_exact(4 * n).remainder());
        let done = x.len() - rest.len();
        for (x, y) in fours.zip(y.chunks_exact_mut(4 * n)) {
            self.add_product_of_four(values, scale, x, y);
        }
        for (x, y) in rest.chunks_exact(n).zip(y[done..].chunks_exact_mut(n)) {
            self.add_product_of_one(values, scale, x, y);
        }
    }

    /// The columns of a group share their rows: a dense trapezoid between two gathered vectors.
    fn add_product_of_one(&self, values: &[f64], scale: f64, x: &[f64], y: &mut [f64]) {
        let (mut from, mut to) = (Vec::new(), Vec::new());
        for group in self.groups.windows(2) {
            let rows = &self.rows[self.starts[group[0]]..self.starts[group[0] + 1]];
            from.clear();
            from.extend(rows.iter().map(|i| scale * x[*i]));
            to.clear();
            to.resize(rows.len(), 0.0);
            for (local, j) in (group[0]..group[1]).enumerate() {
                let values = &values[self.starts[j]..self.starts[j + 1]];
                to[local] += values[0] * from[local];
                let (xj, below) = (from[local], &from[local + 1..]);
                to[local] += add_and_dot(&values[1..], xj, below, &mut to[local + 1..]);
            }
            for (i, t) in rows.iter().zip(&to) {
                y[*i] += t;
            }
        }
    }

    /// The same with four columns side by side.
    fn add_product_of_four(&self, values: &[f64], scale: f64, x: &[f64], y: &mut [f64]) {
        let n = self.ndof();
        let add = |y: &mut [f64; 4], a: f64, x: &[f64; 4]| y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
        let (mut from, mut to) = (Vec::new(), Vec::new());
        for group in self.groups.windows(2) {
            let rows = &self.rows[self.starts[group[0]]..self.starts[group[0] + 1]];
            from.clear();
            from.extend(rows.iter().map(|i| -> [f64; 4] { std::array::from_fn(|c| scale * x[c * n + i]) }));
            to.clear();
            to.resize(rows.len(), [0.0; 4]);
            for (local, j) in (group[0]..group[1]).enumerate() {
                let values = &values[self.starts[j]..self.starts[j + 1]];
                let (xj, mut sum) = (from[local], [0.0; 4]);
                add(&mut sum, values[0], &xj);
                for ((a, x), to) in values[1..].iter().zip(&from[local + 1..]).zip(&mut to[local + 1..]) {
                    add(to, *a, &xj);
                    add(&mut sum, *a, x);
                }
                add(&mut to[local], 1.0, &sum);
            }
            for (i, t) in rows.iter().zip(&to) {
                t.iter().enumerate().for_each(|(c, t)| y[c * n + i] += t);
            }
        }
    }

    /// The first `n` rows and columns, with their part of `values`.
    pub(super) fn leading(&self, values: &[f64], n: usize) -> (Self, Vec<f64>) {
        let (mut starts, mut rows, mut kept) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            let start = self.starts[j];
            let column = &self.rows[start..self.starts[j + 1]];
            let count = column.partition_point(|row| *row < n);
            rows.extend_from_slice(&column[..count]);
            kept.extend_from_slice(&values[start..start + count]);
            starts.push(rows.len());
        }
        (Self::new(starts, rows), kept)
    }

    /// The entries of `values` that are not zero, with their pattern; the diagonal stays.
    pub(super) fn compact(&self, values: &[f64]) -> (Self, Vec<f64>) {
        let (mut starts, mut rows, mut kept) = (vec![0], Vec::new(), Vec::new());
        for j in 0..self.ndof() {
            let range = self.starts[j]..self.starts[j + 1];
            for (row, value) in self.rows[range.clone()].iter().zip(&values[range]) {
                if *value != 0.0 || *row == j {
                    rows.push(*row);
                    kept.push(*value);
                }
            }
            starts.push(kept.len());
        }
        (Self::new(starts, rows), kept)
    }
}

/// `y ← y + s a`; returns `a · x`.
fn add_and_dot(a: &[f64], s: f64, x: &[f64], y: &mut [f64]) -> f64 {
    const LANES: usize = 4;
    let mut sums = [0.0; LANES];
    let (mut a, mut x, mut y) = (a.chunks_exact(LANES), x.chunks_exact(LANES), y.chunks_exact_mut(LANES));
    for ((a, x), y) in (&mut a).zip(&mut x).zip(&mut y) {
        for k in 0..LANES {
            y[k] += s * a[k];
            sums[k] += a[k] * x[k];
        }
    }
    let mut sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    for ((a, x), y) in a.remainder().iter().zip(x.remainder()).zip(y.into_remainder()) {
        *y += s * a;
        sum += a * x;
    }
    sum
}

/// An element matrix that could not be made.
#[derive(Debug, Clone, PartialEq)]
pub struct AssemblyError {
    /// Number of the quad in the file.
    pub quad_tag: u64,
    /// Layer of cells from the bottom.
    pub layer: usize,
    /// What the element said.
    pub error: ElementError,
}

impl fmt::Display for AssemblyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cell {} of the mesh, layer {}: {}", self.quad_tag, self.layer + 1, self.error)
    }
}
impl std::error::Error for AssemblyError {}

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

    /// Adds the lower triangle of `weight` times a cell matrix into `values`.
    pub(crate) fn scatter(&mut self, pattern: &Pattern, a: &[f64], weight: f64, values: &mut [f64]) {
        if self.plain {
            self.add_plain(pattern, a, weight, values);
            return;
        }
        let mut work = std::mem::take(&mut self.work);
        self.transform(a, &mut work);
        self.places.clear();
        self.places.extend(0..self.reduced.len());
        self.add_plain(pattern, &work, weight, values);
        self.work = work;
    }

    /// Adds the lower triangle of a matrix whose row and column `places[i]` belong to the independent unknown `reduced[i]`.
    ///
    /// Runs of consecutive unknowns are consecutive in every column that holds them: one search per run.
    fn add_plain(&self, pattern: &Pattern, a: &[f64], weight: f64, values: &mut [f64]) {
        let (n, m) = (self.reduced.len(), a.len().isqrt());
        for (j, column) in self.reduced.iter().enumerate() {
            let start = pattern.starts[*column];
            let rows = &pattern.rows[start..pattern.starts[column + 1]];
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

/// The pattern of K and M of a plate under constraints.
pub fn pattern(plate: &Plate, constraints: &Constraints) -> Pattern {
    let (mut map, mut cliques) = (CellMap::default(), Cliques::default());
    for (cell, _) in plate.kept_cells() {
        map.set(plate, constraints, cell);
        cliques.push(&map.reduced);
    }
    cliques.pattern(constraints.ndof())
}

/// Sets of unknowns that are all coupled to each other, such as those of a cell.
#[derive(Debug, Default)]
pub(super) struct Cliques {
    members: Vec<u32>,
    /// End of each clique in `members`.
    ends: Vec<u32>,
}

impl Cliques {
    pub(super) fn push(&mut self, unknowns: &[usize]) {
        self.members.extend(unknowns.iter().map(|i| *i as u32));
        self.ends.push(self.members.len() as u32);
    }

    fn of(&self, clique: u32) -> &[u32] {
        let start = if clique == 0 { 0 } else { self.ends[clique as usize - 1] };
        &self.members[start as usize..self.ends[clique as usize] as usize]
    }

    /// The pattern of a matrix of `n` unknowns, each of which is in a clique.
    pub(super) fn pattern(&self, n: usize) -> Pattern {
        // Cliques of every column, then rows of every column through its cliques.
        let mut starts = vec![0_u32; n + 1];
        for i in &self.members {
            starts[*i as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut fill = starts.clone();
        let mut cliques = vec![0_u32; starts[n] as usize];
        for clique in 0..self.ends.len() as u32 {
            for i in self.of(clique) {
                cliques[fill[*i as usize] as usize] = clique;
                fill[*i as usize] += 1;
            }
        }
        let (mut column_starts, mut rows) = (Vec::with_capacity(n + 1), Vec::new());
        column_starts.push(0);
        // Unknowns that the same cliques share, such as those of a node, have their rows in common.
        let (mut seen, mut union, mut of) = (vec![u32::MAX; n], Vec::new(), 0..0);
        for j in 0..n {
            let here = starts[j] as usize..starts[j + 1] as usize;
            if j == 0 || cliques[here.clone()] != cliques[of] {
                union.clear();
                for clique in &cliques[here.clone()] {
                    for i in self.of(*clique) {
                        if *i as usize >= j && seen[*i as usize] != j as u32 {
                            seen[*i as usize] = j as u32;
                            union.push(*i as usize);
                        }
                    }
                }
                union.sort_unstable();
            }
            of = here;
            rows.extend_from_slice(&union[union.partition_point(|i| *i < j)..]);
            column_starts.push(rows.len());
        }
        Pattern::new(column_starts, rows)
    }
}
