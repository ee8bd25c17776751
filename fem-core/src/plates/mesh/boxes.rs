//! Boxes in a tree, to find those near a place.

/// Lower and upper corner.
pub(super) type Box2 = [[f64; 2]; 2];

/// Boxes that a leaf of the tree holds at most.
const LEAF: usize = 8;

/// A balanced tree over boxes: built in n log n, asked in log n.
pub(super) struct Boxes {
    boxes: Vec<Box2>,
    /// Numbers of the boxes; each half of a range belongs to a branch of its own.
    order: Vec<u32>,
    /// What each branch reaches over: branches 2 k + 1 and 2 k + 2 come from branch k.
    reach: Vec<Box2>,
}

impl Boxes {
    pub(super) fn new(boxes: Vec<Box2>) -> Self {
        let mut tree = Self { order: (0..boxes.len() as u32).collect(), reach: Vec::new(), boxes };
        let mut order = std::mem::take(&mut tree.order);
        tree.divide(0, &mut order);
        tree.order = order;
        tree
    }

    fn divide(&mut self, branch: usize, order: &mut [u32]) {
        let mut reach = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for [low, high] in order.iter().map(|k| self.boxes[*k as usize]) {
            for d in 0..2 {
                reach[0][d] = reach[0][d].min(low[d]);
                reach[1][d] = reach[1][d].max(high[d]);
            }
        }
        if self.reach.len() <= branch {
            self.reach.resize(branch + 1, [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]]);
        }
        self.reach[branch] = reach;
        if order.len() <= LEAF {
            return;
        }
        let axis = usize::from(reach[1][1] - reach[0][1] > reach[1][0] - reach[0][0]);
        let twice_middle = |k: &u32| self.boxes[*k as usize][0][axis] + self.boxes[*k as usize][1][axis];
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |a, b| twice_middle(a).total_cmp(&twice_middle(b)).then(a.cmp(b)));
        let (left, right) = order.split_at_mut(half);
        self.divide(2 * branch + 1, left);
        self.divide(2 * branch + 2, right);
    }

    /// Calls `each` with the number of every box that meets `place`.
    pub(super) fn near(&self, place: Box2, mut each: impl FnMut(u32)) {
        self.near_in(0, [0, self.order.len()], place, &mut each);
    }

    fn near_in(&self, branch: usize, [from, to]: [usize; 2], place: Box2, each: &mut impl FnMut(u32)) {
        if !meets(self.reach[branch], place) {
            return;
        }
        if to - from <= LEAF {
            self.order[from..to].iter().filter(|k| meets(self.boxes[**k as usize], place)).for_each(|k| each(*k));
            return;
        }
        let middle = from + (to - from) / 2;
        self.near_in(2 * branch + 1, [from, middle], place, each);
        self.near_in(2 * branch + 2, [middle, to], place, each);
    }
}

fn meets([a, b]: Box2, [c, d]: Box2) -> bool {
    (0..2).all(|k| a[k] <= d[k] && c[k] <= b[k])
}
