//! Displacements that follow from fewer.

use nalgebra::{Cholesky, DMatrix, DVectorViewMut};

/// P of u = P y, by rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Prolongation {
    pub(crate) starts: Vec<usize>,
    pub(crate) terms: Vec<(usize, f64)>,
    /// First coarse unknown of each node column, and their number at the end.
    pub(crate) blocks: Vec<usize>,
}

impl Prolongation {
    /// Number of coarse unknowns.
    pub fn columns(&self) -> usize {
        self.blocks[self.blocks.len() - 1]
    }

    /// First coarse unknowns of the node columns, and the number of all at the end.
    pub fn blocks(&self) -> &[usize] {
        &self.blocks
    }

    /// Coarse unknowns in fine unknown `i`, with their factors.
    pub fn row(&self, i: usize) -> &[(usize, f64)] {
        &self.terms[self.starts[i]..self.starts[i + 1]]
    }

    /// U = P Y, column by column.
    pub fn expand(&self, y: &[f64]) -> Vec<f64> {
        let (n, m) = (self.starts.len() - 1, self.columns().max(1));
        let mut all = vec![0.0; n * (y.len() / m)];
        for (y, u) in y.chunks_exact(m).zip(all.chunks_exact_mut(n.max(1))) {
            for (u, row) in u.iter_mut().zip(self.starts.windows(2)) {
                for (j, p) in &self.terms[row[0]..row[1]] {
                    *u += p * y[*j];
                }
            }
        }
        all
    }

    /// Y = Pᵀ U, column by column.
    pub fn restrict(&self, u: &[f64]) -> Vec<f64> {
        let n = self.starts.len() - 1;
        let mut all = Vec::new();
        for u in u.chunks_exact(n.max(1)) {
            let mut y = vec![0.0; self.columns()];
            for (i, u) in u.iter().enumerate() {
                self.row(i).iter().for_each(|(j, p)| y[*j] += p * u);
            }
            all.append(&mut y);
        }
        all
    }

    /// The Y of which P Y is nearest to U, column by column; a node column's unknowns follow from its own coarse ones alone.
    pub fn fit(&self, u: &[f64]) -> Vec<f64> {
        let mut y = self.restrict(u);
        let mut grams: Vec<_> = self.blocks.windows(2).map(|b| DMatrix::zeros(b[1] - b[0], b[1] - b[0])).collect();
        for row in self.starts.windows(2).map(|row| &self.terms[row[0]..row[1]]).filter(|row| !row.is_empty()) {
            let block = self.blocks.partition_point(|first| *first <= row[0].0) - 1;
            for (i, p) in row {
                row.iter().for_each(|(j, q)| grams[block][(i - self.blocks[block], j - self.blocks[block])] += p * q);
            }
        }
        for (block, gram) in self.blocks.windows(2).zip(grams) {
            let Some(gram) = Cholesky::new(gram) else { continue };
            for y in y.chunks_exact_mut(self.columns().max(1)) {
                gram.solve_mut(&mut DVectorViewMut::from_slice(&mut y[block[0]..block[1]], block[1] - block[0]));
            }
        }
        y
    }
}
