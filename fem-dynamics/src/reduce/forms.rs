//! Symmetric matrices in few coordinates.

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

/// Rows and columns of a block: four registers of four numbers.
const BLOCK: usize = 16;
const LANES: usize = 4;

/// A number for each row of a block.
type Column = [[f64; LANES]; BLOCK / LANES];

/// Symmetric matrices of one order. The blocks of each lower triangle are kept, so that a product reads half of the numbers; what
/// the last blocks have beyond the order is zero.
#[derive(Debug, Clone)]
pub(super) struct Forms {
    order: usize,
    /// Columns of blocks from the diagonal down, matrix by matrix.
    blocks: Vec<[Column; BLOCK]>,
}

impl Forms {
    /// Of matrices `order × order`, one after the other, whose lower triangles are taken.
    pub(super) fn new(order: usize, matrices: &[f64]) -> Self {
        let mut blocks = Vec::new();
        for matrix in matrices.chunks_exact((order * order).max(1)) {
            for (high, low) in pairs(order.div_ceil(BLOCK)) {
                let mut block = [Column::default(); BLOCK];
                for (column, to) in (BLOCK * high..order).zip(&mut block) {
                    for (row, to) in (BLOCK * low..order).zip(to.as_flattened_mut()) {
                        *to = matrix[row.max(column) + order * row.min(column)];
                    }
                }
                blocks.push(block);
            }
        }
        Self { order, blocks }
    }

    /// Numbers from one product to the next.
    pub(super) fn stride(&self) -> usize {
        self.order.next_multiple_of(BLOCK)
    }

    fn blocks_of_each(&self) -> usize {
        let n = self.order.div_ceil(BLOCK);
        n * (n + 1) / 2
    }

    /// Matrix `t`, whole.
    pub(super) fn matrix(&self, t: usize) -> DMatrix<f64> {
        let blocks = &self.blocks[t * self.blocks_of_each()..];
        let mut matrix = DMatrix::zeros(self.order, self.order);
        for ((high, low), block) in pairs(self.order.div_ceil(BLOCK)).zip(blocks) {
            for (column, from) in (BLOCK * high..self.order).zip(block) {
                for (row, value) in (BLOCK * low..self.order).zip(from.as_flattened()) {
                    (matrix[(row, column)], matrix[(column, row)]) = (*value, *value);
                }
            }
        }
        matrix
    }

    /// The same without what lies in rows or columns from `count` on.
    pub(super) fn of_the_first(&self, count: usize) -> Self {
        let mut first = self.clone();
        for blocks in first.blocks.chunks_exact_mut(self.blocks_of_each().max(1)) {
            for ((high, low), block) in pairs(self.order.div_ceil(BLOCK)).zip(blocks) {
                for (column, block) in (BLOCK * high..).zip(block) {
                    let kept = if column < count { count.saturating_sub(BLOCK * low).min(BLOCK) } else { 0 };
                    block.as_flattened_mut()[kept..].fill(0.0);
                }
            }
        }
        first
    }

    /// Finds the product of each matrix with `q`, each [`Forms::stride`] numbers after the one before.
    pub(super) fn products(&self, q: &[f64], padded: &mut Vec<f64>, out: &mut [f64]) {
        padded.clear();
        padded.extend_from_slice(&q[..self.order]);
        padded.resize(self.stride(), 0.0);
        let (q, out) = (columns(padded), columns_mut(out));
        Arch::new().dispatch(Products { blocks: &self.blocks, of_each: self.blocks_of_each(), q, out });
    }

    /// Finds the product of `q`, which is `padded` as [`Forms::products`] leaves it, with each of some `vectors` of as many numbers; leaves
    /// values without a vector.
    pub(super) fn values(&self, padded: &[f64], vectors: &[f64], values: &mut [f64]) {
        Arch::new().dispatch(Values { q: columns(padded), vectors: columns(vectors), values });
    }

    /// Adds to `sum` the vectors with a weight each.
    pub(super) fn add_columns(&self, weights: &[f64], vectors: &[f64], sum: &mut [f64]) {
        Arch::new().dispatch(AddColumns { weights, vectors: columns(vectors), sum: columns_mut(sum) });
    }
}

/// Columns and rows of the blocks of a lower triangle of `n` blocks.
fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |high| (high..n).map(move |low| (high, low)))
}

fn columns(values: &[f64]) -> &[Column] {
    values.as_chunks::<LANES>().0.as_chunks().0
}

fn columns_mut(values: &mut [f64]) -> &mut [Column] {
    values.as_chunks_mut::<LANES>().0.as_chunks_mut().0
}

struct Products<'a> {
    blocks: &'a [[Column; BLOCK]],
    of_each: usize,
    q: &'a [Column],
    out: &'a mut [Column],
}

