//! PᵀAP of sparse matrices.

use super::{Pattern, Symmetric};
use crate::words::prolongation::Prolongation;
use std::sync::Arc;

/// The pattern of PᵀAP for matrices A of the pattern `fine`: all unknowns of a node column have the same rows.
pub(super) fn pattern(fine: &Pattern, p: &Prolongation) -> Pattern {
    let blocks = p.blocks();
    let count = blocks.len() - 1;
    let mut block_of = vec![0; p.columns()];
    for (block, range) in blocks.windows(2).enumerate() {
        block_of[range[0]..range[1]].fill(block);
    }
    let block = |i: usize| p.row(i).first().map(|term| block_of[term.0]);
    // Blocks that meet, the later below the earlier.
    let mut below: Vec<Vec<usize>> = (0..count).map(|b| vec![b]).collect();
    let mut seen = vec![usize::MAX; count];
    for j in 0..fine.ndof() {
        let Some(at) = block(j) else { continue };
        for i in &fine.rows()[fine.starts()[j]..fine.starts()[j + 1]] {
            match block(*i) {
                Some(other) if other > at && seen[other] != at => {
                    seen[other] = at;
                    below[at].push(other);
                }
                Some(other) if other < at => below[other].push(at),
                _ => {}
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
    // Where the rows of a block's first column lie; those of its k-th column lie k places before.
    let mut place = vec![0; p.columns()];
    let mut blocks = p.blocks().windows(2);
    let mut block = 0..0;
    let mut add = |row: usize, column: usize, value: f64, block: &std::ops::Range<usize>, place: &[usize]| {
        let start = starts[column];
        let at = match block.contains(&column) {
            true => start + place[row] - (column - block.start),
            false => start + coarse_rows[start..starts[column + 1]].partition_point(|r| *r < row),
        };
        out[at] += value;
    };
    for j in 0..fine.ncols() {
        let Some((first, _)) = p.row(j).first() else { continue };
        while *first >= block.end {
            let Some(next) = blocks.next() else { break };
            block = next[0]..next[1];
            if !block.is_empty() {
                let rows = &coarse_rows[starts[block.start]..starts[block.start + 1]];
                rows.iter().enumerate().for_each(|(at, row)| place[*row] = at);
            }
        }
        let range = fine.col_range(j);
        for (i, a) in fine.row_idx()[range.clone()].iter().zip(&fine.val()[range]).filter(|(_, a)| **a != 0.0) {
            for (row, pi) in p.row(*i) {
                for (column, pj) in p.row(j) {
                    let value = pi * a * pj;
                    match row.cmp(column) {
                        // The entry above the diagonal adds as much once more.
                        std::cmp::Ordering::Equal if *i != j => add(*row, *column, 2.0 * value, &block, &place),
                        std::cmp::Ordering::Less if *i == j => {}
                        _ => add(*row.max(column), *row.min(column), value, &block, &place),
                    }
                }
            }
        }
    }
    sum
}
