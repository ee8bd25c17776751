//! The integrator fulfils the contract of all integrators, and damps what is too fast for its step.

use fem_core::testkit::{Mode, Oscillators, check_integrator};
use fem_core::time::{Integrator, State};
use plugin_integrator::TrBdf2;

// ANCHOR: contract
#[test]
fn it_fulfils_the_contract() {
    assert_eq!(check_integrator(&TrBdf2::default()), Ok(()));
}
// ANCHOR_END: contract

/// Part of a unit amplitude that is left after a tenth of a second in steps of 10 ms.
fn left(omega: f64) -> f64 {
    let mut scheme = TrBdf2::default();
    let mut sys = Oscillators::free([Mode::new(omega, 0.0)]);
    let mut s = State { u: vec![1.0], ..sys.state() };
    scheme.start(&mut sys, &mut s).unwrap();
    for _ in 0..10 {
        scheme.step(&mut sys, &mut s, 0.01).unwrap();
    }
    s.u[0].hypot(s.v[0] / omega)
}

#[test]
fn it_keeps_slow_motions_and_drops_fast_ones() {
    assert!(left(10.0) > 0.9999, "{}", left(10.0));
    assert!(left(1e6) < 1e-9, "{}", left(1e6));
}
