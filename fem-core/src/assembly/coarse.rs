//! PᵀAP of sparse matrices.

use super::{Pattern, Symmetric};
use crate::words::prolongation::Prolongation;
use std::sync::Arc;

/// The block, a node column, of each coarse unknown.
fn block_of(p: &Prolongation) -> Vec<usize> {
    let mut block_of = vec![0; p.columns()];
    for (block, range) in p.blocks().windows(2).enumerate() {
        block_of[range[0]..range[1]].fill(block);
    }
    block_of
}

/// The pattern of PᵀAP for matrices A of the pattern `fine`: all unknowns of a node column have the same rows.
pub(super) fn pattern(fine: &Pattern, p: &Prolongation) -> Pattern {
    let (blocks, block_of) = (p.blocks(), block_of(p));
    let count = blocks.len() - 1;
    let block = |i: usize| p.row(i).first().map(|term| block_of[term.0]);
    // Blocks that meet, the later below the earlier; a block is met as often as fine unknowns go from one to another.
    let mut below: Vec<Vec<usize>> = (0..count).map(|b| vec![b]).collect();
    let mut seen = vec![usize::MAX; count];
    for j in 0..fine.ndof() {
        let Some(at) = block(j) else { continue };
        for i in &fine.rows()[fine.starts()[j]..fine.starts()[j + 1]] {
            if let Some(other) = block(*i).filter(|other| *other != at && seen[*other] != at) {
                seen[other] = at;
                below[at.min(other)].push(at.max(other));
            }
        }
    }
    let (mut starts, mut all) = (vec![0], Vec::new());
    for (b, rows) in below.iter_mut().enumerate() {
        rows.sort_unstable();
        rows.dedup();
        for j in blocks[b]..blocks[b + 1] {
            all.extend(j..blocks[b + 1]);
            rows[1..].iter().for_each(|r| all.extend(blocks[*r]..blocks[*r + 1]));
            starts.push(all.len());
        }
    }
    Pattern::new(starts, all)
}

/// PᵀAP on its pattern `coarse`.
pub(super) fn product(fine: &Symmetric, p: &Prolongation, coarse: &Arc<Pattern>) -> Symmetric {
    let mut sum = Symmetric::zero(coarse.clone());
    let out = sum.lower_mut().val_mut();
    let (starts, coarse_rows) = (coarse.starts(), coarse.rows());
    let fine = fine.lower();
    let (blocks, block_of) = (p.blocks(), block_of(p));
    let block = |i: usize| p.row(i).first().map(|term| block_of[term.0]);
    for j in 0..fine.ncols() {
        let Some(own) = block(j) else { continue };
        let (mut beside, mut first, mut offset) = (None, [0; 2], 0);
        let range = fine.col_range(j);
        for (i, a) in fine.row_idx()[range.clone()].iter().zip(&fine.val()[range]).filter(|(_, a)| **a != 0.0) {
            let Some(other) = block(*i) else { continue };
            if beside.replace(other) != Some(other) {
                // Where the rows of the later block begin in the first column of the earlier one, in its k-th column k places before.
                first = [own.max(other), own.min(other)].map(|block| blocks[block]);
                let rows = &coarse_rows[starts[first[1]]..starts[first[1] + 1]];
                offset = rows.partition_point(|row| *row < first[0]);
            }
            for (row, pi) in p.row(*i) {
                for (column, pj) in p.row(j) {
                    let value = pi * a * pj;
                    // The entry above the diagonal adds as much once more.
                    let value = if *i != j && row == column { 2.0 * value } else { value };
                    if *i == j && row < column {
                        continue;
                    }
                    let (row, column) = (*row.max(column), *row.min(column));
                    out[starts[column] + offset + row - first[0] - (column - first[1])] += value;
                }
            }
        }
    }
    sum
}
