//! Guards that stop a march which does what no impact can do, at almost no cost.

use crate::impact::{Energies, ImpactSystem, Touch};
use fem_core::time::State;
use std::fmt;

/// Change of the total energy, relative to that of the impact, that counts as wrong.
pub const TOLERANCE: f64 = 1e-2;

/// Loss of it that counts as wrong where a structure is damaged: waves that cracks send out are short, and an integrator that keeps faces
/// from clapping damps them.
pub const MOST_DAMPED: f64 = 5e-2;

/// Energy over that of the impact that speeds and indentations are held against: what is less wrong is for the balance to
/// find, which knows more of the cause.
const GROSS: f64 = 1.5;

/// What rounding may leave of an energy that cannot be negative, relative to that of the impact.
const ROUNDING: f64 = 1e-6;

/// Bounds that follow from the energy E₀ of an impact alone, whatever plate and contact do. Under gravity E₀ is the highest
/// energy that weight can make of it.
///
/// Of each impactor, at every step: indentation and force are numbers, the force does not pull, the indentation is not so
/// deep that the contact alone would have taken 1.5 E₀, the speed not above that of a kinetic energy of 1.5 E₀. Of the
/// whole, as often as wanted: strain energy and kinetic energy are not negative, the sum of all energies is E₀ within
/// [`TOLERANCE`], or has lost [`MOST_DAMPED`] of it where the structure is damaged.
///
/// The first kind costs a few comparisons, the second a product with K and one with M.
#[derive(Debug, Clone)]
pub struct Guard {
    energy: f64,
    /// E₀.
    scale: f64,
    /// What may be missing of the strain energy, and of the sum, relative to E₀.
    lent: f64,
    damped: f64,
    bounds: Vec<Bounds>,
}

#[derive(Debug, Clone, Copy)]
struct Bounds {
    indentation: f64,
    speed: f64,
}

/// A bound that is broken. Impactors are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Alarm {
    /// A number is NaN or infinite.
    NotFinite(&'static str),
    /// The energy has changed by this part of E₀; positive where it has grown.
    Energy(f64),
    /// An impactor is faster than the energy could make it.
    Speed {
        /// Which one.
        impactor: usize,
        /// Its speed, m/s.
        speed: f64,
        /// The highest possible, m/s.
        bound: f64,
    },
    /// A contact is deeper than the energy could press it.
    Penetration {
        /// Which one.
        impactor: usize,
        /// Its indentation, m.
        indentation: f64,
        /// The deepest possible, m.
        bound: f64,
    },
    /// A contact force pulls, N.
    Pull {
        /// Which one.
        impactor: usize,
        /// The force, N.
        force: f64,
    },
    /// An energy that cannot be negative is this part of E₀: the matrix behind it is not positive definite.
    Indefinite {
        /// Stiffness or mass.
        matrix: &'static str,
        /// Its energy over E₀.
        energy: f64,
    },
}

impl fmt::Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite(what) => write!(
                f,
                "{what} is not a finite number: a step beyond the limit of stability, or a contact law or element \
                 whose answer is not finite"
            ),
            Self::Energy(change) if change > 0.0 => write!(
                f,
                "the energy error is {change:.3e} of the impact energy, more than {TOLERANCE:.0e}: energy has grown, \
                 from a step too long for the contact or for the highest frequency, or from a contact law that gives \
                 back more than it took"
            ),
            Self::Energy(change) => write!(
                f,
                "the energy error is {:.3e} of the impact energy, more than is allowed: energy was lost, from a step too long for the \
                 contact, or in waves that the integrator damps",
                -change
            ),
            Self::Speed { impactor, speed, bound } => write!(
                f,
                "impactor {} moves at {speed:.4e} m/s, 1.5 times the energy of the impact could give it {bound:.4e} \
                 m/s: the step is too long for its contact",
                impactor + 1
            ),
            Self::Penetration { impactor, indentation, bound } => write!(
                f,
                "the contact of impactor {} is {indentation:.4e} m deep, 1.5 times the energy of the impact could \
                 press it {bound:.4e} m: the step is too long for its contact, which was crossed in a single step",
                impactor + 1
            ),
            Self::Pull { impactor, force } => write!(
                f,
                "the contact force of impactor {} is {force:.4e} N: a contact law must not pull",
                impactor + 1
            ),
            Self::Indefinite { matrix, energy } => write!(
                f,
                "the energy of the {matrix} is {energy:.3e} of the impact energy and cannot be negative: the {matrix} is \
                 not positive definite"
            ),
        }
    }
}
impl std::error::Error for Alarm {}

