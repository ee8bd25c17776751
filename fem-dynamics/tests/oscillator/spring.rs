//! A mass on a spring, which may stiffen.

use fem_core::energy::Energy;
use fem_core::structure::{Nonlinear, SolveError, Structure, Tangent, Tangents};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A mass of 1 kg on a spring of f = 4 u + c u³.
#[derive(Debug, Default)]
pub(crate) struct Spring {
    /// c, N/m³.
    cubic: f64,
    tangent: f64,
    /// How often the force was asked for.
    pub(crate) integrated: Arc<AtomicU64>,
}

impl Spring {
    pub(crate) fn stiffening(cubic: f64) -> Self {
        Self { cubic, ..Self::default() }
    }
}

impl Structure for Spring {
    fn ndof(&self) -> usize {
        1
    }
    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        y[0] += scale * 4.0 * x[0];
    }
    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        y[0] += scale * x[0];
    }
    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], _: usize) -> Result<(), SolveError> {
        x[0] /= 4.0 + shift;
        Ok(())
    }
    fn solve_mass(&mut self, _: &mut [f64]) -> Result<(), SolveError> {
        Ok(())
    }
    fn nonlinear(&mut self) -> Option<&mut dyn Nonlinear> {
        if self.cubic == 0.0 { None } else { Some(self) }
    }
}

impl Nonlinear for Spring {
    fn internal(&mut self, u: &[f64], _: &[f64], force: &mut [f64]) -> Result<Energy, SolveError> {
        self.integrated.fetch_add(1, Ordering::Relaxed);
        force[0] = 4.0 * u[0] + self.cubic * u[0].powi(3);
        Ok(Energy { stored: 2.0 * u[0].powi(2) + 0.25 * self.cubic * u[0].powi(4), dissipated: 0.0 })
    }
    fn tangents(&mut self) -> Option<&mut dyn Tangents> {
        Some(self)
    }
}

impl Tangents for Spring {
    fn linearise(&mut self, tangent: &Tangent) -> Result<(), SolveError> {
        self.tangent = 4.0 + 3.0 * self.cubic * tangent.u[0].powi(2) + tangent.cm;
        Ok(())
    }
    fn solve_linearised(&mut self, x: &mut [f64], _: usize) -> Result<(), SolveError> {
        x[0] /= self.tangent;
        Ok(())
    }
}
