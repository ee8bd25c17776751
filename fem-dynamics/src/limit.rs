//! Stable time steps.

use crate::impact::ImpactSystem;
use fem_core::structure::Structure;
use fem_core::time::{StepError, StepLimit};
use std::fmt;

/// A step beyond the stability limit of its integrator.
#[derive(Debug, Clone, PartialEq)]
pub struct TooLong {
    /// The step asked for, s.
    pub step: f64,
    /// The longest stable step, s.
    pub limit: f64,
    /// ω Δt that the integrator allows.
    pub omega_dt: f64,
    /// Bound of the highest frequency, Hz.
    pub frequency: f64,
    /// The highest frequency of the plate alone, Hz.
    pub plate: f64,
}

impl fmt::Display for TooLong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the step of {:.4e} s is beyond the stability limit of {:.4e} s: the integrator needs omega*dt <= {} and the \
             highest frequency of plate and contact is {:.4e} Hz (plate alone {:.4e} Hz); shorten the step, reduce the \
             model, or use an implicit integrator such as `newmark`",
            self.step, self.limit, self.omega_dt, self.frequency, self.plate
        )
    }
}
impl std::error::Error for TooLong {}

/// The longest stable step of an integrator with limit `limit` on `system`, whose structure alone has the highest
/// frequency `omega` (rad/s); infinite for an unconditionally stable one.
///
/// # Errors
/// A singular mass, for which no explicit step is stable.
pub fn longest_step(system: &mut ImpactSystem, omega: f64, limit: StepLimit) -> Result<f64, StepError> {
    match limit {
        StepLimit::None => Ok(f64::INFINITY),
        StepLimit::OmegaDt(allowed) => Ok(allowed / system.frequency_bound(omega)?),
    }
}

/// Highest circular frequency of a structure, by power iteration on M⁻¹K with the Rayleigh quotient; the estimate is
/// raised by 2 % because it approaches from below.
///
/// # Errors
/// A singular mass.
pub fn highest_frequency(structure: &mut dyn Structure) -> Result<f64, StepError> {
    let n = structure.ndof();
    // A start that no symmetry makes orthogonal to the answer, the same on every machine.
    let mut x: Vec<f64> = (0..n).map(|i| ((i * 7919 % 1009) as f64 / 1009.0) - 0.47).collect();
    let mut y = vec![0.0; n];
    let mut omega2 = 0.0;
    for _ in 0..300 {
        y.fill(0.0);
        structure.add_stiffness(1.0, &x, &mut y);
        let energy: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
        let mut image = vec![0.0; n];
        structure.add_mass(1.0, &x, &mut image);
        let mass: f64 = x.iter().zip(&image).map(|(x, y)| x * y).sum();
        let quotient = energy / mass;
        structure.solve_mass(&mut y).map_err(|e| StepError::SingularMass(e.0))?;
        let size = y.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (x, y) in x.iter_mut().zip(&y) {
            *x = y / size;
        }
        let settled = (quotient - omega2).abs() <= 1e-4 * quotient;
        omega2 = quotient;
        if settled {
            break;
        }
    }
    Ok(1.02 * omega2.sqrt())
}
