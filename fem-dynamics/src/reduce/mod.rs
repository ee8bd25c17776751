//! Reductions: each chooses a basis; projection and expansion are common ([`Reduced`]).

mod craig_bampton;
mod guyan;
mod krylov;
mod ritz;

pub use craig_bampton::CraigBampton;
pub use guyan::Guyan;
pub use ritz::Ritz;

use fem_core::reduction::{Functional, ReductionError};
use fem_core::structure::{SolveError, Structure};
use nalgebra::{Cholesky, DMatrix, Dyn, SymmetricEigen};

/// Modal masses below this fraction of the largest (at equal stiffness) count as none: the mode follows statically.
const MASSLESS: f64 = 1e-13;

/// A structure in the coordinates in which its K and M are diagonal.
///
/// A mode with inertia is scaled to unit mass, so its stiffness is ω²; a mode without (from a singular M) to unit
/// stiffness and no mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Modal {
    stiffness: Vec<f64>,
    mass: Vec<f64>,
}

impl Modal {
    /// Circular frequencies, rad/s, ascending; infinite for modes without inertia.
    pub fn frequencies(&self) -> impl Iterator<Item = f64> + '_ {
        self.stiffness.iter().zip(&self.mass).map(|(k, m)| if *m > 0.0 { k.sqrt() } else { f64::INFINITY })
    }
}

impl Structure for Modal {
    fn ndof(&self) -> usize {
        self.stiffness.len()
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        for ((y, k), x) in y.iter_mut().zip(&self.stiffness).zip(x) {
            *y += scale * k * x;
        }
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        for ((y, m), x) in y.iter_mut().zip(&self.mass).zip(x) {
            *y += scale * m * x;
        }
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        for column in x.chunks_exact_mut(self.stiffness.len()).take(columns) {
            for ((x, k), m) in column.iter_mut().zip(&self.stiffness).zip(&self.mass) {
                *x /= k + shift * m;
            }
        }
        Ok(())
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        for (i, (x, m)) in x.iter_mut().zip(&self.mass).enumerate() {
            if *m == 0.0 {
                return Err(SolveError(format!("mode {} of the reduced structure has no inertia", i + 1)));
            }
            *x /= m;
        }
        Ok(())
    }

    fn highest_frequency(&mut self) -> Result<f64, SolveError> {
        Ok(self.frequencies().fold(0.0, f64::max))
    }
}

/// A reduced structure and the way back, u = Φ q.
#[derive(Debug, Clone, PartialEq)]
pub struct Reduced {
    /// The structure in modal coordinates.
    pub modal: Modal,
    /// Φ, `ndof × modes`, column-major, modes by frequency.
    pub basis: Vec<f64>,
    ndof: usize,
}

impl Reduced {
    /// Projects `structure` on the columns of `basis` (`ndof × m`) and diagonalises: TᵀKT, TᵀMT.
    ///
    /// The small eigenproblem is solved in the metric of K, which is definite where M need not be.
    ///
    /// # Errors
    /// Columns that depend on each other, or numbers that are not finite.
    pub fn project(structure: &dyn Structure, basis: &[f64]) -> Result<Self, ReductionError> {
        let n = structure.ndof();
        let m = basis.len() / n.max(1);
        let t = DMatrix::from_column_slice(n, m, basis);
        let product = |add: &dyn Fn(&[f64], &mut [f64])| {
            let mut image = DMatrix::zeros(n, m);
            for (x, y) in basis.chunks_exact(n).zip(image.as_mut_slice().chunks_exact_mut(n)) {
                add(x, y);
            }
            let product = t.transpose() * image;
            (&product + product.transpose()) * 0.5
        };
        let k = product(&|x, y| structure.add_stiffness(1.0, x, y));
        let mass = product(&|x, y| structure.add_mass(1.0, x, y));
        if !k.iter().chain(mass.iter()).all(|v| v.is_finite()) {
            return Err(ReductionError("the reduced matrices are not finite".into()));
        }
        let l = definite(k, "the reduced stiffness")?.unpack();
        let singular = || ReductionError("the reduced stiffness is singular".into());
        let half = l.solve_lower_triangular(&mass).ok_or_else(singular)?;
        let inner = l.solve_lower_triangular(&half.transpose()).ok_or_else(singular)?;
        // 1/ω² and the modes in the metric of K.
        let eigen = SymmetricEigen::new((&inner + inner.transpose()) * 0.5);
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        let largest = eigen.eigenvalues.iter().fold(0.0_f64, |a, b| a.max(*b));
        let mut vectors = DMatrix::zeros(m, m);
        let mut modal = Modal { stiffness: Vec::with_capacity(m), mass: Vec::with_capacity(m) };
        for (to, from) in order.into_iter().enumerate() {
            let inverse = eigen.eigenvalues[from];
            let mut column = eigen.eigenvectors.column(from).into_owned();
            // The sign of an eigenvector is nobody's: make its largest entry positive.
            let top = column.iter().fold(0.0_f64, |a, b| if b.abs() > a.abs() { *b } else { a });
            let mut scale = top.signum();
            if inverse > MASSLESS * largest {
                scale /= inverse.sqrt();
                modal.stiffness.push(1.0 / inverse);
                modal.mass.push(1.0);
            } else {
                modal.stiffness.push(1.0);
                modal.mass.push(0.0);
            }
            column *= scale;
            vectors.set_column(to, &column);
        }
        let back = l.transpose().solve_upper_triangular(&vectors).ok_or_else(singular)?;
        let basis = (t * back).as_slice().to_vec();
        Ok(Self { modal, basis, ndof: n })
    }

