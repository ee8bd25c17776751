//! Steps that are halved until an estimate of their error is within a tolerance.

use crate::{hertz, scheme, sun_yang};
use fem_core::testkit::{Mode, Oscillators, check_integrator};
use fem_core::time::{State, StepError, Substeps};
use fem_dynamics::integrate::{divided, located};

const SCHEMES: [&str; 5] = ["energy-conserving", "newmark-average", "central-difference", "generalized-0.5", "rk4"];

#[test]
fn contracts_hold() {
    // Steps that vary at its limit make central differences grow.
    for name in SCHEMES.into_iter().filter(|name| *name != "central-difference") {
        // So loose that the check of the order sees two halves of every step.
        check_integrator(&*divided(located(scheme(name)), 0.1)).unwrap_or_else(|why| panic!("{name}: {why}"));
    }
}

/// Where the way back of a mass from the ground would have begun, in steps of 0.9 s, 3.6 to the contact, and what they were divided
/// into.
fn rebound(name: &str, tolerance: f64) -> (f64, Substeps) {
    let mut sys = Oscillators::sphere(1.0, hertz(1.0, 1.5));
    let mut s = State { u: vec![-0.2], v: vec![1.0], ..sys.state() };
    let mut scheme = divided(scheme(name), tolerance);
    scheme.start(&mut sys, &mut s).unwrap();
    for step in 1..=8 {
        scheme.step(&mut sys, &mut s, 0.9).unwrap();
        assert!((s.t - 0.9 * f64::from(step)).abs() < 1e-12);
    }
    (s.u[0] - s.v[0] * s.t, scheme.take_substeps().unwrap())
}

#[test]
fn errors_follow_the_tolerance_and_parts_the_force() {
    // The time of contact for speed 1, after 0.2 s of flight.
    let exact = 3.218_065_459_7 + 0.2;
    for name in SCHEMES {
        let [loose, middle, tight] = [1e-2, 1e-3, 1e-4].map(|tolerance| {
            let (intercept, parts) = rebound(name, tolerance);
            assert!(parts.longest == 0.45, "{name}: {parts:?}");
            ((intercept - exact).abs(), parts.count)
        });
        for ((error, count), tolerance) in [loose, middle, tight].into_iter().zip([1e-2, 1e-3, 1e-4]) {
            assert!(error < 3.0 * tolerance, "{name}, {tolerance}: {error:e} with {count} parts");
        }
        assert!(loose.1 < middle.1 && middle.1 < tight.1, "{name}: {loose:?} {middle:?} {tight:?}");
    }
}

#[test]
fn what_is_too_tight_is_refused() {
    let mut sys = Oscillators {
        contact: Some(sun_yang(10.0, 0.1, "unloading-curve")),
        ..Oscillators::free([Mode::new(1.0, 0.0)])
    };
    let mut s = State { v: vec![1.0], ..sys.state() };
    let mut scheme = divided(scheme("energy-conserving"), 1e-300);
    scheme.start(&mut sys, &mut s).unwrap();
    let end = scheme.step(&mut sys, &mut s, 1.0);
    assert!(matches!(&end, Err(StepError::NoConvergence { what, .. }) if what.contains("loosen")), "{end:?}");
}
