//! An end notched strip that a mass strikes: the crack runs, the energy stays.

use super::specimens::{Specimen, WIDTH, end_notched};
use fem_core::contact::{ContactForce, ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use fem_core::plugin::{Built, Params, Plugin, Value};
use fem_core::structure::Structure;
use fem_dynamics::impact::{ImpactSystem, Impactor};
use fem_dynamics::integrate::GeneralizedAlpha;

#[derive(Debug, Clone)]
struct Spring(f64);

impl ContactLaw for Spring {
    fn force(&self, _: &ContactHistory, alpha: f64) -> ContactForce {
        let tangent = if alpha > 0.0 { self.0 } else { 0.0 };
        ContactForce { force: tangent * alpha, tangent }
    }
    fn commit(&self, _: &mut ContactHistory, _: f64) {}
    fn energy(&self, _: &ContactHistory, alpha: f64) -> Energy {
        Energy { stored: 0.5 * self.0 * alpha.max(0.0).powi(2), dissipated: 0.0 }
    }
}

/// What is known of a march.
struct Ran {
    /// Largest force, N.
    peak: f64,
    /// Largest deviation of the energy from what it was, relative; what numerical damping takes is in it.
    balance: f64,
    /// Length that holds no more, m.
    open: f64,
    /// Energy dissipated, J.
    dissipated: f64,
}

/// Marches to 1.2 ms in steps of `dt`.
fn march(dt: f64) -> Ran {
    let specimen = Specimen { penalty: 2e13, ..end_notched(25e-3) };
    let (plate, states) = specimen.build();
    let parts = plate.parts().clone();
    let load = parts.constraints.restrict(&specimen.load(&plate));
    let impactor = Impactor { mass: 0.3, velocity: 3.0, start: 0.0, load, law: Box::new(Spring(2e6)) };
    let mut system = ImpactSystem::new(Box::new(plate) as Box<dyn Structure>, vec![impactor]);
    let params = Params::default().with("rho", Value::Number(0.5));
    let Built::Integrator(mut scheme) = GeneralizedAlpha::build(&params).unwrap() else { panic!() };
    let mut state = system.initial();
    state.histories.points = states;
    scheme.start(&mut system, &mut state).unwrap();
    let (mut work, mut peak, mut balance) = (Vec::new(), 0.0_f64, 0.0_f64);
    let whole = 0.5 * 0.3 * 3.0 * 3.0;
    while state.t < 1.2e-3 - 0.5 * dt {
        scheme.step(&mut system, &mut state, dt).unwrap();
        peak = peak.max(system.contact_force(0, &state));
        balance = balance.max((system.energies(&state, &mut work).total() / whole - 1.0).abs());
    }
    let open = parts.interfaces.lost_area(&state.histories.points, 0.9999)[&1] / WIDTH;
    Ran { peak, balance, open, dissipated: system.energies(&state, &mut work).plies }
}

#[test]
fn a_struck_strip_cracks_and_keeps_its_energy() {
    let [long, short] = [0.5e-6, 0.25e-6].map(march);
    // The crack has run by more than half its length, through an unstable part.
    assert!(short.open > 40e-3, "{}", short.open);
    assert!(long.balance < 5e-3 && short.balance < 3e-3, "{} {}", long.balance, short.balance);
    for (name, a, b, tolerance) in [
        ("crack", long.open, short.open, 0.03),
        ("dissipated", long.dissipated, short.dissipated, 0.05),
        ("force", long.peak, short.peak, 0.03),
    ] {
        assert!((a / b - 1.0).abs() < tolerance, "{name}: {a} {b}");
    }
    // What is dissipated is GIIc times the area that has opened, and what the process zone has taken.
    let of_area = short.dissipated / (770.0 * WIDTH * (short.open - 25e-3));
    assert!((1.0..1.15).contains(&of_area), "{of_area}");
}
