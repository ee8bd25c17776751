//! Symmetric matrices whose entries lie near the diagonal.

/// The lower triangle of a symmetric matrix, by columns from the diagonal down.
#[derive(Debug, Clone)]
pub(super) struct Band {
    /// Entries of a column.
    width: usize,
    values: Vec<f64>,
}

impl Band {
    /// The zero matrix of order `n`; rows and columns of entries differ by less than `width`.
    pub(super) fn zero(n: usize, width: usize) -> Self {
        Self { width, values: vec![0.0; n * width] }
    }

    /// Adds to entry (i, j) of the lower triangle; of the upper one, which is the same, nothing is kept.
    pub(super) fn add(&mut self, i: usize, j: usize, value: f64) {
        if i >= j {
            self.values[j * self.width + i - j] += value;
        }
    }

    /// A x.
    pub(super) fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for (j, column) in self.values.chunks_exact(self.width).enumerate() {
            y[j] += column[0] * x[j];
            for (i, a) in (j + 1..x.len()).zip(&column[1..]) {
                y[i] += a * x[j];
                y[j] += a * x[i];
            }
        }
        y
    }

    /// L with A = L Lᵀ; `None` of a matrix that is not positive definite.
    pub(super) fn cholesky(&self) -> Option<BandFactor> {
        let (width, n) = (self.width, self.values.len() / self.width);
        let mut l = self.values.clone();
        for j in 0..n {
            let (column, after) = l[j * width..].split_at_mut(width);
            let pivot = column[0].sqrt();
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            column.iter_mut().for_each(|a| *a /= pivot);
            for (k, next) in after.chunks_exact_mut(width).take(width - 1).enumerate() {
                let rows = &column[k + 1..];
                next.iter_mut().zip(rows).for_each(|(a, l)| *a -= l * rows[0]);
            }
        }
        Some(BandFactor { width, l })
    }
}

/// The Cholesky factor of a [`Band`].
#[derive(Debug, Clone)]
pub(super) struct BandFactor {
    width: usize,
    l: Vec<f64>,
}

impl BandFactor {
    /// `x ← A⁻¹ x`.
    pub(super) fn solve(&self, x: &mut [f64]) {
        for (j, column) in self.l.chunks_exact(self.width).enumerate() {
            x[j] /= column[0];
            let (own, below) = x[j..].split_at_mut(1);
            below.iter_mut().zip(&column[1..]).for_each(|(x, l)| *x -= l * own[0]);
        }
        for (j, column) in self.l.chunks_exact(self.width).enumerate().rev() {
            let (own, below) = x[j..].split_at_mut(1);
            own[0] = (own[0] - below.iter().zip(&column[1..]).map(|(x, l)| x * l).sum::<f64>()) / column[0];
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn solutions_and_products_are_those_of_the_dense_matrix() {
        let (n, width) = (9, 4);
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 5.0 + i as f64,
            apart if apart < width => 1.0 / (1 + i + j) as f64 - 0.3,
            _ => 0.0,
        };
        let mut band = Band::zero(n, width);
        (0..n).for_each(|i| (0..n).filter(|j| i.abs_diff(*j) < width).for_each(|j| band.add(i, j, entry(i, j))));
        let dense = DMatrix::from_fn(n, n, entry);
        let x = DVector::from_fn(n, |i, _| (i as f64 - 3.5).sin());
        assert!((DVector::from(band.product(x.as_slice())) - &dense * &x).amax() < 1e-14);
        let mut found = x.as_slice().to_vec();
        band.cholesky().unwrap().solve(&mut found);
        assert!((DVector::from(found) - dense.cholesky().unwrap().solve(&x)).amax() < 1e-15);
    }

    #[test]
    fn what_is_not_definite_has_no_factor() {
        let mut band = Band::zero(2, 2);
        band.add(0, 0, 1.0);
        band.add(1, 0, 2.0);
        band.add(1, 1, 1.0);
        assert!(band.cholesky().is_none());
    }
}
