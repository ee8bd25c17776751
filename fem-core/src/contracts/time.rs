//! The contract of a time integrator and of the second-order systems it marches.

use crate::contracts::contact::{Branches, ContactHistory, Indentation};
use crate::contracts::structure::SolveError;
use dyn_clone::DynClone;
use std::fmt::{self, Debug};

/// State of a second-order system; a checkpoint of a march is this struct.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State {
    /// Time, s.
    pub t: f64,
    /// Displacements.
    pub u: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
    /// What laws remember.
    pub histories: Histories,
}

/// What the laws of a system remember of its accepted steps.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Histories {
    /// One history per contact.
    pub contacts: Vec<ContactHistory>,
    /// Of the beds under tips, ring by ring, at its inner and its outer edge; none of contacts without a tip.
    pub beds: Vec<[ContactHistory; 2]>,
    /// State variables of the laws of plies, point by point as the structure keeps them
    /// ([`Nonlinear::states`](crate::contracts::structure::Structure::states)).
    pub points: Vec<f64>,
}

impl State {
    /// At rest at t = 0.
    pub fn at_rest(ndof: usize, contacts: usize) -> Self {
        let histories = Histories { contacts: vec![[0.0; 8]; contacts], ..Histories::default() };
        Self { t: 0.0, u: vec![0.0; ndof], v: vec![0.0; ndof], a: vec![0.0; ndof], histories }
    }
}

/// Why a step was not made.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// The mass matrix is singular and the integrator needs its inverse.
    SingularMass(SolveError),
    /// The equations of an implicit step found no solution.
    NoConvergence {
        /// Time at the end of the step, s.
        t: f64,
        /// What did not converge.
        what: String,
    },
    /// A number of the state is NaN or infinite.
    NotFinite {
        /// Time at which it was noticed, s.
        t: f64,
    },
    /// A factorisation failed.
    Factorisation(SolveError),
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SingularMass(why) => write!(f, "the mass matrix is singular: {why}"),
            Self::NoConvergence { t, what } => write!(f, "no convergence at t = {t:.6e} s: {what}"),
            Self::NotFinite { t } => write!(f, "the state is not finite at t = {t:.6e} s"),
            Self::Factorisation(why) => write!(f, "factorisation failed: {why}"),
        }
    }
}
impl std::error::Error for StepError {}

/// The system M a = p(t) − C v − K u + contact(u; h): what an integrator may ask of it.
///
/// `h` is what laws have committed. An implementation solves its own implicit equation, because it alone
/// knows its structure: a linear plate under one contact force needs one back-substitution and a scalar equation, a
/// geometrically nonlinear one a Newton iteration.
pub trait SecondOrderSystem {
    /// Number of unknowns.
    fn ndof(&self) -> usize;

    /// `f ← p(t) − C v − K u + contact(u; h)`.
    fn force(&mut self, t: f64, u: &[f64], v: &[f64], h: &Histories, f: &mut [f64]);

