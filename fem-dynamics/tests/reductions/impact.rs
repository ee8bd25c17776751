//! The force of an impact on a chain, against the unreduced chain at the same step.

use crate::{Dense, basis, reduction, spread};
use fem_core::functional::Functional;
use fem_core::plugin::{Built, Dimension, Params, Plugin, Value};
use fem_core::structure::Structure;
use fem_dynamics::contact::Hertz;
use fem_dynamics::impact::{ImpactSystem, Impactor};
use fem_dynamics::integrate::Newmark;
use fem_dynamics::reduce::Reduced;

/// Masses of the chain and the one that is hit.
const N: usize = 240;
const HIT: usize = 144;

fn chain() -> Dense {
    Dense::chain(&[2e-3; N], 4e6)
}

/// Contact forces over two passages of the wave to the held end and back.
fn forces(mass: f64, structure: Box<dyn Structure>, load: Vec<(usize, f64)>) -> Vec<f64> {
    let k = Value::Quantity(1e7, Dimension::contact_stiffness(1.5));
    let Ok(Built::Contact(law)) = Hertz::build(&Params::default().with("k", k)) else { panic!() };
    let Ok(Built::Integrator(mut newmark)) = Newmark::build(&Params::default()) else { panic!() };
    let impactor = Impactor { mass, velocity: 2.0, start: 0.0, load, law };
    let mut system = ImpactSystem::new(structure, vec![impactor]);
    let mut state = system.initial();
    newmark.start(&mut system, &mut state).unwrap();
    (0..2500)
        .map(|_| {
            newmark.step(&mut system, &mut state, 2e-5).unwrap();
            system.contact_force(0, &state)
        })
        .collect()
}

/// Relative L2 difference of the force with `unknowns` of the reduction, and its largest value relative.
fn errors(mass: f64, name: &str, unknowns: usize, full: &[f64]) -> (f64, f64) {
    let mut chain = chain();
    let contact = Functional::dof(HIT);
    // The contact, or the static residual, is one of the unknowns.
    let count = if name == "ritz" { unknowns } else { unknowns - 1 };
    let t = basis(&*reduction(name, count), &mut chain, std::slice::from_ref(&contact), &spread(N)).unwrap();
    assert_eq!(t.ncols(), unknowns, "{name}");
    let reduced = Reduced::project(&chain, t.as_slice()).unwrap();
    let load = reduced.restrict(&contact).into_iter().enumerate().collect();
    let force = forces(mass, Box::new(reduced.modal), load);
    let square = |f: &mut dyn Iterator<Item = f64>| f.map(|x| x * x).sum::<f64>().sqrt();
    let l2 = square(&mut force.iter().zip(full).map(|(a, b)| a - b)) / square(&mut full.iter().copied());
    let peak = |f: &[f64]| f.iter().fold(0.0_f64, |m, x| m.max(*x));
    (l2, (peak(&force) / peak(full) - 1.0).abs())
}

/// Relative L2 difference at equal size, measured and rounded up.
const L2: [(&str, [f64; 2]); 6] = [
    ("guyan", [7e-3, 5e-2]),
    ("guyan-ratio", [5e-3, 4e-2]),
    ("irs", [4e-2, 4e-2]),
    ("modal", [2e-3, 1e-3]),
    ("craig-bampton", [3e-3, 2e-3]),
    ("ritz", [3e-4, 9e-4]),
];

#[test]
fn the_force_converges_to_that_of_the_unreduced_chain() {
    // A tenth of the mass of the chain, which bounces off before an end answers; as much as the chain.
    for (case, mass) in [0.05, 0.5].into_iter().enumerate() {
        let full = forces(mass, Box::new(chain()), vec![(HIT, 1.0)]);
        for (name, bounds) in L2 {
            let [few, some, many] = [10, 20, 40].map(|unknowns| errors(mass, name, unknowns, &full));
            assert!(many.0 <= bounds[case], "{mass} kg, {name}: {:e}", many.0);
            assert!(many.0 < some.0 && some.0 < few.0, "{mass} kg, {name}: {few:?} {some:?} {many:?}");
        }
    }
}

#[test]
fn a_short_impact_shows_what_irs_loses() {
    let full = forces(0.05, Box::new(chain()), vec![(HIT, 1.0)]);
    let [irs, guyan] = ["irs", "guyan"].map(|name| errors(0.05, name, 40, &full).0);
    assert!(irs > 4.0 * guyan, "{irs:e} {guyan:e}");
}
