//! How a plate responds: with its waves, with its lowest modes, or as if at rest.

use super::estimate::Estimate;
use crate::effect::{Answer, Number};
use fem_core::plugin::digits;

/// How a plate responds to an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// As if it were at rest at every moment: a static solution gives the peak.
    QuasiStatic,
    /// Neither: a march in time finds out.
    Dynamic,
    /// The impact is over before waves come back from the edge: supports do not matter.
    SmallMass,
}

/// M/m_p up to which a mass is small, and from which on it is large (Olsson 2000).
pub(super) const SMALL: f64 = 0.2;
const LARGE: f64 = 2.0;

/// Static over wave force from which on a response is quasi-static, whatever the masses; below 1 waves rule it.
const STATIC: f64 = 2.0;

impl Regime {
    /// By the masses, unless the forces contradict them: a large mass whose force at rest is below that of the first wave, a
    /// small one whose force at rest is far above it. Then a march must find out.
    pub fn of(mass_ratio: f64, static_over_wave: f64) -> Self {
        match mass_ratio {
            large if large >= LARGE && static_over_wave > 1.0 => Self::QuasiStatic,
            small if small <= SMALL && static_over_wave < STATIC => Self::SmallMass,
            _ => Self::Dynamic,
        }
    }

    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::QuasiStatic => "quasi-static",
            Self::Dynamic => "full dynamics",
            Self::SmallMass => "small mass",
        }
    }
}

impl Estimate {
    /// Error of the largest force without inertia of the plate: the force of the first wave over that at rest. Waves that edges send
    /// back may double it.
    pub fn inertia_error(&self) -> f64 {
        (self.wave.force / self.linear.force).min(1.0)
    }

    pub(super) fn regime_answer(&self, cost: f64) -> Answer {
        let choice = match self.regime {
            Regime::QuasiStatic => "quasi-static: a static solution gives the peak, a march the ripple on it",
            Regime::Dynamic => "full dynamics: march in time",
            Regime::SmallMass => "small mass: march in time; the plate acts as if infinite, its supports do not matter",
        };
        Answer {
            question: "regime",
            numbers: vec![
                Number::new("M / plate mass", digits(self.mass_ratio))
                    .threshold(format!("small up to {SMALL}, large from {LARGE}"))
                    .source("Olsson 2000"),
                Number::new("static / wave force", digits(self.static_over_wave))
                    .threshold(format!("waves below 1, static above {STATIC}"))
                    .source("sqrt(L/(1+L)) / exp(-z/sqrt(1-z^2) acos z), after Christoforou and Yigit 1998"),
                Number::new(
                    "L = Kb/K, z = sqrt(K M)/2c",
                    format!("{}, {}", digits(self.stiffness_ratio), digits(self.damping)),
                )
                .source("c = 8 sqrt(m D*), K the secant of the contact law"),
                Number::new("lambda = M/(c T)", digits(self.inelasticity))
                    .threshold("1: below a half-space, above a plate that takes the energy")
                    .source("T = (M/(k sqrt V))^(2/5), Zener 1941"),
            ],
            choice: choice.into(),
            effect: "inertia of the plate",
            error: Some(format!("without it the force is wrong by about {:.1} %", 100.0 * self.inertia_error())),
            cost: Some(cost),
        }
    }
}
