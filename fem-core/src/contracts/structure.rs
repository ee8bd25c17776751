//! What the dynamic half may ask of a structure, sparse or reduced, linear or not.

use crate::words::energy::Energy;
use crate::words::prolongation::Prolongation;
use std::fmt;
use std::sync::Arc;

/// Why a structure has no answer.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum SolveError {
    /// The inverse of the mass was asked for.
    NoInertia {
        /// An unknown without any.
        unknown: String,
    },
    /// The stiffness is not positive definite.
    NotPositive {
        /// The unknown at which that shows.
        unknown: String,
    },
    /// A matrix holds a number that is not finite.
    NotFinite {
        /// Its unknown.
        unknown: String,
    },
    /// The tangent stiffness of a reduced plate is not positive definite.
    Buckled,
    /// A solution with a tangent was asked for before there was one.
    NotLinearised,
    /// The structure is linear, and was asked for forces that are not.
    Linear,
    /// An iteration for modes met a number that is not finite.
    ModesNotFinite,
    /// An iteration for modes did not end.
    ModesNotConverged {
        /// Modes asked for.
        count: usize,
        /// Vectors of the space searched.
        vectors: usize,
    },
    /// What else was in the way, such as a cell that cannot be integrated.
    Other(Arc<dyn std::error::Error + Send + Sync>),
}

impl SolveError {
    /// `why`, an error or a text, as an error of a structure.
    pub fn other(why: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        Self::Other(why.into().into())
    }
}

/// Errors are equal where they say the same.
impl PartialEq for SolveError {
    fn eq(&self, other: &Self) -> bool {
        self.to_string() == other.to_string()
    }
}

impl fmt::Display for SolveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoInertia { unknown } => write!(f, "{unknown} has no inertia"),
            Self::NotPositive { unknown } => write!(
                f,
                "the stiffness is not positive definite, seen at {unknown}: the structure is not held there, or its sizes or \
                 moduli lie too far apart for the arithmetic"
            ),
            Self::NotFinite { unknown } => write!(f, "the matrix is not finite at {unknown}"),
            Self::Buckled => {
                f.write_str(
                    "the tangent stiffness of the reduced plate is not positive definite: it buckles, or in a march its steps are too \
                     long to be followed",
                )
            }
            Self::NotLinearised => f.write_str("no tangent has been factorised"),
            Self::Linear => f.write_str("the structure is linear"),
            Self::ModesNotFinite => f.write_str("the Lanczos iteration met a number that is not finite"),
            Self::ModesNotConverged { count, vectors } => {
                write!(f, "{count} modes did not converge in a space of {vectors} vectors: ask for fewer")
            }
            Self::Other(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for SolveError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Other(why) => why.source(),
            _ => None,
        }
    }
}

/// A structure with stiffness K (symmetric, positive definite but for the free motions) and mass M (symmetric, semi-definite).
///
/// One with viscous damping C (symmetric, semi-definite) has an `add_damping`, `solve_damped`, `solve_damped_mass` and
/// `damping_rate` of its own; as they are provided, C = 0.
pub trait Structure: fmt::Debug + Send {
    /// Number of unknowns.
    fn ndof(&self) -> usize;

    /// What unknown `i` is called in messages.
    fn name(&self, i: usize) -> String {
        format!("unknown {}", i + 1)
    }

    /// `Y ← Y + scale · K X`, X and Y of `ndof × columns`, column-major.
    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]);

    /// `Y ← Y + scale · M X`, X and Y of `ndof × columns`, column-major.
    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]);

    /// `y ← y + scale · C x`, C of viscous damping; none adds nothing.
    fn add_damping(&self, _scale: f64, _x: &[f64], _y: &mut [f64]) {}

    /// Motions R that cost no energy, K R = 0, with Rᵀ M R = 1; `ndof × motions`, column-major. None of a structure that is held.
    fn free_motions(&self) -> &[f64] {
        &[]
    }

    /// `X ← (K + shift · M)⁻¹ X`, X of `ndof × columns`, column-major. The last factorisation is kept.
    ///
    /// At a shift of 0 a structure with free motions is in the frame that moves with them (inertia relief):
    /// X ← P K⁺ Pᵀ X, P = 1 − R Rᵀ M, is the deformation by what of a load does not accelerate it as a whole, and free of R.
    ///
    /// # Errors
    /// A matrix that is not positive definite; the message names the unknown.
    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError>;

    /// `x ← M⁻¹ x`.
    ///
    /// # Errors
    /// A singular mass.
    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError>;

    /// `X ← (K + cm · M + cc · C)⁻¹ X`, X of `ndof × columns`, column-major. The last factorisation is kept.
    ///
    /// # Errors
    /// As [`Self::solve_shifted`].
    fn solve_damped(&mut self, cm: f64, _cc: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        self.solve_shifted(cm, x, columns)
    }

    /// `x ← (M + cc · C)⁻¹ x`.
    ///
    /// # Errors
    /// A singular matrix.
    fn solve_damped_mass(&mut self, _cc: f64, x: &mut [f64]) -> Result<(), SolveError> {
        self.solve_mass(x)
    }

    /// Upper bound of the eigenvalues of M⁻¹C, 1/s, where no circular frequency is above `omega`.
    fn damping_rate(&self, _omega: f64) -> f64 {
        0.0
    }

    /// Highest circular frequency, rad/s, never below the true one by more than a few per cent.
    ///
    /// By power iteration on M⁻¹K with the Rayleigh quotient, which approaches from below; raised by 2 %.
    ///
    /// # Errors
    /// A singular mass.
    fn highest_frequency(&mut self) -> Result<f64, SolveError> {
        let n = self.ndof();
        // A start that no symmetry makes orthogonal to the answer, the same on every machine.
        let mut x: Vec<f64> = (0..n).map(|i| (i * 7919 % 1009) as f64 / 1009.0 - 0.47).collect();
        let (mut stiff, mut inert) = (vec![0.0; n], vec![0.0; n]);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut square = 0.0;
        for _ in 0..300 {
            stiff.fill(0.0);
            inert.fill(0.0);
            self.add_stiffness(1.0, &x, &mut stiff);
            self.add_mass(1.0, &x, &mut inert);
            let quotient = dot(&x, &stiff) / dot(&x, &inert);
            self.solve_mass(&mut stiff)?;
            let size = stiff.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for (x, y) in x.iter_mut().zip(&stiff) {
                *x = y / size;
            }
            let settled = (quotient - square).abs() <= 1e-5 * quotient;
            square = quotient;
            if settled {
                break;
            }
        }
        Ok(1.02 * square.sqrt())
    }

    /// Number of state variables of all points, where plies follow laws with a memory; those of a virgin structure are 0.
    fn states(&self) -> usize {
        0
    }

    /// Its internal force, where that is not K u.
    fn nonlinear(&mut self) -> Option<&mut dyn Nonlinear> {
        None
    }

    /// A number that changes when K does, of a structure whose interfaces open.
    fn revision(&self) -> u64 {
        0
    }

    /// A coarse model of the structure, where it has one.
    ///
    /// # Errors
    /// A coarse matrix that is too large to factorise.
    fn coarse(&self) -> Result<Option<Coarse>, SolveError> {
        Ok(None)
    }

    /// Factorisations and solved right-hand sides so far, where they cost anything.
    fn work(&self) -> (u64, u64) {
        (0, 0)
    }
}