    /// A functional of u in modal coordinates: Φᵀ w.
    pub fn restrict(&self, w: &Functional) -> Vec<f64> {
        self.basis.chunks_exact(self.ndof).map(|mode| w.of(mode)).collect()
    }

    /// `u = Φ q`.
    pub fn expand(&self, q: &[f64], u: &mut [f64]) {
        u.fill(0.0);
        for (q, column) in q.iter().zip(self.basis.chunks_exact(u.len())) {
            for (u, c) in u.iter_mut().zip(column) {
                *u += q * c;
            }
        }
    }
}

/// `X ← K⁻¹ X`.
fn solve(structure: &mut dyn Structure, x: &mut [f64]) -> Result<(), ReductionError> {
    let columns = x.len() / structure.ndof().max(1);
    structure.solve_shifted(0.0, x, columns).map_err(|e| ReductionError(e.0))
}

fn definite(a: DMatrix<f64>, what: &str) -> Result<Cholesky<f64, Dyn>, ReductionError> {
    Cholesky::new(a).ok_or_else(|| {
        ReductionError(format!("{what} is not positive definite: some of the governors depend on each other"))
    })
}

/// The static shapes for unit values of functionals: T = X S⁻¹ with X = K⁻¹ E and S = Eᵀ X.
///
/// For unit vectors E these are Guyan's (eq. 28); for a weighted mean they condense on the mean.
#[derive(Debug)]
struct StaticShapes {
    /// X, `n × functionals`.
    flexibility: Vec<f64>,
    /// S.
    factor: Cholesky<f64, Dyn>,
}

impl StaticShapes {
    fn new(structure: &mut dyn Structure, functionals: &[Functional]) -> Result<Self, ReductionError> {
        let n = structure.ndof();
        let mut x = vec![0.0; n * functionals.len()];
        for (w, column) in functionals.iter().zip(x.chunks_exact_mut(n)) {
            w.add_to(1.0, column);
        }
        solve(structure, &mut x)?;
        let s =
            DMatrix::from_fn(functionals.len(), functionals.len(), |i, j| functionals[i].of(&x[j * n..(j + 1) * n]));
        let factor = definite((&s + s.transpose()) * 0.5, "the flexibility at the governors")?;
        Ok(Self { flexibility: x, factor })
    }

    /// T.
    fn shapes(&self) -> Vec<f64> {
        let m = self.factor.l_dirty().nrows();
        let x = DMatrix::from_column_slice(self.flexibility.len() / m, m, &self.flexibility);
        (x * self.factor.inverse()).as_slice().to_vec()
    }

    /// `x ← x − X S⁻¹ Eᵀ x`: what remains of a displacement when the functionals are held at zero under forces at them.
    fn hold(&self, functionals: &[Functional], x: &mut [f64]) {
        let n = x.len();
        let reactions = self
            .factor
            .solve(&nalgebra::DVector::from_iterator(functionals.len(), functionals.iter().map(|w| w.of(x))));
        for (r, column) in reactions.iter().zip(self.flexibility.chunks_exact(n)) {
            for (x, c) in x.iter_mut().zip(column) {
                *x -= r * c;
            }
        }
    }
}
