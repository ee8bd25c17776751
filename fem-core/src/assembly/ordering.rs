//! Geometric nested dissection of the node columns of a plate.

use crate::plate::Plate;

/// Columns at which dissection stops.
const LEAF: usize = 6;

/// Elimination order of the columns of `plate`: halves first, their separator last, recursively (George 1973).
///
/// The set is cut at the median of its longer side; the columns of the right half that touch the left are the separator.
pub fn nested_dissection(plate: &Plate) -> Vec<u32> {
    let n = plate.columns.len();
    // Of columns that a symmetry ties together one stands for all, with the cells of all.
    let symmetry = plate.symmetry();
    let columns = |quad| plate.columns_of_quad(quad).iter().map(|c| symmetry.column(*c) as usize);
    let mut degree = vec![0_u32; n + 1];
    for (quad, _) in symmetry.quads() {
        for c in columns(quad) {
            degree[c + 1] += 1;
        }
    }
    for i in 0..n {
        degree[i + 1] += degree[i];
    }
    let mut cells = vec![0_u32; degree[n] as usize];
    let mut fill = degree.clone();
    for (quad, _) in symmetry.quads() {
        for c in columns(quad) {
            cells[fill[c] as usize] = quad as u32;
            fill[c] += 1;
        }
    }
    let mut work = Work { plate, starts: degree, cells, left: vec![0; n], cut: 0, order: Vec::with_capacity(n) };
    let (mut kept, tied): (Vec<u32>, Vec<u32>) = (0..n as u32).partition(|c| symmetry.column(*c) == *c);
    work.dissect(&mut kept);
    work.order.extend(tied);
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
        let symmetry = self.plate.symmetry();
        let on_left = |c: &u32| self.left[symmetry.column(*c) as usize] == cut;
        let touches = |c: &u32| {
            let cells = self.starts[*c as usize] as usize..self.starts[*c as usize + 1] as usize;
            self.cells[cells].iter().any(|q| self.plate.columns_of_quad(*q as usize).iter().any(on_left))
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
