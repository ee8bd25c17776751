//! Reductions: each chooses a basis; projection and expansion are common ([`Reduced`]).

mod craig_bampton;
mod diagonal;
mod directions;
mod forms;
mod governors;
mod guyan;
mod irs;
mod membrane;
mod modal;
mod motions;
mod restored;
mod ritz;
mod stretched;

pub use craig_bampton::CraigBampton;
pub use diagonal::Modal;
pub use guyan::Guyan;
pub use irs::Irs;
pub use membrane::{Companions, Followers, MembraneForms, MembranePlate, TensionPatterns};
pub use modal::ModalTruncation;
pub use ritz::Ritz;
pub use stretched::{Share, Stretch, StretchedPlate};

use fem_core::functional::Functional;
use fem_core::reduction::ReductionError;
use fem_core::structure::{SolveError, Structure};
use fem_core::vectorised::add_columns;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, SymmetricEigen};
use pulp::{Arch, Simd, WithSimd};

/// Modal masses below this fraction of the largest (at equal stiffness) count as none: the mode follows statically.
const MASSLESS: f64 = 1e-13;

/// A vector of a basis counts as a combination of those before it when this share of its energy is left.
const DEPENDENT: f64 = 1e-12;

/// The same where rounding of the matrix is larger, as of many springs that are stiff beside what is between them.
const ROUNDED: [f64; 3] = [1e-10, 1e-8, 1e-6];

/// Least share of a mode in the static responses to the contacts; with less, no contact excites it.
const EXCITED: f64 = 1e-9;

/// Vectors of the largest basis that is made: dense matrices beyond that cost more than the sparse ones they replace.
const LARGEST: usize = 2000;

