//! Springs that only push, from which a structure lifts off.

use crate::vector::axpy;
use fem_core::functional::Functional;
use fem_core::structure::SolveError;
use fem_core::vectorised::{add_columns, add_rows, rows_times, vectorised};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::sync::Arc;

/// Turns of Newton's method, and halvings of its line search.
const MOST: usize = 100;
const HALVINGS: usize = 80;

/// What may be missing of the forces, relative to the largest of them: rounding, and where rounding keeps it from falling.
const ENOUGH: f64 = 1e-13;
const ROUNDED: f64 = 1e-9;

/// Slope of the potential at the end of a way, relative to that at its beginning, below which the way was long enough.
const FLAT: f64 = 0.1;

/// Numbers of the factors that are kept, if these are several: a plate that rattles comes back to the same few sets of springs.
const REMEMBERED: usize = 1 << 20;

/// Share of the springs that let go, where without them nothing would hold the structure.
const NEARLY: f64 = 1.0 - 1e-6;

/// What is said where nothing of a structure lies on its springs any more.
pub const LIFTED_OFF: &str =
    "the loads lift the plate off its one-sided supports: hold it otherwise, or turn the loads round";

/// A spring that only pushes; w = pᵀu > 0 where the structure has lifted off.
#[derive(Debug, Clone, PartialEq)]
pub struct OneSided {
    /// p.
    pub at: Functional,
    /// k, N/m.
    pub stiffness: f64,
}

/// One-sided springs of a structure in whose matrix A they are as if they pulled, too.
///
/// Those that have lifted are relieved of their pull by forces F = r(w), r(w) = k ⟨w⟩, ⟨w⟩ = max(w, 0):
///
/// ```text
/// w = b + G F,    G = Pᵀ A⁻¹ P,    b = Pᵀu without F
/// ```
///
/// That is where Π(F) = ½ Fᵀ G F − Σ ∫ r(b + G F) dw has its minimum, and Π is convex, for G ≤ diag(1/k). Newton's method with a line
/// search finds it: (1 − r′ G) d = r − F.
#[derive(Debug, Default)]
pub struct Lifting {
    springs: Arc<[OneSided]>,
    /// Pᵀ by rows, where each p has all unknowns, as those of a reduced structure have; otherwise nothing.
    rows: Vec<f64>,
    /// G.
    compliance: DMatrix<f64>,
    /// w of each where a step begins, of forces that are means over it.
    before: Option<Vec<f64>>,
    /// F of the last deflections of a step: those after them are near.
    forces: DVector<f64>,
    w: DVector<f64>,
    /// √r′ of each.
    roots: Vec<f64>,
    /// Factors of 1 − √r′ G √r′ of those that are not 0, and the roots that each is of, the last one that was used first.
    factors: Vec<(Vec<f64>, Cholesky<f64, Dyn>)>,
    turns: u64,
}

impl Lifting {
    /// `springs` under a structure.
    pub fn new(springs: Arc<[OneSided]>) -> Self {
        let n = springs.first().map_or(0, |spring| spring.at.0.len());
        let full = |spring: &OneSided| spring.at.0.len() == n && (0..).zip(&spring.at.0).all(|(i, (j, _))| i == *j);
        let rows = match springs.iter().all(full) {
            true => springs.iter().flat_map(|spring| spring.at.0.iter().map(|(_, p)| *p)).collect(),
            false => Vec::new(),
        };
        Self { springs, rows, ..Self::default() }
    }

    /// The springs.
    pub fn springs(&self) -> &Arc<[OneSided]> {
        &self.springs
    }

    /// Turns of Newton's method so far.
    pub fn turns(&self) -> u64 {
        self.turns
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.springs.is_empty()
    }

    /// Takes the matrix A of a structure of `n` unknowns, by `solve`, X ← A⁻¹ X.
    ///
    /// # Errors
    /// Those of `solve`.
    pub fn set(
        &mut self,
        n: usize,
        mut solve: impl FnMut(&mut [f64], usize) -> Result<(), SolveError>,
    ) -> Result<(), SolveError> {
        let count = self.springs.len();
        self.compliance = DMatrix::zeros(count, count);
        self.forces = DVector::zeros(count);
        self.factors.clear();
        let mut x = vec![0.0; n];
        for (j, spring) in self.springs.iter().enumerate() {
            x.fill(0.0);
            spring.at.add_to(1.0, &mut x);
            solve(&mut x, 1)?;
            let w = self.deflections(&x);
            self.compliance.column_mut(j).copy_from_slice(&w);
        }
        self.compliance = 0.5 * (&self.compliance + self.compliance.transpose());
        Ok(())
    }

