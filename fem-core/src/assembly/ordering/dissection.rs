//! Geometric nested dissection of a graph (George 1973).

use super::cover::Shores;
use crate::assembly::pattern::Cliques;

/// Vertices at which dissection stops.
const LEAF: usize = 4;

/// Least share of a set on either side of a cut.
const SHARE: f64 = 1.0 / 3.0;

/// What a cut costs more if it leaves all on one side.
const UNEVEN: f64 = 0.5;

/// A graph in space, its vertices weighted by the unknowns that they stand for.
pub(super) struct Graph {
    places: Vec<[f64; 3]>,
    weights: Vec<u32>,
    starts: Vec<u32>,
    links: Vec<u32>,
}

/// A set divided.
struct Division {
    cost: f64,
    separator: Vec<u32>,
    halves: [Vec<u32>; 2],
}

impl Graph {
    /// All members of a clique are linked.
    pub(super) fn new(places: Vec<[f64; 3]>, weights: Vec<u32>, cliques: &Cliques) -> Self {
        let count = weights.len();
        let (of, all) = cliques.by_member(count);
        let (mut starts, mut links) = (vec![0], Vec::new());
        let mut seen = vec![u32::MAX; count];
        for vertex in 0..count {
            seen[vertex] = vertex as u32;
            for clique in &all[of[vertex] as usize..of[vertex + 1] as usize] {
                for other in cliques.of(*clique) {
                    if std::mem::replace(&mut seen[*other as usize], vertex as u32) != vertex as u32 {
                        links.push(*other);
                    }
                }
            }
            starts.push(links.len() as u32);
        }
        Self { places, weights, starts, links }
    }

    fn links(&self, vertex: u32) -> &[u32] {
        &self.links[self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }

    fn weight(&self, vertex: u32) -> u32 {
        self.weights[vertex as usize]
    }

    fn weight_of(&self, set: &[u32]) -> u32 {
        set.iter().map(|v| self.weight(*v)).sum()
    }

    /// The vertices of `set` in their order of elimination: halves first, what separates them last, recursively.
    ///
    /// Sets are cut across the axis that offers the smallest separator; that is a set of least weight that touches every link
    /// across the cut.
    pub(super) fn dissect(&self, set: Vec<u32>) -> Vec<u32> {
        let count = self.weights.len();
        let mut order = Vec::with_capacity(set.len());
        Dissection { graph: self, side: vec![0; count], sides: 0, rank: vec![0; count] }.dissect(set, &mut order);
        order
    }
}

struct Dissection<'a> {
    graph: &'a Graph,
    /// The last of the sets looked at that a vertex was in, and its place in that.
    side: Vec<u32>,
    rank: Vec<u32>,
    /// Sets looked at so far.
    sides: u32,
}

/// What a separator costs that leaves so much on either side.
fn cost(separator: f64, [left, right]: [f64; 2]) -> f64 {
    let uneven = (left - right) / (left + right).max(1.0);
    separator * (1.0 + UNEVEN * uneven * uneven)
}