/// Rows of Φ that serve all fields before the next ones are read.
const ROWS: usize = 512;

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
    /// Projects `structure` on its free motions and the columns of `basis` (`ndof × m`) and diagonalises: TᵀKT, TᵀMT.
    ///
    /// The small eigenproblem is solved in the metric of K, which is definite where M need not be. Columns that depend on
    /// those before them are left out.
    ///
    /// # Errors
    /// No columns, a stiffness that is not definite on them, or numbers that are not finite.
    pub fn project(structure: &dyn Structure, basis: &[f64]) -> Result<Self, ReductionError> {
        Self::project_loaded(structure, basis, &[])
    }

    /// The same where the first columns of `basis` are the responses at rest to `forces`, which need not be in balance on a structure
    /// that moves: only the other columns are multiplied by K.
    ///
    /// # Errors
    /// As [`Reduced::project`].
    pub fn project_loaded(structure: &dyn Structure, basis: &[f64], forces: &[f64]) -> Result<Self, ReductionError> {
        let n = structure.ndof();
        let m = basis.len() / n.max(1);
        if m == 0 {
            return Err(ReductionError::NoVectors);
        }
        let free = DMatrix::from_column_slice(n, structure.free_motions().len() / n, structure.free_motions());
        let mut t = DMatrix::from_column_slice(n, m, basis);
        part_from(&free, structure, &mut t);
        let product = |known: &[f64], add: &dyn Fn(&[f64], &mut [f64])| {
            let mut image = DMatrix::zeros(n, m);
            let (front, rest) = image.as_mut_slice().split_at_mut(known.len());
            front.copy_from_slice(known);
            add(&t.as_slice()[known.len()..], rest);
            let product = t.transpose() * image;
            (&product + product.transpose()) * 0.5
        };
        // Motions as a whole, of which the columns are free, feel no force of a balanced load nor of what balances it.
        let k = product(forces, &|x, y| structure.add_stiffness(1.0, x, y));
        let mass = product(&[], &|x, y| structure.add_mass(1.0, x, y));
        Self::diagonalise(&free, t, k, mass)
    }

    /// `structure`, of which this is a reduction, on the columns of `more` as well (`ndof × any`): only these are multiplied by K
    /// and M.
    ///
    /// # Errors
    /// As [`Reduced::project`].
    pub fn with(&self, structure: &dyn Structure, more: &[f64]) -> Result<Self, ReductionError> {
        let (n, moves) = (self.ndof, structure.free_motions().len() / self.ndof);
        let free = DMatrix::from_column_slice(n, moves, structure.free_motions());
        let mut added = DMatrix::from_column_slice(n, more.len() / n, more);
        part_from(&free, structure, &mut added);
        let modes = self.modal.ndof() - moves;
        let mut t = DMatrix::from_column_slice(n, modes, &self.basis[n * moves..])
            .resize_horizontally(modes + added.ncols(), 0.0);
        t.columns_mut(modes, added.ncols()).copy_from(&added);
        let product = |known: &[f64], add: &dyn Fn(&[f64], &mut [f64])| {
            let mut image = DMatrix::zeros(n, added.ncols());
            add(added.as_slice(), image.as_mut_slice());
            let beside = t.tr_mul(&image);
            let mut product = DMatrix::zeros(t.ncols(), t.ncols());
            product.view_mut((0, 0), (modes, modes)).set_partial_diagonal(known.iter().copied());
            product.columns_mut(modes, added.ncols()).copy_from(&beside);
            product.rows_mut(modes, added.ncols()).copy_from(&beside.transpose());
            product
        };
        let k = product(&self.modal.stiffness[moves..], &|x, y| structure.add_stiffness(1.0, x, y));
        let mass = product(&self.modal.mass[moves..], &|x, y| structure.add_mass(1.0, x, y));
        Self::diagonalise(&free, t, k, mass)
    }

    /// The structure on its motions `free` and on the columns of `t`, whose Gram matrices in K and M are given.
    fn diagonalise(
        free: &DMatrix<f64>,
        t: DMatrix<f64>,
        k: DMatrix<f64>,
        mass: DMatrix<f64>,
    ) -> Result<Self, ReductionError> {
        if !k.iter().chain(mass.iter()).all(|v| v.is_finite()) {
            return Err(ReductionError::NotFinite("a reduced matrix"));
        }
        let only = |a: &DMatrix<f64>, kept: &[usize]| a.select_rows(kept).select_columns(kept);
        let definite = |least: f64| {
            let kept = independent(&k, least);
            Cholesky::new(only(&k, &kept)).map(|factor| (kept, factor.unpack()))
        };
        let found = [DEPENDENT].into_iter().chain(ROUNDED).find_map(definite);
        let (kept, l) = found.ok_or(ReductionError::SingularStiffness)?;
        let m = kept.len();
        let (mass, t) = if m == t.ncols() { (mass, t) } else { (only(&mass, &kept), t.select_columns(&kept)) };
        let half = l.solve_lower_triangular(&mass).ok_or(ReductionError::SingularStiffness)?;
        let inner = l.solve_lower_triangular(&half.transpose()).ok_or(ReductionError::SingularStiffness)?;
        // 1/ω² and the modes in the metric of K.
        let eigen = SymmetricEigen::new((&inner + inner.transpose()) * 0.5);
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        let largest = eigen.eigenvalues.iter().fold(0.0_f64, |a, b| a.max(*b));
        let mut vectors = DMatrix::zeros(m, m);
        let moves = free.ncols();
        let mut modal = Modal { stiffness: vec![0.0; moves], mass: vec![1.0; moves], damping: Vec::new() };
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
        let back = l.transpose().solve_upper_triangular(&vectors).ok_or(ReductionError::SingularStiffness)?;
        let ndof = t.nrows();
        let basis = [free.as_slice(), (t * back).as_slice()].concat();
        Ok(Self { modal, basis, ndof })
    }

    /// The same without the modes above the circular frequency `omega`, rad/s.
    fn up_to(mut self, omega: f64) -> Self {
        let Modal { stiffness, mass, damping } = &mut self.modal;
        let slow = |(k, m): &(&f64, &f64)| **k <= omega * omega * **m;
        let kept = stiffness.iter().zip(&*mass).take_while(slow).count();
        stiffness.truncate(kept);
        mass.truncate(kept);
        damping.truncate(kept);
        self.basis.truncate(kept * self.ndof);
        self
    }

    /// A functional of u in modal coordinates: Φᵀ w.
    pub fn restrict(&self, w: &Functional) -> Vec<f64> {
        self.basis.chunks_exact(self.ndof).map(|mode| w.of(mode)).collect()
    }

    /// `u = Φ q` of one field, or of several, one after the other.
    pub fn expand(&self, q: &[f64], u: &mut [f64]) {
        let n = self.ndof.max(1);
        let modes = self.basis.len() / n;
        u.fill(0.0);
        Arch::new().dispatch(Expansion { basis: &self.basis, sizes: [n, modes.max(1)], q, u });
    }
}

/// `u ← u + Φ q`, by blocks of rows; `sizes` are those of a field and of its q.
struct Expansion<'a> {
    basis: &'a [f64],
    sizes: [usize; 2],
    q: &'a [f64],
    u: &'a mut [f64],
}

impl WithSimd for Expansion<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { basis, sizes: [n, modes], q, u } = self;
        for first in (0..n).step_by(ROWS) {
            for (q, u) in q.chunks_exact(modes).zip(u.chunks_exact_mut(n)) {
                let end = n.min(first + ROWS);
                add_columns(&basis[first..], n, q, &mut u[first..end]);
            }
        }
    }
}

