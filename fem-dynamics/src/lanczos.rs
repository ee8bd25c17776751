//! Block Lanczos iteration in the metric of M.

use crate::vector::{axpy, dot};
use fem_core::structure::{SolveError, Structure};
use nalgebra::{DMatrix, SymmetricEigen};
use std::collections::VecDeque;

/// Relative residual at which a mode counts as found; its frequency is then good to about the square of it.
const TOLERANCE: f64 = 1e-7;

/// A direction shorter than this fraction of what it was before orthogonalisation counts as zero.
const EXHAUSTED: f64 = 1e-10;

/// Sweeps after which a direction that is still not orthogonal is rounding alone.
const SWEEPS: usize = 4;

/// Vectors between two looks at the convergence.
const LOOK: usize = 8;

/// The Krylov space {X, A X, A² X, …} of the operator A = S M, S symmetric (an inverse stiffness), with an M-orthonormal
/// basis V: full reorthogonalisation, twice, which is enough (Parlett).
///
/// Vectors join one by one. The block form (X of several columns) finds a frequency as often as X has columns, and what
/// any one of them excites.
pub(crate) struct Lanczos<'a, S> {
    structure: &'a mut dyn Structure,
    inverse: S,
    n: usize,
    v: Vec<f64>,
    /// M V.
    mv: Vec<f64>,
    /// T = Vᵀ M A V: the upper triangle by columns.
    t: Vec<Vec<f64>>,
    /// Vectors that come from the start; they are the first.
    starts: usize,
    /// What may join next.
    ahead: VecDeque<Direction>,
}

struct Direction {
    x: Vec<f64>,
    /// Square of the length that orthogonalisation has taken so far.
    taken: f64,
    /// The basis vector whose image under A it is a part of; none for the start.
    of: Option<usize>,
}

