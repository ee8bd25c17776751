//! Amplification of one step of the oscillator.

use crate::{SCHEMES, scheme, table};
use fem_core::testkit::{Mode, Oscillators};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepLimit};
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// Spectral radius and relative period error of a unit step, from the matrix that takes (u, v, a) to the next step.
fn spectrum(mut scheme: Box<dyn Integrator>, omega: f64, zeta: f64) -> (f64, Option<f64>) {
    let mut sys = Oscillators::free([Mode::new(omega, zeta)]);
    let mut amplification = Matrix3::zeros();
    for (column, [u, v, a]) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate() {
        let mut s = State { u: vec![u], v: vec![v], a: vec![a], ..sys.state() };
        scheme.resume(&mut sys);
        scheme.step(&mut sys, &mut s, 1.0).unwrap();
        amplification.set_column(column, &[s.u[0], s.v[0], s.a[0]].into());
    }
    let roots = amplification.complex_eigenvalues();
    let radius = roots.iter().map(|z| z.norm()).fold(0.0, f64::max);
    let oscillating = roots.iter().find(|z| z.im > 1e-9);
    (radius, oscillating.map(|z| omega * (1.0 - zeta * zeta).sqrt() / z.arg() - 1.0))
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * b.abs().max(1.0)
}

/// Schemes that are the same on an oscillator as the one of the table.
fn alike(name: &str) -> Vec<&str> {
    if name == "newmark-average" { vec![name, "energy-conserving"] } else { vec![name] }
}

#[test]
fn radius_and_period_agree_with_the_reference() {
    for row in table("spectral") {
        let (name, omega, zeta) = (row.text("scheme"), row.number("omega_dt"), row.number("zeta"));
        for name in alike(name) {
            let (radius, period) = spectrum(scheme(name), omega, zeta);
            let expected = row.number("radius");
            assert!(close(radius, expected), "{name} {omega} {zeta}: radius {radius}, {expected}");
            let expected = row.get("period_error");
            assert_eq!(period.is_some(), expected.is_some(), "{name} {omega} {zeta}");
            if let (Some(period), Some(expected)) = (period, expected) {
                assert!(close(period, expected), "{name} {omega} {zeta}: period error {period}, {expected}");
            }
        }
    }
}

#[test]
fn limits_agree_with_theory() {
    let rows = table("limits");
    for (row, name) in rows.iter().flat_map(|row| alike(row.text("scheme")).into_iter().map(move |name| (row, name))) {
        let scheme = scheme(name);
        let radius = |omega: f64| spectrum(scheme.clone(), omega, 0.0).0;
        match row.get("limit") {
            None => {
                assert_eq!(scheme.limit(), StepLimit::None, "{name}");
                // Where three roots meet, the radius nears its limit as (omega dt)^(-2/3).
                let far = radius(1e8);
                assert!((far - row.number("radius_at_infinity")).abs() < 1e-5, "{name}: {far}");
            }
            Some(limit) => {
                let Some(own) = scheme.limit().product() else { panic!("{name} claims no limit") };
                assert!(own <= 0.9 * limit + 1e-9 || (limit == 0.0 && radius(own) - 1.0 <= 1e-6), "{name}: {own}");
                assert!(limit == 0.0 || radius(limit * (1.0 - 1e-9)) < 1.0 + 1e-7, "{name}");
                assert!(radius(limit * 1.001 + 1e-3) > 1.0, "{name}");
            }
        }
        let short = 2.0 * PI * 0.01;
        let coefficient = spectrum(scheme.clone(), short, 0.0).1.unwrap() / (short * short);
        assert!(close(coefficient, row.number("period_coefficient")), "{name}: {coefficient}");
    }
    assert_eq!(scheme("dormand-prince").limit(), StepLimit::None);
    assert_eq!(SCHEMES.len(), rows.len() + 2);
}

#[test]
fn massless_dofs_at_rest_need_no_inverse_of_the_mass() {
    let mut sys = Oscillators::free([Mode::new(1.0, 0.0), Mode { m: 0.0, c: 0.0, k: 1.0 }]);
    let mut newmark = scheme("newmark-average");
    let mut moving = State { v: vec![1.0, 0.0], ..sys.state() };
    newmark.start(&mut sys, &mut moving).unwrap();
    newmark.step(&mut sys, &mut moving, 0.1).unwrap();
    assert_eq!(moving.u[1], 0.0);
    assert!(sys.solve_mass(0.0, &mut [1.0, 1.0]).is_err());
    let mut loaded = State { u: vec![0.0, 1.0], ..sys.state() };
    assert!(newmark.start(&mut sys, &mut loaded).is_err());
}
