//! Structures that are free to move as a whole.

use super::Symmetric;
use crate::words::functional::Functional;
use nalgebra::{Cholesky, DMatrix, DMatrixView, DVectorViewMut, SymmetricEigen};

/// Energy of a motion over that of the diagonal of K below which it costs none: what rounding leaves, and less than the
/// softest foundation.
const NO_ENERGY: f64 = 1e-13;

/// Work of a load on a motion, relative, that is rounding.
const BALANCED: f64 = 1e-9;

/// Free motions of a structure, and springs by which its stiffness can be factorised.
///
/// As many springs as motions hold a structure determinately: under loads in balance they carry nothing, and which ones they
/// are changes a displacement by a free motion only.
#[derive(Debug, Clone, Default)]
pub(super) struct Released {
    /// R, `ndof × motions`; Rᵀ M R = 1 where there is inertia.
    motions: Vec<f64>,
    /// M R; empty without inertia.
    momenta: Vec<f64>,
    /// Unknowns, and the stiffness on each.
    springs: Vec<(usize, f64)>,
}

impl Released {
    /// Those of the given `motions` (`ndof × any`, column-major) that cost no energy.
    pub(super) fn new(k: &Symmetric, m: &Symmetric, motions: &[f64]) -> Self {
        if motions.is_empty() {
            return Self::default();
        }
        let n = k.ndof();
        let given = DMatrix::from_column_slice(n, motions.len() / n, motions);
        let image = |matrix: &Symmetric, of: &DMatrix<f64>| {
            let mut image = DMatrix::zeros(n, of.ncols());
            matrix.add_product(1.0, of.as_slice(), image.as_mut_slice());
            image
        };
        // In the metric of the diagonal of K translations and slopes compare.
        let weights: Vec<f64> = (0..n).map(|i| k.diagonal(i).max(0.0).sqrt()).collect();
        let weighted = |r: &DMatrix<f64>| DMatrix::from_fn(n, r.ncols(), |i, j| weights[i] * r[(i, j)]);
        let Some(r) = orthonormal(&given, weighted(&given).tr_mul(&weighted(&given))) else { return Self::default() };
        let energies = SymmetricEigen::new(r.tr_mul(&image(k, &r)));
        let free: Vec<usize> = (0..r.ncols()).filter(|j| energies.eigenvalues[*j] <= NO_ENERGY).collect();
        let r = r * energies.eigenvectors.select_columns(&free);
        let springs = springs(weighted(&r), &weights);
        let momenta = image(m, &r);
        let mass = r.tr_mul(&momenta);
        match orthonormal(&r, mass.clone()).zip(orthonormal(&momenta, mass)) {
            Some((r, momenta)) => {
                Self { motions: r.as_slice().to_vec(), momenta: momenta.as_slice().to_vec(), springs }
            }
            None => Self { motions: r.as_slice().to_vec(), momenta: Vec::new(), springs },
        }
    }

    /// R of a structure with inertia.
    pub(super) fn motions(&self) -> &[f64] {
        if self.momenta.is_empty() { &[] } else { &self.motions }
    }

    /// Whether a load does work on a free motion: beside what it would do on the motion that the diagonal of K lets it move most.
    pub(super) fn moves_under(&self, load: &Functional, k: &Symmetric) -> bool {
        let own: f64 = load.0.iter().map(|(i, w)| w * w / k.diagonal(*i)).sum();
        self.motions.chunks_exact(k.ndof().max(1)).any(|motion| {
            let size: f64 = motion.iter().enumerate().map(|(i, r)| k.diagonal(i) * r * r).sum();
            load.of(motion).powi(2) > BALANCED * BALANCED * own * size
        })
    }

    pub(super) fn springs(&self) -> &[(usize, f64)] {
        &self.springs
    }

    /// Takes from loads, `ndof × columns`, what accelerates the structure as a whole: Pᵀ x = x − M R Rᵀ x.
    pub(super) fn balance(&self, loads: &mut [f64], columns: usize) {
        subtract(&self.momenta, &self.motions, loads, columns);
    }

    /// Takes the free motions from displacements, `ndof × columns`: P x = x − R Rᵀ M x.
    pub(super) fn deform(&self, x: &mut [f64], columns: usize) {
        subtract(&self.motions, &self.momenta, x, columns);
    }
}

/// X ← X − A Bᵀ X.
fn subtract(a: &[f64], b: &[f64], x: &mut [f64], columns: usize) {
    if b.is_empty() || a.is_empty() || columns == 0 {
        return;
    }
    let n = x.len() / columns;
    let [a, b] = [a, b].map(|a| DMatrixView::from_slice(a, n, a.len() / n));
    for x in x.chunks_exact_mut(n) {
        let mut x = DVectorViewMut::from_slice(x, n);
        let shares = b.tr_mul(&x);
        x.gemv(-1.0, &a, &shares, 1.0);
    }
}

/// A L⁻ᵀ with L Lᵀ = `gram`; nothing where that is not definite.
fn orthonormal(a: &DMatrix<f64>, gram: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let l = Cholesky::new(gram)?.unpack();
    Some(l.solve_lower_triangular(&a.transpose())?.transpose())
}

/// One unknown for each motion, as stiff as its own diagonal: each the one that the motions not yet stopped move most, by
/// `rows` times the roots of the diagonal.
fn springs(mut rows: DMatrix<f64>, weights: &[f64]) -> Vec<(usize, f64)> {
    let mut chosen = Vec::new();
    for _ in 0..rows.ncols() {
        let size = |i: usize| rows.row(i).norm_squared();
        let Some(at) = (0..rows.nrows()).reduce(|a, b| if size(b) > size(a) { b } else { a }) else { break };
        let direction = rows.row(at).normalize();
        let along = &rows * direction.transpose();
        rows -= along * direction;
        chosen.push((at, weights[at] * weights[at]));
    }
    chosen
}
