//! A mass that strikes the ground.

use crate::{SCHEMES, dormand_prince, hertz, march, scheme, sun_yang, table};
use fem_core::contact::ContactLaw;
use fem_core::testkit::Oscillators;
use fem_core::time::{Integrator, State};
use fem_dynamics::contact::YigitChristoforou;

/// Highest force and indentation, time of contact, and the state after it.
struct Impact {
    force: f64,
    alpha: f64,
    time: f64,
    /// Largest error of the energy, relative to that of the impact.
    imbalance: f64,
    end: State,
}

/// `steps` steps of `dt`, which should hold the whole contact.
fn impact(scheme: Box<dyn Integrator>, m: f64, v: f64, law: Box<dyn ContactLaw>, dt: f64, steps: usize) -> Impact {
    let mut sys = Oscillators::sphere(m, law.clone());
    let s = State { v: vec![v], ..sys.state() };
    let start = 0.5 * m * v * v;
    let mut seen = Impact { force: 0.0, alpha: 0.0, time: 0.0, imbalance: 0.0, end: s.clone() };
    march(scheme, &mut sys, s, dt, steps, |s| {
        let h = &s.histories.contacts[0];
        let energy = law.energy(h, s.u[0]);
        let total = 0.5 * m * s.v[0] * s.v[0] + energy.stored + energy.dissipated;
        seen.imbalance = seen.imbalance.max((total / start - 1.0).abs());
        seen.force = seen.force.max(law.force(h, s.u[0]).force);
        seen.alpha = seen.alpha.max(s.u[0]);
        if s.u[0] <= 0.0 && seen.time == 0.0 && s.t > 0.0 {
            // Free flight since the contact ended.
            seen.time = s.t - s.u[0] / s.v[0];
        }
        seen.end = s.clone();
    });
    seen
}

/// Of a scheme of order 1, 2 or more, in this order.
fn of_order(order: i32, tolerances: [f64; 3]) -> f64 {
    tolerances[order.min(3) as usize - 1]
}

#[track_caller]
fn assert_close(what: &str, value: f64, expected: f64, tolerance: f64) {
    let error = (value / expected - 1.0).abs();
    assert!(error <= tolerance, "{what}: {value}, expected {expected}, error {error:e}");
}

#[test]
fn hertz_on_the_ground_meets_closed_forms() {
    for row in table("hertz_ground") {
        let [m, v, k, n, time] = ["m", "v", "k", "n", "time"].map(|c| row.number(c));
        for (name, order) in SCHEMES {
            let seen = impact(scheme(name), m, v, hertz(k, n), time / 2000.0, 2100);
            let tolerance = of_order(order, [6e-3, 4e-6, 4e-9]);
            assert_close(name, seen.alpha, row.number("d_max"), tolerance);
            assert_close(name, seen.force, row.number("F_max"), tolerance);
            assert_close(name, seen.time, time, tolerance);
            assert_close(name, -seen.end.v[0], v, tolerance);
            assert!(seen.imbalance <= tolerance, "{name}: energy {:e}", seen.imbalance);
        }
    }
}

#[test]
fn hertz_history_agrees_with_the_reference() {
    let rows = table("hertz_mass");
    for (name, order) in SCHEMES {
        let error = |steps: usize| {
            let mut sys = Oscillators::sphere(1.0, hertz(1.0, 1.5));
            let s = State { v: vec![1.0], ..sys.state() };
            let (mut error, mut step): (f64, _) = (0.0, 0);
            march(scheme(name), &mut sys, s, 0.05 / steps as f64, steps * (rows.len() - 1), |s| {
                if step % steps == 0 {
                    let row = &rows[step / steps];
                    error = error.max((s.u[0] - row.number("d")).abs()).max((s.v[0] - row.number("v")).abs());
                }
                step += 1;
            });
            error
        };
        let (long, short) = (error(20), error(40));
        // The table has ten digits.
        if order > 2 {
            assert!(short < 1e-9, "{name}: {short:e}");
        } else {
            let observed = (long / short).log2();
            assert!((observed - f64::from(order)).abs() < 0.05, "{name}: order {observed}, error {short:e}");
        }
    }
}

