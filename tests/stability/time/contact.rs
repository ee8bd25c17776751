//! Stiff, soft, short, grazing, repeated and multiple contact.

use super::plate::{MASS, Navier, Units};
use super::{TOLERANCE, hertz, integrator, integrators, largest, march, spring, struck, sun_yang};
use crate::case::{Case, Room};
use fem::core::contact::ContactLaw;
use fem::core::testkit::Modes;
use fem::core::time::{State, StepError};
use fem::dynamics::impact::{ImpactSystem, Impactor};

pub(super) fn cases() -> Vec<Case> {
    let sweep = "Newmark; Navier's plate of 25 modes, Hertz and Sun-Yang contact; K of a steel tip times 1e-4, 1, 1e4; \
                 impactor of 1e-4 to 1e6 of the plate's mass; 1 mm/s to 300 m/s";
    let case = |name, varied, measure, bound, worst| Case {
        room: Room::Time,
        name,
        varied,
        measure,
        bound,
        long: false,
        worst,
    };
    vec![
        case("stiff and soft contact: energy", sweep, "energy error over the energy of the impact", 1e-2, || {
            swept(|swept| swept.seen.imbalance())
        }),
        case("stiff and soft contact: impulse", sweep, "m (v0 - v1) against the integral of the force, over m v0", 1e-9, || {
            swept(Swept::impulse)
        }),
        case("stiff and soft contact: rebound", sweep, "speed of the impactor over that of the impact, less 1", 1e-2, || {
            swept(|swept| (swept.seen.state.v.last().unwrap().abs() / swept.velocity - 1.0).max(0.0))
        }),
        case("stiff and soft contact: sign", sweep, "steps after which the contact force is negative", 0.0, || {
            swept(|swept| swept.seen.forces.iter().filter(|f| !(**f >= 0.0)).count() as f64)
        }),
    ]
}

/// An impact of a sweep.
struct Swept {
    mass: f64,
    velocity: f64,
    dt: f64,
    seen: super::Seen,
}

impl Swept {
    /// Newmark's velocities are those of the trapezoidal rule.
    fn impulse(self) -> f64 {
        let half: f64 = self.seen.forces.windows(2).map(|f| 0.5 * (f[0] + f[1])).sum::<f64>() + 0.5 * self.seen.forces[0];
        let lost = self.velocity - self.seen.state.v.last().unwrap();
        (self.mass * lost - half * self.dt).abs() / (self.mass * self.velocity)
    }
}

const K: f64 = 8e8;

fn swept(measure: impl Fn(Swept) -> f64) -> f64 {
    let plate = Navier::new(5, Units::SI);
    let mut worst = 0.0_f64;
    for stiffer in [1e-4, 1.0, 1e4] {
        for ratio in [1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6] {
            for velocity in [1e-3, 1.0, 300.0] {
                for law in [hertz(stiffer * K), sun_yang(stiffer * K, 2e-5)] {
                    let mass = ratio * MASS;
                    let mut system = struck(&plate, &[mass], velocity, law);
                    let omega = system.highest_frequency().unwrap();
                    let fastest = system.frequency_bound(omega).unwrap();
                    let contact = std::f64::consts::PI * (mass * plate.flexibility()).sqrt();
                    let dt = 0.3 / fastest;
                    let steps = (1.5 * contact / dt).max(2000.0);
                    let t = std::time::Instant::now();
                    let seen = march(integrator("newmark"), &mut system, dt, (steps as usize).min(200_000)).unwrap();
                    let s = Swept { mass, velocity, dt, seen };
                    eprintln!("K {stiffer:e} ratio {ratio:e} v {velocity:e} steps {steps:.1e} imb {:.2e} v1 {:e} fmin {:e} peak {:e} last {:e} {:?}", s.seen.imbalance(), s.seen.state.v.last().unwrap()/velocity, s.seen.forces.iter().fold(0.0_f64,|a,b|a.min(*b)), largest(s.seen.forces.iter().copied()), s.seen.forces.last().unwrap(), t.elapsed());
                    worst = largest([worst, measure(s)]);
                }
            }
        }
    }
    worst
}
