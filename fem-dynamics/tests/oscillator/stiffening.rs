//! Implicit steps of a structure that stiffens, and what they say of its energy.

use crate::{hertz, scheme};
use fem_core::energy::Energy;
use fem_core::structure::{Nonlinear, SolveError, Structure, Tangent, Tangents};
use fem_dynamics::impact::{ImpactSystem, Impactor};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A mass of 1 kg on a spring of f = 4 u + 50 u³.
#[derive(Debug, Default)]
struct Stiffening {
    tangent: f64,
    /// How often the force was asked for.
    integrated: Arc<AtomicU64>,
}

/// What is stored in the spring, J.
fn stored(u: f64) -> f64 {
    2.0 * u * u + 12.5 * u.powi(4)
}

impl Structure for Stiffening {
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
        Some(self)
    }
}

impl Nonlinear for Stiffening {
    fn internal(&mut self, u: &[f64], _: &[f64], force: &mut [f64]) -> Result<Energy, SolveError> {
        self.integrated.fetch_add(1, Ordering::Relaxed);
        force[0] = 4.0 * u[0] + 50.0 * u[0].powi(3);
        Ok(Energy { stored: stored(u[0]), dissipated: 0.0 })
    }
    fn tangents(&mut self) -> Option<&mut dyn Tangents> {
        Some(self)
    }
}

impl Tangents for Stiffening {
    fn linearise(&mut self, tangent: &Tangent) -> Result<(), SolveError> {
        self.tangent = 4.0 + 150.0 * tangent.u[0].powi(2) + tangent.cm;
        Ok(())
    }
    fn solve_linearised(&mut self, x: &mut [f64], _: usize) -> Result<(), SolveError> {
        x[0] /= self.tangent;
        Ok(())
    }
}

/// The energy at the end of a step follows from its last iteration, and needs no force of its own.
#[test]
fn the_energy_is_that_of_the_spring() {
    let structure = Stiffening::default();
    let integrated = Arc::clone(&structure.integrated);
    let contact = hertz(1e3, 1.5);
    let impactor = Impactor { mass: 2.0, velocity: 1.0, start: 0.0, load: vec![(0, 1.0)], law: contact };
    let mut system = ImpactSystem::new(Box::new(structure), vec![impactor]);
    let mut state = system.initial();
    let mut newmark = scheme("newmark-average");
    newmark.start(&mut system, &mut state).unwrap();
    let mut largest = 0.0_f64;
    for step in 0..200 {
        newmark.step(&mut system, &mut state, 2e-3).unwrap();
        let before = integrated.load(Ordering::Relaxed);
        let strain = system.energies(&state, &mut Vec::new()).strain;
        assert_eq!(integrated.load(Ordering::Relaxed), before, "step {step}");
        largest = largest.max(strain);
        let missing = strain - stored(state.u[0]);
        assert!(missing.abs() <= 1e-13 * largest, "step {step}: {missing:e} J of {strain:e} J");
    }
    assert!(state.u[0].abs() > 0.1, "it stiffens: {:e} m", state.u[0]);
    // Anywhere else it is integrated.
    state.u[0] *= 1.0 + 1e-12;
    let before = integrated.load(Ordering::Relaxed);
    system.energies(&state, &mut Vec::new());
    assert_eq!(integrated.load(Ordering::Relaxed), before + 1);
}
