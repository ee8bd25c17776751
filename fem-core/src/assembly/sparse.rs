//! A plate's K and M as a [`Structure`].

use super::released::Released;
use super::{Cholesky, FactorError, InternalForce, LargePlate, LawPlate, Symbolic, Symmetric, coarse, condition};
use crate::contracts::structure::Coarse;
use crate::contracts::structure::{Nonlinear, SolveError, Structure, Tangent, Tangents};
use crate::words::damping::Rayleigh;
use crate::words::energy::Energy;
use crate::words::functional::Functional;
use crate::words::prolongation::Prolongation;
use std::fmt;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// What the factor at hand belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Factored {
    Nothing,
    Shifted(f64),
    Mass,
    Tangent,
}

/// Internal forces other than K u.
#[derive(Debug)]
enum Beyond {
    Large(Box<LargePlate>),
    Laws(Box<LawPlate>),
}

impl Beyond {
    fn internal(
        &mut self,
        k: &Symmetric,
        u: &[f64],
        points: &[f64],
        force: &mut [f64],
        tangent: Option<&mut Symmetric>,
    ) -> Result<Energy, SolveError> {
        let done = match self {
            Self::Large(large) => InternalForce::internal(&mut **large, u, force, tangent),
            Self::Laws(laws) => laws.on(k, points).internal(u, force, tangent),
        };
        done.map_err(SolveError::other)
    }
}

/// Sparse stiffness and mass on one pattern, with one factorisation kept.
pub struct SparseStructure {
    k: Symmetric,
    m: Symmetric,
    /// M without its zeros: the components of a displacement have no inertia in common.
    inertia: Symmetric,
    factor: Cholesky,
    factored: Factored,
    combined: Symmetric,
    /// Of a tangent, which comes with its force.
    force: Vec<f64>,
    prolongation: Option<Prolongation>,
    beyond: Option<Beyond>,
    damping: Option<Rayleigh>,
    released: Released,
    threads: NonZeroUsize,
    name: Box<dyn Fn(usize) -> String + Send>,
    factorisations: u64,
    solves: u64,
}

impl fmt::Debug for SparseStructure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SparseStructure").field("ndof", &self.k.ndof()).field("entries", &self.entries()).finish()
    }
}

impl SparseStructure {
    /// `k` and `m`, both on the pattern of `symbolic`, factorised by `threads`; `name(column)` describes an unknown in messages.
    pub fn new(
        symbolic: Symbolic,
        k: Symmetric,
        m: Symmetric,
        threads: NonZeroUsize,
        name: impl Fn(usize) -> String + Send + 'static,
    ) -> Self {
        Self {
            name: Box::new(name),
            combined: Symmetric::zero(symbolic.pattern().clone()),
            force: Vec::new(),
            prolongation: None,
            beyond: None,
            damping: None,
            released: Released::default(),
            threads,
            factor: Cholesky::new(symbolic, threads),
            factored: Factored::Nothing,
            inertia: m.compact(),
            k,
            m,
            factorisations: 0,
            solves: 0,
        }
    }

    /// Offers a coarse model to those who can use one.
    pub fn offer_coarse(&mut self, prolongation: Prolongation) {
        self.prolongation = Some(prolongation);
    }

    /// Gives the structure the internal forces of large deflections; its K is their tangent at rest.
    pub fn stiffen(&mut self, large: Option<LargePlate>) {
        self.beyond = large.map(|large| Beyond::Large(Box::new(large)));
    }

    /// Gives large deflections, where the structure has them, a stiffness that its K holds: of springs, or of stresses at rest.
    pub fn carry(&mut self, more: &Symmetric) {
        if let Some(Beyond::Large(large)) = &mut self.beyond {
            large.carry(more);
        }
    }

    /// Gives the structure the internal forces of plies that follow laws; its K is their tangent before anything has happened.
    pub fn follow(&mut self, mut laws: LawPlate) {
        laws.share(self.threads);
        self.beyond = Some(Beyond::Laws(Box::new(laws)));
    }

    /// Gives the structure viscous damping.
    pub fn damp(&mut self, damping: Rayleigh) {
        self.damping = Some(damping);
    }