impl Guard {
    /// The bounds of `system` from its initial state.
    pub fn new(system: &mut ImpactSystem) -> Self {
        let initial = system.initial();
        Self::begun(system, &initial)
    }

    /// The bounds of `system` that begins with `state`.
    pub fn begun(system: &mut ImpactSystem, state: &State) -> Self {
        let energy = system.energies(state, &mut Vec::new()).total();
        // Bounds that cannot be found do not bind.
        let highest = system.highest_energy(energy).unwrap_or(f64::INFINITY);
        let most = GROSS * highest;
        let bounds = system.impactors().iter().map(|impactor| Bounds {
            indentation: impactor.indentation_of(most).unwrap_or(f64::INFINITY),
            speed: (2.0 * most / impactor.mass).sqrt(),
        });
        let scale = if highest.is_finite() { highest } else { energy };
        let bounds = bounds.collect();
        // An interface is lent what it is opened with, and gives it back elsewhere.
        let (lent, damped) = if system.softens() { (TOLERANCE, MOST_DAMPED) } else { (ROUNDING, TOLERANCE) };
        Self { energy, scale, lent, damped, bounds }
    }

    /// Energy at the beginning, J.
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// Looks at impactor `i` at the end of a step.
    ///
    /// # Errors
    /// A bound that is broken.
    #[inline]
    pub fn touch(&self, i: usize, touch: Touch) -> Result<(), Alarm> {
        let Touch { indentation, force, velocity, .. } = touch;
        let Bounds { indentation: deepest, speed } = self.bounds[i];
        // Comparisons that NaN fails, and one branch.
        if (indentation <= deepest) & (0.0..f64::INFINITY).contains(&force) & (velocity.abs() <= speed) {
            return Ok(());
        }
        Err(self.broken(i, touch))
    }

    #[cold]
    fn broken(&self, impactor: usize, Touch { indentation, force, velocity, .. }: Touch) -> Alarm {
        let bounds = self.bounds[impactor];
        if ![indentation, force, velocity].iter().all(|v| v.is_finite()) {
            Alarm::NotFinite("the contact")
        } else if force < 0.0 {
            Alarm::Pull { impactor, force }
        } else if indentation > bounds.indentation {
            Alarm::Penetration { impactor, indentation, bound: bounds.indentation }
        } else {
            Alarm::Speed { impactor, speed: velocity.abs(), bound: bounds.speed }
        }
    }

    /// Looks at all energies; returns the change of their sum, relative to E₀, where it is within [`TOLERANCE`].
    ///
    /// # Errors
    /// A bound that is broken.
    pub fn balance(&self, energies: &Energies) -> Result<f64, Alarm> {
        for (matrix, energy, most) in [("stiffness", energies.strain, self.lent), ("mass", energies.kinetic, ROUNDING)]
        {
            if energy < -most * self.scale {
                return Err(Alarm::Indefinite { matrix, energy: energy / self.scale });
            }
        }
        let change = (energies.total() - self.energy) / self.scale;
        match change {
            c if (-self.damped..=TOLERANCE).contains(&c) => Ok(c),
            c if c.is_finite() => Err(Alarm::Energy(c)),
            _ => Err(Alarm::NotFinite("the energy")),
        }
    }
}
