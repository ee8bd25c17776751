//! A plate without inertia.

use super::{SWITCHES, Switch, read_switch};
use crate::effect::{AdviceRule, Body, Effect, EffectInfo, EffectPlugin, Exclusion, Expected, Feature, Nature, Wish};
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::reduce::Reduced;
use fem_io::scene::{Form, SceneError, SceneValue, key, words};

/// The plate is at rest under the contact forces at every instant.
///
/// `inertia = "auto"` leaves it so where every impactor is so heavy that twice the force of the first wave, as edges send waves
/// back, is below 5 % of the force at rest, unless modes are followed or the integrator needs inertia.
#[derive(Debug, Clone, Copy)]
pub struct NoInertia;

/// Error of the largest force from which on a plate is not left without its inertia.
const THRESHOLD: f64 = 0.05;

impl EffectPlugin for NoInertia {
    const INFO: EffectInfo = EffectInfo {
        key: key(
            "inertia",
            Form::Words(&words(&SWITCHES)),
            r#""off""#,
            "inertia of the plate; without it the plate is at rest under the contact forces at every instant",
        )
        .default(r#""on""#),
        source: "Shivakumar, Elber, Illg 1985",
        columns: &[],
        advice: Some(AdviceRule {
            formula: "2 x force of the first wave / static force",
            number: first_wave,
            threshold: THRESHOLD,
            acts_above: false,
            answer: None,
            hindsight: None,
        }),
    };

    fn read(value: &SceneValue<'_>) -> Result<Wish, SceneError> {
        read_switch(value, Switch::Off, Self)
    }
}

impl Effect for NoInertia {
    fn info(&self) -> &'static EffectInfo {
        &Self::INFO
    }

    fn excludes(&self) -> &'static [Exclusion] {
        const EXCLUDED: &[Exclusion] = &[
            Exclusion::new(
                Feature::PlyLaws,
                "a plate without inertia is what its static responses are, but plies follow a law",
                "leave it out, or the `law` of the material",
            ),
            Exclusion::new(
                Feature::NoImpact,
                "`effects.inertia` needs an impact, and this analysis has none",
                "leave it out",
            ),
            Exclusion::new(
                Feature::FollowedModes,
                "`output.modes` follows vibrations, and a plate without inertia has none",
                "leave one of `output.modes` and `effects.inertia` out",
            )
            .unless_auto(),
            Exclusion::new(
                Feature::ExplicitIntegrator,
                "the integrator needs the inverse of the mass matrix",
                "choose an implicit integrator such as `newmark`, or leave `effects.inertia` out",
            )
            .unless_auto(),
        ];
        EXCLUDED
    }

    fn alter(&self, nature: &mut Nature) {
        nature.inertia = false;
    }

    fn on_reduced(&mut self, reduced: &mut Reduced) {
        reduced.modal.without_inertia();
    }

    fn on_system(&mut self, _: &Body<'_>, _: Option<&Reduced>, system: ImpactSystem) -> ImpactSystem {
        system.without_inertia()
    }
}

/// Twice the force of the first wave over that of the plate at rest, as edges send waves back; 1 where inertia matters anyway.
fn first_wave(expected: &Expected) -> f64 {
    if expected.quasi_static && !expected.vibrates { 2.0 * expected.first_wave } else { 1.0 }
}
