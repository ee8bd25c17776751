//! A symmetric sparse matrix on a pattern that others share.

use super::{Pattern, PatternError};
use crate::words::functional::Functional;
use faer::sparse::ops::binary_op;
use faer::sparse::{FaerError, SparseColMat, SparseColMatMut, SparseColMatRef};
use pulp::{Arch, Simd, WithSimd};
use std::sync::Arc;

/// A symmetric matrix such as K or M: faer's sparse matrix of its lower triangle, on a pattern that it shares with others.
///
/// faer's sparse matrices own their pattern, which for K, M and their sums would be stored and copied several times;
/// [`Symmetric::lower`] is faer's view of pattern and values without a copy, for all that faer offers.
#[derive(Debug, Clone, PartialEq)]
pub struct Symmetric {
    pattern: Arc<Pattern>,
    values: Vec<f64>,
}

/// `Y ← Y + scale · A X` of so many columns.
struct Product<'a, const COLUMNS: usize> {
    matrix: &'a Symmetric,
    scale: f64,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl<const COLUMNS: usize> WithSimd for Product<'_, COLUMNS> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { matrix, scale, x, y } = self;
        match COLUMNS {
            1 => matrix.add_product_of_one(scale, x, y),
            _ => matrix.add_product_of::<COLUMNS>(scale, x, y),
        }
    }
}

impl Symmetric {
    /// The zero matrix on `pattern`.
    pub fn zero(pattern: Arc<Pattern>) -> Self {
        Self { values: vec![0.0; pattern.entries()], pattern }
    }