/// Takes from the columns of `t` their shares in the motions `free` of the structure, in the metric of its M.
fn part_from(free: &DMatrix<f64>, structure: &dyn Structure, t: &mut DMatrix<f64>) {
    if !free.is_empty() {
        let mut momenta = DMatrix::zeros(free.nrows(), free.ncols());
        structure.add_mass(1.0, free.as_slice(), momenta.as_mut_slice());
        *t -= free * momenta.tr_mul(t);
    }
}

/// `X ← K⁻¹ X`.
fn solve(structure: &mut dyn Structure, x: &mut [f64]) -> Result<(), SolveError> {
    let columns = x.len() / structure.ndof().max(1);
    structure.solve_shifted(0.0, x, columns)
}

/// K⁻¹ P for the unit loads P of `functionals`, `n × functionals`: all that a structure without inertia can do under them.
///
/// # Errors
/// A structure that is not held.
pub fn static_responses(structure: &mut dyn Structure, functionals: &[Functional]) -> Result<Vec<f64>, ReductionError> {
    let n = structure.ndof();
    let mut x = vec![0.0; n * functionals.len()];
    for (w, column) in functionals.iter().zip(x.chunks_exact_mut(n.max(1))) {
        w.add_to(1.0, column);
    }
    solve(structure, &mut x)?;
    Ok(x)
}

/// As many of `asked` vectors as the structure has room for beside `others`.
///
/// # Errors
/// More than [`LARGEST`] of them.
fn columns(structure: &dyn Structure, asked: usize, others: usize) -> Result<usize, ReductionError> {
    let n = structure.ndof();
    let columns = asked.min(n.saturating_sub(others));
    if columns > LARGEST {
        return Err(ReductionError::TooManyVectors { asked, largest: LARGEST, unknowns: n });
    }
    Ok(columns)
}

/// Columns that do not depend on those before them, by a share of at least `least`, of a basis with the Gram matrix `gram`.
fn independent(gram: &DMatrix<f64>, least: f64) -> Vec<usize> {
    shares(gram, least).into_iter().enumerate().filter(|(_, share)| *share > least).map(|(j, _)| j).collect()
}

/// How much of each column is left beside those before it, those left out of which no more than `least` is.
fn shares(gram: &DMatrix<f64>, least: f64) -> Vec<f64> {
    let mut kept: Vec<usize> = Vec::new();
    // Rows of the Cholesky factor of the columns kept.
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let column = |j: usize| {
        let mut row: Vec<f64> = Vec::with_capacity(kept.len() + 1);
        for (i, other) in kept.iter().zip(&rows) {
            let known: f64 = row.iter().zip(other).map(|(a, b)| a * b).sum();
            row.push((gram[(*i, j)] - known) / other[row.len()]);
        }
        let left = gram[(j, j)] - row.iter().map(|x| x * x).sum::<f64>();
        if left > least * gram[(j, j)] {
            row.push(left.sqrt());
            rows.push(row);
            kept.push(j);
        }
        left / gram[(j, j)]
    };
    (0..gram.ncols()).map(column).collect()
}

/// Functionals whose values follow from those before them, to rounding; empty where there are none at all.
#[derive(Debug)]
struct Dependent {
    functionals: Vec<Functional>,
}

impl Dependent {
    fn find(functionals: &[Functional], gram: &DMatrix<f64>) -> Self {
        let kept = independent(gram, DEPENDENT);
        let dependent = functionals.iter().enumerate().filter(|(i, _)| !kept.contains(i));
        Self { functionals: dependent.map(|(_, w)| w.clone()).collect() }
    }

    fn named(&self, structure: &dyn Structure) -> ReductionError {
        let name = |w: &Functional| match w.0[..] {
            [(i, _)] => structure.name(i),
            _ => "the deflection under a contact".into(),
        };
        let names: Vec<String> = self.functionals.iter().map(name).collect();
        match names.is_empty() {
            true => ReductionError::NoGovernors,
            false => ReductionError::DependentGovernors { names },
        }
    }
}

/// S: values of functionals under the loads with the responses `x`.
fn flexibility(functionals: &[Functional], x: &[f64]) -> DMatrix<f64> {
    let m = functionals.len();
    let n = x.len() / m.max(1);
    let s = DMatrix::from_fn(m, m, |i, j| functionals[i].of(&x[j * n..(j + 1) * n]));
    (&s + s.transpose()) * 0.5
}

