//! A mass much smaller than the plate's: the impact is over before waves return from the edges.

use fem_core::contact::{ContactForce, ContactHistory, ContactLaw};
use std::f64::consts::TAU;
use std::ops::ControlFlow;

/// c = 8 √(m D*), N s/m: force over velocity of an infinite plate under a force at a point (Zener, Phys. Rev. 59 (1941) 669;
/// Olsson, AIAA J. 30 (1992) 1587). m is the mass per area, D* the effective bending stiffness.
pub fn impedance(areal_mass: f64, bending_stiffness: f64) -> f64 {
    8.0 * (areal_mass * bending_stiffness).sqrt()
}

/// T = (M/(k √V))^(2/5), s: time scale of Hertz's contact; on a rigid target it lasts 3.218 T.
pub fn contact_time(mass: f64, velocity: f64, k: f64) -> f64 {
    (mass / (k * velocity.sqrt())).powf(0.4)
}

/// Zener's λ = M/(c T): far below 1 the impactor sees a half-space, above 1 the plate takes its energy.
pub fn inelasticity(mass: f64, velocity: f64, impedance: f64, k: f64) -> f64 {
    mass / (impedance * contact_time(mass, velocity, k))
}

/// Largest force of a mass that strikes an infinite plate through a linear spring K, N:
///
/// F = V √(K M) exp(−ζ/√(1 − ζ²) · acos ζ) with ζ = √(K M)/(2 c) < 1, and the same with acosh and √(ζ² − 1) beyond; it falls
/// from V √(K M) on a half-space to c V on a plate that yields as it is struck.
pub fn linear_contact_force(mass: f64, velocity: f64, impedance: f64, stiffness: f64) -> f64 {
    let zeta = damping(mass, impedance, stiffness);
    let exponent = match (1.0 - zeta * zeta).abs().sqrt() {
        // Both branches meet here.
        root if root < 1e-4 => 1.0,
        root if zeta < 1.0 => zeta / root * zeta.acos(),
        root => zeta / root * zeta.acosh(),
    };
    velocity * (stiffness * mass).sqrt() * (-exponent).exp()
}

/// ζ = √(K M)/(2 c).
pub fn damping(mass: f64, impedance: f64, stiffness: f64) -> f64 {
    (stiffness * mass).sqrt() / (2.0 * impedance)
}

/// The first contact with an infinite plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// Largest force, N.
    pub force: f64,
    /// When, s.
    pub time: f64,
    /// Deflection under the impactor at the end of the contact, m.
    pub deflection: f64,
    /// Largest indentation, m.
    pub indentation: f64,
    /// √(∫ Ḟ² dt / ∫ F² dt) / 2π, Hz.
    pub frequency: f64,
}

/// Steps of the integration within a time scale of the contact or of the plate, whichever is shorter.
const STEPS: f64 = 400.0;

/// Indentation at the beginning over that of the first step.
const TOUCH: f64 = 1e-9;

/// Steps after which the integration ends in any case.
const MOST_STEPS: usize = 200_000;

/// Contact with an infinite plate, whose deflection grows at F/c:
///
/// α'' + F'(α) α'/c + F(α)/M = 0, α(0) = 0, α'(0) = V
///
/// (Zener; Olsson), by the method of Runge and Kutta. Any contact law will do; the deflection is the momentum that was given
/// up, over c.
pub fn infinite_plate(mass: f64, velocity: f64, impedance: f64, law: &dyn ContactLaw, k: f64) -> Wave {
    let mut peak = Wave { force: 0.0, time: 0.0, deflection: 0.0, indentation: 0.0, frequency: 0.0 };
    let (mut square, mut rates, mut last) = (0.0, 0.0, 0.0);
    follow(mass, velocity, impedance, law, k, |Moment { time, dt, state: [alpha, speed], force }| {
        if alpha > peak.indentation {
            peak = Wave { force, time, indentation: alpha, ..peak };
        }
        square += force * force;
        rates += ((force - last) / dt).powi(2);
        last = force;
        let given_up = velocity - (speed + force / impedance);
        peak.deflection = mass * given_up / impedance;
        ControlFlow::Continue(())
    });
    peak.frequency = (rates / square).sqrt() / TAU;
    peak
}

/// The time of [`Wave`] alone, which is over long before the contact is.
pub fn rise_time(mass: f64, velocity: f64, impedance: f64, law: &dyn ContactLaw, k: f64) -> f64 {
    let (mut time, mut indentation) = (0.0, 0.0);
    follow(mass, velocity, impedance, law, k, |moment| {
        let [alpha, _] = moment.state;
        if !(alpha > indentation) {
            return ControlFlow::Break(());
        }
        (time, indentation) = (moment.time, alpha);
        ControlFlow::Continue(())
    });
    time
}

/// What the contact with an infinite plate is after a step.
struct Moment {
    time: f64,
    dt: f64,
    /// Indentation and its rate.
    state: [f64; 2],
    force: f64,
}

/// Steps through the contact, until it is over or `heard` has enough.
fn follow(
    mass: f64,
    velocity: f64,
    impedance: f64,
    law: &dyn ContactLaw,
    k: f64,
    mut heard: impl FnMut(Moment) -> ControlFlow<()>,
) {
    let contact = |alpha: f64| law.force(&ContactHistory::default(), alpha);
    let rate = |contact: ContactForce, speed: f64| [speed, -contact.tangent * speed / impedance - contact.force / mass];
    let along = |s: [f64; 2], r: [f64; 2], h: f64| [s[0] + h * r[0], s[1] + h * r[1]];
    let dt = contact_time(mass, velocity, k) / (1.0 + inelasticity(mass, velocity, impedance, k)) / STEPS;
    // Just touching: laws have no tangent before.
    let mut state = [TOUCH * velocity * dt, velocity];
    let mut here = contact(state[0]);
    for step in 1..=MOST_STEPS {
        let next = |r: [f64; 2], h: f64| {
            let [alpha, speed] = along(state, r, h);
            rate(contact(alpha), speed)
        };
        let a = rate(here, state[1]);
        let b = next(a, 0.5 * dt);
        let c = next(b, 0.5 * dt);
        let d = next(c, dt);
        state = std::array::from_fn(|i| state[i] + dt / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        here = contact(state[0]);
        let moment = Moment { time: step as f64 * dt, dt, state, force: here.force };
        if heard(moment).is_break() || !(state[0] > 0.0) {
            break;
        }
    }
}