#[test]
fn sun_yang_on_the_ground_meets_closed_forms() {
    for row in table("sun_yang_ground") {
        let [m, v, k, critical, alpha, dent] = ["mass", "v", "k", "critical", "d_max", "dent"].map(|c| row.number(c));
        for (name, order) in SCHEMES {
            let law = sun_yang(k, critical, "loading-exponent");
            let seen = impact(scheme(name), m, v, law.clone(), alpha / v / 1000.0, 4000);
            // The highest indentation lies between two steps.
            let tolerance = of_order(order, [4e-3, 2e-6, 5e-7]);
            assert_close(name, seen.alpha, alpha, tolerance);
            assert_close(name, seen.force, row.number("F_max"), tolerance);
            assert_close(name, -seen.end.v[0] / v, row.number("e"), tolerance);
            assert!(seen.imbalance <= of_order(order, [4e-3, 2e-6, 2e-9]), "{name}: energy {:e}", seen.imbalance);

            let touch = dent + 1e-2 * (alpha - dent) * [-1.0, 1.0][usize::from(dent == 0.0)];
            let force = law.force(&seen.end.histories.contacts[0], touch).force;
            assert_eq!(force == 0.0, dent > 0.0, "{name}: force {force} at {touch}");
        }
    }
}

/// A sphere that comes to rest three times as deep as the ground yields, with F in units of k yields^1.5.
#[test]
fn a_sphere_on_ground_that_yields_meets_closed_forms() {
    let (m, k, yields) = (2.0, 9.7e8_f64, 4e-5_f64);
    let work = k * yields.powf(2.5);
    let dent = (3.0_f64.powf(1.5) - 4.0).powf(2.0 / 3.0);
    let given_back = 0.4 * (3.0_f64.powf(2.5) - dent.powf(2.5)) - dent.powf(1.5) * (3.0 - dent);
    let v = (2.0 * 5.4 * work / m).sqrt();
    for (name, order) in SCHEMES {
        let law = Box::new(YigitChristoforou::new(k, yields));
        let seen = impact(scheme(name), m, v, law, 3.0 * yields / v / 1000.0, 4000);
        let tolerance = of_order(order, [4e-3, 2e-6, 5e-7]);
        assert_close(name, seen.alpha, 3.0 * yields, tolerance);
        assert_close(name, seen.force, 4.0 * k * yields.powf(1.5), tolerance);
        assert_close(name, -seen.end.v[0] / v, (given_back / 5.4).sqrt(), tolerance);
        assert!(seen.imbalance <= of_order(order, [4e-3, 2e-6, 1e-7]), "{name}: energy {:e}", seen.imbalance);
    }
}

#[test]
fn a_restart_within_the_contact_changes_no_bit() {
    for (name, _) in SCHEMES {
        let mut sys = Oscillators::sphere(1.0, sun_yang(1.0, 0.5, "loading-exponent"));
        let mut straight = State { v: vec![1.0], ..sys.state() };
        let mut own = scheme(name);
        own.start(&mut sys, &mut straight).unwrap();
        let mut restarted = straight.clone();
        for step in 0..60 {
            own.step(&mut sys, &mut straight, 0.05).unwrap();
            let mut fresh = scheme(name);
            fresh.resume(&mut sys);
            fresh.step(&mut sys, &mut restarted, 0.05).unwrap();
            assert_eq!(straight, restarted, "{name}, step {step}");
        }
    }
}

#[test]
fn dormand_prince_finds_a_contact_inside_one_step() {
    let time = 3.2180654597;
    let law = hertz(1.0, 1.5);
    let seen = impact(dormand_prince(1e-8), 1.0, 1.0, law, 2.0 * time, 1);
    assert_close("time", seen.time, time, 1e-6);
    assert_close("speed", -seen.end.v[0], 1.0, 1e-6);
    let law = sun_yang(1.0, 10.0, "unloading-curve");
    let seen = impact(dormand_prince(1e-8), 1.0, 1.0, law, 2.0 * time, 1);
    assert_close("restitution", -seen.end.v[0], (5.0_f64 / 7.0).sqrt(), 1e-3);
}

#[test]
fn free_flight_keeps_the_speed_to_the_last_bit() {
    for (name, _) in SCHEMES {
        let mut sys = Oscillators::sphere(3.7, hertz(1.0, 1.5));
        let s = State { u: vec![-1.0], v: vec![-0.3], ..sys.state() };
        march(scheme(name), &mut sys, s, 1e-3, 10_000, |s| assert_eq!(s.v, [-0.3], "{name} at {}", s.t));
    }
}
