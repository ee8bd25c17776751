//! Which thread eliminates which subtrees.

use super::analysis::Tree;
use std::ops::Range;

/// Subtrees tried per thread before the division is settled.
const PIECES: usize = 16;

/// What each thread after the first is taken to add where all share the tiles of a front, as a share of a thread of its own subtrees.
/// It decides who does what, and no number.
const SHARED: f64 = 0.7;

/// A part of the postorder.
#[derive(Debug, Clone)]
pub(super) enum Item {
    /// A subtree that one worker eliminates beside the others.
    Subtree { worker: usize, fronts: Range<usize> },
    /// A front above the subtrees, eliminated after them by all workers.
    Front(usize),
}

impl Item {
    pub(super) fn fronts(&self) -> Range<usize> {
        match self {
            Self::Subtree { fronts, .. } => fronts.clone(),
            Self::Front(f) => *f..*f + 1,
        }
    }
}

/// The whole postorder, in parts.
#[derive(Debug)]
pub(super) struct Schedule {
    pub items: Vec<Item>,
    pub workers: usize,
}

impl Schedule {
    /// Divides `tree` among `workers` threads: of the cuts met while the largest subtree is opened again and again, the one
    /// that takes least time if a thread makes the same number of operations a second everywhere.
    pub(super) fn new(tree: &Tree, workers: usize) -> Self {
        let mut flops: Vec<f64> = tree.fronts.iter().map(|f| f.flops()).collect();
        for f in 0..flops.len() {
            let below: f64 = tree.children[tree.fronts[f].children.clone()].iter().map(|c| flops[*c as usize]).sum();
            flops[f] += below;
        }
        let together = 1.0 + SHARED * (workers as f64 - 1.0);
        let mut cut: Vec<u32> = tree.roots.clone();
        let (mut best, mut least) = (cut.clone(), f64::INFINITY);
        loop {
            cut.sort_unstable_by(|a, b| flops[*b as usize].total_cmp(&flops[*a as usize]).then(a.cmp(b)));
            let beside: f64 = cut.iter().map(|f| flops[*f as usize]).sum();
            let all: f64 = tree.roots.iter().map(|f| flops[*f as usize]).sum();
            let loads = loads(&cut, &flops, workers).1;
            let time = (all - beside) / together + loads.iter().copied().fold(0.0, f64::max);
            if time < least {
                (best, least) = (cut.clone(), time);
            }
            let Some(largest) = cut.first() else { break };
            let children = tree.fronts[*largest as usize].children.clone();
            if workers == 1 || children.is_empty() || cut.len() >= PIECES * workers.max(tree.roots.len()) {
                break;
            }
            cut.swap_remove(0);
            cut.extend_from_slice(&tree.children[children]);
        }
        let mut parts: Vec<_> = best.iter().copied().zip(loads(&best, &flops, workers).0).collect();
        parts.sort_unstable();
        let (mut items, mut next) = (Vec::new(), 0);
        for (root, worker) in parts {
            let fronts = tree.fronts[root as usize].first..root as usize + 1;
            items.extend((next..fronts.start).map(Item::Front));
            next = fronts.end;
            items.push(Item::Subtree { worker, fronts });
        }
        items.extend((next..tree.fronts.len()).map(Item::Front));
        Self { items, workers }
    }
}

/// Gives every subtree of `cut`, the largest first, to the worker with the least to do: workers, and what each has to do.
fn loads(cut: &[u32], flops: &[f64], workers: usize) -> (Vec<usize>, Vec<f64>) {
    let mut loads = vec![0.0; workers];
    let given = cut
        .iter()
        .map(|f| {
            let mut worker = 0;
            for w in 1..workers {
                if loads[w] < loads[worker] {
                    worker = w;
                }
            }
            loads[worker] += flops[*f as usize];
            worker
        })
        .collect();
    (given, loads)
}
