//! Implicit steps of a structure whose internal force is not linear.

use super::ImpactSystem;
use super::influence::Strikers;
use super::mean::MeanForce;
use crate::vector::dot;
use fem_core::energy::Energy;
use fem_core::structure::{Nonlinear, SolveError, Structure, Tangent, Tangents};
use fem_core::time::{Histories, StepError};

/// Error of the change of displacement at which an iteration ends, relative, in the energy norm of the tangent, far below what the
/// step leaves; the second where forces are means over a step, for the sake of the energy.
const ENOUGH: [f64; 2] = [1e-4, 1e-10];

/// The same relative to the displacement itself: what rounding leaves.
const ROUNDING: f64 = 1e-11;

/// Factor on the error per turn above which the tangent is renewed: a tangent costs some turns.
const SLOW: f64 = 0.06;

/// Turns, and tangents among them, before a step counts as unsolvable.
const MOST: usize = 60;
const MOST_TANGENTS: usize = 12;

/// What an iteration keeps between steps.
#[derive(Debug, Default)]
pub(super) struct Newton {
    tangent: Option<Tangent>,
    load: Vec<f64>,
    at: Vec<f64>,
    force: Vec<f64>,
    residual: Vec<f64>,
    step: Vec<f64>,
    mean: MeanForce,
    /// Where the last iteration ended, and what is stored there.
    end: Vec<f64>,
    stored: Option<f64>,
    /// So far.
    turns: u64,
}

impl Newton {
    /// What is stored at `u`, if an iteration has ended there: its last turn δ adds f δ to what it began with. That leaves out ½ δ K δ,
    /// a few millionths at most of the energy of what the step changes: δ is below ([`ENOUGH`]/[`SLOW`]) of that.
    pub(super) fn stored(&self, u: &[f64]) -> Option<f64> {
        self.stored.filter(|_| self.end == u)
    }
}

impl ImpactSystem {
    /// The tangent in use, if there is one: a march that is resumed takes it again.
    pub fn tangent(&self) -> Option<&Tangent> {
        self.newton.tangent.as_ref()
    }

    /// Iterations of implicit steps so far; none of a linear structure.
    pub fn iterations(&self) -> u64 {
        self.newton.turns
    }

    /// Whether the internal force of the structure is not linear in its displacements.
    pub fn is_nonlinear(&mut self) -> bool {
        self.structure.nonlinear().is_some()
    }

    /// Whether it falls short of K u without a tangent, as that of a structure that is damaged does.
    pub fn softens(&mut self) -> bool {
        self.structure.nonlinear().is_some_and(|forces| forces.tangents().is_none())
    }

    /// Takes the tangent of the structure.
    ///
    /// # Errors
    /// One that is not positive definite, which only a structure can have that buckles or is not held.
    pub fn linearise(&mut self, tangent: Tangent) -> Result<(), StepError> {
        let Self { structure, impactors, tips, influence, newton, .. } = self;
        let n = structure.ndof();
        let Some(large) = structure.nonlinear().and_then(|f| f.tangents()) else { return Ok(()) };
        newton.tangent = None;
        large.linearise(&tangent).map_err(StepError::Factorisation)?;
        influence.set(tangent.cm, tangent.cc, n, Strikers { impactors, tips }, |x, count| {
            large.solve_linearised(x, count)
        })?;
        newton.tangent = Some(tangent);
        Ok(())
    }

