//! The motions of a reduced plate that stretch it.

use super::Modal;
use super::forms::Forms;
use crate::vector::{axpy, dot};
use fem_core::structure::{SolveError, Structure as _};
use nalgebra::{Cholesky, DMatrix, DMatrixView, DVector, DVectorView, SymmetricEigen};
use std::borrow::Cow;

/// Motions of a plate on springs that let go by which it is stretched, at least: as many as a plate has vectors by default.
const LEAST: usize = 60;

/// Coordinates y = Xᵀ q of the motions that stretch a reduced plate: q themselves, those of its modes, or few.
///
/// A plate on springs that only push has a vector for each that may let go. Its modes are those of the plate that none has let go; one
/// that lifts off takes a bit of all of them, however fast. What is smooth is told by its modes without these springs:
///
/// ```text
/// (Λ − Σ k p pᵀ) x = ω² x,    Xᵀ X = 1,    q ≈ X y
/// ```
///
/// X the slowest, as many as there are modes beside the answers to springs, and then what the tension of the plate is coupled to beside.
#[derive(Debug, Clone, Default)]
pub(super) struct Motions {
    /// X; nothing where y = q.
    few: Option<DMatrix<f64>>,
}

impl Motions {
    /// Of the modes of `modal` on springs that only push, each with what it holds of them and its stiffness; `answers` of the modes are
    /// there for their sake. All modes where some have no inertia. Forces on the modes, the columns of `couplings`, lie in the motions but
    /// for what does less than the energy `least`.
    pub(super) fn new(
        modal: &Modal,
        (springs, answers): (&[(Vec<f64>, f64)], usize),
        (couplings, least): (&DMatrix<f64>, f64),
    ) -> Self {
        let n = modal.ndof();
        let count = n.saturating_sub(answers).max(LEAST);
        if springs.is_empty() || count >= n || modal.frequencies().any(f64::is_infinite) {
            return Self::default();
        }
        let mut free = DMatrix::from_diagonal(&DVector::from_column_slice(&modal.stiffness));
        for (at, k) in springs {
            let at = DVectorView::from_slice(at, n);
            free.ger(-k, &at, &at, 1.0);
        }
        let modes = SymmetricEigen::new(free);
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|a, b| modes.eigenvalues[*a].total_cmp(&modes.eigenvalues[*b]));
        let mut x = modes.eigenvectors.select_columns(&order[..count]);
        for coupling in couplings.column_iter() {
            let mut rest = coupling.into_owned();
            // Twice is enough.
            for _ in 0..2 {
                rest -= &x * x.tr_mul(&rest);
            }
            let energy: f64 = rest.iter().zip(modal.compliances()).map(|(f, c)| f * c * f).sum();
            if energy > least && x.ncols() < n {
                let column = x.ncols();
                x = x.insert_column(column, 0.0);
                x.set_column(column, &rest.normalize());
            }
        }
        Self { few: Some(x) }
    }

    /// How many they are of so many modes.
    pub(super) fn count(&self, modes: usize) -> usize {
        self.few.as_ref().map_or(modes, DMatrix::ncols)
    }

    /// Their displacements Φ X, `ndof × count`; Φ is `basis`.
    pub(super) fn fields<'a>(&self, basis: &'a [f64]) -> Cow<'a, [f64]> {
        match &self.few {
            None => Cow::Borrowed(basis),
            Some(x) => {
                let basis = DMatrixView::from_slice(basis, basis.len() / x.nrows(), x.nrows());
                Cow::Owned((basis * x).as_slice().to_vec())
            }
        }
    }

    /// Finds y.
    pub(super) fn of(&self, q: &[f64], y: &mut Vec<f64>) {
        y.clear();
        match &self.few {
            None => y.extend_from_slice(q),
            Some(x) => y.extend(x.as_slice().chunks_exact(q.len()).map(|x| dot(x, q))),
        }
    }

    /// Xᵀ F, of forces on the modes column by column.
    pub(super) fn of_all(&self, forces: DMatrix<f64>) -> DMatrix<f64> {
        match &self.few {
            None => forces,
            Some(x) => x.tr_mul(&forces),
        }
    }

    /// Adds X g.
    pub(super) fn add(&self, g: &[f64], force: &mut [f64]) {
        match &self.few {
            None => axpy(1.0, g, force),
            Some(x) => g.iter().zip(x.as_slice().chunks_exact(force.len())).for_each(|(g, x)| axpy(*g, x, force)),
        }
    }

    /// A = D + X T Xᵀ, D = diag(`own`), T = `tangent`, for solutions.
    ///
    /// # Errors
    /// One that is not positive definite.
    pub(super) fn inverse(&self, own: &[f64], mut tangent: DMatrix<f64>) -> Result<Inverse, SolveError> {
        let n = own.len();
        let Some(x) = &self.few else {
            own.iter().enumerate().for_each(|(i, own)| tangent[(i, i)] += own);
            let inverse = Cholesky::new(tangent).ok_or(SolveError::Buckled)?.inverse();
            return Ok(Inverse::Whole(Forms::new(n, inverse.as_slice())));
        };
        let mut eased = x.clone();
        eased.column_iter_mut().for_each(|mut x| x.iter_mut().zip(own).for_each(|(x, own)| *x /= own));
        let l = Cholesky::new(x.tr_mul(&eased)).ok_or(SolveError::Buckled)?.unpack();
        let across = l.tr_mul(&tangent);
        let mut inner = &across * &l;
        (0..inner.nrows()).for_each(|i| inner[(i, i)] += 1.0);
        let inner = Cholesky::new(inner).ok_or(SolveError::Buckled)?.solve(&across);
        let core = l.tr_solve_lower_triangular(&inner).ok_or(SolveError::Buckled)?;
        Ok(Inverse::Beside { own: own.to_vec(), turned: &eased * core, eased })
    }
}

