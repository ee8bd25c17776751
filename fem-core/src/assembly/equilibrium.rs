//! Equilibrium of a plate under large deflections and loads at rest.

use super::{AssemblyError, Cholesky, FactorError, LargePlate, Symbolic, Symmetric, condition};
use crate::words::energy::Energy;
use std::fmt;
use std::num::NonZeroUsize;

/// Iterations before a load counts as one that cannot be borne: plates take some ten, a cantilever that bends to a right angle
/// fifty.
const MOST: usize = 200;

/// Times that a step may lead to where the plate would buckle before the load counts as one that buckles it.
const RETREATS: usize = 20;

/// Newton decrement rᵀ K⁻¹ r over the work of the load at which an iteration ends: the error of the energy is half as large,
/// that of displacements its root.
const ENOUGH: f64 = 1e-22;

/// Decrement that counts as the end where it falls no more: what is left is rounding.
const ROUNDING: f64 = 1e-14;

/// Decrement below which a whole step is right and a line search only measures rounding.
const NEAR: f64 = 1e-6;

/// Displacements in equilibrium with a load.
#[derive(Debug, Clone)]
pub struct Equilibrium {
    /// Independent displacements.
    pub u: Vec<f64>,
    /// Work done on the plate, J.
    pub energy: Energy,
    /// Newton decrements rᵀ K⁻¹ r over the work of the load, one per iteration: the squared distance to the solution in the
    /// energy norm. Near the solution each is about the square of the one before.
    pub decrements: Vec<f64>,
    /// ‖load − f‖ over the larger of ‖load‖ and ‖K u‖ (free strains move a plate without a load).
    pub residual: f64,
    /// Condition number of the last tangent where it may be worth a word
    /// ([`notable_condition`](super::SparseStructure::notable_condition)).
    pub condition: Option<f64>,
    /// Right-hand sides solved for.
    pub solves: u64,
}

/// Why there is no equilibrium.
#[derive(Debug, Clone)]
pub enum EquilibriumError {
    /// A cell that could not be integrated.
    Assembly(AssemblyError),
    /// A tangent that is not positive definite, or too large.
    Factor(FactorError),
    /// Newton's method did not end; the last decrement.
    NoConvergence(f64),
}

impl fmt::Display for EquilibriumError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Assembly(error) => error.fmt(f),
            Self::Factor(FactorError::NotPositive { .. }) => f.write_str(
                "the tangent stiffness is not positive definite: the plate gives way under this load, or is not held",
            ),
            Self::Factor(error) => error.fmt(f),
            Self::NoConvergence(decrement) => write!(
                f,
                "Newton's method did not converge in {MOST} iterations (decrement {decrement:.1e} of the work of the \
                 load)"
            ),
        }
    }
}
impl std::error::Error for EquilibriumError {}

/// An internal force whose equilibrium with a load is sought.
pub trait InternalForce {
    /// Internal force at the independent displacements `u`, and the tangent on the pattern of K where it is asked for; returns
    /// the work done, J.
    ///
    /// # Errors
    /// A cell that cannot be integrated, displacements that are not finite.
    fn internal(
        &mut self,
        u: &[f64],
        force: &mut [f64],
        tangent: Option<&mut Symmetric>,
    ) -> Result<Energy, AssemblyError>;

    /// How much of the step `d` from `u` is taken, where the work done is `energy`, J, and the internal force `force`; `tried` is
    /// a work array.
    ///
    /// # Errors
    /// As [`InternalForce::internal`].
    fn length(
        &mut self,
        energy: f64,
        force: &[f64],
        load: &[f64],
        u: &[f64],
        d: &[f64],
        tried: &mut [f64],
    ) -> Result<f64, EquilibriumError>;
}

