//! Numbers that scatter together.

use super::design::SweepAxis;
use super::distribution::{standard_quantile, standard_share};
use nalgebra::DMatrix;

/// Gauss's copula: each number keeps its own distribution, and the normal numbers z = Φ⁻¹(F(x)) behind them have this matrix of
/// correlation (Nataf 1962; Liu and Der Kiureghian 1986).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Copula {
    /// Lower triangle L of the matrix R = L Lᵀ, row by row; none where nothing is correlated.
    rows: Vec<Vec<f64>>,
}

impl Copula {
    /// Of pairs `KEY, KEY = 0.6`.
    ///
    /// # Errors
    /// A pair that cannot be read, names no key of `axes` that has any number, or says something again; a matrix that is not
    /// positive definite.
    pub(super) fn new(axes: &[SweepAxis], pairs: &[String]) -> Result<Self, String> {
        if pairs.is_empty() {
            return Ok(Self { rows: Vec::new() });
        }
        let mut matrix = DMatrix::<f64>::identity(axes.len(), axes.len());
        for pair in pairs {
            let read = || {
                let (keys, value) = pair.rsplit_once('=')?;
                let (a, b) = keys.split_once(',')?;
                Some((a.trim(), b.trim(), value.trim().parse::<f64>().ok()?))
            };
            let (a, b, value) = read().ok_or_else(|| format!("`{pair}` is no correlation: write KEY,KEY=0.6"))?;
            let place = |key: &str| match axes.iter().position(|axis| axis.key == key) {
                Some(k) if axes[k].variation.count().is_none() => Ok(k),
                Some(_) => Err(format!("`{key}` has so many values, and only numbers that scatter are correlated")),
                None => Err(format!("`{key}` is correlated and does not vary")),
            };
            let (i, j) = (place(a)?, place(b)?);
            if i == j || matrix[(i, j)] != 0.0 {
                return Err(format!("`{pair}`: these two have a correlation already"));
            }
            if !(value.abs() < 1.0) {
                return Err(format!("`{pair}`: a correlation lies between -1 and 1"));
            }
            (matrix[(i, j)], matrix[(j, i)]) = (value, value);
        }
        let least = matrix.clone().symmetric_eigenvalues().min();
        let lower = matrix.cholesky().filter(|_| least > 1e-9).ok_or_else(|| {
            format!("the matrix of correlations is not positive definite, its least eigenvalue is {least:.3}: no numbers scatter so")
        })?;
        let lower = lower.l();
        Ok(Self { rows: (0..axes.len()).map(|i| lower.row(i).iter().take(i + 1).copied().collect()).collect() })
    }

    /// Whether it leaves numbers as they are.
    pub(super) fn is_none(&self) -> bool {
        self.rows.is_empty()
    }

    /// Shares of probability that are correlated, from independent ones.
    pub(super) fn correlated(&self, shares: Vec<f64>) -> Vec<f64> {
        if self.is_none() {
            return shares;
        }
        let within = |share: f64| share.clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON);
        let normal: Vec<f64> = shares.iter().map(|share| standard_quantile(within(*share))).collect();
        let sum = |row: &Vec<f64>| row.iter().zip(&normal).map(|(l, z)| l * z).sum();
        let of = |(row, share): (&Vec<f64>, f64)| match row.split_last() {
            // What is correlated with nothing before it stays to the bit.
            Some((_, before)) if before.iter().all(|l| *l == 0.0) => share,
            _ => standard_share(sum(row)),
        };
        self.rows.iter().zip(shares).map(of).collect()
    }
}
