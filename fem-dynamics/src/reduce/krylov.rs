//! Lanczos iteration in the metric of M.

use crate::vector::{axpy, dot};
use fem_core::reduction::ReductionError;
use fem_core::structure::Structure;
use nalgebra::{DMatrix, SymmetricEigen};

/// Relative residual at which a mode counts as found; its frequency is then good to the square of it.
const TOLERANCE: f64 = 1e-7;

/// A new direction shorter than this fraction of its image ends the Krylov space.
const EXHAUSTED: f64 = 1e-12;

/// Iterations between two looks at the convergence.
const LOOK: usize = 8;

/// The Krylov space {x, A x, A² x, …} of the operator A = S M, S symmetric (an inverse stiffness), with an M-orthonormal
/// basis: full reorthogonalisation, twice, which is enough (Parlett).
pub(super) struct Krylov<'a, S> {
    structure: &'a mut dyn Structure,
    inverse: S,
    /// Basis and its image under M, `n × steps`.
    v: Vec<f64>,
    mv: Vec<f64>,
    /// Projection of A on the basis: diagonal and neighbours.
    alpha: Vec<f64>,
    beta: Vec<f64>,
    /// Next direction, its image, and its length.
    next: Vec<f64>,
    image: Vec<f64>,
    length: f64,
    exhausted: bool,
}

impl<'a, S> Krylov<'a, S>
where
    S: FnMut(&mut dyn Structure, &mut [f64]) -> Result<(), ReductionError>,
{
    /// Starts from `x`; `inverse` applies S to any number of columns.
    ///
    /// # Errors
    /// A start that is not finite.
    pub(super) fn new(structure: &'a mut dyn Structure, inverse: S, x: Vec<f64>) -> Result<Self, ReductionError> {
        let image = vec![0.0; x.len()];
        let (v, mv, alpha, beta) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut krylov = Self { structure, inverse, v, mv, alpha, beta, next: x, image, length: 0.0, exhausted: false };
        krylov.orthogonalise()?;
        Ok(krylov)
    }

    /// Makes the next direction orthogonal to the basis and measures it.
    fn orthogonalise(&mut self) -> Result<(), ReductionError> {
        let n = self.next.len();
        self.image.fill(0.0);
        self.structure.add_mass(1.0, &self.next, &mut self.image);
        let before = dot(&self.next, &self.image).max(0.0).sqrt();
        for _ in 0..2 {
            for (v, mv) in self.v.chunks_exact(n).zip(self.mv.chunks_exact(n)) {
                let share = dot(mv, &self.next);
                axpy(-share, v, &mut self.next);
                axpy(-share, mv, &mut self.image);
            }
        }
        self.length = dot(&self.next, &self.image).max(0.0).sqrt();
        self.exhausted = self.length <= EXHAUSTED * before;
        if self.length.is_finite() {
            Ok(())
        } else {
            Err(ReductionError("the Lanczos iteration met a number that is not finite".into()))
        }
    }

    /// Adds one vector to the basis; `false` when the space is exhausted.
    ///
    /// # Errors
    /// Those of the operator.
    pub(super) fn grow(&mut self) -> Result<bool, ReductionError> {
        if self.exhausted {
            return Ok(false);
        }
        if !self.alpha.is_empty() {
            self.beta.push(self.length);
        }
        let scale = 1.0 / self.length;
        self.v.extend(self.next.iter().map(|x| x * scale));
        self.image.iter_mut().for_each(|x| *x *= scale);
        self.mv.extend_from_slice(&self.image);
        self.next.copy_from_slice(&self.image);
        (self.inverse)(self.structure, &mut self.next)?;
        self.alpha.push(dot(&self.image, &self.next));
        self.orthogonalise()?;
        Ok(true)
    }

    /// The basis so far, `n × steps`.
    pub(super) fn into_basis(self) -> Vec<f64> {
        self.v
    }

    /// The `count` modes of lowest frequency in the space; fewer when it is exhausted before.
    ///
    /// A singular M leaves components in the vectors that it cannot see: one more application of A purifies the modes.
    ///
    /// # Errors
    /// Those of the operator, and a space that grows beyond five times the modes without convergence.
    pub(super) fn lowest_modes(mut self, count: usize) -> Result<Vec<f64>, ReductionError> {
        let n = self.next.len();
        let limit = n.min(5 * count + 60);
        loop {
            let grown = self.alpha.len() < limit && self.grow()?;
            let steps = self.alpha.len();
            if grown && (steps <= count || !steps.is_multiple_of(LOOK)) {
                continue;
            }
            let t = DMatrix::from_fn(steps, steps, |i, j| match i.abs_diff(j) {
                0 => self.alpha[i],
                1 => self.beta[i.min(j)],
                _ => 0.0,
            });
            let eigen = SymmetricEigen::new(t);
            let mut order: Vec<usize> = (0..steps).filter(|i| eigen.eigenvalues[*i] > 0.0).collect();
            order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
            order.truncate(count);
            let residual = |i: usize| self.length * eigen.eigenvectors[(steps - 1, i)].abs() / eigen.eigenvalues[i];
            if !self.exhausted && order.iter().any(|i| residual(*i) > TOLERANCE) {
                if grown {
                    continue;
                }
                return Err(ReductionError(format!(
                    "{count} modes did not converge in a Krylov space of {limit} vectors: ask for fewer"
                )));
            }
            let mut modes = vec![0.0; n * order.len()];
            for (i, mode) in order.iter().zip(modes.chunks_exact_mut(n)) {
                for (s, mv) in eigen.eigenvectors.column(*i).iter().zip(self.mv.chunks_exact(n)) {
                    axpy(*s / eigen.eigenvalues[*i], mv, mode);
                }
            }
            (self.inverse)(self.structure, &mut modes)?;
            return Ok(modes);
        }
    }
}
