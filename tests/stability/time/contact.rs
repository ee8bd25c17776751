//! Stiff, soft, short, repeated and multiple contact.

use super::plate::{MASS, Navier, Units};
use super::{Seen, TOLERANCE, hertz, integrator, integrators, largest, march, spring, struck, sun_yang};
use crate::case::{Case, Room};
use fem::core::contact::ContactLaw;
use fem::core::time::Integrator;
use fem::dynamics::impact::{ImpactSystem, Impactor};
use std::f64::consts::PI;

pub(super) fn cases() -> Vec<Case> {
    let swept = "Newmark; Navier's plate of 25 modes, Hertz and Sun-Yang contact; K of a steel tip times 1e-4, 1, 1e4; \
                 impactor of 1e-4 to 1e6 of the plate's mass; 1 mm/s to 300 m/s; the step shortened where a run would stop";
    vec![
        Room::Time.case(
            "stiff and soft contact: energy",
            swept,
            "times that the step has to be divided by four until the energy error is below 1e-2 (and no force is negative)",
            3.0,
            || sweep().divided,
        ),
        Room::Time.case(
            "stiff and soft contact: impulse",
            swept,
            "m (v0 - v1) against the integral of the force, over m v0",
            1e-10,
            || sweep().impulse,
        ),
        Room::Time.case(
            "stiff and soft contact: rebound",
            swept,
            "speed of the impactor over that before, less 1, where positive",
            1e-3,
            || sweep().rebound,
        ),
        Room::Time.case(
            "contact inside one step",
            "every integrator without a limit, but one that keeps the energy whatever the step; a mass against a spring and \
             against Navier's plate; steps of 0.3 to 1e3 times the contact",
            "marches without an error whose energy error stays below 1e-2 while the speed after is off by more than 5 %",
            0.0,
            inside_one_step,
        ),
        Room::Time.case(
            "two impactors in one place",
            "Newmark, rk4; halves of mass and stiffness; Navier's plate of 25 modes; K times 1e-4, 1",
            "difference of the force from that of one impactor, over the largest",
            1e-12,
            two_in_one_place,
        ),
        Room::Time.case(
            "two impactors, mirrored",
            "Newmark, rk4; Navier's plate of 25 modes, 1/100 to 1e4 of its mass; K times 1e-4, 1 (at 1e4 they chatter, and \
             rounding grows to all of the force)",
            "difference of the two forces, over the largest",
            1e-12,
            mirrored,
        ),
        Room::Time.case(
            "two impactors near each other",
            "Newmark; apart by 0, 1e-12, 1e-6, 1e-3 and 1e-1 of the edge; 1/100 to 1e4 of the plate's mass; K times 1, 1e4",
            "energy error over that of the impact",
            TOLERANCE,
            near_each_other,
        ),
    ]
}

/// Stiffness of a steel tip, N/m^1.5.
pub(super) const K: f64 = 8e8;

/// The worst of the sweep, which each row makes for itself: it takes some seconds.
#[derive(Debug, Default)]
struct Sweep {
    divided: f64,
    impulse: f64,
    rebound: f64,
}

fn sweep() -> Sweep {
    let plate = Navier::new(5, Units::SI);
    let mut worst = Sweep::default();
    swept(|mass, velocity, law| worst.take(&plate, mass, velocity, law));
    worst
}

/// Shows masses, velocities and laws of the sweep.
fn swept(mut show: impl FnMut(f64, f64, &dyn Fn() -> Box<dyn ContactLaw>)) {
    for stiffer in [1e-4, 1.0, 1e4] {
        for ratio in [1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6] {
            for velocity in [1e-3, 1.0, 300.0] {
                let k = stiffer * K;
                show(ratio * MASS, velocity, &|| hertz(k));
                show(ratio * MASS, velocity, &|| sun_yang(k, 2e-5));
            }
        }
    }
}

