//! Linear systems whose matrix is near one that has been factorised.

/// Solves A x = b by GMRES (Saad and Schultz 1986) in the inner product of P, which is symmetric, positive definite and near A: of
/// all x in the space of P⁻¹ A the one of smallest residual in the norm of P⁻¹, the energy that the residual would have on P.
///
/// A may be indefinite and need not be symmetric. Every direction costs a product and a solve; all are kept.
#[derive(Debug, Clone, Default)]
pub(super) struct Krylov {
    /// Directions, and P times each.
    directions: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
    /// Upper triangle of the rotated Hessenberg matrix, column by column.
    triangle: Vec<Vec<f64>>,
    rotations: Vec<[f64; 2]>,
    /// Right-hand side after the rotations.
    rhs: Vec<f64>,
}

impl Krylov {
    /// Solves for `x`, which holds b, until the residual is `tolerance` of that of b or the space has `most` dimensions; returns the
    /// directions that it took and the residual, relative.
    pub(super) fn solve(
        &mut self,
        mut product: impl FnMut(&[f64], &mut [f64]),
        mut solve: impl FnMut(&mut [f64]),
        x: &mut [f64],
        tolerance: f64,
        most: usize,
    ) -> (usize, f64) {
        let n = x.len();
        let (mut image, mut direction) = (x.to_vec(), x.to_vec());
        solve(&mut direction);
        let size = dot(&image, &direction).max(0.0).sqrt();
        x.fill(0.0);
        if size == 0.0 {
            return (0, 0.0);
        }
        self.rhs.clear();
        self.rhs.push(size);
        let mut norm = size;
        let mut count = 0;
        while count < most {
            set(&mut self.directions, count, &direction, norm);
            set(&mut self.images, count, &image, norm);
            image.clear();
            image.resize(n, 0.0);
            product(&self.directions[count], &mut image);
            direction.copy_from_slice(&image);
            solve(&mut direction);
            let mut column = vec![0.0; count + 2];
            // Twice, so that rounding leaves the directions orthogonal.
            for _ in 0..2 {
                for (k, h) in column[..=count].iter_mut().enumerate() {
                    let share = dot(&image, &self.directions[k]);
                    *h += share;
                    add(-share, &self.images[k], &mut image);
                    add(-share, &self.directions[k], &mut direction);
                }
            }
            norm = dot(&image, &direction).max(0.0).sqrt();
            column[count + 1] = norm;
            self.rotate(column, count);
            count += 1;
            let residual = self.rhs[count].abs() / size;
            if residual <= tolerance || norm == 0.0 || !residual.is_finite() {
                break;
            }
        }
        let mut shares = self.rhs[..count].to_vec();
        for k in (0..count).rev() {
            shares[k] /= self.triangle[k][k];
            for i in 0..k {
                shares[i] -= self.triangle[k][i] * shares[k];
            }
        }
        shares.iter().zip(&self.directions).for_each(|(share, direction)| add(*share, direction, x));
        (count, self.rhs[count].abs() / size)
    }

    /// Makes a column of the Hessenberg matrix one of the triangle.
    fn rotate(&mut self, mut column: Vec<f64>, k: usize) {
        self.rotations.truncate(k);
        self.triangle.truncate(k);
        for (i, [c, s]) in self.rotations.iter().enumerate() {
            (column[i], column[i + 1]) = (c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]);
        }
        let length = column[k].hypot(column[k + 1]);
        let [c, s] = if length > 0.0 { [column[k] / length, column[k + 1] / length] } else { [1.0, 0.0] };
        column[k] = length;
        column.truncate(k + 1);
        self.rotations.push([c, s]);
        self.triangle.push(column);
        self.rhs.truncate(k + 1);
        let last = self.rhs[k];
        self.rhs[k] = c * last;
        self.rhs.push(-s * last);
    }
}

/// `all[k] ← x / norm`, in the storage that is there.
fn set(all: &mut Vec<Vec<f64>>, k: usize, x: &[f64], norm: f64) {
    if all.len() == k {
        all.push(Vec::new());
    }
    all[k].clear();
    all[k].extend(x.iter().map(|x| x / norm));
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(scale: f64, x: &[f64], y: &mut [f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += scale * x);
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Cholesky, DMatrix, DVector};

    #[test]
    fn solves_what_is_near_a_factor_and_neither_symmetric_nor_definite() {
        let n = 40;
        let near = DMatrix::from_fn(n, n, |i, j| if i == j { 4.0 } else { 1.0 / (1.0 + i.abs_diff(j) as f64) });
        let factor = Cholesky::new(near.clone()).unwrap();
        let mut a = near;
        // Five rows that soften, and couple one way only.
        for k in 0..5 {
            a[(7 * k, 7 * k)] -= 9.0;
            a[(7 * k, 3)] += 2.0;
        }
        let b = DVector::from_fn(n, |i, _| (i as f64).sin());
        let mut x = b.as_slice().to_vec();
        let product = |x: &[f64], y: &mut [f64]| y.copy_from_slice((&a * DVector::from_column_slice(x)).as_slice());
        let solve = |x: &mut [f64]| {
            let solved = factor.solve(&DVector::from_column_slice(x));
            x.copy_from_slice(solved.as_slice());
        };
        let (count, residual) = Krylov::default().solve(product, solve, &mut x, 1e-12, n);
        // One direction for each that A and P tell apart, and one for the rest.
        assert!(count <= 11 && residual <= 1e-12, "{count} {residual}");
        let rest = (&a * DVector::from_vec(x) - &b).norm() / b.norm();
        assert!(rest < 1e-11, "{rest}");
    }
}