impl<'a, S> Lanczos<'a, S>
where
    S: FnMut(&mut dyn Structure, &mut [f64]) -> Result<(), SolveError>,
{
    /// Starts from the columns of `start`; `inverse` applies S to any number of columns.
    pub(crate) fn new(structure: &'a mut dyn Structure, inverse: S, start: &[f64]) -> Self {
        let n = structure.ndof();
        let (v, mv, t, ahead) = (Vec::new(), Vec::new(), Vec::new(), VecDeque::new());
        let mut lanczos = Self { structure, inverse, n, v, mv, t, starts: 0, ahead };
        for x in start.chunks_exact(n.max(1)) {
            lanczos.queue(x.to_vec(), None);
        }
        lanczos
    }

    /// Starts from A X: a start that is free of what M cannot see.
    ///
    /// # Errors
    /// Those of the operator.
    pub(crate) fn excited(structure: &'a mut dyn Structure, mut inverse: S, x: &[f64]) -> Result<Self, SolveError> {
        let mut start = vec![0.0; x.len()];
        structure.add_mass(1.0, x, &mut start);
        inverse(structure, &mut start)?;
        Ok(Self::new(structure, inverse, &start))
    }

    fn size(&self) -> usize {
        self.t.len()
    }

    fn queue(&mut self, x: Vec<f64>, of: Option<usize>) {
        let mut direction = Direction { x, taken: 0.0, of };
        let shares = self.sweep(&mut direction);
        if of.is_some() {
            self.t.push(shares);
        }
        self.ahead.push_back(direction);
    }

    /// Takes from `direction` its shares in the basis, and returns them.
    fn sweep(&self, direction: &mut Direction) -> Vec<f64> {
        let basis = self.v.chunks_exact(self.n.max(1)).zip(self.mv.chunks_exact(self.n.max(1)));
        let take = |(v, mv): (&[f64], &[f64])| {
            let share = dot(mv, &direction.x);
            axpy(-share, v, &mut direction.x);
            share
        };
        let shares: Vec<f64> = basis.map(take).collect();
        direction.taken += dot(&shares, &shares);
        shares
    }

    /// M x of a direction without its shares in the basis, and its length; none where nothing is left.
    fn remainder(&self, direction: &mut Direction) -> Result<Option<(Vec<f64>, f64)>, SolveError> {
        for _ in 0..SWEEPS {
            let shares = self.sweep(direction);
            let mut image = vec![0.0; self.n];
            self.structure.add_mass(1.0, &direction.x, &mut image);
            let square = dot(&direction.x, &image);
            if !square.is_finite() {
                return Err(SolveError::ModesNotFinite);
            }
            if square <= EXHAUSTED * EXHAUSTED * direction.taken {
                break;
            }
            // Where this sweep took more than it left, rounding of what it took shows in the rest.
            if dot(&shares, &shares) <= square {
                return Ok((square > 0.0).then(|| (image, square.sqrt())));
            }
        }
        Ok(None)
    }

    /// Adds one vector to the basis; `false` when the space is exhausted.
    ///
    /// # Errors
    /// Those of the operator, and numbers that are not finite.
    pub(crate) fn grow(&mut self) -> Result<bool, SolveError> {
        while let Some(mut direction) = self.ahead.pop_front() {
            let Some((mut x, length)) = self.remainder(&mut direction)? else { continue };
            x.iter_mut().for_each(|x| *x /= length);
            self.v.extend(direction.x.iter().map(|x| x / length));
            self.mv.extend_from_slice(&x);
            (self.inverse)(self.structure, &mut x)?;
            self.starts += usize::from(direction.of.is_none());
            self.queue(x, Some(self.size()));
            return Ok(true);
        }
        Ok(false)
    }

    /// The basis so far, `n × vectors`.
    pub(crate) fn into_basis(self) -> Vec<f64> {
        self.v
    }

    /// The `count` modes of lowest frequency in the space, fewer when it is exhausted before: eigenvalues of A, largest
    /// first, and shapes, `n × modes`, of no particular length.
    ///
    /// Modes with less than `share` of their length in the start are left out. Rounding lets modes in that the start does
    /// not excite at all; a share of 0 takes these as well.
    ///
    /// A singular M leaves components in the vectors that it cannot see: one more application of A purifies the modes.
    ///
    /// # Errors
    /// Those of the operator, numbers that are not finite, and a space that grows without convergence.
    pub(crate) fn lowest(self, count: usize, share: f64) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        self.find(count, share, |theta| theta)
    }

    /// The same of the eigenvalues of largest `rank`, among those of positive rank, whatever the start excites.
    ///
    /// # Errors
    /// As [`Lanczos::lowest`].
    pub(crate) fn largest(self, count: usize, rank: fn(f64) -> f64) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        self.find(count, 0.0, rank)
    }

    fn find(mut self, count: usize, share: f64, rank: fn(f64) -> f64) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        let limit = self.n.min(count.saturating_mul(5).saturating_add(80));
        loop {
            let grown = self.size() < limit && self.grow()?;
            let size = self.size();
            if grown && (size <= count || !size.is_multiple_of(LOOK)) {
                continue;
            }
            if count == 0 || size == 0 {
                return Ok((Vec::new(), Vec::new()));
            }
            let eigen = SymmetricEigen::new(DMatrix::from_fn(size, size, |i, j| self.t[i.max(j)][i.min(j)]));
            let excited = |i: usize| eigen.eigenvectors.view((0, i), (self.starts, 1)).norm() >= share;
            let rank = |i: usize| rank(eigen.eigenvalues[i]);
            let mut order: Vec<usize> = (0..size).filter(|i| rank(*i) > 0.0 && excited(*i)).collect();
            order.sort_by(|a, b| rank(*b).total_cmp(&rank(*a)));
            order.truncate(count);
            let beyond = self.beyond()?;
            let residual = |i: usize| {
                let share = |of: usize| eigen.eigenvectors[(of, i)].abs();
                let parts = beyond.iter().map(|(of, length)| of.map_or(f64::INFINITY, share) * length);
                parts.sum::<f64>() / rank(i)
            };
            let whole = size == self.n || beyond.is_empty();
            if whole || order.len() == count && order.iter().all(|i| residual(*i) <= TOLERANCE) {
                let theta: Vec<f64> = order.iter().map(|i| eigen.eigenvalues[*i]).collect();
                let mut shapes = vec![0.0; self.n * order.len()];
                for ((i, theta), shape) in order.iter().zip(&theta).zip(shapes.chunks_exact_mut(self.n)) {
                    for (s, mv) in eigen.eigenvectors.column(*i).iter().zip(self.mv.chunks_exact(self.n)) {
                        axpy(s / theta, mv, shape);
                    }
                }
                (self.inverse)(self.structure, &mut shapes)?;
                return Ok((theta, shapes));
            }
            if !grown {
                return Err(SolveError::ModesNotConverged { count, vectors: size });
            }
        }
    }

    /// How far what is ahead leads out of the space: the basis vector whose image it belongs to, and its length.
    fn beyond(&mut self) -> Result<Vec<(Option<usize>, f64)>, SolveError> {
        let mut beyond = Vec::new();
        for mut direction in std::mem::take(&mut self.ahead) {
            if let Some((_, length)) = self.remainder(&mut direction)? {
                beyond.push((direction.of, length));
                self.ahead.push_back(direction);
            }
        }
        Ok(beyond)
    }
}
