//! The assembly tree: which columns are eliminated together, in which dense front, after which others.

use crate::assembly::Pattern;
use std::ops::Range;

/// Entries of a factor that every machine has room for.
const MODEST: usize = 1 << 20;

/// Columns eliminated together in one dense front.
#[derive(Debug, Clone)]
pub(super) struct Front {
    /// Its unknowns in [`Tree::unknowns`], ascending: the pivots, then the rows below them.
    pub unknowns: Range<usize>,
    /// Number of pivots.
    pub pivots: usize,
    /// Where its panel starts: `unknowns × pivots`, column-major.
    pub panel: usize,
    /// The fronts whose updates it takes, in [`Tree::children`].
    pub children: Range<usize>,
    /// The first front of the subtree that it ends.
    pub first: usize,
}

impl Front {
    /// Unknowns of the front.
    pub(super) fn size(&self) -> usize {
        self.unknowns.len()
    }

    /// Rows below the pivots.
    pub(super) fn below(&self) -> usize {
        self.size() - self.pivots
    }

    /// Entries of the packed triangle that it hands to its parent.
    pub(super) fn update(&self) -> usize {
        self.below() * (self.below() + 1) / 2
    }

    /// Additions and multiplications of its elimination.
    pub(super) fn flops(&self) -> f64 {
        let (p, r) = (self.pivots as f64, self.below() as f64);
        p * p * p / 3.0 + p * p * r + p * r * r
    }
}

/// Fronts in postorder: children before parents, subtrees contiguous.
#[derive(Debug)]
pub(super) struct Tree {
    pub fronts: Vec<Front>,
    pub unknowns: Vec<u32>,
    pub children: Vec<u32>,
    /// Fronts without a parent.
    pub roots: Vec<u32>,
    /// Length of all panels.
    pub storage: usize,
}

/// A front in the making; widths and weights count columns, the lists hold groups.
#[derive(Default)]
struct Node {
    pivots: Vec<u32>,
    rows: Vec<u32>,
    width: usize,
    weight: usize,
    children: Vec<u32>,
    /// Entries stored though zero.
    zeros: usize,
}

impl Node {
    fn stored(width: usize, weight: usize) -> usize {
        width * (width + 1) / 2 + width * weight
    }

    /// Zeros of the front that takes `child` in, if they are worth it.
    fn zeros_with(&self, child: &Self) -> Option<usize> {
        let width = self.width + child.width;
        let all = Self::stored(width, self.weight);
        let held = Self::stored(self.width, self.weight) + Self::stored(child.width, child.weight);
        let zeros = self.zeros + child.zeros + (all - held);
        // Narrow fronts lose more to their handling than to zeros.
        let share = match width {
            ..=32 => 0.5,
            33..=96 => 0.15,
            _ => 0.05,
        };
        (zeros as f64 <= share * all as f64).then_some(zeros)
    }
}

impl Tree {
    /// Analyses `pattern`, whose own order is the elimination order.
    ///
    /// Works on groups of columns with equal neighbours, so that the cost is that of the nodes of a mesh. `fits` hears how
    /// many entries the factor has, each time their number has doubled and at the end; what it refuses is returned.
    pub(super) fn new(pattern: &Pattern, fits: impl Fn(usize) -> bool) -> Result<Self, usize> {
        let groups = pattern.groups();
        let count = groups.len() - 1;
        let mut group_of = vec![0_u32; pattern.ndof()];
        for g in 0..count {
            group_of[groups[g]..groups[g + 1]].fill(g as u32);
        }
        let width = |g: u32| groups[g as usize + 1] - groups[g as usize];
        let mut nodes: Vec<Node> = Vec::with_capacity(count);
        let mut waiting: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut roots = Vec::new();
        let mut seen = vec![u32::MAX; count];
        let (mut stored, mut asked) = (0_usize, MODEST);
        for g in 0..count as u32 {
            let column = groups[g as usize];
            let mut children = std::mem::take(&mut waiting[g as usize]);
            let mut rows = Vec::new();
            seen[g as usize] = g;
            let mut take = |row: u32| {
                if seen[row as usize] != g {
                    seen[row as usize] = g;
                    rows.push(row);
                }
            };
            pattern.rows()[pattern.starts()[column]..pattern.starts()[column + 1]]
                .iter()
                .for_each(|i| take(group_of[*i]));
            for child in &children {
                nodes[*child as usize].rows.iter().for_each(|row| take(*row));
            }
            rows.sort_unstable();
            let weight = rows.iter().map(|r| width(*r)).sum();
            stored += Node::stored(width(g), weight);
            let mut node = Node { pivots: vec![g], rows, width: width(g), weight, ..Node::default() };
            // The child with the most rows costs the fewest zeros.
            children.sort_unstable_by_key(|c| (usize::MAX - nodes[*c as usize].weight, *c));
            for c in children {
                match node.zeros_with(&nodes[c as usize]) {
                    Some(zeros) => {
                        let child = std::mem::take(&mut nodes[c as usize]);
                        stored += zeros - node.zeros - child.zeros;
                        node.pivots.extend(child.pivots);
                        node.children.extend(child.children);
                        node.width += child.width;
                        node.zeros = zeros;
                    }
                    None => node.children.push(c),
                }
            }
            match node.rows.first() {
                Some(parent) => waiting[*parent as usize].push(g),
                None => roots.push(g),
            }
            nodes.push(node);
            if stored > asked {
                if !fits(stored) {
                    return Err(stored);
                }
                asked = 2 * stored;
            }
        }
        let tree = Self::numbered(nodes, roots, groups);
        if fits(tree.total()) { Ok(tree) } else { Err(tree.total()) }
    }