    /// Lets the structure move as a whole by those of `motions` (`ndof × any`, column-major) that cost no energy. Without
    /// inertia it stays where it is, and loads on it must be in balance.
    pub fn release(&mut self, motions: &[f64]) {
        self.released = Released::new(&self.k, &self.inertia, motions);
        self.factored = Factored::Nothing;
    }

    /// K ← K + `scale` A, A on the pattern of K.
    pub fn add(&mut self, scale: f64, a: &Symmetric) {
        self.k.add(scale, a);
        self.factored = Factored::Nothing;
    }

    /// Whether a load accelerates the structure as a whole.
    pub fn moves_under(&self, load: &Functional) -> bool {
        self.released.moves_under(load, &self.k)
    }

    /// Entries of one triangle of K.
    pub fn entries(&self) -> usize {
        self.k.pattern().entries()
    }

    /// K and M.
    pub fn matrices(&self) -> (&Symmetric, &Symmetric) {
        (&self.k, &self.m)
    }

    /// Condition number of K with its unknowns in units that make its diagonal 1, estimated: displacements under loads at
    /// rest lose up to log₁₀ of it of their 16 digits. Some five solves (Higham 1988).
    ///
    /// # Errors
    /// A stiffness that is not positive definite.
    pub fn condition(&mut self) -> Result<f64, SolveError> {
        self.factorise(Factored::Shifted(0.0))?;
        let (factor, solves) = (&mut self.factor, &mut self.solves);
        Ok(condition::estimate(&self.k, |x| {
            factor.solve(x, 1);
            *solves += 1;
        }))
    }

    /// The same where it may be worth a word: `None` where pivots of the factor show that it is not beyond [`NOTABLE_CONDITION`](super::NOTABLE_CONDITION),
    /// which takes no solve.
    ///
    /// # Errors
    /// As [`SparseStructure::condition`].
    pub fn notable_condition(&mut self) -> Result<Option<f64>, SolveError> {
        self.factorise(Factored::Shifted(0.0))?;
        Ok(condition::notable(&self.k, &mut self.factor, &mut self.solves))
    }

    fn factorise(&mut self, what: Factored) -> Result<(), SolveError> {
        if self.factored == what {
            return Ok(());
        }
        let matrix = match what {
            Factored::Mass => &self.m,
            Factored::Shifted(0.0) | Factored::Nothing if !self.released.springs().is_empty() => {
                self.combined.lower_mut().val_mut().copy_from_slice(self.k.lower().val());
                self.combined.add_to_diagonal(self.released.springs());
                &self.combined
            }
            Factored::Shifted(0.0) | Factored::Nothing => &self.k,
            Factored::Tangent => &self.combined,
            Factored::Shifted(shift) => {
                let combined = self.combined.lower_mut().val_mut().iter_mut();
                for ((c, k), m) in combined.zip(self.k.lower().val()).zip(self.m.lower().val()) {
                    *c = k + shift * m;
                }
                &self.combined
            }
        };
        self.factored = Factored::Nothing;
        self.factorisations += 1;
        self.factor.factorise(matrix.lower()).map_err(|e| match e {
            FactorError::NotPositive { column } if what == Factored::Mass => {
                SolveError::NoInertia { unknown: (self.name)(column) }
            }
            FactorError::NotPositive { column } => SolveError::NotPositive { unknown: (self.name)(column) },
            FactorError::NotFinite { column } => SolveError::NotFinite { unknown: (self.name)(column) },
            other => SolveError::other(other),
        })?;
        self.factored = what;
        Ok(())
    }
}

impl Structure for SparseStructure {
    fn ndof(&self) -> usize {
        self.k.ndof()
    }

    fn name(&self, i: usize) -> String {
        (self.name)(i)
    }

    fn free_motions(&self) -> &[f64] {
        self.released.motions()
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.k.add_product(scale, x, y);
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.inertia.add_product(scale, x, y);
    }

    fn add_damping(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        let Rayleigh { mass, stiffness } = self.damping.unwrap_or_default();
        if mass != 0.0 {
            self.add_mass(scale * mass, x, y);
        }
        if stiffness != 0.0 {
            self.add_stiffness(scale * stiffness, x, y);
        }
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        self.factorise(Factored::Shifted(shift))?;
        let relieved = shift == 0.0;
        if relieved {
            self.released.balance(x, columns);
        }
        self.factor.solve(x, columns);
        if relieved {
            self.released.deform(x, columns);
        }
        self.solves += columns as u64;
        Ok(())
    }

