//! Sparse Cholesky: multifrontal over the elimination tree, with faer's dense kernels in the fronts (Duff and Reid 1983).
//!
//! | step | where |
//! | --- | --- |
//! | elimination tree, fronts, their order | `analysis` |
//! | subtrees to threads | `schedule` |
//! | elimination | `numeric` |
//! | dense work of a front, in tiles that threads share | `dense` |
//! | substitution | `solve` |

mod analysis;
mod dense;
mod numeric;
mod schedule;
mod solve;
#[cfg(test)]
mod tests;

use super::Pattern;
use analysis::Tree;
use faer::sparse::SparseColMatRef;
use schedule::Schedule;
use std::fmt;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Why a matrix has no Cholesky factor.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum FactorError {
    /// An entry is NaN or infinite.
    NotFinite {
        /// Its column.
        column: usize,
    },
    /// The pivot of this column is not positive: the structure is not held there, or the matrix is singular.
    NotPositive {
        /// The column.
        column: usize,
    },
    /// The matrix has another pattern than was analysed.
    OtherPattern,
    /// More unknowns than can be numbered.
    TooLarge(usize),
    /// This machine could not hold the factor and what its making needs.
    NoRoom {
        /// As much or more, bytes.
        bytes: f64,
    },
}

impl fmt::Display for FactorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { column } => write!(f, "column {column} holds a number that is not finite"),
            Self::NotPositive { column } => write!(f, "the pivot of column {column} is not positive"),
            Self::OtherPattern => f.write_str("the pattern of the matrix is not the one that was analysed"),
            Self::TooLarge(unknowns) => write!(f, "{unknowns} unknowns are more than can be numbered"),
            Self::NoRoom { bytes } => {
                write!(f, "the factor needs {:.1} GB or more, which is not available", bytes * 1e-9)
            }
        }
    }
}
impl std::error::Error for FactorError {}

/// The symbolic factorisation of a pattern.
#[derive(Debug, Clone)]
pub struct Symbolic {
    pattern: Arc<Pattern>,
    tree: Arc<Tree>,
}

impl Symbolic {
    /// Analyses `pattern`; its own order is the elimination order.
    ///
    /// # Errors
    /// [`FactorError::TooLarge`], [`FactorError::NoRoom`].
    pub fn new(pattern: Arc<Pattern>) -> Result<Self, FactorError> {
        if u32::try_from(pattern.ndof()).is_err() {
            return Err(FactorError::TooLarge(pattern.ndof()));
        }
        // Asking for all of it at once is refused where parts of it would be granted and then not found.
        let fits = |entries| Vec::<f64>::new().try_reserve_exact(entries).is_ok();
        let tree = Tree::new(&pattern, fits).map_err(|entries| FactorError::NoRoom { bytes: 8.0 * entries as f64 })?;
        Ok(Self { pattern, tree: Arc::new(tree) })
    }

    /// Entries that the factor stores.
    pub fn entries(&self) -> usize {
        self.tree.storage
    }

    /// Additions and multiplications of a factorisation.
    pub fn flops(&self) -> f64 {
        self.tree.fronts.iter().map(analysis::Front::flops).sum()
    }

    /// Memory that factorising takes on one thread, the factor included, bytes.
    pub fn bytes(&self) -> f64 {
        8.0 * self.tree.total() as f64
    }

    /// The pattern analysed.
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }
}

/// A Cholesky factorisation whose storage serves any number of matrices of one pattern.
pub struct Cholesky {
    symbolic: Symbolic,
    schedule: Schedule,
    panels: Vec<f64>,
    /// Whether nothing has been written into the panels yet.
    clean: bool,
    local: Vec<f64>,
}

impl fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cholesky").field("entries", &self.panels.len()).finish_non_exhaustive()
    }
}

impl Cholesky {
    /// Reserves the storage. The factor is the same bit for bit for any number of `threads`.
    pub fn new(symbolic: Symbolic, threads: NonZeroUsize) -> Self {
        let schedule = Schedule::new(&symbolic.tree, threads.get());
        Self { panels: vec![0.0; symbolic.entries()], clean: true, schedule, symbolic, local: Vec::new() }
    }

    /// Factorises the symmetric matrix whose lower triangle is `matrix`, of the pattern analysed.
    ///
    /// # Errors
    /// Another pattern, a number that is not finite, or a pivot that is not positive.
    pub fn factorise(&mut self, matrix: SparseColMatRef<'_, usize, f64>) -> Result<(), FactorError> {
        let (found, analysed) = (matrix.symbolic(), self.symbolic.pattern.symbolic());
        let same = |found: &[usize], analysed: &[usize]| std::ptr::eq(found, analysed) || found == analysed;
        if !same(found.col_ptr(), analysed.col_ptr()) || !same(found.row_idx(), analysed.row_idx()) {
            return Err(FactorError::OtherPattern);
        }
        if let Some(bad) = matrix.val().iter().position(|v| !v.is_finite()) {
            return Err(FactorError::NotFinite { column: found.col_ptr().partition_point(|s| *s <= bad) - 1 });
        }
        let clean = std::mem::take(&mut self.clean);
        numeric::factorise(&self.symbolic.tree, &self.schedule, matrix, &mut self.panels, clean)
            .map_err(|bad| FactorError::NotPositive { column: bad.column })
    }

    /// The smallest pivot of `matrix`, the one factorised, with its unknowns in units that make its diagonal 1, and the column of
    /// it: 1 where a column depends on none before it, rounding where it follows from these. `None` of no columns.
    pub fn weakest(&self, matrix: SparseColMatRef<'_, usize, f64>) -> Option<(usize, f64)> {
        let tree = &*self.symbolic.tree;
        let pivots = tree.fronts.iter().flat_map(|front| {
            let diagonal = (0..front.pivots).map(|j| self.panels[front.panel + j * front.size() + j]);
            tree.unknowns(front).iter().map(|column| *column as usize).zip(diagonal)
        });
        let scaled = pivots.map(|(j, l)| (j, l * l / matrix.val()[matrix.col_range(j).start]));
        scaled.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// `X ← A⁻¹ X`, X of `n × columns`, column-major.
    pub fn solve(&mut self, x: &mut [f64], columns: usize) {
        let mut local = std::mem::take(&mut self.local);
        self.solve_in(x, columns, &mut local);
        self.local = local;
    }

    /// The same with room lent by the caller.
    pub(super) fn solve_in(&self, x: &mut [f64], columns: usize, local: &mut Vec<f64>) {
        let (tree, n) = (&*self.symbolic.tree, self.symbolic.pattern.ndof());
        if n == 0 {
            return;
        }
        for x in x[..n * columns].chunks_mut(n * solve::BLOCK) {
            if x.len() < n * solve::FEW {
                x.chunks_exact_mut(n).for_each(|x| solve::single(tree, &self.panels, x, local));
            } else {
                solve::block(tree, &self.panels, x, n, local);
            }
        }
    }
}