impl WithSimd for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { blocks, of_each, q, out } = self;
        let n = q.len();
        if n == 0 {
            return;
        }
        for (blocks, out) in blocks.chunks_exact(of_each).zip(out.chunks_exact_mut(n)) {
            out.fill(Column::default());
            let mut blocks = blocks.iter();
            for high in 0..n {
                let q_high = q[high];
                if let Some(block) = blocks.next() {
                    add_block(block, &q_high, &mut out[high]);
                }
                // What the blocks below the diagonal do as their own transposes, a row of registers for each column.
                let mut across = [[0.0; LANES]; BLOCK];
                for (low, block) in (high + 1..n).zip(&mut blocks) {
                    add_both(block, [&q_high, &q[low]], &mut out[low], &mut across);
                }
                let sums = out[high].as_flattened_mut().iter_mut().zip(&across);
                sums.for_each(|(sum, [a, b, c, d])| *sum += (a + b) + (c + d));
            }
        }
    }
}

/// [`Forms::values`]
struct Values<'a> {
    q: &'a [Column],
    vectors: &'a [Column],
    values: &'a mut [f64],
}

impl WithSimd for Values<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { q, vectors, values } = self;
        for (value, vector) in values.iter_mut().zip(vectors.chunks_exact(q.len().max(1))) {
            let mut sums = Column::default();
            for (vector, q) in vector.iter().zip(q) {
                for ((sums, vector), q) in sums.iter_mut().zip(vector).zip(q) {
                    (0..LANES).for_each(|lane| sums[lane] = vector[lane].mul_add(q[lane], sums[lane]));
                }
            }
            let [[a, b, c, d], rest @ ..] = sums;
            *value = rest.iter().fold((a + b) + (c + d), |sum, [a, b, c, d]| sum + ((a + b) + (c + d)));
        }
    }
}

/// [`Forms::add_columns`]
struct AddColumns<'a> {
    weights: &'a [f64],
    vectors: &'a [Column],
    sum: &'a mut [Column],
}

impl WithSimd for AddColumns<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { weights, vectors, sum } = self;
        for (weight, vector) in weights.iter().zip(vectors.chunks_exact(sum.len().max(1))) {
            for (sum, vector) in sum.as_flattened_mut().iter_mut().zip(vector.as_flattened()) {
                (0..LANES).for_each(|lane| sum[lane] = weight.mul_add(vector[lane], sum[lane]));
            }
        }
    }
}

/// `y ← y + A x`
#[inline(always)]
fn add_block(block: &[Column; BLOCK], x: &Column, y: &mut Column) {
    let mut sums = *y;
    for (column, x) in block.iter().zip(x.as_flattened()) {
        for (sums, column) in sums.iter_mut().zip(column) {
            (0..LANES).for_each(|lane| sums[lane] = x.mul_add(column[lane], sums[lane]));
        }
    }
    *y = sums;
}

/// The same with the first `x`, and adds the products of each column of A with the second, not yet summed over the lanes: one waits for
/// no result of the other.
#[inline(always)]
fn add_both(block: &[Column; BLOCK], x: [&Column; 2], y: &mut Column, across: &mut [[f64; LANES]; BLOCK]) {
    let (mut sums, rows) = (*y, *x[1]);
    for ((column, x), across) in block.iter().zip(x[0].as_flattened()).zip(across) {
        let mut products = *across;
        for ((sums, column), row) in sums.iter_mut().zip(column).zip(&rows) {
            (0..LANES).for_each(|lane| sums[lane] = x.mul_add(column[lane], sums[lane]));
            (0..LANES).for_each(|lane| products[lane] = row[lane].mul_add(column[lane], products[lane]));
        }
        *across = products;
    }
    *y = sums;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_any_order() {
        for n in [0, 1, 3, 15, 16, 17, 31, 32, 60, 129] {
            let q: Vec<f64> = (0..n).map(|i| i as f64 - 7.0).collect();
            // Small whole numbers, whose sums are exact.
            let entry = |t: usize, i: usize, j: usize| (((i * j + 3 * (i + j)) * 31 + 5 * t) % 17) as f64;
            let matrix = |t: usize| DMatrix::from_fn(n, n, |i, j| entry(t, i, j));
            let all: Vec<f64> = (0..3).flat_map(|t| matrix(t).as_slice().to_vec()).collect();
            let forms = Forms::new(n, &all);
            let mut out = vec![f64::NAN; 3 * forms.stride()];
            forms.products(&q, &mut Vec::new(), &mut out);
            for t in 0..if n > 0 { 3 } else { 0 } {
                assert_eq!(forms.matrix(t), matrix(t), "{n}");
                let want = matrix(t) * nalgebra::DVector::from_vec(q.clone());
                assert_eq!(&out[t * forms.stride()..][..n], want.as_slice(), "{n}");
            }
        }
    }

    #[test]
    fn the_first_rows_and_columns_are_left_alone() {
        let n = 37;
        let matrix = DMatrix::from_fn(n, n, |i, j| 1.0 + (i * j + i + j) as f64);
        let forms = Forms::new(n, matrix.as_slice());
        for count in [0, 5, 16, 20, 32, 37, 40] {
            let mut want = matrix.clone();
            for i in 0..n {
                for j in 0..n {
                    if i.max(j) >= count {
                        want[(i, j)] = 0.0;
                    }
                }
            }
            assert_eq!(forms.of_the_first(count).matrix(0), want, "{count}");
        }
    }
}
