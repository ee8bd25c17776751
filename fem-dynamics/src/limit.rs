//! Stable time steps.

use crate::impact::ImpactSystem;
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
            "the step of {:.4} us is beyond the stability limit of {:.4} us: the integrator needs omega*dt <= {} and the \
             highest frequency of plate and contact is {:.4e} Hz (plate alone {:.4e} Hz)",
            self.step * 1e6,
            self.limit * 1e6,
            self.omega_dt,
            self.frequency,
            self.plate
        )
    }
}
impl std::error::Error for TooLong {}

/// The longest stable step of an integrator with limit `limit` on `system`; infinite for an unconditionally stable one.
/// Returns it with the highest circular frequency of the structure alone.
///
/// # Errors
/// A singular mass, for which no explicit step is stable.
pub fn longest_step(system: &mut ImpactSystem, limit: StepLimit) -> Result<(f64, Option<f64>), StepError> {
    let Some(allowed) = limit.product() else { return Ok((f64::INFINITY, None)) };
    let omega = system.highest_frequency()?;
    let mut bound = system.frequency_bound(omega)?;
    if let StepLimit::RootDt(_) = limit {
        bound = system.root_bound(omega).max(bound);
    }
    Ok((allowed / bound, Some(omega)))
}