    /// Has forces be means over steps that begin with the displacements `u`, or if there are none those at their ends.
    pub fn begin(&mut self, u: Option<&[f64]>) {
        self.before = u.map(|u| self.deflections(u));
        self.forces = DVector::zeros(self.springs.len());
    }

    /// Looks for F near to what it is at the deflections `w`: what is found in a step depends on no other step.
    pub fn expect(&mut self, w: &[f64]) {
        self.w = DVector::from_column_slice(w);
        self.forces = DVector::from_iterator(w.len(), self.laws(&self.w).map(|(force, _)| force));
    }

    /// Pᵀu.
    pub fn deflections(&self, u: &[f64]) -> Vec<f64> {
        if self.rows.is_empty() {
            return self.springs.iter().map(|spring| spring.at.of(u)).collect();
        }
        let mut w = vec![0.0; self.springs.len()];
        rows_times(&self.rows, &u[..self.rows.len() / w.len()], &mut w);
        w
    }

    /// Finds F for the deflections `b`, in a step that has [begun](Self::begin); whether it was found.
    pub fn relieve(&mut self, b: &[f64]) -> bool {
        let b = DVector::from_column_slice(b);
        let mut least = f64::INFINITY;
        for _ in 0..MOST {
            self.w = self.moved(&self.forces) + &b;
            let (forces, roots): (Vec<f64>, Vec<f64>) =
                self.laws(&self.w).map(|(force, tangent)| (force, tangent.sqrt())).unzip();
            self.roots = roots;
            let missing = DVector::from_vec(forces) - &self.forces;
            let size = self.springs.iter().zip(&b).zip(&self.forces);
            let size =
                size.fold(0.0_f64, |size, ((spring, b), force)| size.max(force.abs()).max(spring.stiffness * b.abs()));
            let left = missing.amax();
            if !left.is_finite() {
                return false;
            }
            if left <= ENOUGH * size || (left >= 0.5 * least && least <= ROUNDED * size) {
                return true;
            }
            least = least.min(left);
            let way = self.newton(&missing);
            self.turns += 1;
            let length = self.search(&way);
            self.forces += length * way;
        }
        false
    }

    /// F of the last deflections.
    pub fn forces(&self) -> &[f64] {
        self.forces.as_slice()
    }

    /// Aᵀ dF/ds of the last deflections, where these change by A ds: dF = √r′ Z ds, (1 − √r′ G √r′) Z = √r′ A.
    pub fn slopes(&mut self, a: &[Vec<f64>]) -> DMatrix<f64> {
        let lifted = self.lifted();
        let scaled = DMatrix::from_fn(lifted.len(), a.len(), |row, k| self.roots[lifted[row]] * a[k][lifted[row]]);
        match self.factorise(&lifted) {
            Some(factor) => scaled.tr_mul(&factor.solve(&scaled)),
            None => DMatrix::zeros(a.len(), a.len()),
        }
    }

    /// Adds P F of the last deflections to `f`.
    pub fn add_load(&self, f: &mut [f64]) {
        self.add_combined(self.forces.as_slice(), f);
    }

    /// Adds P r(Pᵀu) to `f`.
    pub fn add_forces(&self, u: &[f64], f: &mut [f64]) {
        self.add_combined(&self.reliefs(u), f);
    }

    /// Adds P x to `f`.
    fn add_combined(&self, x: &[f64], f: &mut [f64]) {
        match self.rows.is_empty() {
            true => self.springs.iter().zip(x).for_each(|(spring, x)| spring.at.add_to(*x, f)),
            false => add_rows(&self.rows, x, &mut f[..self.rows.len() / x.len()]),
        }
    }

    /// r(Pᵀu) of each spring, N.
    pub fn reliefs(&self, u: &[f64]) -> Vec<f64> {
        let each = self.springs.iter().zip(self.deflections(u));
        each.map(|(spring, w)| relief(spring.stiffness, w).0).collect()
    }

    /// Σ ½ k ⟨w⟩², the energy that springs would have if they pulled, J.
    pub fn energy(&self, u: &[f64]) -> f64 {
        let each = self.springs.iter().zip(self.deflections(u));
        each.map(|(spring, w)| 0.5 * spring.stiffness * w.max(0.0).powi(2)).sum()
    }

    /// r and r′ of each.
    fn laws<'a>(&'a self, w: &'a DVector<f64>) -> impl Iterator<Item = (f64, f64)> + 'a {
        self.springs.iter().zip(w).enumerate().map(|(i, (spring, w))| match &self.before {
            None => relief(spring.stiffness, *w),
            Some(before) => mean_relief(spring.stiffness, before[i], *w),
        })
    }

    fn lifted(&self) -> Vec<usize> {
        (0..self.roots.len()).filter(|i| self.roots[*i] > 0.0).collect()
    }

