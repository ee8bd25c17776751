//! Multifrontal elimination: each front takes the updates of its children, eliminates its pivots, passes an update on.

use super::analysis::{Front, Tree};
use super::dense;
use super::schedule::{Item, Schedule};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SparseColMatRef;
use std::ops::Range;

/// The matrix to factorise.
type Matrix<'a> = SparseColMatRef<'a, usize, f64>;

/// Numbers of the smallest page of memory. A page of fresh zeros that is read before it is written is mapped twice, and the second time
/// all threads are interrupted.
const PAGE: usize = 512;

/// A pivot that is not positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BadPivot {
    /// The front, whose number orders several of these.
    front: usize,
    pub column: usize,
}

/// Fills `panels` with the factor; they need not be `clean`, all zero.
///
/// Every front takes its children in one order and is divided into the same tiles, whoever computes them: no number depends on the
/// threads.
pub(super) fn factorise(
    tree: &Tree,
    schedule: &Schedule,
    matrix: Matrix<'_>,
    panels: &mut [f64],
    clean: bool,
) -> Result<(), BadPivot> {
    // The panels of a subtree are contiguous, and so are those between two subtrees.
    let mut shares: Vec<Vec<(Range<usize>, &mut [f64])>> = (0..schedule.workers).map(|_| Vec::new()).collect();
    let mut top = Vec::new();
    let mut rest = panels;
    for item in &schedule.items {
        let (piece, after) = rest.split_at_mut(tree.panels(item.fronts()).len());
        rest = after;
        match item {
            Item::Subtree { worker, fronts } => shares[*worker].push((fronts.clone(), piece)),
            Item::Front(f) => top.push((*f, piece)),
        }
    }
    let work = |share: Vec<(Range<usize>, &mut [f64])>| {
        let mut worker = Worker::new(tree, share.iter().map(|s| s.0.clone()), clean);
        let mut share = share.into_iter();
        let done = share.try_for_each(|(fronts, panels)| worker.subtree(tree, matrix, fronts, panels));
        // Updates of the subtrees before one that fails come first.
        (worker.stack, done.err())
    };
    // Work goes to the first workers first.
    shares.retain(|share| !share.is_empty());
    let mut shares = shares.into_iter();
    let own = shares.next().unwrap_or_default();
    let results: Vec<(Vec<f64>, Option<BadPivot>)> = std::thread::scope(|scope| {
        let others: Vec<_> = shares.map(|share| scope.spawn(|| work(share))).collect();
        let own = work(own);
        let join = |other: std::thread::ScopedJoinHandle<'_, _>| match other.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        std::iter::once(own).chain(others.into_iter().map(join)).collect()
    });
    // A front above that comes before the first failure in the order of one thread may fail itself: it goes first.
    let mut failure = results.iter().filter_map(|r| r.1).min_by_key(|e| e.front);
    let limit = failure.map_or(usize::MAX, |e| e.front);
    if !top.is_empty() {
        let updates: Vec<&[f64]> = results.iter().map(|r| r.0.as_slice()).collect();
        failure = above(tree, schedule, matrix, top, &updates, limit, clean).err().or(failure);
    }
    failure.map_or(Ok(()), Err)
}

/// Eliminates the fronts above the subtrees up to front `limit`; `updates` of the subtrees lie worker by worker.
fn above(
    tree: &Tree,
    schedule: &Schedule,
    matrix: Matrix<'_>,
    top: Vec<(usize, &mut [f64])>,
    updates: &[&[f64]],
    limit: usize,
    clean: bool,
) -> Result<(), BadPivot> {
    let mut worker = Worker { threads: schedule.workers, ..Worker::new(tree, top.iter().map(|t| t.0..t.0), clean) };
    let square = top.iter().map(|t| tree.fronts[t.0].below().pow(2)).max().unwrap_or(0);
    worker.square.resize(square, 0.0);
    let mut taken = vec![0; updates.len()];
    let mut top = top.into_iter();
    for item in schedule.items.iter().take_while(|item| item.fronts().end <= limit) {
        match item {
            Item::Subtree { worker: w, fronts } => {
                let length = tree.fronts[fronts.end - 1].update();
                worker.stack.extend_from_slice(&updates[*w][taken[*w]..taken[*w] + length]);
                taken[*w] += length;
            }
            Item::Front(_) => {
                if let Some((f, panel)) = top.next() {
                    worker.eliminate(tree, matrix, f, panel)?;
                }
            }
        }
    }
    Ok(())
}

/// Buffers of one thread.
struct Worker {
    /// Place of an unknown in the front at work; others hold what is left of earlier fronts.
    place: Vec<u32>,
    /// Updates that wait for their parents: lower triangles, packed by columns.
    stack: Vec<f64>,
    /// The update in the making.
    square: Vec<f64>,
    scratch: MemBuffer,
    /// Whether panels come as zeros.
    clean: bool,
    /// That share the tiles of a front.
    threads: usize,
}