/// The static shapes for unit values of functionals: T = X S⁻¹ with X = K⁻¹ E and S = Eᵀ X.
///
/// For unit vectors E these are Guyan's (eq. 28); for a weighted mean they condense on the mean.
#[derive(Debug)]
struct StaticShapes {
    functionals: Vec<Functional>,
    /// X, `n × functionals`.
    flexibility: Vec<f64>,
    /// S.
    factor: Cholesky<f64, Dyn>,
}

impl StaticShapes {
    fn new(structure: &mut dyn Structure, functionals: Vec<Functional>) -> Result<Self, ReductionError> {
        let flexibility = static_responses(structure, &functionals)?;
        Self::of(functionals, flexibility).map_err(|dependent| dependent.named(structure))
    }

    fn of(functionals: Vec<Functional>, x: Vec<f64>) -> Result<Self, Dependent> {
        let s = flexibility(&functionals, &x);
        // Where S is that near to singular, its inverse, K* and M* hold no digit.
        let dependent = Dependent::find(&functionals, &s);
        match Cholesky::new(s).filter(|_| !functionals.is_empty() && dependent.functionals.is_empty()) {
            Some(factor) => Ok(Self { functionals, flexibility: x, factor }),
            None => Err(dependent),
        }
    }

    /// The same for those that do not follow from the ones before them, at least `least` of them.
    fn of_independent(
        structure: &mut dyn Structure,
        functionals: Vec<Functional>,
        least: usize,
    ) -> Result<Self, ReductionError> {
        let x = static_responses(structure, &functionals)?;
        let kept = independent(&flexibility(&functionals, &x), DEPENDENT);
        let shapes = if kept.len() < least { Self::of(functionals, x) } else { Self::some(&functionals, &x, &kept) };
        shapes.map_err(|dependent| dependent.named(structure))
    }

    fn some(functionals: &[Functional], x: &[f64], chosen: &[usize]) -> Result<Self, Dependent> {
        let n = x.len() / functionals.len();
        let x = chosen.iter().flat_map(|i| &x[i * n..(i + 1) * n]).copied().collect();
        Self::of(chosen.iter().map(|i| functionals[*i].clone()).collect(), x)
    }

    /// Refuses functionals that follow from those before them in `gram`, a matrix condensed on them.
    fn check_independence(&self, gram: &DMatrix<f64>) -> Result<(), Dependent> {
        let dependent = Dependent::find(&self.functionals, gram);
        if dependent.functionals.is_empty() { Ok(()) } else { Err(dependent) }
    }

    /// The functional of which least is left beside those before it.
    fn nearest(&self) -> Dependent {
        let shares = shares(&flexibility(&self.functionals, &self.flexibility), DEPENDENT);
        let least = (0..shares.len()).min_by(|i, j| shares[*i].total_cmp(&shares[*j]));
        Dependent { functionals: least.map(|i| self.functionals[i].clone()).into_iter().collect() }
    }

    /// The shapes for some of the functionals; the others are condensed.
    fn only(&self, chosen: &[usize]) -> Result<Self, Dependent> {
        Self::some(&self.functionals, &self.flexibility, chosen)
    }

    /// TᵀKT = S⁻¹ and TᵀMT.
    fn condensed(&self, structure: &dyn Structure) -> (DMatrix<f64>, DMatrix<f64>) {
        let m = self.functionals.len();
        let n = self.flexibility.len() / m;
        let x = DMatrix::from_column_slice(n, m, &self.flexibility);
        let mut image = DMatrix::zeros(n, m);
        structure.add_mass(1.0, &self.flexibility, image.as_mut_slice());
        let k = self.factor.inverse();
        let mass = &k * (x.transpose() * image) * &k;
        ((&k + k.transpose()) * 0.5, (&mass + mass.transpose()) * 0.5)
    }

    /// T.
    fn shapes(&self) -> Vec<f64> {
        let m = self.functionals.len();
        let x = DMatrix::from_column_slice(self.flexibility.len() / m, m, &self.flexibility);
        (x * self.factor.inverse()).as_slice().to_vec()
    }

    /// `x ← x − X S⁻¹ Eᵀ x`: what remains of a displacement when the functionals are held at zero under forces at them.
    fn hold(&self, x: &mut [f64]) {
        let n = x.len();
        let values = self.functionals.iter().map(|w| w.of(x));
        let reactions = self.factor.solve(&DVector::from_iterator(self.functionals.len(), values));
        for (r, column) in reactions.iter().zip(self.flexibility.chunks_exact(n)) {
            for (x, c) in x.iter_mut().zip(column) {
                *x -= r * c;
            }
        }
    }
}
