//! Geometric nested dissection of the node columns of a plate.

use crate::plate::Plate;

/// Columns at which dissection stops.
const LEAF: usize = 6;

/// Elimination order of the columns of `plate`: halves first, their separator last, recursively (George 1973).
///
/// The set is cut at the median of its longer side; the columns of the right half that touch the left are the separator.
pub fn nested_dissection(plate: &Plate) -> Vec<u32> {
    let n = plate.columns.len();
    let quads = plate.plane.quads.len();
    let mut degree = vec![0_u32; n + 1];
    for quad in 0..quads {
        for c in plate.columns_of_quad(quad) {
            degree[*c as usize + 1] += 1;
        }
    }
    for i in 0..n {
        degree[i + 1] += degree[i];
    }
    let mut cells = vec![0_u32; degree[n] as usize];
    let mut fill = degree.clone();
    for q in 0..quads {
        for c in plate.columns_of_quad(q) {
            cells[fill[*c as usize] as usize] = q as u32;
            fill[*c as usize] += 1;
        }
    }
    let mut work = Work { plate, starts: degree, cells, left: vec![0; n], cut: 0, order: Vec::with_capacity(n) };
    let mut all: Vec<u32> = (0..n as u32).collect();
    work.dissect(&mut all);
    work.order
}

struct Work<'a> {
    plate: &'a Plate,
    starts: Vec<u32>,
    cells: Vec<u32>,
    /// Number of the cut in which a column was last on the left.
    left: Vec<u32>,
    cut: u32,
    order: Vec<u32>,
}

impl Work<'_> {
    fn dissect(&mut self, set: &mut [u32]) {
        if set.len() <= LEAF {
            self.order.extend_from_slice(set);
            return;
        }
        let extent = |d: usize| {
            let of = |c: &u32| self.plate.columns[*c as usize][d];
            let (low, high) =
                set.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            high - low
        };
        let d = usize::from(extent(1) > extent(0));
        let by = |a: &u32, b: &u32| {
            self.plate.columns[*a as usize][d].total_cmp(&self.plate.columns[*b as usize][d]).then(a.cmp(b))
        };
        let half = set.len() / 2;
        set.select_nth_unstable_by(half, by);
        let (left, right) = set.split_at_mut(half);
        // Input order decides ties below, so make it independent of the selection's shuffle.
        left.sort_unstable();
        self.cut += 1;
        let cut = self.cut;
        for c in left.iter() {
            self.left[*c as usize] = cut;
        }
        let touches = |c: &u32| {
            let cells = self.starts[*c as usize] as usize..self.starts[*c as usize + 1] as usize;
            self.cells[cells]
                .iter()
                .any(|q| self.plate.columns_of_quad(*q as usize).iter().any(|c| self.left[*c as usize] == cut))
        };
        right.sort_unstable_by_key(|c| (touches(c), *c));
        let inner = right.partition_point(|c| !touches(c));
        let (right, separator) = right.split_at_mut(inner);
        let separator = separator.to_vec();
        self.dissect(left);
        self.dissect(right);
        self.order.extend(separator);
    }
}