/// A structure on fewer unknowns, u = P y: PᵀKP and PᵀMP.
#[derive(Debug)]
pub struct Coarse {
    /// The coarse structure.
    pub structure: Box<dyn Structure>,
    /// P.
    pub prolongation: Prolongation,
}

/// Internal forces that are not linear in the displacements, with f(0) = 0 and ∂f/∂u = K at u = 0 before anything has happened.
///
/// Where plies follow laws with a memory, f depends on the states `points` that the last accepted step has left.
pub trait Nonlinear {
    /// Internal force at `u`; returns the work done on the structure, J.
    ///
    /// # Errors
    /// A cell that cannot be integrated, displacements that are not finite.
    fn internal(&mut self, u: &[f64], points: &[f64], force: &mut [f64]) -> Result<Energy, SolveError>;

    /// Takes `u` into the states.
    ///
    /// # Errors
    /// As [`Nonlinear::internal`].
    fn commit(&mut self, _u: &[f64], _points: &mut [f64]) -> Result<(), SolveError> {
        Ok(())
    }

    /// What implicit steps iterate with. None of a structure that softens, whose forces never rise faster than those of K as
    /// [`Structure::solve_damped`] has it at hand, but for what is slow beside a step: that then takes the place of a tangent, once a step.
    fn tangents(&mut self) -> Option<&mut dyn Tangents> {
        None
    }
}

/// Tangents of internal forces.
pub trait Tangents {
    /// Factorises a tangent and keeps it.
    ///
    /// # Errors
    /// A matrix that is not positive definite; the message names the unknown.
    fn linearise(&mut self, tangent: &Tangent) -> Result<(), SolveError>;

    /// `X ← A⁻¹ X` with the last tangent, X of `ndof × columns`, column-major.
    ///
    /// # Errors
    /// There was none.
    fn solve_linearised(&mut self, x: &mut [f64], columns: usize) -> Result<(), SolveError>;
}

/// Which tangent is meant: A = ∂f/∂u + cm M + cc C, C the damping.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tangent {
    /// Factor on the mass.
    pub cm: f64,
    /// Factor on the damping.
    pub cc: f64,
    /// Displacements at which the internal force is derived.
    pub u: Vec<f64>,
    /// States of the points there.
    pub points: Vec<f64>,
}

/// How the deflections of a plate stretch it, as the laws of its plies see it: its membrane strains are Σ b_t (ε_t + B s_t), the amounts
/// b_t functions of its displacements, ε_t = Σ c_p ε_p over the pairs p of few deflections, ε_p by their slopes, s_t displacements that
/// follow at once.
pub trait Stretching: std::fmt::Debug + Send + Sync {
    /// The deflections, independent unknowns, one after the other.
    fn deflections(&self) -> &[f64];

    /// c_p of each pattern, `pairs × patterns`.
    fn combinations(&self) -> &[f64];

    /// The amounts at `u`, and `u` + Σ b_t s_t.
    fn expand(&self, u: &[f64], completed: &mut [f64], amounts: &mut Vec<f64>);

    /// Adds to `force` what the membrane stresses do on layers that are told apart, and what ties these carries over: Σ b_t r_t,
    /// r_t = ∫ Bᵀ C (ε_t + B s_t) dV.
    fn tear(&self, u: &[f64], force: &mut [f64]);

    /// Adds to `force` what forces conjugate to both do on `u`.
    fn restrict(&self, u: &[f64], on_completed: &[f64], on_amounts: &[f64], force: &mut [f64]);
}