    /// faer's view of the lower triangle.
    pub fn lower(&self) -> SparseColMatRef<'_, usize, f64> {
        SparseColMatRef::new(self.pattern.symbolic(), &self.values)
    }

    /// The same with values that can be changed.
    pub fn lower_mut(&mut self) -> SparseColMatMut<'_, usize, f64> {
        SparseColMatMut::new(self.pattern.symbolic(), &mut self.values)
    }

    /// The pattern.
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// Order of the matrix.
    pub fn ndof(&self) -> usize {
        self.pattern.ndof()
    }

    /// Both triangles, for what takes a matrix that need not be symmetric.
    ///
    /// # Errors
    /// More memory than there is.
    pub fn full(&self) -> Result<SparseColMat<usize, f64>, FaerError> {
        let upper = self.lower().transpose().to_col_major()?;
        binary_op(self.lower(), upper.as_ref(), |lower, upper| lower.or(upper).copied().unwrap_or(0.0))
    }

    /// `A ← A + scale · w wᵀ`: of a stiffness, a spring that holds the displacement w.
    ///
    /// # Errors
    /// Unknowns of which the pattern couples no two, as those of cells that do not touch; some entries may have been added.
    pub fn add_spring(&mut self, scale: f64, w: &Functional) -> Result<(), PatternError> {
        let Self { pattern, values } = self;
        for (j, b) in &w.0 {
            let start = pattern.starts()[*j];
            let column = &pattern.rows()[start..pattern.starts()[*j + 1]];
            for (i, a) in w.0.iter().filter(|(i, _)| i >= j) {
                let missing = |_| PatternError::Missing { row: *i, column: *j };
                values[start + column.binary_search(i).map_err(missing)?] += scale * a * b;
            }
        }
        Ok(())
    }

    /// `A ← A + scale · B`, both on one pattern.
    pub fn add(&mut self, scale: f64, other: &Self) {
        self.values.iter_mut().zip(&other.values).for_each(|(a, b)| *a += scale * b);
    }

    /// Entry (i, i).
    pub(super) fn diagonal(&self, i: usize) -> f64 {
        self.values[self.pattern.starts()[i]]
    }

    /// Adds to entries (i, i).
    pub(super) fn add_to_diagonal(&mut self, more: &[(usize, f64)]) {
        for (i, value) in more {
            self.values[self.pattern.starts()[*i]] += value;
        }
    }

    /// `Y ← Y + scale · A X`, both `n × columns`, column-major; columns go together in eights and fours, which reads the matrix once
    /// for all of them.
    ///
    /// faer's product wants both triangles, twice the memory, and takes longer (`cargo bench --bench assembly`).
    pub fn add_product(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        let n = self.ndof();
        if n == 0 {
            return;
        }
        let (x, single) = x.split_at(x.len() - x.len() % (4 * n));
        let (fours, alone) = y.split_at_mut(x.len());
        for (x, y) in x.chunks(8 * n).zip(fours.chunks_mut(8 * n)) {
            match x.len() / n {
                8 => Arch::new().dispatch(Product::<8> { matrix: self, scale, x, y }),
                _ => Arch::new().dispatch(Product::<4> { matrix: self, scale, x, y }),
            }
        }
        for (x, y) in single.chunks_exact(n).zip(alone.chunks_exact_mut(n)) {
            Arch::new().dispatch(Product::<1> { matrix: self, scale, x, y });
        }
    }

    /// The columns of a group share their rows: a dense trapezoid between two gathered vectors.
    #[inline(always)]
    fn add_product_of_one(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        let (starts, rows) = (self.pattern.starts(), self.pattern.rows());
        let (mut from, mut to) = (Vec::new(), Vec::new());
        for group in self.pattern.groups().windows(2) {
            let rows = &rows[starts[group[0]]..starts[group[0] + 1]];
            from.clear();
            from.extend(rows.iter().map(|i| scale * x[*i]));
            to.clear();
            to.resize(rows.len(), 0.0);
            for (local, j) in (group[0]..group[1]).enumerate() {
                let values = &self.values[starts[j]..starts[j + 1]];
                to[local] += values[0] * from[local];
                let (xj, below) = (from[local], &from[local + 1..]);
                to[local] += add_and_dot(&values[1..], xj, below, &mut to[local + 1..]);
            }
            for (i, t) in rows.iter().zip(&to) {
                y[*i] += t;
            }
        }
    }

    /// The same with some columns side by side.
    #[inline(always)]
    fn add_product_of<const COLUMNS: usize>(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        let n = self.ndof();
        let add = |y: &mut [f64; COLUMNS], a: f64, x: &[f64; COLUMNS]| {
            y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
        };
        let (starts, rows) = (self.pattern.starts(), self.pattern.rows());
        let (mut from, mut to) = (Vec::new(), Vec::new());
        for group in self.pattern.groups().windows(2) {
            let rows = &rows[starts[group[0]]..starts[group[0] + 1]];
            from.clear();
            from.extend(rows.iter().map(|i| -> [f64; COLUMNS] { std::array::from_fn(|c| scale * x[c * n + i]) }));
            to.clear();
            to.resize(rows.len(), [0.0; COLUMNS]);
            for (local, j) in (group[0]..group[1]).enumerate() {
                let values = &self.values[starts[j]..starts[j + 1]];
                let (xj, mut sum) = (from[local], [0.0; COLUMNS]);
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

    /// The first `n` rows and columns.
    pub(super) fn leading(&self, n: usize) -> Self {
        self.kept(n, |row, _, _| row < n)
    }

    /// The matrix without entries that are zero; the diagonal stays.
    #[must_use]
    pub fn compact(&self) -> Self {
        self.kept(self.ndof(), |row, column, value| value != 0.0 || row == column)
    }

    /// The entries of the first `n` columns for which `keep(row, column, value)`.
    fn kept(&self, n: usize, keep: impl Fn(usize, usize, f64) -> bool) -> Self {
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        let lower = self.lower();
        for j in 0..n {
            let entries = lower.col_range(j);
            for (row, value) in lower.row_idx()[entries.clone()].iter().zip(&self.values[entries]) {
                if keep(*row, j, *value) {
                    rows.push(*row);
                    values.push(*value);
                }
            }
            starts.push(rows.len());
        }
        Self { pattern: Arc::new(Pattern::new(starts, rows)), values }
    }
}

/// `y ← y + s a`; returns `a · x`.
#[inline(always)]
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::assembly::PatternError;
    use faer::sparse::linalg::matmul::sparse_dense_matmul;
    use faer::sparse::{Pair, SymbolicSparseColMat};
    use faer::{Accum, Mat, MatRef, Par};

    /// A symmetric matrix of 8 unknowns in nodes of 1, 2 or 3, as faer orders its triplets.
    fn sample() -> (Symmetric, SparseColMat<usize, f64>) {
        let nodes = [0, 1, 1, 2, 3, 3, 3, 4];
        let coupled = |i: usize, j: usize| nodes[i] == nodes[j] || (nodes[i] + nodes[j]) % 3 == 1;
        let places = (0..8).flat_map(|j| (j..8).map(move |i| Pair::new(i, j))).filter(|p| coupled(p.row, p.col));
        let places: Vec<_> = places.collect();
        let (lower, order) = SymbolicSparseColMat::try_new_from_indices(8, 8, &places).unwrap();
        let values: Vec<f64> = places.iter().map(|p| 1.0 / (1 + p.row * p.row + 3 * p.col) as f64).collect();
        let mut a = Symmetric::zero(Arc::new(Pattern::try_from(lower.clone()).unwrap()));
        let faer = SparseColMat::new_from_argsort(lower, &order, &values).unwrap();
        a.lower_mut().val_mut().copy_from_slice(faer.val());
        (a, faer)
    }

    #[test]
    fn faer_sees_the_same_matrix() {
        let (a, lower) = sample();
        assert_eq!(a.lower().to_dense(), lower.to_dense());
        let full = a.full().unwrap().to_dense();
        let dense = lower.to_dense();
        assert_eq!(full, Mat::from_fn(8, 8, |i, j| dense[(i.max(j), i.min(j))]));
    }

    #[test]
    fn products_are_those_of_faer() {
        let (a, full) = (sample().0, sample().0.full().unwrap());
        for columns in [1, 3, 4, 9] {
            let x: Vec<f64> = (0..8 * columns).map(|k| ((k * 5) % 7) as f64 - 2.5).collect();
            let mut y: Vec<f64> = (0..8 * columns).map(|k| (k % 3) as f64).collect();
            let mut want = MatRef::from_column_major_slice(&y, 8, columns).to_owned();
            let x_faer = MatRef::from_column_major_slice(&x, 8, columns);
            sparse_dense_matmul(want.as_mut(), Accum::Add, full.as_ref(), x_faer, -2.0, Par::Seq);
            a.add_product(-2.0, &x, &mut y);
            let found = MatRef::from_column_major_slice(&y, 8, columns);
            assert!((found - want).norm_max() < 1e-14);
        }
    }

    #[test]
    fn parts_are_those_of_the_dense_matrix() {
        let (mut a, lower) = sample();
        let dense = lower.to_dense();
        assert_eq!(a.leading(5).lower().to_dense(), dense.submatrix(0, 0, 5, 5).to_owned());
        a.lower_mut().val_mut()[0] = 0.0;
        a.lower_mut().val_mut()[2] = 0.0;
        let compact = a.compact();
        assert_eq!(compact.lower().to_dense(), a.lower().to_dense());
        assert_eq!(compact.pattern().entries() + 1, a.pattern().entries(), "the diagonal stays");
    }

    #[test]
    fn what_is_no_lower_triangle_is_refused() {
        let pattern = |n, starts: Vec<usize>, rows| {
            let columns = starts.len() - 1;
            Pattern::try_from(SymbolicSparseColMat::new_checked(n, columns, starts, None, rows))
        };
        assert_eq!(pattern(3, vec![0, 1], vec![0]), Err(PatternError::NotSquare { rows: 3, columns: 1 }));
        // The diagonal is missing, an entry lies above it, a column is empty.
        assert_eq!(pattern(3, vec![0, 2, 3, 4], vec![0, 2, 2, 2]), Err(PatternError::Column(1)));
        assert_eq!(pattern(2, vec![0, 1, 3], vec![0, 0, 1]), Err(PatternError::Column(1)));
        assert_eq!(pattern(2, vec![0, 1, 1], vec![0]), Err(PatternError::Column(1)));
        let unsorted = SymbolicSparseColMat::new_unsorted_checked(3, 3, vec![0, 3, 4, 5], None, vec![0, 2, 1, 1, 2]);
        assert_eq!(Pattern::try_from(unsorted), Err(PatternError::Column(0)));
        let roomy = SymbolicSparseColMat::new_checked(1, 1, vec![0, 2], Some(vec![1]), vec![0, 0]);
        assert_eq!(Pattern::try_from(roomy), Err(PatternError::NotCompressed));
    }
}
