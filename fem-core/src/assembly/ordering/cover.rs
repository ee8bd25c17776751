//! Smallest covers of the links between two shores (Kőnig 1931; by weight, Ford and Fulkerson 1956).

/// Two sets of weighted vertices with links between them, and a flow from one to the other.
pub(super) struct Shores<'a> {
    /// Of each on the left its neighbours on the right.
    links: &'a [Vec<u32>],
    /// How much of the weight of each, left and right, is not used up by the flow.
    free: [Vec<u32>; 2],
    /// Into each on the right: from which on the left, how much.
    flow: Vec<Vec<(u32, u32)>>,
    bound: u32,
}

impl<'a> Shores<'a> {
    /// The flow that is found at first sight.
    pub(super) fn new(links: &'a [Vec<u32>], weights: [Vec<u32>; 2]) -> Self {
        let flow = vec![Vec::new(); weights[1].len()];
        let mut shores = Self { links, free: weights, flow, bound: 0 };
        for (left, links) in links.iter().enumerate() {
            for right in links.iter().map(|right| *right as usize) {
                let amount = shores.free[0][left].min(shores.free[1][right]);
                if amount > 0 {
                    shores.free[0][left] -= amount;
                    shores.free[1][right] -= amount;
                    shores.flow[right].push((left as u32, amount));
                    shores.bound += amount;
                }
            }
        }
        shores
    }

    /// A weight that every cover has.
    pub(super) fn bound(&self) -> u32 {
        self.bound
    }

    /// Which of either shore are in a cover of least weight.
    pub(super) fn cover(mut self) -> [Vec<bool>; 2] {
        let (mut tried, mut search) = (vec![0; self.flow.len()], 0);
        for left in 0..self.links.len() {
            while self.free[0][left] > 0 {
                search += 1;
                let amount = self.push(left, self.free[0][left], &mut tried, search);
                if amount == 0 {
                    break;
                }
                self.free[0][left] -= amount;
            }
        }
        // What can be reached from what is left over: the cover is the rest on the left, these on the right.
        let mut kept = vec![true; self.links.len()];
        let mut reached = vec![false; self.flow.len()];
        let mut open: Vec<usize> = (0..self.links.len()).filter(|left| self.free[0][*left] > 0).collect();
        while let Some(left) = open.pop() {
            if !std::mem::replace(&mut kept[left], false) {
                continue;
            }
            for right in self.links[left].iter().map(|right| *right as usize) {
                if !std::mem::replace(&mut reached[right], true) {
                    open.extend(self.flow[right].iter().map(|(left, _)| *left as usize));
                }
            }
        }
        [kept, reached]
    }

    /// Pushes up to `amount` more out of `left`, moving others if need be; what `search` has tried is marked with it.
    fn push(&mut self, left: usize, amount: u32, tried: &mut [u32], search: u32) -> u32 {
        let links = self.links;
        for right in links[left].iter().map(|right| *right as usize) {
            if std::mem::replace(&mut tried[right], search) == search {
                continue;
            }
            let free = amount.min(self.free[1][right]);
            if free > 0 {
                self.free[1][right] -= free;
                self.add(right, left, free);
                return free;
            }
            for k in 0..self.flow[right].len() {
                let (other, held) = self.flow[right][k];
                let moved = self.push(other as usize, amount.min(held), tried, search);
                if moved > 0 {
                    self.flow[right][k].1 -= moved;
                    if moved == held {
                        self.flow[right].swap_remove(k);
                    }
                    self.add(right, left, moved);
                    return moved;
                }
            }
        }
        0
    }

    fn add(&mut self, right: usize, left: usize, amount: u32) {
        let flow = &mut self.flow[right];
        match flow.iter_mut().find(|(from, _)| *from == left as u32) {
            Some((_, held)) => *held += amount,
            None => flow.push((left as u32, amount)),
        }
    }
}
