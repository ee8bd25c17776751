//! Sparse Cholesky by faer, in the order the pattern comes in.

use super::Pattern;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use std::fmt;
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
    /// The factor would not fit.
    TooLarge(String),
}

impl fmt::Display for FactorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { column } => write!(f, "column {column} holds a number that is not finite"),
            Self::NotPositive { column } => write!(f, "the pivot of column {column} is not positive"),
            Self::TooLarge(why) => write!(f, "the factor is too large: {why}"),
        }
    }
}
impl std::error::Error for FactorError {}

/// The symbolic factorisation of a pattern.
#[derive(Debug, Clone)]
pub struct Symbolic {
    pattern: Arc<Pattern>,
    symbolic: Arc<SymbolicCholesky<usize>>,
}

impl Symbolic {
    /// Analyses `pattern`; its own order is the elimination order.
    ///
    /// # Errors
    /// [`FactorError::TooLarge`].
    pub fn new(pattern: Arc<Pattern>) -> Result<Self, FactorError> {
        // faer 0.24 fails an assertion with `SymmetricOrdering::Identity` on a lower triangle; the same order, spelt out,
        // goes through its permuting path.
        let identity: Vec<usize> = (0..pattern.ndof()).collect();
        let order = SymmetricOrdering::Custom(PermRef::new_checked(&identity, &identity, pattern.ndof()));
        // Twelve unknowns a node make dense blocks: faer's estimate may still fall for the entry-by-entry method.
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(view(&pattern), Side::Lower, order, params)
            .map_err(|e| FactorError::TooLarge(format!("{e:?}")))?;
        Ok(Self { symbolic: Arc::new(symbolic), pattern })
    }

    /// Entries that the factor stores.
    pub fn entries(&self) -> usize {
        self.symbolic.len_val()
    }

    /// The pattern analysed.
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }
}

fn view(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, usize> {
    let n = pattern.ndof();
    SymbolicSparseColMatRef::new_checked(n, n, &pattern.starts, None, &pattern.rows)
}

/// A Cholesky factorisation whose storage serves any number of matrices of one pattern.
pub struct Cholesky {
    symbolic: Symbolic,
    values: Vec<f64>,
    memory: MemBuffer,
    solve_columns: usize,
    solve_memory: MemBuffer,
}

impl fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cholesky").field("entries", &self.values.len()).finish_non_exhaustive()
    }
}

impl Cholesky {
    /// Reserves the storage.
    pub fn new(symbolic: Symbolic) -> Self {
        let memory =
            MemBuffer::new(symbolic.symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()));
        let values = vec![0.0; symbolic.entries()];
        let solve_memory = MemBuffer::new(symbolic.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Self { symbolic, values, memory, solve_columns: 1, solve_memory }
    }

    /// Factorises the matrix of the analysed pattern with these `values`.
    ///
    /// # Errors
    /// A number that is not finite, or a pivot that is not positive.
    pub fn factorise(&mut self, values: &[f64]) -> Result<(), FactorError> {
        let pattern = &self.symbolic.pattern;
        if let Some(bad) = values.iter().position(|v| !v.is_finite()) {
            return Err(FactorError::NotFinite { column: pattern.starts.partition_point(|s| *s <= bad) - 1 });
        }
        let matrix = SparseColMatRef::new(view(pattern), values);
        self.symbolic
            .symbolic
            .factorize_numeric_llt::<f64>(
                &mut self.values,
                matrix,
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut self.memory),
                Default::default(),
            )
            .map(|_| ())
            .map_err(|e| match e {
                LltError::NonPositivePivot { index } => {
                    let column = match self.symbolic.symbolic.perm() {
                        Some(p) => p.arrays().0[index],
                        None => index,
                    };
                    FactorError::NotPositive { column }
                }
            })
    }

    /// `X ← A⁻¹ X`, X of `n × columns`, column-major.
    pub fn solve(&mut self, x: &mut [f64], columns: usize) {
        let symbolic = &self.symbolic.symbolic;
        if columns > self.solve_columns {
            self.solve_memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq));
            self.solve_columns = columns;
        }
        let x = MatMut::from_column_major_slice_mut(x, self.symbolic.pattern.ndof(), columns);
        LltRef::<usize, f64>::new(symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            x,
            Par::Seq,
            MemStack::new(&mut self.solve_memory),
        );
    }
}
