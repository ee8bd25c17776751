//! What an impact will do, before it is computed.

use super::large_mass::{self, ImpactPeak, Spring, energy_balance, rigid_target};
use super::plate::PlateConstants;
use super::regime::Regime;
use super::small_mass::{self, Wave, infinite_plate, rise_time};
use fem_core::contact::ContactLaw;
use std::f64::consts::FRAC_PI_2;

/// An impactor as the advisor sees it.
#[derive(Debug, Clone, Copy)]
pub struct Blow<'a> {
    /// Mass, kg.
    pub mass: f64,
    /// Velocity, m/s.
    pub velocity: f64,
    /// Time from its arrival to the end of the march, s.
    pub time: f64,
    /// Its contact law.
    pub law: &'a dyn ContactLaw,
}

impl Blow<'_> {
    /// ½ M V², J.
    pub fn energy(&self) -> f64 {
        0.5 * self.mass * self.velocity * self.velocity
    }
}

/// The first contact of `blow` with an infinite plate of this mass per area, kg/m², and bending stiffness, N m; and the constant of
/// Hertz's law that is as stiff where the blow is spent, N/m^1.5.
pub(super) fn first_wave(areal_mass: f64, bending_stiffness: f64, blow: &Blow<'_>) -> (Wave, f64) {
    let (impedance, k) = (small_mass::impedance(areal_mass, bending_stiffness), as_stiff(blow));
    (infinite_plate(blow.mass, blow.velocity, impedance, blow.law, k), k)
}

/// When the force of that first contact is largest, s.
pub(super) fn first_rise(areal_mass: f64, bending_stiffness: f64, blow: &Blow<'_>) -> f64 {
    let impedance = small_mass::impedance(areal_mass, bending_stiffness);
    rise_time(blow.mass, blow.velocity, impedance, blow.law, as_stiff(blow))
}

fn as_stiff(blow: &Blow<'_>) -> f64 {
    let rigid = rigid_target(blow.energy(), blow.law);
    rigid.force / rigid.indentation.powf(1.5)
}

/// The estimates for an impact, as if its impactor struck alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// How the plate responds.
    pub regime: Regime,
    /// M over the mass of the plate inside the supports.
    pub mass_ratio: f64,
    /// L = Kb/K of Christoforou and Yigit, K the secant of the contact law at the force that is expected.
    pub stiffness_ratio: f64,
    /// Their ζ = √(K M)/(2 c).
    pub damping: f64,
    /// Zener's λ.
    pub inelasticity: f64,
    /// √(L/(1 + L)) over the force of the infinite plate at ζ: the peak at rest over that of the first wave.
    pub static_over_wave: f64,
    /// The peak without inertia of the plate, linear.
    pub linear: ImpactPeak,
    /// The same with membrane stiffening.
    pub with_membrane: ImpactPeak,
    /// The first contact with an infinite plate.
    pub wave: Wave,
    /// Energy of the contact at the peak over that of the impact.
    pub contact_share: f64,
    /// Largest indentation, m.
    pub indentation: f64,
    /// When the force is largest, s after the impactor's arrival.
    pub time_of_peak: f64,
    /// Largest deflection under the impactor before the march ends, m.
    pub deflection: f64,
}

impl Estimate {
    /// Of `blow` on `plate`.
    pub fn new(plate: &PlateConstants, blow: &Blow<'_>) -> Self {
        let Blow { mass, velocity, time, law } = *blow;
        // What does not go on as a motion of both together.
        let energy = blow.energy() / (1.0 + mass / plate.free_mass);
        let bending = Spring { bending: plate.stiffness, membrane: 0.0 };
        let stiffer = plate.membrane_coefficient() * plate.stiffness / plate.thickness.powi(2);
        let linear = energy_balance(energy, bending, law);
        let with_membrane = energy_balance(energy, Spring { membrane: stiffer, ..bending }, law);
        let impedance = small_mass::impedance(plate.areal_mass, plate.bending_stiffness);
        let (wave, k) = first_wave(plate.areal_mass, plate.bending_stiffness, blow);

        let force = linear.force.max(wave.force);
        let secant = force / large_mass::indentation(law, force);
        let stiffness_ratio = plate.stiffness / secant;
        let at_rest = (stiffness_ratio / (1.0 + stiffness_ratio)).sqrt();
        let first_wave = small_mass::linear_contact_force(mass, velocity, impedance, secant);
        let static_over_wave = at_rest * velocity * (secant * mass).sqrt() / first_wave;
        let mass_ratio = mass / plate.mass();
        let regime = Regime::of(mass_ratio, static_over_wave);

        let quasi_static = regime != Regime::SmallMass && with_membrane.force >= wave.force;
        let at_peak = match quasi_static {
            true => large_mass::time_of_peak(velocity, &with_membrane),
            false => wave.time,
        };
        let (indentation, contact_energy) = match quasi_static {
            true => (with_membrane.indentation, with_membrane.contact_energy),
            false => (wave.indentation, large_mass::work(law, wave.indentation)),
        };
        let deflection = match regime {
            Regime::SmallMass => wave.deflection,
            _ => {
                let whole = large_mass::time_of_peak(velocity, &with_membrane);
                with_membrane.deflection * (FRAC_PI_2 * (time / whole).min(1.0)).sin()
            }
        };
        Self {
            regime,
            mass_ratio,
            stiffness_ratio,
            damping: small_mass::damping(mass, impedance, secant),
            inelasticity: small_mass::inelasticity(mass, velocity, impedance, k),
            static_over_wave,
            linear,
            with_membrane,
            wave,
            contact_share: contact_energy / energy,
            indentation,
            time_of_peak: at_peak,
            deflection,
        }
    }

    /// Largest force of the whole impact, N: that of the first wave or, unless the mass is small, that of the plate at rest,
    /// whichever is larger.
    pub fn force(&self) -> f64 {
        match self.regime {
            Regime::SmallMass => self.wave.force,
            Regime::QuasiStatic => self.with_membrane.force,
            Regime::Dynamic => self.with_membrane.force.max(self.wave.force),
        }
    }
}