    /// The fronts of `nodes` in an order of few waiting updates (Liu 1986), their groups spelt out as columns.
    fn numbered(mut nodes: Vec<Node>, roots: Vec<u32>, groups: &[usize]) -> Self {
        let update = |node: &Node| node.weight * (node.weight + 1) / 2;
        let mut peaks = vec![0_usize; nodes.len()];
        for i in 0..nodes.len() {
            let mut children = std::mem::take(&mut nodes[i].children);
            children.sort_unstable_by_key(|c| {
                let c = *c as usize;
                (usize::MAX - (peaks[c] - update(&nodes[c])), c)
            });
            let mut held = 0;
            for c in &children {
                peaks[i] = peaks[i].max(held + peaks[*c as usize]);
                held += update(&nodes[*c as usize]);
            }
            peaks[i] = peaks[i].max(held).max(update(&nodes[i]));
            nodes[i].children = children;
        }
        let mut tree =
            Self { fronts: Vec::new(), unknowns: Vec::new(), children: Vec::new(), roots: Vec::new(), storage: 0 };
        // Depth first without recursion: a chain of fronts may be as deep as the matrix is large.
        let mut path: Vec<(u32, usize, usize)> = Vec::new();
        let mut finished: Vec<u32> = Vec::new();
        for root in roots {
            path.push((root, 0, finished.len()));
            while let Some((node, next, base)) = path.last_mut() {
                let at = &mut nodes[*node as usize];
                if let Some(child) = at.children.get(*next) {
                    *next += 1;
                    let child = *child;
                    path.push((child, 0, finished.len()));
                    continue;
                }
                at.pivots.sort_unstable();
                let begin = tree.unknowns.len();
                for g in at.pivots.iter().chain(&at.rows) {
                    tree.unknowns.extend(groups[*g as usize] as u32..groups[*g as usize + 1] as u32);
                }
                let number = tree.fronts.len() as u32;
                let children = tree.children.len()..tree.children.len() + finished.len() - *base;
                tree.children.extend(finished.drain(*base..));
                let first =
                    tree.children.get(children.start).map_or(number as usize, |c| tree.fronts[*c as usize].first);
                let front = Front {
                    unknowns: begin..tree.unknowns.len(),
                    pivots: at.width,
                    panel: tree.storage,
                    children,
                    first,
                };
                tree.storage += front.size() * front.pivots;
                tree.fronts.push(front);
                finished.push(number);
                path.pop();
            }
        }
        tree.roots = finished;
        tree
    }

    /// The unknowns of a front.
    pub(super) fn unknowns(&self, front: &Front) -> &[u32] {
        &self.unknowns[front.unknowns.clone()]
    }

    /// The panels of a range of fronts.
    pub(super) fn panels(&self, fronts: Range<usize>) -> Range<usize> {
        let start = |f: usize| self.fronts.get(f).map_or(self.storage, |f| f.panel);
        start(fronts.start)..start(fronts.end)
    }

    /// Entries of the panels and of the buffers of one thread.
    pub(super) fn total(&self) -> usize {
        let (stack, square) = self.memory(0..self.fronts.len());
        self.storage + stack + square
    }

    /// Largest length of the stack of updates, and largest square that a front updates, over whole subtrees.
    pub(super) fn memory(&self, fronts: Range<usize>) -> (usize, usize) {
        let (mut held, mut peak, mut square) = (0_usize, 0, 0);
        for front in &self.fronts[fronts] {
            let children = &self.children[front.children.clone()];
            held -= children.iter().map(|c| self.fronts[*c as usize].update()).sum::<usize>();
            held += front.update();
            peak = peak.max(held);
            square = square.max(front.below().pow(2));
        }
        (peak, square)
    }
}
