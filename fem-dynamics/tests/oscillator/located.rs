//! Contacts whose changes of branch are located, against closed forms and an outside integration.

use crate::spring::Spring;
use crate::{SCHEMES, dormand_prince, law, length, scheme, stiffness};
use fem_core::contact::ContactLaw;
use fem_core::plugin::Value;
use fem_core::testkit::{Oscillators, check_integrator};
use fem_core::time::{Integrator, SecondOrderSystem, State};
use fem_dynamics::contact::SunYang;
use fem_dynamics::impact::{ImpactSystem, Impactor};
use fem_dynamics::integrate::located;

/// Schemes that are located, with their orders.
const HIGH: [(&str, f64); 3] = [("rk3", 3.0), ("rk4", 4.0), ("dormand-prince", 5.0)];

/// Without error control, so that orders show.
fn whole_steps(name: &str) -> Box<dyn Integrator> {
    if name == "dormand-prince" { dormand_prince(0.1) } else { scheme(name) }
}

fn sun_yang(k: f64, n: f64, critical: f64) -> Box<dyn ContactLaw> {
    law::<SunYang>(&stiffness(k, n).with("m", Value::Number(n + 1.0)).with("critical", length(critical)))
}

/// The state after `steps` equal steps to the time `end`.
fn end(mut scheme: Box<dyn Integrator>, sys: &mut dyn SecondOrderSystem, mut s: State, end: f64, steps: u32) -> State {
    scheme.start(sys, &mut s).unwrap();
    for _ in 0..steps {
        scheme.step(sys, &mut s, end / f64::from(steps)).unwrap();
    }
    assert!((s.t - end).abs() < 1e-12);
    s
}

/// Error of a mass that flies for 0.37 s, strikes the ground, leaves a dent and flies on to 5 s; exponents n and n + 1.
fn ground(scheme: Box<dyn Integrator>, n: f64, steps: u32) -> f64 {
    // ∫ dx/√(1 − xᵖ) from 0 to 1, p = n + 1 and n + 2.
    let [loading, unloading] = match n {
        2.0 => [1.4021821053254543, 1.3110287771460599],
        _ => [1.4716375921623523, 1.3507245306289988],
    };
    let (critical, before): (f64, f64) = (0.3, 0.37);
    let peak = (0.5 * (n + 1.0)).powf(1.0 / (n + 1.0));
    let depth = peak * (critical / peak).powf(0.4);
    let away = (2.0 * peak.powf(n) * depth / (n + 2.0)).sqrt();
    let apart = before + peak * loading + depth / away * unloading;
    let mut sys = Oscillators::sphere(1.0, sun_yang(1.0, n, critical));
    let s = State { u: vec![-before], v: vec![1.0], ..sys.state() };
    let s = end(scheme, &mut sys, s, 5.0, steps);
    (s.u[0] - (peak - depth - away * (5.0 - apart))).abs().max((s.v[0] + away).abs())
}

/// Error of 1.5 kg at 1 m/s on the mass on its spring, at 4 s.
fn two_masses(scheme: Box<dyn Integrator>, n: f64, steps: u32) -> f64 {
    // Branch by branch with scipy's DOP853, relative tolerance 2.5e-14. For n = 2 the masses touch, turn and part, touch
    // again, go beyond the largest indentation, turn and part, touch once more and part.
    let (k, expected) = match n {
        2.0 => (40.0, [-0.178717299436789, -0.6136498771549183, 0.6391331166747629, -0.5746602905989593]),
        _ => (10.0, [-0.2518907690463982, -0.509962880236784, 0.4166346015741468, -0.6111236537686259]),
    };
    let impactor = Impactor { mass: 1.5, velocity: 1.0, start: 0.0, load: vec![(0, 1.0)], law: sun_yang(k, n, 0.1) };
    let mut sys = ImpactSystem::new(Box::new(Spring::default()), vec![impactor]);
    let s = sys.initial();
    let s = end(scheme, &mut sys, s, 4.0, steps);
    let energy = sys.energies(&s, &mut Vec::new()).total();
    let errors = s.u.iter().chain(&s.v).zip(expected).map(|(a, b)| (a - b).abs());
    errors.fold((energy / 0.75 - 1.0).abs(), f64::max)
}

