//! Damped free vibration of a structure in modal coordinates.

use crate::{Dense, random_definite};
use fem_core::damping::{Damping, Rayleigh};
use fem_core::plugin::{Built, Params, Plugin};
use fem_core::time::Integrator;
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::integrate::{CentralDifference, DormandPrince, GeneralizedAlpha, HhtAlpha, Newmark, Rk3, Rk4};
use fem_dynamics::reduce::{Modal, Reduced};
use std::f64::consts::TAU;

fn built<P: Plugin>() -> Box<dyn Integrator> {
    match P::build(&Params::default()) {
        Ok(Built::Integrator(integrator)) => integrator,
        other => panic!("{other:?}"),
    }
}

fn modal(damping: Damping) -> Modal {
    let n = 5;
    let structure = Dense::new(random_definite(n, 1), random_definite(n, 2));
    let unit: Vec<f64> = (0..n * n).map(|i| f64::from(i / n == i % n)).collect();
    let mut modal = Reduced::project(&structure, &unit).unwrap().modal;
    modal.damp(damping);
    modal
}

/// Displacement and velocity at `t` of `ü + 2 ζ ω u̇ + ω² u = 0` from rest at 1.
fn closed_form(omega: f64, zeta: f64, t: f64) -> [f64; 2] {
    let decay = (-zeta * omega * t).exp();
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let (sin, cos) = (damped * t).sin_cos();
    [decay * (cos + zeta * omega / damped * sin), -decay * omega * omega / damped * sin]
}

#[test]
fn every_mode_decays_as_its_closed_form() {
    let rayleigh = Rayleigh { mass: 0.05, stiffness: 0.02 };
    for damping in [Damping::Ratio(0.05), Damping::Rayleigh(rayleigh)] {
        let modal = modal(damping);
        let frequencies: Vec<f64> = modal.frequencies().collect();
        let end = 3.0 * TAU / frequencies[0];
        for mut integrator in [
            built::<Newmark>(),
            built::<GeneralizedAlpha>(),
            built::<HhtAlpha>(),
            built::<CentralDifference>(),
            built::<Rk3>(),
            built::<Rk4>(),
            built::<DormandPrince>(),
        ] {
            let mut error = |steps: u32| {
                let mut system = ImpactSystem::new(Box::new(modal.clone()), Vec::new());
                let mut state = system.initial();
                state.u.fill(1.0);
                integrator.start(&mut system, &mut state).unwrap();
                (0..steps).for_each(|_| integrator.step(&mut system, &mut state, end / f64::from(steps)).unwrap());
                let each = frequencies.iter().enumerate().map(|(i, omega)| {
                    let zeta = match damping {
                        Damping::Ratio(ratio) => ratio,
                        Damping::Rayleigh(Rayleigh { mass, stiffness }) => 0.5 * (mass / omega + stiffness * omega),
                    };
                    let [u, v] = closed_form(*omega, zeta, end);
                    (state.u[i] - u).abs().max((state.v[i] - v).abs() / omega)
                });
                each.fold(0.0, f64::max)
            };
            let [long, short] = [4000, 8000].map(&mut error);
            let order = (long / short).log2();
            let least = f64::from(integrator.order()) - 0.3;
            assert!(short < 1e-8 || (short < 1e-3 && order > least), "{integrator:?}: {short:e}, order {order}");
        }
    }
}

/// Successive peaks of a mode fall by δ = 2π ζ/√(1 − ζ²), the logarithmic decrement.
#[test]
fn peaks_fall_by_the_logarithmic_decrement() {
    let zeta = 0.05;
    let modal = modal(Damping::Ratio(zeta));
    let omega = modal.frequencies().next().unwrap();
    let period = TAU / (omega * (1.0_f64 - zeta * zeta).sqrt());
    let mut system = ImpactSystem::new(Box::new(modal), Vec::new());
    let mut state = system.initial();
    state.u[0] = 1.0;
    let (mut newmark, steps) = (built::<Newmark>(), 2000);
    newmark.start(&mut system, &mut state).unwrap();
    let mut peaks = vec![1.0];
    for _ in 0..4 {
        (0..steps).for_each(|_| newmark.step(&mut system, &mut state, period / f64::from(steps)).unwrap());
        peaks.push(state.u[0]);
    }
    let decrement = TAU * zeta / (1.0 - zeta * zeta).sqrt();
    for pair in peaks.windows(2) {
        assert!(((pair[0] / pair[1]).ln() / decrement - 1.0).abs() < 1e-4, "{peaks:?}");
    }
}
