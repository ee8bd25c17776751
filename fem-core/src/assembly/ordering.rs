//! Geometric nested dissection of the node columns of a plate.

use crate::plates::plate::Plate;

/// Columns at which dissection stops.
const LEAF: usize = 6;

/// Shares of a set that a cut leaves on its left, tried along both axes.
const SHARES: [f64; 5] = [0.5, 0.45, 0.55, 0.4, 0.6];

/// Elimination order of the columns of `plate`: halves first, their separator last, recursively (George 1973).
///
/// Of several cuts across each axis the one with the smallest separator wins; a separator is a smallest set of columns
/// that touches every connection across the cut (Kőnig 1931, by augmenting paths).
pub fn nested_dissection(plate: &Plate) -> Vec<u32> {
    // Of columns that a symmetry ties together one stands for all, with the neighbours of all.
    let symmetry = plate.symmetry();
    let corners =
        symmetry.quads().map(|(quad, _)| plate.columns_of_quad(quad).iter().map(|c| symmetry.column(*c)).collect());
    let (kept, tied): (Vec<u32>, Vec<u32>) = (0..plate.columns.len() as u32).partition(|c| symmetry.column(*c) == *c);
    let mut order = dissect(&plate.columns, corners, kept);
    order.extend(tied);
    order
}

/// The same for a `set` of the columns at `places`, where all columns of a clique are neighbours.
pub(super) fn dissect(places: &[[f64; 2]], cliques: impl Iterator<Item = Vec<u32>>, set: Vec<u32>) -> Vec<u32> {
    let mut neighbours = vec![Vec::new(); places.len()];
    for clique in cliques {
        for c in &clique {
            neighbours[*c as usize].extend(clique.iter().filter(|other| *other != c));
        }
    }
    for list in &mut neighbours {
        list.sort_unstable();
        list.dedup();
    }
    let mut work =
        Dissection { places, neighbours, side: vec![0; places.len()], cut: 0, order: Vec::with_capacity(set.len()) };
    work.dissect(set);
    work.order
}

struct Dissection<'a> {
    places: &'a [[f64; 2]],
    neighbours: Vec<Vec<u32>>,
    /// Twice the number of the cut that a column took part in last, plus one on its right.
    side: Vec<u32>,
    cut: u32,
    order: Vec<u32>,
}

impl Dissection<'_> {
    fn dissect(&mut self, mut set: Vec<u32>) {
        if set.len() <= LEAF {
            self.order.extend(set);
            return;
        }
        let mut best: Option<(f64, Vec<u32>, [Vec<u32>; 2])> = None;
        for axis in 0..2 {
            let place = |c: &u32| self.places[*c as usize][axis];
            set.sort_unstable_by(|a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
            for share in SHARES {
                let (left, right) = set.split_at((share * set.len() as f64) as usize);
                let separator = self.separator(left, right);
                let keep = |half: &[u32]| -> Vec<u32> {
                    half.iter().copied().filter(|c| separator.binary_search(c).is_err()).collect()
                };
                let halves = [keep(left), keep(right)];
                let [l, r] = [halves[0].len() as f64, halves[1].len() as f64];
                let uneven = (l - r) / (l + r).max(1.0);
                let cost = separator.len() as f64 * (1.0 + 2.0 * uneven * uneven);
                if best.as_ref().is_none_or(|b| cost < b.0) {
                    best = Some((cost, separator, halves));
                }
            }
        }
        if let Some((_, separator, halves)) = best {
            halves.into_iter().for_each(|half| self.dissect(half));
            self.order.extend(separator);
        }
    }

    /// Neighbours of `c` on a side of the present cut.
    fn across(&self, c: u32, side: u32) -> impl Iterator<Item = u32> {
        self.neighbours[c as usize].iter().copied().filter(move |d| self.side[*d as usize] == side)
    }

    /// A smallest set of columns without which `left` and `right` do not touch, ascending.
    fn separator(&mut self, left: &[u32], right: &[u32]) -> Vec<u32> {
        self.cut += 1;
        let sides = [2 * self.cut, 2 * self.cut + 1];
        for (half, side) in [(left, sides[0]), (right, sides[1])] {
            half.iter().for_each(|c| self.side[*c as usize] = side);
        }
        let shore = |half: &[u32], other: u32| -> Vec<u32> {
            let mut shore: Vec<u32> =
                half.iter().copied().filter(|c| self.across(*c, other).next().is_some()).collect();
            shore.sort_unstable();
            shore
        };
        let (left, right) = (shore(left, sides[1]), shore(right, sides[0]));
        let links: Vec<Vec<usize>> = left
            .iter()
            .map(|c| self.across(*c, sides[1]).map(|d| right.partition_point(|r| *r < d)).collect())
            .collect();
        let mut mate: Vec<Option<usize>> = vec![None; right.len()];
        let mut matched = vec![false; left.len()];
        for (l, matched) in matched.iter_mut().enumerate() {
            *matched = augment(l, &links, &mut mate, &mut vec![false; right.len()]);
        }
        // What alternating paths from unmatched columns reach: the cover is the rest on the left, these on the right.
        let mut reached = (vec![false; left.len()], vec![false; right.len()]);
        let mut open: Vec<usize> = (0..left.len()).filter(|l| !matched[*l]).collect();
        while let Some(l) = open.pop() {
            if std::mem::replace(&mut reached.0[l], true) {
                continue;
            }
            for r in &links[l] {
                if !std::mem::replace(&mut reached.1[*r], true) {
                    open.extend(mate[*r]);
                }
            }
        }
        let kept_left = left.iter().zip(&reached.0).filter(|(_, r)| !**r).map(|(c, _)| *c);
        let kept_right = right.iter().zip(&reached.1).filter(|(_, r)| **r).map(|(c, _)| *c);
        let mut separator: Vec<u32> = kept_left.chain(kept_right).collect();
        separator.sort_unstable();
        separator
    }
}

/// Finds a partner for `l`, if those that have one can be matched anew.
fn augment(l: usize, links: &[Vec<usize>], mate: &mut [Option<usize>], tried: &mut [bool]) -> bool {
    for r in &links[l] {
        if !std::mem::replace(&mut tried[*r], true) && mate[*r].is_none_or(|other| augment(other, links, mate, tried)) {
            mate[*r] = Some(l);
            return true;
        }
    }
    false
}