    /// Newton's method for the change d, with a tangent that is kept as long as it serves:
    ///
    /// A δ = r − cm M d − cc C d − f(ũ + d) + Σ F p, A = K_T + cm M + cc C, d ← d + δ,
    ///
    /// the contact forces F such that the laws hold at ũ + d + δ; or with mean forces over the step from `start`. The error after a turn is estimated from how fast δ falls in
    /// the norm of A.
    pub(super) fn iterate(
        &mut self,
        [cm, cc, t]: [f64; 3],
        h: &Histories,
        start: Option<&[f64]>,
        from: &[f64],
        d: &mut [f64],
    ) -> Result<(), StepError> {
        let n = self.structure.ndof();
        self.newton.stored = None;
        let enough = ENOUGH[usize::from(start.is_some())];
        if let Some(start) = start {
            self.newton.mean.begin(&mut *self.structure, &start[..n], &h.points)?;
        }
        let take = |u: &[f64]| Tangent { cm, cc, u: u.to_vec(), points: h.points.clone() };
        if !self.newton.tangent.as_ref().is_some_and(|tangent| tangent.cm == cm && tangent.cc == cc) {
            self.linearise(take(&from[..n]))?;
        }
        self.newton.load.clear();
        self.newton.load.extend_from_slice(d);
        d.fill(0.0);
        let (mut largest, mut renewals) = (0.0_f64, 0);
        // The size of the turn before, with the same tangent.
        let mut before = None;
        for _ in 0..MOST {
            let Self { structure, impactors, tips, influence, newton, contact_calls, .. } = self;
            let strikers = Strikers { impactors, tips };
            let Newton { load, at, force, residual, step, mean, end, stored, .. } = newton;
            newton.turns += 1;
            at.clear();
            at.extend(from[..n].iter().zip(&*d).map(|(u, d)| u + d));
            force.resize(n, 0.0);
            let energy = match start {
                None => internal(&mut **structure, at, &h.points, force)?,
                Some(_) => mean.internal(&mut **structure, at, &h.points, force)?,
            };
            residual.clear();
            residual.extend(load[..n].iter().zip(&*force).map(|(r, f)| r - f));
            structure.add_mass(-cm, &d[..n], residual);
            structure.add_damping(-cc, &d[..n], residual);
            step.clear();
            step.extend_from_slice(residual);
            tangents(nonlinear(structure.nonlinear())?)?.solve_linearised(step, 1).map_err(StepError::Factorisation)?;
            let free = impactors.iter().zip(&load[n..]).zip(&d[n..]);
            step.extend(free.map(|((impactor, r), d)| r / (cm * impactor.mass) - d));
            influence.begin(start.map(|u| &u[..n]));
            influence.set_approaches(strikers, from);
            influence.set_approaches(strikers, d);
            let mut forces = structure.nonlinear();
            let solve = |x: &mut [f64], count| match forces.as_mut().and_then(|forces| forces.tangents()) {
                Some(tangents) => tangents.solve_linearised(x, count),
                None => Err(SolveError::NotLinearised),
            };
            *contact_calls += influence.touch(strikers, t, h, start, step, solve)?;
            d.iter_mut().zip(&*step).for_each(|(d, step)| *d += step);
            let work: f64 = residual.iter().zip(&*step).map(|(r, d)| r * d).sum();
            let square = work + influence.work(strikers, step);
            if !square.is_finite() {
                return Err(StepError::NotFinite { t });
            }
            let size = square.abs().sqrt();
            largest = largest.max(size);
            let rate = before.map(|before: f64| size / before);
            let left = match rate {
                Some(rate) if rate < 0.5 => size * rate / (1.0 - rate),
                _ => size,
            };
            // A mode without inertia may ring, so that the way from ũ is longer than the whole displacement.
            let displacement = energy.total().abs().sqrt();
            if left <= enough * largest.min(displacement) || size <= ROUNDING * displacement {
                end.clear();
                end.extend(from[..n].iter().zip(&*d).map(|(u, d)| u + d));
                let elastic = start.is_none() && energy.dissipated == 0.0;
                *stored = elastic.then(|| energy.stored + dot(force, &step[..n]));
                return Ok(());
            }
            before = Some(size);
            if rate.is_some_and(|rate| rate > SLOW) {
                if renewals == MOST_TANGENTS {
                    break;
                }
                let point: Vec<f64> = from[..n].iter().zip(&*d).map(|(u, d)| u + d).collect();
                self.linearise(take(&point))?;
                renewals += 1;
                before = None;
            }
        }
        Err(StepError::NoConvergence { t, what: "Newton's method for the plate".into() })
    }
}

fn nonlinear(structure: Option<&mut dyn Nonlinear>) -> Result<&mut dyn Nonlinear, StepError> {
    structure.ok_or(StepError::Factorisation(SolveError::Linear))
}

fn tangents(forces: &mut dyn Nonlinear) -> Result<&mut dyn Tangents, StepError> {
    forces.tangents().ok_or(StepError::Factorisation(SolveError::NotLinearised))
}

/// Internal force of a structure that is not linear.
pub(super) fn internal(
    structure: &mut dyn Structure,
    u: &[f64],
    points: &[f64],
    force: &mut [f64],
) -> Result<Energy, StepError> {
    nonlinear(structure.nonlinear())?.internal(u, points, force).map_err(StepError::Factorisation)
}