type Error = fn(Box<dyn Integrator>, f64, u32) -> f64;
const CASES: [(&str, Error); 2] = [("ground", ground), ("two masses", two_masses)];

/// Mean order between `coarse` steps and 8 times as many, and the last error.
fn order(error: impl Fn(u32) -> f64, coarse: u32) -> (f64, f64) {
    let (long, short) = (error(coarse), error(8 * coarse));
    ((long / short).log2() / 3.0, short)
}

/// Root mean square of the errors of step lengths that differ a little: where in a step the switches lie decides much.
fn mean(error: Error, scheme: impl Fn() -> Box<dyn Integrator>, n: f64, steps: u32) -> f64 {
    let squares = (0..40).map(|k| error(scheme(), n, steps + k * steps / 80).powi(2));
    (squares.sum::<f64>() / 40.0).sqrt()
}

#[test]
fn smooth_branches_keep_the_order() {
    for (case, error) in CASES {
        for (name, nominal) in HIGH {
            let coarse = if nominal == 5.0 { 92 } else { 184 };
            let (observed, with) = order(|steps| error(located(whole_steps(name)), 2.0, steps), coarse);
            assert!((observed - nominal).abs() < 0.3, "{case}, {name}: order {observed}, error {with:e}");
            let without = error(whole_steps(name), 2.0, 8 * coarse);
            assert!(without > 8.0 * with, "{case}, {name}: {without:e} without, {with:e}");
        }
    }
}

#[test]
fn without_location_all_fall_to_the_second_order() {
    for (case, error) in CASES {
        for (name, _) in HIGH {
            let (observed, _) = order(|steps| mean(error, || whole_steps(name), 2.0, steps), 400);
            assert!((observed - 2.0).abs() < 0.2, "{case}, {name}: order {observed}");
        }
    }
}

#[test]
fn the_second_order_needs_no_location() {
    for (case, error) in CASES {
        for (name, nominal) in SCHEMES {
            if nominal != 2 {
                continue;
            }
            let (observed, _) = order(|steps| mean(error, || located(scheme(name)), 2.0, steps), 400);
            assert!((observed - 2.0).abs() < 0.1, "{case}, {name}: order {observed}");
        }
    }
}

#[test]
fn the_exponent_of_hertz_limits_the_order() {
    for (name, nominal) in HIGH {
        let (observed, with) = order(|steps| mean(ground, || located(whole_steps(name)), 1.5, steps), 200);
        let without = mean(ground, || whole_steps(name), 1.5, 1600);
        // The third order hides the rest of order 2.5, which has a small factor.
        let expected = if nominal == 3.0 { 3.0 } else { 2.5 };
        assert!((observed - expected).abs() < 0.3, "{name}: order {observed}, error {with:e}");
        assert!(without > 50.0 * with, "{name}: {without:e} without, {with:e}");
    }
}

#[test]
fn a_contact_inside_one_step_of_error_control_is_found() {
    let error = |scheme| ground(scheme, 1.5, 1);
    let fine = || dormand_prince(1e-10);
    let (with, without) = (error(located(fine())), error(fine()));
    assert!(with < 1e-8, "{with:e}");
    assert!(without > 1e-6, "{without:e}");
}

#[test]
fn two_contacts_at_once_are_one() {
    // Two impactors of half the mass and half the contact stiffness each are one of both.
    let impactors = |parts: usize| {
        let share = 1.0 / parts as f64;
        let law = sun_yang(40.0 * share, 2.0, 0.1);
        vec![Impactor { mass: 1.5 * share, velocity: 1.0, start: 0.0, load: vec![(0, 1.0)], law }; parts]
    };
    let [one, two] = [1, 2].map(|parts| {
        let mut sys = ImpactSystem::new(Box::new(Spring::default()), impactors(parts));
        let s = sys.initial();
        end(located(scheme("rk4")), &mut sys, s, 4.0, 400)
    });
    assert_eq!(two.u[1], two.u[2]);
    for (a, b) in [(one.u[0], two.u[0]), (one.u[1], two.u[1]), (one.v[0], two.v[0]), (one.v[1], two.v[1])] {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
}

#[test]
fn contracts_hold() {
    for (name, _) in HIGH {
        let scheme = located(scheme(name));
        check_integrator(&*scheme).unwrap_or_else(|why| panic!("{name}: {why}"));
    }
}
