//! Orders of convergence.

use crate::{SCHEMES, dormand_prince, march, scheme, table};
use fem_core::testkit::{Mode, Oscillators, check_integrator};
use fem_core::time::{Integrator, State, StepError};
use std::f64::consts::PI;

const OMEGA: f64 = 2.0 * PI;

/// Dormand and Prince's pair without its error control.
fn whole_steps(name: &str) -> Box<dyn Integrator> {
    if name == "dormand-prince" { dormand_prince(0.1) } else { scheme(name) }
}

#[test]
fn contracts_hold() {
    for (name, order) in SCHEMES {
        assert_eq!(scheme(name).order(), order as u32, "{name}");
        check_integrator(&*scheme(name)).unwrap_or_else(|why| panic!("{name}: {why}"));
    }
}

#[test]
fn errors_agree_with_the_reference() {
    for row in table("convergence") {
        let (name, zeta, steps) = (row.text("scheme"), row.number("zeta"), row.number("steps"));
        let damped = OMEGA * (1.0 - zeta * zeta).sqrt();
        let exact = |t: f64| {
            let (sin, cos) = (damped * t).sin_cos();
            (-zeta * OMEGA * t).exp() * (cos + zeta * OMEGA / damped * sin)
        };
        let mut sys = Oscillators::free([Mode::new(OMEGA, zeta)]);
        let mut error: f64 = 0.0;
        let s = State { u: vec![1.0], ..sys.state() };
        march(scheme(name), &mut sys, s, 2.0 / steps, steps as usize, |s| {
            error = error.max((s.u[0] - exact(s.t)).abs());
        });
        let expected = row.number("error");
        // Accelerations from differences of displacements lose (omega dt)^2 to rounding, here and in the reference.
        let rounding = if name.starts_with("rk") { 1e-12 } else { 2e-10 };
        let tolerance = 1e-6 * expected + rounding;
        assert!((error - expected).abs() <= tolerance, "{name} {zeta} {steps}: {error:e}, {expected:e}");
    }
}

#[test]
fn loaded_oscillators_converge_in_order() {
    let rows = table("oscillator");
    let harmonic: fn(usize, f64) -> f64 = |_, t| (0.7 * OMEGA * t).sin();
    let none: fn(usize, f64) -> f64 = |_, _| 0.0;
    let step: fn(usize, f64) -> f64 = |_, _| 1.0;
    for (name, order) in SCHEMES {
        let scheme = whole_steps(name);
        // Steps in 0.05 s: enough to be in the range of the order, few enough to stay above the table's 12 digits.
        let coarse = [160, 16, 8, 4, 1][order as usize - 1];
        for (column, zeta, u, load) in [
            ("free", 0.0, 1.0, none),
            ("damped", 0.05, 1.0, none),
            ("step", 0.05, 0.0, step),
            ("harmonic", 0.0, 0.0, harmonic),
        ] {
            let error = |steps: usize| {
                let mut sys = Oscillators { load, ..Oscillators::free([Mode::new(OMEGA, zeta)]) };
                let s = State { u: vec![u], ..sys.state() };
                let (mut error, mut step): (f64, _) = (0.0, 0);
                march(scheme.clone(), &mut sys, s, 0.05 / steps as f64, steps * (rows.len() - 1), |s| {
                    if step % steps == 0 {
                        error = error.max((s.u[0] - rows[step / steps].number(column)).abs());
                    }
                    step += 1;
                });
                error
            };
            let (long, short) = (error(coarse), error(2 * coarse));
            let observed = (long / short).log2();
            assert!((observed - f64::from(order)).abs() < 0.1, "{name}, {column}: order {observed}, error {short:e}");
        }
    }
}

#[test]
fn a_step_of_endless_parts_is_refused() {
    let mut sys = Oscillators::free([Mode::new(OMEGA, 0.0)]);
    let mut s = State { u: vec![1.0], ..sys.state() };
    let mut scheme = dormand_prince(1e-6);
    scheme.start(&mut sys, &mut s).unwrap();
    let end = scheme.step(&mut sys, &mut s, 1e6);
    assert!(matches!(end, Err(StepError::NoConvergence { .. })), "{end:?}");
}