    /// The factor for the roots as they are, those of `lifted` not 0; one that is kept where they are the same.
    fn factorise(&mut self, lifted: &[usize]) -> Option<&Cholesky<f64, Dyn>> {
        if let Some(found) = self.factors.iter().position(|(roots, _)| *roots == self.roots) {
            self.factors[..=found].rotate_right(1);
        } else {
            let matrix = |share: f64| {
                let mut matrix = DMatrix::identity(lifted.len(), lifted.len());
                // The lower triangle is all that is read.
                for (k, (j, mut column)) in lifted.iter().zip(matrix.column_iter_mut()).enumerate() {
                    let (root, compliance) = (share * self.roots[*j], self.compliance.column(*j));
                    for (i, value) in lifted.iter().zip(column.iter_mut()).skip(k) {
                        *value -= root * self.roots[*i] * compliance[*i];
                    }
                }
                matrix
            };
            let factor = cholesky(matrix(1.0)).or_else(|| cholesky(matrix(NEARLY)))?;
            self.factors.truncate((REMEMBERED / (lifted.len() * lifted.len()).max(1)).saturating_sub(1));
            self.factors.insert(0, (self.roots.clone(), factor));
        }
        self.factors.first().map(|(_, factor)| factor)
    }

    /// d = ρ + √r′ x with (1 − √r′ G √r′) x = √r′ G ρ, for ρ = r − F; ρ itself, a way down as well, where rounding leaves no more.
    fn newton(&mut self, missing: &DVector<f64>) -> DVector<f64> {
        let (lifted, moved) = (self.lifted(), self.moved(missing));
        let scaled = DVector::from_iterator(lifted.len(), lifted.iter().map(|i| self.roots[*i] * moved[*i]));
        let mut way = missing.clone();
        let Some(x) = self.factorise(&lifted).map(|factor| factor.solve(&scaled)) else { return way };
        lifted.iter().zip(&x).for_each(|(i, x)| way[*i] += self.roots[*i] * x);
        way
    }

    /// G F; most of F are 0 where most of the plate lies on its springs.
    fn moved(&self, forces: &DVector<f64>) -> DVector<f64> {
        let mut w = DVector::zeros(forces.len());
        let columns = self.compliance.as_slice().chunks_exact(forces.len().max(1));
        for (column, force) in columns.zip(forces).filter(|(_, force)| **force != 0.0) {
            axpy(*force, column, w.as_mut_slice());
        }
        w
    }

    /// How far to go: all of the way, or to about the minimum of Π along it, whose slope never falls.
    fn search(&self, way: &DVector<f64>) -> f64 {
        let moved = self.moved(way);
        let slope = |length: f64| {
            let w = &self.w + length * &moved;
            let forces = self.laws(&w).map(|(force, _)| force);
            let each = forces.zip(&self.forces).zip(way).zip(&moved);
            each.map(|(((r, force), way), moved)| moved * (force + length * way - r)).sum::<f64>()
        };
        let flat = FLAT * slope(0.0).abs();
        let (mut low, mut high) = (0.0, 1.0);
        if slope(high) <= flat {
            return high;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let there = slope(middle);
            if there.abs() <= flat {
                return middle;
            }
            if there < 0.0 { low = middle } else { high = middle }
        }
        low
    }
}

/// L Lᵀ of a matrix whose lower triangle is given, column by column; nothing where it is not positive definite. It is found anew whenever
/// a spring lets go: nalgebra's own takes some four times as long.
fn cholesky(mut matrix: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let n = matrix.nrows();
    let mut row = Vec::with_capacity(n);
    for j in 0..n {
        let (before, rest) = matrix.as_mut_slice().split_at_mut(j * n);
        let column = &mut rest[j..n];
        row.clear();
        row.extend(before.iter().skip(j).step_by(n).map(|l| -l));
        vectorised(|| add_columns(before.get(j..).unwrap_or_default(), n, &row, column));
        let root = column[0].sqrt();
        if !(root > 0.0) {
            return None;
        }
        column.iter_mut().for_each(|l| *l /= root);
    }
    Some(Cholesky::pack_dirty(matrix))
}

/// k ⟨w⟩ and its derivative.
fn relief(stiffness: f64, w: f64) -> (f64, f64) {
    if w > 0.0 { (stiffness * w, stiffness) } else { (0.0, 0.0) }
}