/// Time to march, s, and steps that follow the fastest motion.
fn length(plate: &Navier, system: &mut ImpactSystem) -> (f64, f64) {
    let fastest = system.frequency_bound(plate.highest()).unwrap();
    let mass = system.impactors()[0].mass;
    let end = (1.5 * PI * (mass * plate.flexibility()).sqrt()).max(600.0 / fastest);
    (end, 10.0 * end * fastest)
}

/// Steps of the sweep before any is divided.
const UNDIVIDED: usize = 10_000;

/// Shows the impacts of the sweep with the length and number of their undivided steps.
pub(super) fn sweep_of(mut show: impl FnMut(&mut ImpactSystem, f64, usize)) {
    let plate = Navier::new(5, Units::SI);
    swept(|mass, velocity, law| {
        let mut system = struck(&plate, &[mass], velocity, law());
        let (end, ample) = length(&plate, &mut system);
        let steps = (ample as usize).min(UNDIVIDED);
        show(&mut system, end / steps as f64, steps);
    });
}

impl Sweep {
    fn take(&mut self, plate: &Navier, mass: f64, velocity: f64, law: &dyn Fn() -> Box<dyn ContactLaw>) {
        let system = || struck(plate, &[mass], velocity, law());
        let (end, ample) = length(plate, &mut system());
        // As somebody does who is told to shorten the step.
        let marches = [1, 4, 16, 64].map(|parts| parts * UNDIVIDED).into_iter().enumerate().map(|(divided, most)| {
            let steps = (ample as usize).min(most);
            let dt = end / steps as f64;
            (divided, dt, march(integrator("newmark"), &mut system(), dt, steps))
        });
        let accepted = marches.flat_map(|(divided, dt, seen)| seen.map(|seen| (divided, dt, seen)));
        let Some((divided, dt, seen)) = accepted.into_iter().find(|(_, _, seen)| seen.imbalance() <= TOLERANCE) else {
            panic!("{mass} kg, {velocity} m/s, {:?}: no step is short enough", law());
        };
        let after = seen.state.v.last().unwrap();
        // Newmark's velocities are those of the trapezoidal rule, with no force before the first step.
        let impulse = dt * (seen.forces.iter().sum::<f64>() - 0.5 * seen.forces.last().unwrap());
        self.divided = largest([self.divided, divided as f64]);
        self.impulse = largest([self.impulse, ((velocity - after - impulse / mass) / velocity).abs()]);
        self.rebound = largest([self.rebound, (after.abs() / velocity - 1.0).max(0.0)]);
        assert!(seen.forces.iter().all(|force| *force >= 0.0));
    }
}

/// Marches of a few steps, each longer than the contact, against speeds of short steps.
fn inside_one_step() -> f64 {
    let plate = Navier::new(3, Units::SI);
    // One stiff mode is a ground.
    let ground = Navier::ground();
    let mut plausible = 0;
    for (plate, mass) in [(&ground, MASS), (&plate, 1e-2 * MASS), (&plate, MASS)] {
        let system = || struck(plate, &[mass], 1.0, spring(1e6));
        let contact = PI * (mass * (1e-6 + plate.flexibility())).sqrt();
        let speed = |seen: &Seen| *seen.state.v.last().unwrap();
        let fine = march(integrator("newmark"), &mut system(), 2e-4 * contact, 20_000).unwrap();
        assert!(fine.imbalance() < 1e-4 && *fine.forces.last().unwrap() == 0.0, "{:e}", fine.imbalance());
        for (_, scheme) in integrators().into_iter().filter(|(_, scheme)| shows_in_energy(&**scheme)) {
            for times in [0.3, 0.7, 1.0, 1.5, 3.0, 10.0, 100.0, 1e3] {
                let dt = times * contact;
                let Ok(seen) = march(scheme.clone(), &mut system(), dt, (4.0 / times) as usize + 4) else { continue };
                let off = (speed(&seen) - speed(&fine)).abs();
                plausible += u32::from(seen.imbalance() <= TOLERANCE && off > 0.05);
            }
        }
    }
    f64::from(plausible)
}