/// The inverse of a tangent.
#[derive(Debug, Clone)]
pub(super) enum Inverse {
    Whole(Forms),
    /// D⁻¹ − (D⁻¹ X W) (D⁻¹ X)ᵀ with
    ///
    /// ```text
    /// W = L⁻ᵀ (1 + Lᵀ T L)⁻¹ Lᵀ T,    L Lᵀ = Xᵀ D⁻¹ X
    /// ```
    Beside {
        own: Vec<f64>,
        turned: DMatrix<f64>,
        eased: DMatrix<f64>,
    },
}

impl Inverse {
    /// X ← A⁻¹ X, column by column; `work` is room.
    pub(super) fn solve(&self, x: &mut [f64], [padded, solution]: [&mut Vec<f64>; 2]) {
        match self {
            Self::Whole(inverse) => {
                solution.resize(inverse.stride(), 0.0);
                inverse.products(x, padded, solution);
                x.iter_mut().zip(&*solution).for_each(|(x, solution)| *x = *solution);
            }
            Self::Beside { own, turned, eased } => {
                solution.clear();
                solution.extend(eased.as_slice().chunks_exact(x.len()).map(|column| dot(column, x)));
                x.iter_mut().zip(own).for_each(|(x, own)| *x /= own);
                let each = solution.iter().zip(turned.as_slice().chunks_exact(x.len()));
                each.for_each(|(share, column)| axpy(-share, column, x));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// A chain of masses between springs, `k` of them to the ground, in its modes.
    fn chain(n: usize, k: &[(usize, f64)]) -> (Modal, Vec<(Vec<f64>, f64)>) {
        let mut stiffness = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        });
        k.iter().for_each(|(i, k)| stiffness[(*i, *i)] += k);
        let modes = SymmetricEigen::new(stiffness);
        let springs = k.iter().map(|(i, k)| (modes.eigenvectors.row(*i).iter().copied().collect(), *k)).collect();
        let modal = Modal { stiffness: modes.eigenvalues.as_slice().to_vec(), mass: vec![1.0; n], damping: Vec::new() };
        (modal, springs)
    }

    #[test]
    fn the_slowest_without_springs_are_those_of_the_free_chain() {
        let (modal, springs) = chain(90, &[(3, 50.0), (4, 50.0), (77, 1e3)]);
        let none = DMatrix::zeros(90, 0);
        let motions = Motions::new(&modal, (&springs, 25), (&none, 0.0));
        assert_eq!(motions.count(90), 65);
        // Xᵀ (Λ − Σ k p pᵀ) X are the lowest of 2 − 2 cos(π j/91).
        for j in 0..65 {
            let (mut x, mut y) = (vec![0.0; 90], vec![0.0; 65]);
            y[j] = 1.0;
            motions.add(&y, &mut x);
            let pulled: f64 = springs.iter().map(|(p, k)| k * dot(p, &x).powi(2)).sum();
            let energy = x.iter().zip(&modal.stiffness).map(|(x, k)| k * x * x).sum::<f64>() - pulled;
            let exact = 2.0 - 2.0 * (std::f64::consts::PI * (j + 1) as f64 / 91.0).cos();
            assert!((energy - exact).abs() < 1e-11, "{j}: {energy} {exact}");
        }
        assert_eq!(Motions::new(&modal, (&springs, 30), (&none, 0.0)).count(90), 60);
        assert_eq!(Motions::new(&modal, (&[], 30), (&none, 0.0)).count(90), 90);
        let still = Modal { mass: vec![0.0; 90], ..modal };
        assert_eq!(
            Motions::new(&still, (&springs, 30), (&none, 0.0)).count(90),
            90,
            "the order of modes without inertia says nothing"
        );
    }

    #[test]
    fn couplings_are_motions_if_they_do_anything() {
        let (modal, springs) = chain(90, &[(3, 50.0), (77, 1e3)]);
        // On one mode, on that and another, and hardly anything on all.
        let couplings = DMatrix::from_fn(90, 3, |i, t| match t {
            0 => f64::from(i == 70),
            1 => f64::from(i == 70) + 3.0 * f64::from(i == 20),
            _ => 1e-6,
        });
        let motions = Motions::new(&modal, (&springs, 30), (&couplings, 1e-9));
        let x = motions.few.as_ref().unwrap();
        assert_eq!(x.ncols(), 62);
        assert!((x.tr_mul(x) - DMatrix::identity(62, 62)).abs().max() < 1e-12);
        let left = &couplings - x * motions.of_all(couplings.clone());
        assert!(left.columns(0, 2).abs().max() < 1e-12 && left.column(2).abs().max() > 1e-7, "{left}");
    }

    #[test]
    fn tangents_are_inverted_as_if_written_out() {
        let (modal, springs) = chain(80, &[(3, 50.0), (40, 1e4)]);
        let none = DMatrix::zeros(80, 0);
        let motions = Motions::new(&modal, (&springs, 10), (&none, 0.0));
        let count = motions.count(80);
        let own: Vec<f64> = modal.stiffness.iter().map(|k| k + 0.3).collect();
        // Positive, indefinite, and so much so that the whole is.
        for (scale, sound) in [(1.0, true), (-0.1, true), (-5.0, false)] {
            let tangent = DMatrix::from_fn(count, count, |i, j| scale / (1 + i + j) as f64);
            let inverse = motions.inverse(&own, tangent.clone());
            assert_eq!(inverse.is_ok(), sound, "{scale}");
            let Ok(inverse) = inverse else { continue };
            let x = motions.few.as_ref().unwrap();
            let whole = DMatrix::from_diagonal(&DVector::from_column_slice(&own)) + x * tangent * x.transpose();
            let wanted = DVector::from_fn(80, |i, _| ((3 * i) % 7) as f64 - 2.0);
            let mut found = (&whole * &wanted).as_slice().to_vec();
            inverse.solve(&mut found, [&mut Vec::new(), &mut Vec::new()]);
            let error = found.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-10, "{scale}: {error}");
        }
    }
}
