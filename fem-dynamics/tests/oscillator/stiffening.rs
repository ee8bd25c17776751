//! Implicit steps of a structure that stiffens, and what they say of its energy.

use crate::spring::Spring;
use crate::{hertz, scheme};
use fem_dynamics::impact::{ImpactSystem, Impactor};
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// The energy at the end of a step follows from its last iteration, and needs no force of its own.
#[test]
fn the_energy_is_that_of_the_spring() {
    let spring = Spring::stiffening(50.0);
    // J, by hand.
    let stored = |u: f64| 2.0 * u * u + 12.5 * u.powi(4);
    let integrated = Arc::clone(&spring.integrated);
    let contact = hertz(1e3, 1.5);
    let impactor = Impactor { mass: 2.0, velocity: 1.0, start: 0.0, load: vec![(0, 1.0)], law: contact };
    let mut system = ImpactSystem::new(Box::new(spring), vec![impactor]);
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