/// The mean of k ⟨w⟩ along the way from `before` to an end w₁ with `middle` between them, [½ k ⟨w₁⟩² − ½ k ⟨w₀⟩²]/(w₁ − w₀), which does
/// the work of the energy, and its derivative by `middle`.
fn mean_relief(stiffness: f64, before: f64, middle: f64) -> (f64, f64) {
    let end = 2.0 * middle - before;
    match (before > 0.0, end > 0.0) {
        (false, false) => (0.0, 0.0),
        (true, true) => (stiffness * middle, stiffness),
        (false, true) => {
            let share = end / (end - before);
            (0.5 * stiffness * end * share, stiffness * share * (2.0 - share))
        }
        (true, false) => {
            let share = before / (before - end);
            (0.5 * stiffness * before * share, stiffness * share * share)
        }
    }
}

/// Displacements at rest of a structure on one-sided springs, whose stiffness `solve` divides by, under a load that moves it by `free`
/// as if they pulled.
///
/// # Errors
/// A load that lifts it off.
pub fn at_rest(
    lifting: &mut Lifting,
    free: &mut [f64],
    mut solve: impl FnMut(&mut [f64], usize) -> Result<(), SolveError>,
) -> Result<(), SolveError> {
    lifting.set(free.len(), &mut solve)?;
    let b = lifting.deflections(free);
    lifting.begin(None);
    if !lifting.relieve(&b) {
        return Err(SolveError::other(LIFTED_OFF));
    }
    if lifting.forces().iter().any(|force| *force != 0.0) {
        let mut more = vec![0.0; free.len()];
        lifting.add_load(&mut more);
        solve(&mut more, 1)?;
        free.iter_mut().zip(&more).for_each(|(u, more)| *u += more);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_times_their_transposes() {
        for n in [0, 1, 2, 5, 64, 97] {
            let l = DMatrix::from_fn(n, n, |i, j| match i.cmp(&j) {
                std::cmp::Ordering::Less => 0.0,
                std::cmp::Ordering::Equal => 2.0 + i as f64,
                std::cmp::Ordering::Greater => ((i * j + i) % 7) as f64 - 3.0,
            });
            let found = cholesky(&l * l.transpose()).unwrap().unpack();
            assert!((found - l).abs().max() < 1e-11, "{n}");
        }
        assert!(cholesky(DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 4.0 - 1e-9])).is_none());
        assert!(cholesky(DMatrix::from_element(1, 1, f64::NAN)).is_none());
    }

    /// A relief does the work of its energy and its derivative is that of differences, through all four ways over the kink.
    #[test]
    fn means_do_the_work_of_the_energy() {
        let energy = |w: f64| 0.5 * 3.0 * w.max(0.0).powi(2);
        for (before, end) in [(-1.0, -0.5), (-1.0, 2.0), (1.5, -0.25), (0.5, 2.0), (0.0, 1.0), (1.0, 0.0)] {
            let middle = 0.5 * (before + end);
            let (force, tangent) = mean_relief(3.0, before, middle);
            assert!((force * (end - before) - (energy(end) - energy(before))).abs() < 1e-14);
            let step = 1e-6;
            let [above, below] = [middle + step, middle - step].map(|w| mean_relief(3.0, before, w).0);
            assert!(((above - below) / (2.0 * step) - tangent).abs() < 1e-5, "{before} {end}");
        }
    }

    /// A rigid bar with three springs beneath: pressed beyond the kern of its outer two, it stands on one end only, and is lifted
    /// where nothing presses.
    #[test]
    fn bars_stand_on_what_pushes() {
        // Of w and tilt of the bar, springs at −1, 0 and 1; heavily loaded off its middle, between springs.
        let spring = |x: f64| OneSided { at: Functional(vec![(0, -1.0), (1, -x)]), stiffness: 2.0 };
        let mut lifting = Lifting::new([-1.0, 0.0, 1.0].map(spring).into());
        // A = Σ k p pᵀ = diag(6, 4).
        let solve = |x: &mut [f64], _: usize| {
            (x[0], x[1]) = (x[0] / 6.0, x[1] / 4.0);
            Ok(())
        };
        // A force of 1 at 0.8 downwards: w is up to the supports, so that positive displacements press.
        let mut u = [1.0, 0.8];
        solve(&mut u, 1).unwrap();
        at_rest(&mut lifting, &mut u, solve).unwrap();
        // On the springs at 0 and 1: 2 (v + 0) + 2 (v + θ) = 1, 2 (v + θ) = 0.8.
        assert!((u[0] - 0.1).abs() < 1e-14 && (u[1] - 0.3).abs() < 1e-14, "{u:?}");
        let mut up = [-1.0 / 6.0, 0.0];
        assert!(at_rest(&mut lifting, &mut up, solve).unwrap_err().to_string().contains("lift the plate off"));
        let mut beside = [1.0 / 6.0, 1.5 / 4.0];
        assert!(at_rest(&mut lifting, &mut beside, solve).is_err());
    }
}
