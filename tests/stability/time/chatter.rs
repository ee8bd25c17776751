//! A heavy impactor on a light mode, which bounces between its own spring and the impactor.

use super::plate::{Navier, Units};
use super::{integrator, largest, spring, struck};
use crate::case::{Case, Room};
use fem::core::structure::Structure;
use fem::core::time::SecondOrderSystem;

pub(super) fn cases() -> Vec<Case> {
    let varied = "one mode under 100, 300, 1000 times its mass, spring contact 30 and 300 times as stiff as the mode; rk4 and \
                  dormand-prince with switches located, Newmark; 12 to 203 contacts";
    let case =
        |name, measure, bound, worst| Case { room: Room::Time, name, varied, measure, bound, long: false, worst };
    vec![
        case(
            "chatter: number of contacts",
            "difference from closed forms branch by branch, switches by bisection",
            0.0,
            || chatter().count,
        ),
        case("chatter: energy", "energy error over that of the impact", 1e-3, || chatter().energy),
        case(
            "chatter: rebound, switches located",
            "error of the speed after the last contact, over that before the first",
            1e-6,
            || chatter().located,
        ),
        case(
            "chatter: rebound, Newmark",
            "error of the speed after the last contact, over that before the first",
            1e-2,
            || chatter().newmark,
        ),
    ]
}

#[derive(Debug, Default)]
struct Chatter {
    count: f64,
    energy: f64,
    located: f64,
    newmark: f64,
}

fn chatter() -> Chatter {
    let mut worst = Chatter::default();
    for ratio in [100.0, 300.0, 1000.0] {
        for stiffer in [30.0, 300.0] {
            worst.take(ratio, stiffer);
        }
    }
    worst
}

impl Chatter {
    fn take(&mut self, ratio: f64, stiffer: f64) {
        let plate = Navier::new(1, Units::SI);
        let [m, k] = [mass(&plate), 1.0 / plate.flexibility()];
        let contact = stiffer * k;
        let exact = Exact { m, k, impactor: ratio * m, contact };
        let end = 1.2 * std::f64::consts::PI * (ratio * m / k).sqrt();
        let (count, speed) = exact.march(1.0, end);
        for name in ["rk4", "dormand-prince", "newmark"] {
            let mut system = struck(&plate, &[ratio * m], 1.0, spring(contact));
            let mut scheme = integrator(name);
            let dt = 0.02 / ((k + 2.0 * contact) / m).sqrt();
            let mut state = system.initial();
            scheme.start(&mut system, &mut state).unwrap();
            let (mut contacts, mut touching, mut work) = (0_u32, false, Vec::new());
            let before = system.energies(&state, &mut work).total();
            for _ in 0..(end / dt) as usize {
                scheme.step(&mut system, &mut state, dt).unwrap();
                let touches = system.contact_force(0, &state) > 0.0;
                contacts += u32::from(touches && !touching);
                touching = touches;
                let energy = system.energies(&state, &mut work).total();
                self.energy = largest([self.energy, (energy / before - 1.0).abs()]);
            }
            self.count += f64::from(contacts.abs_diff(count));
            let error = (state.v[system.ndof() - 1] - speed).abs();
            let worst = if name == "newmark" { &mut self.newmark } else { &mut self.located };
            *worst = largest([*worst, error]);
        }
    }
}

fn mass(plate: &Navier) -> f64 {
    let mut one = [0.0];
    plate.add_mass(1.0, &[1.0], &mut one);
    one[0]
}

/// Two masses in closed form: apart, one oscillates and one flies; together, they have two modes.
struct Exact {
    m: f64,
    k: f64,
    impactor: f64,
    contact: f64,
}

/// w, z and their rates.
type Motion = [f64; 4];

impl Exact {
    /// `t` later, on the branch `touching`.
    fn after(&self, [w, z, dw, dz]: Motion, touching: bool, t: f64) -> Motion {
        if !touching {
            let [w, dw] = turned((self.k / self.m).sqrt(), w, dw, t);
            return [w, z + dz * t, dw, dz];
        }
        // In coordinates scaled by the roots of the masses: a symmetric matrix [a, b; b, c].
        let [s, r] = [self.m, self.impactor].map(f64::sqrt);
        let (a, b, c) = ((self.k + self.contact) / self.m, -self.contact / (s * r), self.contact / self.impactor);
        let angle = 0.5 * (2.0 * b).atan2(a - c);
        let (sin, cos) = angle.sin_cos();
        let onto = |w: f64, z: f64| [cos * s * w + sin * r * z, cos * r * z - sin * s * w];
        let squares =
            [a * cos * cos + 2.0 * b * sin * cos + c * sin * sin, a * sin * sin - 2.0 * b * sin * cos + c * cos * cos];
        let (q, dq) = (onto(w, z), onto(dw, dz));
        let [[q0, dq0], [q1, dq1]] = [0, 1].map(|i| turned(squares[i].sqrt(), q[i], dq[i], t));
        let back = |q0: f64, q1: f64| [(cos * q0 - sin * q1) / s, (sin * q0 + cos * q1) / r];
        let ([w, z], [dw, dz]) = (back(q0, q1), back(dq0, dq1));
        [w, z, dw, dz]
    }

    /// Contacts up to `end`, and the speed of the impactor then.
    fn march(&self, velocity: f64, end: f64) -> (u32, f64) {
        let look = 0.01 / ((self.k + 2.0 * self.contact) / self.m).sqrt();
        let (mut x, mut t, mut touching, mut contacts) = ([0.0, 0.0, 0.0, velocity], 0.0, true, 1);
        loop {
            let apart = |dt: f64| {
                let [w, z, ..] = self.after(x, touching, dt);
                (z > w) != touching
            };
            // A switch leaves α = 0 but for rounding: look behind it.
            let Some(high) = (1..).map(|i| f64::from(i) * look).find(|dt| t + dt > end || apart(*dt)) else { continue };
            if t + high > end {
                let [.., speed] = self.after(x, touching, end - t);
                return (contacts, speed);
            }
            let (mut low, mut high) = (high - look, high);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if apart(middle) { high = middle } else { low = middle }
            }
            x = self.after(x, touching, high);
            t += high;
            touching = !touching;
            contacts += u32::from(touching);
        }
    }
}

/// An oscillator's displacement and rate `t` later.
fn turned(omega: f64, q: f64, dq: f64, t: f64) -> [f64; 2] {
    let (sin, cos) = (omega * t).sin_cos();
    [q * cos + dq * sin / omega, dq * cos - q * omega * sin]
}