impl Dissection<'_> {
    fn dissect(&mut self, set: Vec<u32>, order: &mut Vec<u32>) {
        match (set.len() > LEAF).then(|| self.divide(&set)).flatten() {
            Some(Division { separator, halves, .. }) => {
                drop(set);
                halves.into_iter().for_each(|half| self.dissect(half, order));
                order.extend(separator);
            }
            None => order.extend(set),
        }
    }

    fn divide(&mut self, set: &[u32]) -> Option<Division> {
        let mut cuts = Vec::new();
        for axis in 0..3 {
            let place = |v: &u32| self.graph.places[*v as usize][axis];
            let mut sorted = set.to_vec();
            sorted.sort_unstable_by(|a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
            if place(&sorted[0]) == place(&sorted[sorted.len() - 1]) {
                continue;
            }
            if let Some((cost, at)) = self.best_cut(&sorted) {
                cuts.push((cost, at, sorted));
            }
        }
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best: Option<Division> = None;
        for (_, at, sorted) in cuts {
            let limit = best.as_ref().map_or(f64::INFINITY, |b| b.cost);
            best = self.separate(sorted.split_at(at), limit).or(best);
        }
        best
    }

    /// Marks `set` as a side of its own, and where each vertex is in it.
    fn mark(&mut self, set: &[u32]) -> u32 {
        self.sides += 1;
        for (rank, v) in set.iter().enumerate() {
            (self.side[*v as usize], self.rank[*v as usize]) = (self.sides, rank as u32);
        }
        self.sides
    }

    /// The cheapest place to cut a `sorted` set in, if the lighter of the two shores became the separator, and what it costs.
    fn best_cut(&mut self, sorted: &[u32]) -> Option<(f64, usize)> {
        let (graph, own) = (self.graph, self.mark(sorted));
        // By how much the weight of either shore changes from a place to the next.
        let mut changes = vec![[0_i64; 2]; sorted.len() + 1];
        for (rank, v) in sorted.iter().enumerate() {
            let ranks = graph.links(*v).iter().filter(|x| self.side[**x as usize] == own);
            let ranks = ranks.map(|x| self.rank[*x as usize] as usize);
            let (first, last) = ranks.fold((rank, rank), |(first, last), r| (first.min(r), last.max(r)));
            let weight = i64::from(graph.weight(*v));
            changes[rank][0] += weight;
            changes[last][0] -= weight;
            changes[first][1] += weight;
            changes[rank][1] -= weight;
        }
        let total = f64::from(graph.weight_of(sorted));
        let (mut shores, mut left, mut best) = ([0_i64; 2], 0.0, None);
        for (rank, v) in sorted.iter().enumerate() {
            shores = [0, 1].map(|side| shores[side] + changes[rank][side]);
            left += f64::from(graph.weight(*v));
            if left < SHARE * total || left > (1.0 - SHARE) * total {
                continue;
            }
            let [separator, other] = shores.map(|s| s as f64);
            let cost = if separator <= other {
                cost(separator, [left - separator, total - left])
            } else {
                cost(other, [left, total - left - other])
            };
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, rank + 1));
            }
        }
        best.filter(|(_, at)| *at < sorted.len())
    }

    /// Neighbours of `v` on a side.
    fn across(&self, v: u32, side: u32) -> impl Iterator<Item = &u32> {
        self.graph.links(v).iter().filter(move |x| self.side[**x as usize] == side)
    }

    /// The division at a cut, if it costs less than `limit`.
    fn separate(&mut self, (left, right): (&[u32], &[u32]), limit: f64) -> Option<Division> {
        let sides = [left, right].map(|half| self.mark(half));
        let graph = self.graph;
        let shore = |half: &[u32], other: u32| -> Vec<u32> {
            half.iter().copied().filter(|v| self.across(*v, other).next().is_some()).collect()
        };
        let shores = [shore(left, sides[1]), shore(right, sides[0])];
        for (rank, v) in shores[1].iter().enumerate() {
            self.rank[*v as usize] = rank as u32;
        }
        let links = |v: &u32| self.across(*v, sides[1]).map(|x| self.rank[*x as usize]).collect();
        let links: Vec<Vec<u32>> = shores[0].iter().map(links).collect();
        let weights = [0, 1].map(|side: usize| shores[side].iter().map(|v| graph.weight(*v)).collect());
        let shored = Shores::new(&links, weights);
        if f64::from(shored.bound()) >= limit {
            return None;
        }
        let chosen = shored.cover();
        let cover = [0, 1].map(|side: usize| shores[side].iter().zip(&chosen[side]).filter(|c| *c.1).map(|c| *c.0));
        let mut separator: Vec<u32> = cover.into_iter().flatten().collect();
        separator.sort_unstable();
        let halves = [left, right]
            .map(|half| -> Vec<u32> { half.iter().copied().filter(|v| separator.binary_search(v).is_err()).collect() });
        let sizes = [&halves[0], &halves[1]].map(|half| f64::from(graph.weight_of(half)));
        let cost = cost(f64::from(graph.weight_of(&separator)), sizes);
        (cost < limit).then_some(Division { cost, separator, halves })
    }
}