    /// `y ← y + scale · M x`.
    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]);

    /// `y ← y + scale · C x`; without damping this adds nothing.
    fn add_damping(&self, scale: f64, x: &[f64], y: &mut [f64]);

    /// `x ← (M + cc C)⁻¹ x`; explicit schemes ask for `cc` = 0 or for one value per step length.
    ///
    /// # Errors
    /// [`StepError::SingularMass`] when M has no inverse.
    fn solve_mass(&mut self, cc: f64, x: &mut [f64]) -> Result<(), StepError>;

    /// Solves `(cm M + cc C) d + K (from + d) = r + p(t) + contact(from + d; h)` for the change d of the displacement.
    ///
    /// `d` holds r on entry and the solution on return; the factorisation for (`cm`, `cc`) is kept between calls.
    ///
    /// It is the change that is asked for because velocities and accelerations are made from it: as the difference of two
    /// displacements it would have an error of ε |u|, and the acceleration one of ε |u|/Δt². A mass in free flight, u =
    /// v t, would change its speed by some ε times the number of steps, at every step.
    ///
    /// # Errors
    /// No convergence, or a matrix that cannot be factorised.
    fn solve_implicit(
        &mut self,
        cm: f64,
        cc: f64,
        t: f64,
        h: &Histories,
        from: &[f64],
        d: &mut [f64],
    ) -> Result<(), StepError>;

    /// Solves `(cm M + cc C) d + f̄ = r + p(t) + Σ F̄ p` for the change d of the displacement to the middle `from + d` of a step
    /// from `s` to u₁ = 2 (from + d) − u₀, whose forces are discrete gradients of their energies:
    ///
    /// ```text
    /// f̄ᵀ (u₁ − u₀) = V(u₁) − V(u₀)            f̄ = K (from + d) of a linear structure
    /// F̄ (α₁ − α₀)  = W(α₁; h) − W(α₀; h)      of each contact, W stored and dissipated, h as committed in s
    /// ```
    ///
    /// Otherwise as [`Self::solve_implicit`].
    ///
    /// # Errors
    /// As [`Self::solve_implicit`].
    fn solve_midpoint(
        &mut self,
        cm: f64,
        cc: f64,
        t: f64,
        s: &State,
        from: &[f64],
        d: &mut [f64],
    ) -> Result<(), StepError>;

    /// Takes the accepted state into its histories.
    ///
    /// # Errors
    /// A point at which a law finds no answer.
    fn commit(&mut self, state: &mut State) -> Result<(), StepError>;

    /// Takes note of the end of a part of a step that an integrator has divided, and that began at the time `from`. Parts may be tried anew:
    /// a note takes back those after its beginning.
    fn note(&mut self, _from: f64, _state: &State) {}

    /// Indentation of contact `i` and its rate.
    fn indentation(&self, i: usize, state: &State) -> Indentation;

    /// Where the law of contact `i` changes its branch, after the committed history.
    fn branches(&self, i: usize, h: &ContactHistory) -> Branches;
}

/// How an integrator limits its step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepLimit {
    /// Stable for every step, as long as the system is linear.
    None,
    /// ω Δt must not exceed this, ω the highest frequency of plate and contact, however they are damped.
    OmegaDt(f64),
    /// |λ| Δt must not exceed this, λ the roots of λ² M + λ C + K of plate and contact: ω without damping, more where a motion
    /// is damped beyond its critical damping. The limit of schemes to which damping is a force like others.
    RootDt(f64),
}

impl StepLimit {
    /// The product that is limited, if there is one.
    pub fn product(self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::OmegaDt(limit) | Self::RootDt(limit) => Some(limit),
        }
    }
}

/// Substeps into which steps were divided by an error estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Substeps {
    /// How many.
    pub count: u64,
    /// The shortest, s.
    pub shortest: f64,
    /// The longest, s.
    pub longest: f64,
}

impl Substeps {
    /// So many of length `h`, s.
    pub fn new(count: u64, h: f64) -> Self {
        Self { count, shortest: h, longest: h }
    }

    /// These and `more`.
    #[must_use]
    pub fn and(self, more: Self) -> Self {
        Self {
            count: self.count + more.count,
            shortest: self.shortest.min(more.shortest),
            longest: self.longest.max(more.longest),
        }
    }
}

/// A one-step time integrator.
///
/// It keeps only work arrays: all that a restart needs is in [`State`].
pub trait Integrator: DynClone + Debug + Send {
    /// Order of accuracy in u and v while forces are smooth.
    fn order(&self) -> u32;

    /// The limit that the caller enforces before the march.
    fn limit(&self) -> StepLimit;

    /// Whether structure, impactors and contacts together gain no energy whatever the step, as with
    /// [`SecondOrderSystem::solve_midpoint`].
    fn conserves_energy(&self) -> bool {
        false
    }

    /// Spectral radius for steps much longer than a period: below 1, high modes are damped.
    fn radius_of_long_steps(&self) -> f64 {
        1.0
    }

    /// Substeps of the steps made since this was last asked, of one that divides its steps by an error estimate.
    fn take_substeps(&mut self) -> Option<Substeps> {
        None
    }

    /// The same with a tolerance `factor` times as large, of one that divides its steps by an error estimate in proportion to it.
    fn with_tolerance(&self, _factor: f64) -> Option<Box<dyn Integrator>> {
        None
    }

    /// Sizes work arrays and finds the acceleration of a fresh state.
    ///
    /// # Errors
    /// As [`SecondOrderSystem::solve_mass`].
    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError>;

    /// Sizes work arrays for a state that another march left.
    fn resume(&mut self, sys: &mut dyn SecondOrderSystem);

    /// Advances `s` by `dt` and commits its histories.
    ///
    /// # Errors
    /// Those of the system; `s` is then not to be used.
    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError>;
}
dyn_clone::clone_trait_object!(Integrator);