impl Worker {
    fn new(tree: &Tree, shares: impl Iterator<Item = Range<usize>>, clean: bool) -> Self {
        let (mut held, mut stack, mut square) = (0, 0, 0);
        for fronts in shares {
            let (peak, s) = tree.memory(fronts.clone());
            stack = stack.max(held + peak);
            square = square.max(s);
            held += fronts.last().map_or(0, |f| tree.fronts[f].update());
        }
        let pivots = tree.fronts.iter().map(|f| f.pivots).max().unwrap_or(0);
        let unknowns = tree.unknowns.iter().max().map_or(0, |u| *u as usize + 1);
        Self {
            place: vec![0; unknowns],
            stack: Vec::with_capacity(stack),
            square: vec![0.0; square],
            scratch: MemBuffer::new(dense::scratch(pivots)),
            clean,
            threads: 1,
        }
    }

    fn subtree(
        &mut self,
        tree: &Tree,
        matrix: Matrix<'_>,
        fronts: Range<usize>,
        mut panels: &mut [f64],
    ) -> Result<(), BadPivot> {
        for f in fronts {
            let (panel, rest) = panels.split_at_mut(tree.panels(f..f + 1).len());
            panels = rest;
            self.eliminate(tree, matrix, f, panel)?;
        }
        Ok(())
    }

    fn eliminate(&mut self, tree: &Tree, matrix: Matrix<'_>, f: usize, panel: &mut [f64]) -> Result<(), BadPivot> {
        let front = &tree.fronts[f];
        let unknowns = tree.unknowns(front);
        let (size, pivots, below) = (front.size(), front.pivots, front.below());
        for (k, u) in unknowns.iter().enumerate() {
            self.place[*u as usize] = k as u32;
        }
        if self.clean {
            panel.iter_mut().step_by(PAGE).for_each(|value| *value = 0.0);
        } else {
            panel.fill(0.0);
        }
        for (u, column) in unknowns.iter().zip(panel.chunks_exact_mut(size)) {
            let entries = matrix.col_range(*u as usize);
            for (row, value) in matrix.row_idx()[entries.clone()].iter().zip(&matrix.val()[entries]) {
                column[self.place[*row] as usize] = *value;
            }
        }
        let square = &mut self.square[..below * below];
        for (k, column) in square.chunks_exact_mut(below.max(1)).enumerate() {
            column[k..].fill(0.0);
        }
        let children = &tree.children[front.children.clone()];
        let taken: usize = children.iter().map(|c| tree.fronts[*c as usize].update()).sum();
        let base = self.stack.len() - taken;
        let mut at = base;
        for child in children {
            let child = &tree.fronts[*child as usize];
            let update = &self.stack[at..at + child.update()];
            at += child.update();
            extend_add(tree, child, &self.place, update, panel, square, (size, pivots));
        }
        self.stack.truncate(base);

        let scratch = MemStack::new(&mut self.scratch);
        dense::eliminate(panel, square, (size, pivots), self.threads, scratch)
            .map_err(|index| BadPivot { front: f, column: unknowns[index] as usize })?;
        if below == 0 {
            return Ok(());
        }
        for (k, column) in square.chunks_exact(below).enumerate() {
            self.stack.extend_from_slice(&column[k..]);
        }
        Ok(())
    }
}

/// Adds the packed update of `child` into the front at work.
fn extend_add(
    tree: &Tree,
    child: &Front,
    place: &[u32],
    mut update: &[f64],
    panel: &mut [f64],
    square: &mut [f64],
    (size, pivots): (usize, usize),
) {
    let rows = &tree.unknowns(child)[child.pivots..];
    let places: Vec<usize> = rows.iter().map(|u| place[*u as usize] as usize).collect();
    // Runs of consecutive places: (first row of the update, place, length).
    let mut runs: Vec<(usize, usize, usize)> = Vec::new();
    for (row, place) in places.iter().enumerate() {
        match runs.last_mut() {
            Some((_, first, length)) if *first + *length == *place => *length += 1,
            _ => runs.push((row, *place, 1)),
        }
    }
    let below = size - pivots;
    let mut current = 0;
    for (k, to) in places.iter().enumerate() {
        let (column, after) = update.split_at(rows.len() - k);
        update = after;
        let (target, offset) = if *to < pivots {
            (&mut panel[to * size..(to + 1) * size], 0)
        } else {
            (&mut square[(to - pivots) * below..(to - pivots + 1) * below], pivots)
        };
        if runs[current].0 + runs[current].2 == k {
            current += 1;
        }
        for (row, place, length) in &runs[current..] {
            let skip = k.saturating_sub(*row);
            let target = &mut target[place + skip - offset..place + length - offset];
            for (t, u) in target.iter_mut().zip(&column[row + skip - k..row + length - k]) {
                *t += u;
            }
        }
    }
}
