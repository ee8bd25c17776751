//! Reductions and modes of chains and of random matrices, against closed forms and the unreduced structure.
#![allow(clippy::unwrap_used, clippy::panic)]

mod bounds;
mod damping;
mod frequencies;
mod governors;
mod impact;
mod stages;
mod statics;

use fem_core::functional::Functional;
use fem_core::plugin::{Built, Params, Plugin, Value};
use fem_core::reduction::{Reduction, ReductionError};
use fem_core::structure::{SolveError, Structure};
use fem_dynamics::reduce::{CraigBampton, Guyan, Irs, ModalTruncation, Ritz};
use nalgebra::{Cholesky, DMatrix, DVectorView, DVectorViewMut, Dyn};

/// K and M as full matrices.
#[derive(Debug, Clone)]
struct Dense {
    k: DMatrix<f64>,
    m: DMatrix<f64>,
    factor: Option<(f64, Cholesky<f64, Dyn>)>,
    solves: u64,
}

impl Dense {
    fn new(k: DMatrix<f64>, m: DMatrix<f64>) -> Self {
        Self { k, m, factor: None, solves: 0 }
    }

    /// Springs `k` between masses `m` in a row, the first spring held at its far end, the last mass free.
    fn chain(masses: &[f64], k: f64) -> Self {
        let n = masses.len();
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 if i + 1 == n => k,
            0 => 2.0 * k,
            1 => -k,
            _ => 0.0,
        };
        Self::new(DMatrix::from_fn(n, n, entry), DMatrix::from_diagonal(&masses.to_vec().into()))
    }

    /// `TᵀKT` and `TᵀMT`.
    fn condensed(&self, t: &DMatrix<f64>) -> Self {
        Self::new(t.transpose() * &self.k * t, t.transpose() * &self.m * t)
    }
}

/// `Y ← Y + scale · A X`, column by column.
fn add_product(a: &DMatrix<f64>, scale: f64, x: &[f64], y: &mut [f64]) {
    let n = a.nrows();
    for (x, y) in x.chunks_exact(n).zip(y.chunks_exact_mut(n)) {
        DVectorViewMut::from_slice(y, n).gemv(scale, a, &DVectorView::from_slice(x, n), 1.0);
    }
}

impl Structure for Dense {
    fn ndof(&self) -> usize {
        self.k.nrows()
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        add_product(&self.k, scale, x, y);
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        add_product(&self.m, scale, x, y);
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        if self.factor.as_ref().is_none_or(|(s, _)| *s != shift) {
            let factor = Cholesky::new(&self.k + &self.m * shift).ok_or(SolveError::other("not held"))?;
            self.factor = Some((shift, factor));
        }
        let (_, factor) = self.factor.as_ref().unwrap();
        for column in x.chunks_exact_mut(self.k.nrows()).take(columns) {
            let n = column.len();
            factor.solve_mut(&mut DVectorViewMut::from_slice(column, n));
        }
        self.solves += columns as u64;
        Ok(())
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        let factor = Cholesky::new(self.m.clone()).ok_or(SolveError::other("no inertia"))?;
        let n = x.len();
        factor.solve_mut(&mut DVectorViewMut::from_slice(x, n));
        Ok(())
    }
}

/// Symmetric positive definite, of eigenvalues from 1 to about `n`², the same every time.
fn random_definite(n: usize, seed: usize) -> DMatrix<f64> {
    let mut state = seed as u64 + 1;
    let a = DMatrix::from_fn(n, n, |_, _| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    });
    &a * a.transpose() * 12.0 + DMatrix::identity(n, n)
}

fn built<P: Plugin>(params: &Params) -> Box<dyn Reduction> {
    match P::build(params) {
        Ok(Built::Reduction(reduction)) => reduction,
        other => panic!("{other:?}"),
    }
}

/// The reduction `name` with `count` governors, modes or vectors.
fn reduction(name: &str, count: usize) -> Box<dyn Reduction> {
    let with = |key: &str| Params::default().with(key, Value::Number(count as f64));
    match name {
        "guyan" => built::<Guyan>(&with("governors")),
        "guyan-ratio" => built::<Guyan>(&with("governors").with("select", Value::Text("ratio".into()))),
        "irs" => built::<Irs>(&with("governors")),
        "modal" => built::<ModalTruncation>(&with("modes")),
        "craig-bampton" => built::<CraigBampton>(&with("modes")),
        "ritz" => built::<Ritz>(&with("vectors")),
        _ => panic!("{name}"),
    }
}

/// The basis as a matrix.
fn basis(
    reduction: &dyn Reduction,
    structure: &mut Dense,
    keep: &[Functional],
    candidates: &[usize],
) -> Result<DMatrix<f64>, ReductionError> {
    let n = structure.ndof();
    reduction.basis(structure, keep, candidates).map(|t| DMatrix::from_column_slice(n, t.len() / n, &t))
}

/// Unknowns of a chain of `n`, each as far as possible from those before it (bisection).
fn spread(n: usize) -> Vec<usize> {
    let mut dofs = Vec::new();
    let mut parts = n.next_power_of_two();
    while parts > 1 {
        parts /= 2;
        dofs.extend((parts..n).step_by(2 * parts));
    }
    dofs.push(0);
    dofs
}
