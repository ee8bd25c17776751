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

/// Columns on either side of a cut that have neighbours across it, and a matching of them.
struct Cut {
    /// Axis, and how many of the set, sorted along it, are on the left.
    at: (usize, usize),
    left: Vec<u32>,
    right: Vec<u32>,
    /// Of each on the left its neighbours on the right.
    links: Vec<Vec<usize>>,
    /// Of each on the right the one on the left that it is matched with.
    mate: Vec<Option<usize>>,
    matched: Vec<bool>,
}

impl Dissection<'_> {
    fn dissect(&mut self, mut set: Vec<u32>) {
        if set.len() <= LEAF {
            self.order.extend(set);
            return;
        }
        let mut sorted = [Vec::new(), Vec::new()];
        let mut cuts = Vec::new();
        for (axis, sorted) in sorted.iter_mut().enumerate() {
            let place = |c: &u32| self.places[*c as usize][axis];
            set.sort_unstable_by(|a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
            cuts.extend(SHARES.map(|share| self.cut(&set, (axis, (share * set.len() as f64) as usize))));
            sorted.clone_from(&set);
        }
        // A separator is at most a shore and at least a matching, and a cut costs one to three times its separator: across
        // a strip there is a cut that costs less than any along it can.
        let most = cuts.iter().map(|cut| 3 * cut.left.len().min(cut.right.len())).min().unwrap_or(0);
        let mut best: Option<(f64, Vec<u32>, [Vec<u32>; 2])> = None;
        for cut in cuts.into_iter().filter(|cut| cut.matched.iter().filter(|m| **m).count() <= most) {
            let (left, right) = sorted[cut.at.0].split_at(cut.at.1);
            let separator = cut.separator();
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
        drop(sorted);
        if let Some((_, separator, halves)) = best {
            halves.into_iter().for_each(|half| self.dissect(half));
            self.order.extend(separator);
        }
    }

    /// Neighbours of `c` on a side of the present cut.
    fn across(&self, c: u32, side: u32) -> impl Iterator<Item = u32> {
        self.neighbours[c as usize].iter().copied().filter(move |d| self.side[*d as usize] == side)
    }

    /// The cut of a `set`, sorted along an axis, with each column on the left matched to the first that is free.
    fn cut(&mut self, set: &[u32], at: (usize, usize)) -> Cut {
        self.cut += 1;
        let (left, right) = set.split_at(at.1);
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
        let take = |(l, links): (usize, &Vec<usize>)| {
            let free = links.iter().find(|r| mate[**r].is_none());
            free.map(|r| mate[*r] = Some(l)).is_some()
        };
        let matched = links.iter().enumerate().map(take).collect();
        Cut { at, left, right, links, mate, matched }
    }
}

impl Cut {
    /// A smallest set of columns without which the sides do not touch, ascending.
    fn separator(mut self) -> Vec<u32> {
        let mut tried = vec![usize::MAX; self.right.len()];
        for l in 0..self.left.len() {
            self.matched[l] = self.matched[l] || augment(l, l, &self.links, &mut self.mate, &mut tried);
        }
        let Self { left, right, links, mate, matched, .. } = self;
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

/// Finds a partner for `l`, if those that have one can be matched anew; what `search` has tried is marked with it.
fn augment(l: usize, search: usize, links: &[Vec<usize>], mate: &mut [Option<usize>], tried: &mut [usize]) -> bool {
    for r in &links[l] {
        if std::mem::replace(&mut tried[*r], search) != search
            && mate[*r].is_none_or(|other| augment(other, search, links, mate, tried))
        {
            mate[*r] = Some(l);
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns in a random plane with random neighbours: no smaller set touches every link across the cut.
    #[test]
    fn separators_are_smallest() {
        let mut state = 7_u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        for _ in 0..300 {
            let n = 4 + random(9) as usize;
            let places: Vec<[f64; 2]> = (0..n).map(|_| [random(100) as f64, random(100) as f64]).collect();
            let mut neighbours = vec![Vec::new(); n];
            for (a, b) in (0..n).flat_map(|a| (0..a).map(move |b| (a, b))) {
                if random(3) == 0 {
                    neighbours[a].push(b as u32);
                    neighbours[b].push(a as u32);
                }
            }
            let mut work = Dissection {
                places: &places,
                neighbours: neighbours.clone(),
                side: vec![0; n],
                cut: 0,
                order: Vec::new(),
            };
            let set: Vec<u32> = (0..n as u32).collect();
            let found = work.cut(&set, (0, n / 2)).separator();
            let parts = |chosen: u32| {
                let out = |c: usize| chosen >> c & 1 == 0;
                (0..n / 2).all(|a| !out(a) || neighbours[a].iter().all(|b| (*b as usize) < n / 2 || !out(*b as usize)))
            };
            assert!(parts(found.iter().map(|c| 1 << c).sum()), "{found:?}");
            let least = (0..1_u32 << n).filter(|set| parts(*set)).map(u32::count_ones).min();
            assert_eq!(Some(found.len() as u32), least);
            work.dissect(set.clone());
            work.order.sort_unstable();
            assert_eq!(work.order, set);
        }
    }
}
