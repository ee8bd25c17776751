//! The sparsity pattern of a plate, built once: faer's symbolic matrix, and which of its columns are alike.

use super::cell_map::CellMap;
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;
use faer::sparse::{SymbolicSparseColMat, SymbolicSparseColMatRef};
use std::fmt;

/// Lower triangle of a symmetric matrix: rows ascending, the diagonal first in every column.
///
/// [`Pattern::symbolic`] is faer's view of it; a symbolic matrix of faer becomes a pattern by `try_from`, without a copy.
#[derive(Debug, Clone)]
pub struct Pattern {
    lower: SymbolicSparseColMat<usize>,
    /// First columns of the runs of columns that no row or column of the matrix tells apart, and the number of columns.
    groups: Vec<usize>,
}

/// Why a symbolic matrix is not the lower triangle of a symmetric one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum PatternError {
    /// It has another number of rows than of columns.
    NotSquare {
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
    },
    /// There is room between its columns (faer's uncompressed form).
    NotCompressed,
    /// A column does not hold its diagonal and then rows below, ascending.
    Column(usize),
    /// It has no entry in this place.
    Missing {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
    },
}

impl fmt::Display for PatternError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotSquare { rows, columns } => write!(f, "a matrix of {rows} x {columns} is not square"),
            Self::NotCompressed => f.write_str("there is room between the columns of the matrix"),
            Self::Missing { row, column } => write!(f, "the pattern couples no unknowns {row} and {column}"),
            Self::Column(j) => write!(f, "column {j} does not hold its diagonal and then rows below it, ascending"),
        }
    }
}
impl std::error::Error for PatternError {}

impl TryFrom<SymbolicSparseColMat<usize>> for Pattern {
    type Error = PatternError;

    /// `lower` as a pattern: square, compressed, every column its diagonal first, then rows below it, ascending.
    fn try_from(lower: SymbolicSparseColMat<usize>) -> Result<Self, PatternError> {
        let (rows, columns) = lower.shape();
        if rows != columns {
            return Err(PatternError::NotSquare { rows, columns });
        }
        if lower.col_nnz().is_some() {
            return Err(PatternError::NotCompressed);
        }
        let wrong = |j: &usize| {
            let rows = &lower.row_idx()[lower.col_range(*j)];
            rows.first() != Some(j) || rows.windows(2).any(|pair| pair[0] >= pair[1])
        };
        (0..columns).find(wrong).map_or_else(|| Ok(Self::grouped(lower)), |j| Err(PatternError::Column(j)))
    }
}

impl PartialEq for Pattern {
    fn eq(&self, other: &Self) -> bool {
        self.starts() == other.starts() && self.rows() == other.rows()
    }
}

impl Pattern {
    /// The pattern with these starts of columns, the number of entries at their end, and rows.
    pub(super) fn new(starts: Vec<usize>, rows: Vec<usize>) -> Self {
        let n = starts.len() - 1;
        Self::grouped(SymbolicSparseColMat::new_checked(n, n, starts, None, rows))
    }

    fn grouped(lower: SymbolicSparseColMat<usize>) -> Self {
        let n = lower.ncols();
        let column = |j: usize| &lower.row_idx()[lower.col_range(j)];
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
        Self { lower, groups }
    }

    /// faer's view of the pattern.
    pub fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        self.lower.as_ref()
    }

    /// Number of columns.
    pub fn ndof(&self) -> usize {
        self.lower.ncols()
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.lower.row_idx().len()
    }

    /// Start of each column, and the number of entries at the end.
    pub(super) fn starts(&self) -> &[usize] {
        self.lower.col_ptr()
    }

    /// Row of each entry.
    pub(super) fn rows(&self) -> &[usize] {
        self.lower.row_idx()
    }

    /// First columns of the runs of columns with equal neighbours, and the number of columns at the end.
    pub(super) fn groups(&self) -> &[usize] {
        &self.groups
    }
}

/// The pattern of K and M of a plate under constraints.
pub fn pattern(plate: &Plate, constraints: &Constraints) -> Pattern {
    joined_pattern(plate, constraints, std::iter::empty())
}

/// The same where the independent unknowns of each set of `more` are coupled as well.
pub(super) fn joined_pattern<'a>(
    plate: &Plate,
    constraints: &Constraints,
    more: impl Iterator<Item = &'a [usize]>,
) -> Pattern {
    let (mut map, mut cliques) = (CellMap::default(), Cliques::default());
    for (cell, _) in plate.kept_cells() {
        map.set(plate, constraints, cell);
        cliques.push(&map.reduced);
    }
    more.for_each(|set| cliques.push(set));
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

    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.ends.len() as u32).map(|clique| self.of(clique))
    }

    pub(super) fn of(&self, clique: u32) -> &[u32] {
        let start = if clique == 0 { 0 } else { self.ends[clique as usize - 1] };
        &self.members[start as usize..self.ends[clique as usize] as usize]
    }

    /// The cliques of each of `n` unknowns, ascending: where they start, the number of all at the end, and the cliques.
    pub(super) fn by_member(&self, n: usize) -> (Vec<u32>, Vec<u32>) {
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
        (starts, cliques)
    }

    /// The pattern of a matrix of `n` unknowns, each of which is in a clique.
    pub(super) fn pattern(&self, n: usize) -> Pattern {
        let (starts, cliques) = self.by_member(n);
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