    fn solve_damped(&mut self, cm: f64, cc: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        let Some(damping) = self.damping else { return self.solve_shifted(cm, x, columns) };
        let (scale, shift) = damping.with_stiffness(cm, cc);
        self.solve_shifted(shift, x, columns)?;
        x.iter_mut().for_each(|x| *x /= scale);
        Ok(())
    }

    fn solve_damped_mass(&mut self, cc: f64, x: &mut [f64]) -> Result<(), SolveError> {
        let Some(damping) = self.damping else { return self.solve_mass(x) };
        let (mass, stiffness) = damping.with_mass(cc);
        if stiffness == 0.0 {
            self.solve_mass(x)?;
            x.iter_mut().for_each(|x| *x /= mass);
        } else {
            self.solve_shifted(mass / stiffness, x, 1)?;
            x.iter_mut().for_each(|x| *x /= stiffness);
        }
        Ok(())
    }

    fn damping_rate(&self, omega: f64) -> f64 {
        let Rayleigh { mass, stiffness } = self.damping.unwrap_or_default();
        mass + stiffness * omega * omega
    }

    fn states(&self) -> usize {
        match &self.beyond {
            Some(Beyond::Laws(laws)) => laws.states(),
            _ => 0,
        }
    }

    fn nonlinear(&mut self) -> Option<&mut dyn Nonlinear> {
        self.beyond.is_some().then_some(self as _)
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        self.factorise(Factored::Mass)?;
        self.factor.solve(x, 1);
        self.solves += 1;
        Ok(())
    }

    fn coarse(&self) -> Result<Option<Coarse>, SolveError> {
        let Some(p) = &self.prolongation else { return Ok(None) };
        let pattern = Arc::new(coarse::pattern(self.k.pattern(), p));
        let k = coarse::product(&self.k, p, &pattern);
        let m = coarse::product(&self.inertia, p, &pattern);
        let symbolic = Symbolic::new(pattern).map_err(SolveError::other)?;
        let mut structure = Self::new(symbolic, k, m, self.threads, |i| format!("coarse unknown {}", i + 1));
        structure.release(&p.fit(self.released.motions()));
        Ok(Some(Coarse { structure: Box::new(structure), prolongation: p.clone() }))
    }

    fn work(&self) -> (u64, u64) {
        (self.factorisations, self.solves)
    }
}

impl Nonlinear for SparseStructure {
    fn internal(&mut self, u: &[f64], points: &[f64], force: &mut [f64]) -> Result<Energy, SolveError> {
        self.beyond.as_mut().ok_or(SolveError::Linear)?.internal(&self.k, u, points, force, None)
    }

    fn commit(&mut self, u: &[f64], points: &mut [f64]) -> Result<(), SolveError> {
        match &mut self.beyond {
            Some(Beyond::Laws(laws)) => laws.commit(u, points).map_err(SolveError::other),
            _ => Ok(()),
        }
    }

    fn tangents(&mut self) -> Option<&mut dyn Tangents> {
        Some(self)
    }
}

impl Tangents for SparseStructure {
    fn linearise(&mut self, Tangent { cm, cc, u, points }: &Tangent) -> Result<(), SolveError> {
        let beyond = self.beyond.as_mut().ok_or(SolveError::Linear)?;
        self.force.resize(u.len(), 0.0);
        beyond.internal(&self.k, u, points, &mut self.force, Some(&mut self.combined))?;
        let damping = self.damping.unwrap_or_default();
        let cm = cm + cc * damping.mass;
        let combined = self.combined.lower_mut().val_mut();
        combined.iter_mut().zip(self.m.lower().val()).for_each(|(k, m)| *k += cm * m);
        if damping.stiffness != 0.0 {
            let ck = cc * damping.stiffness;
            combined.iter_mut().zip(self.k.lower().val()).for_each(|(tangent, k)| *tangent += ck * k);
        }
        self.factored = Factored::Nothing;
        self.factorise(Factored::Tangent)
    }

    fn solve_linearised(&mut self, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        if self.factored != Factored::Tangent {
            return Err(SolveError::NotLinearised);
        }
        self.factor.solve(x, columns);
        self.solves += columns as u64;
        Ok(())
    }
}