/// Whether a step has no limit, and one too long for a contact shows in the energy.
fn shows_in_energy(scheme: &dyn Integrator) -> bool {
    super::limit(scheme).is_none() && !scheme.conserves_energy()
}

/// `plate` under impactors at 2 m/s.
fn several(plate: &Navier, mass: f64, law: &dyn Fn() -> Box<dyn ContactLaw>, at: &[[f64; 2]]) -> ImpactSystem {
    let impactor = |at: &[f64; 2]| Impactor { mass, velocity: 2.0, start: 0.0, load: plate.load(*at), law: law() };
    ImpactSystem::new(Box::new(plate.clone()), at.iter().map(impactor).collect())
}

/// Steps through the fastest period, over some periods of the plate.
fn steps(system: &mut ImpactSystem, plate: &Navier) -> (f64, usize) {
    let dt = 0.3 / system.frequency_bound(plate.highest()).unwrap();
    (dt, ((2.0 * PI / plate.lowest() / dt) as usize).clamp(4000, 20_000))
}

fn off(a: impl IntoIterator<Item = f64>, b: &[f64]) -> f64 {
    largest(a.into_iter().zip(b).map(|(a, b)| (a - b).abs())) / largest(b.iter().copied())
}

fn two_in_one_place() -> f64 {
    let plate = Navier::new(5, Units::SI);
    let middle = [0.5, 0.5];
    let errors = ["newmark", "rk4"].into_iter().flat_map(|name| [1e-4, 1.0].map(|stiffer| (name, stiffer * K)));
    largest(errors.map(|(name, k)| {
        let [mut one, mut two] = [(1, 1.0), (2, 0.5)]
            .map(|(count, share)| several(&plate, share * MASS, &|| sun_yang(share * k, 2e-5), &vec![middle; count]));
        let (dt, steps) = steps(&mut one, &plate);
        let [one, two] = [&mut one, &mut two].map(|system| march(integrator(name), system, dt, steps).unwrap());
        off(two.forces.iter().map(|force| 2.0 * force), &one.forces)
    }))
}

fn mirrored() -> f64 {
    let plate = Navier::new(5, Units::SI);
    let mut worst = 0.0;
    for name in ["newmark", "rk4"] {
        for ratio in [1e-2, 1.0, 1e2, 1e4] {
            for stiffer in [1e-4, 1.0] {
                let places = [[0.3, 0.5], [0.7, 0.5]];
                let system = &mut several(&plate, ratio * MASS, &|| sun_yang(stiffer * K, 2e-5), &places);
                let (dt, steps) = steps(system, &plate);
                let mut scheme = integrator(name);
                let mut state = system.initial();
                scheme.start(system, &mut state).unwrap();
                let forces = (0..steps).map(|_| {
                    scheme.step(system, &mut state, dt).unwrap();
                    [0, 1].map(|i| system.contact_force(i, &state))
                });
                let (left, right): (Vec<f64>, Vec<f64>) = forces.map(|[a, b]| (a, b)).unzip();
                worst = largest([worst, off(left, &right)]);
            }
        }
    }
    worst
}

fn near_each_other() -> f64 {
    let plate = Navier::new(5, Units::SI);
    let mut worst = 0.0;
    for apart in [0.0, 1e-12, 1e-6, 1e-3, 0.1] {
        for ratio in [1e-2, 1.0, 1e4] {
            for stiffer in [1.0, 1e4] {
                let places = [[0.5, 0.5], [0.5 + apart, 0.5]];
                let system = &mut several(&plate, ratio * MASS, &|| hertz(stiffer * K), &places);
                let (dt, steps) = steps(system, &plate);
                worst = largest([worst, march(integrator("newmark"), system, dt, steps).unwrap().imbalance()]);
            }
        }
    }
    worst
}