/// Solves f(ũ) = `load` by Newton's method from `u`.
///
/// A step to where the tangent is not positive definite is taken back halfway, some times.
///
/// # Errors
/// See [`EquilibriumError`].
pub fn equilibrium(
    plate: &mut dyn InternalForce,
    symbolic: Symbolic,
    load: &[f64],
    mut u: Vec<f64>,
    threads: NonZeroUsize,
) -> Result<Equilibrium, EquilibriumError> {
    let n = u.len();
    let mut tangent = Symmetric::zero(symbolic.pattern().clone());
    let mut factor = Cholesky::new(symbolic, threads);
    let (mut force, mut step, mut tried) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    // Where the tangent was positive last, and how often a step may still be taken back halfway to there.
    let (mut last, mut retreats) = (vec![0.0; n], RETREATS);
    let mut decrements: Vec<f64> = Vec::new();
    for _ in 0..MOST {
        let energy = plate.internal(&u, &mut force, Some(&mut tangent)).map_err(EquilibriumError::Assembly)?.total();
        match factor.factorise(tangent.lower()) {
            Err(FactorError::NotPositive { .. }) if retreats > 0 && !decrements.is_empty() => {
                retreats -= 1;
                u.iter_mut().zip(&last).for_each(|(u, last)| *u = 0.5 * (*u + last));
                continue;
            }
            done => done.map_err(EquilibriumError::Factor)?,
        }
        last.copy_from_slice(&u);
        for ((step, load), force) in step.iter_mut().zip(load).zip(&force) {
            *step = load - force;
        }
        let residual = step.clone();
        factor.solve(&mut step, 1);
        // The work that the load would do on a linear plate, before there is any other; free strains alone have energy.
        let work = dot(load, &u).abs().max(dot(load, &step).abs()).max(energy).max(f64::MIN_POSITIVE);
        let decrement = dot(&residual, &step) / work;
        let stalled = decrements.last().is_some_and(|last| decrement <= ROUNDING && decrement > 0.1 * last);
        decrements.push(decrement);
        let near = decrement <= NEAR;
        let length = if near { 1.0 } else { plate.length(energy, &force, load, &u, &step, &mut tried)? };
        u.iter_mut().zip(&step).for_each(|(u, d)| *u += length * d);
        if decrement <= ENOUGH || stalled {
            let energy = plate.internal(&u, &mut force, None).map_err(EquilibriumError::Assembly)?;
            step.iter_mut().zip(load).zip(&force).for_each(|((rest, load), force)| *rest = load - force);
            force.fill(0.0);
            tangent.add_product(1.0, &u, &mut force);
            let scale = dot(load, load).max(dot(&force, &force)).max(f64::MIN_POSITIVE);
            let residual = (dot(&step, &step) / scale).sqrt();
            let mut solves = decrements.len() as u64;
            let condition = condition::notable(&tangent, &mut factor, &mut solves);
            return Ok(Equilibrium { u, energy, decrements, residual, condition, solves });
        }
    }
    Err(EquilibriumError::NoConvergence(decrements.last().copied().unwrap_or(f64::NAN)))
}

impl InternalForce for LargePlate {
    fn internal(
        &mut self,
        u: &[f64],
        force: &mut [f64],
        tangent: Option<&mut Symmetric>,
    ) -> Result<Energy, AssemblyError> {
        Ok(Energy { stored: LargePlate::internal(self, u, force, tangent)?, dissipated: 0.0 })
    }

    /// First minimum of W(u + s d) − s loadᵀ d beyond s = 0: the strain energy is a polynomial of the fourth degree in the
    /// displacements, so that five numbers give all of it along a line and the search is exact. A plate that stiffens is never
    /// overshot and needs no load steps.
    fn length(
        &mut self,
        energy: f64,
        force: &[f64],
        load: &[f64],
        u: &[f64],
        d: &[f64],
        tried: &mut [f64],
    ) -> Result<f64, EquilibriumError> {
        let mut scrap = vec![0.0; u.len()];
        let mut at = |s: f64| {
            tried.iter_mut().zip(u).zip(d).for_each(|((t, u), d)| *t = u + s * d);
            LargePlate::internal(self, tried, &mut scrap, None).map_err(EquilibriumError::Assembly)
        };
        // W = energy + a s + s² (b + c s + e s²)
        let a = dot(force, d);
        let part = |s: f64, w: f64| (w - energy - a * s) / (s * s);
        let [half, one, two] = [(0.5, at(0.5)?), (1.0, at(1.0)?), (2.0, at(2.0)?)].map(|(s, w)| part(s, w));
        let e = (two - one - 2.0 * (one - half)) / 1.5;
        let c = two - one - 3.0 * e;
        let b = one - c - e;
        let slope = |s: f64| a - dot(load, d) + s * (2.0 * b + s * (3.0 * c + s * 4.0 * e));
        // The slope at 0 is minus the decrement; bisect the first change of its sign on a grid.
        let (mut low, mut high) = (0.0, 1.0);
        for k in 1..=200 {
            high = f64::from(k) / 100.0;
            if slope(high) >= 0.0 {
                break;
            }
            low = high;
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        Ok(high)
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
