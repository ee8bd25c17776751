//! Residual stresses of the plies since the plate was free of stress.

use super::OFF;
use crate::effect::{Body, Effect, EffectInfo, EffectPlugin, Exclusion, Facts, Feature, Nature, Wish};
use crate::error::Error;
use fem_core::assembly::free_forces;
use fem_core::element::Stack;
use fem_core::element::form;
use fem_core::failure::Site;
use fem_core::laminate::Laminate;
use fem_core::material::{Material, MaterialError};
use fem_core::plugin::Dimension;
use fem_core::recovery::{Recovery, Station};
use fem_core::residual::Residual;
use fem_core::tensor::{Global, Ply, Stress6};
use fem_io::scene::{Analysis, Form, SceneError, SceneValue, key};

/// A change of temperature since the plate was free of stress.
///
/// Under loads at rest it strains the plies; in an impact their stresses are those of the free plate, which the march does not
/// know.
#[derive(Debug, Clone, Copy)]
pub struct Cure {
    /// K.
    change: f64,
}

/// The largest change that is taken, K: fibres of carbon are made at less.
const LARGEST_CHANGE: f64 = 3000.0;

impl EffectPlugin for Cure {
    const INFO: EffectInfo = EffectInfo {
        key: key(
            "cure",
            Form::OneOf(&[OFF, Form::Quantity(Dimension::TEMPERATURE)]),
            r#""-150 K""#,
            "residual stresses of the plies; the change counts from the temperature at which the plate is free of stress",
        )
        .default(r#""off""#),
        source: "Tsai and Hahn 1980",
        columns: &[],
        advice: None,
    };

    fn read(value: &SceneValue<'_>) -> Result<Wish, SceneError> {
        if value.is_word("off") {
            return Ok(Wish::Off);
        }
        let change = value.quantity(Dimension::TEMPERATURE)?;
        if change.abs() > LARGEST_CHANGE {
            let message = format!("no ply keeps its stiffness over a change of {}", Dimension::TEMPERATURE.of(change));
            let help = format!("give at most {} either way", Dimension::TEMPERATURE.of(LARGEST_CHANGE));
            return Err(value.error(message, help));
        }
        Ok(Wish::On(Box::new(Self { change })))
    }
}

impl Effect for Cure {
    fn info(&self) -> &'static EffectInfo {
        &Self::INFO
    }

    fn excludes(&self) -> &'static [Exclusion] {
        const EXCLUDED: &[Exclusion] = &[
            Exclusion::new(
                Feature::Modes,
                "residual stresses change neither the natural modes nor the buckling loads of a free plate",
                "leave `cure` out",
            ),
            Exclusion::new(
                Feature::PlyLaws,
                "residual stresses are those of linear elastic plies, but plies follow a law",
                "leave it out, or the `law` of the material",
            ),
        ];
        EXCLUDED
    }

    fn check(&self, facts: &Facts<'_>) -> Result<(), SceneError> {
        let (scene, source) = (facts.scene, &facts.scene.source);
        let looks = facts.criteria.iter().any(|(_, criterion)| criterion.info().site == Site::Interface);
        let judged = scene.interface.as_ref().filter(|_| looks);
        if let (Analysis::Static(_), Some(resin)) = (&scene.analysis, judged) {
            let message = "the resin between plies has no thermal strain of its own in a static analysis";
            let help = "leave the criteria that judge interfaces out, or `effects.cure`";
            return Err(source.error_at(&resin.place, message, help));
        }
        let plies = scene.plies().map(|ply| ply.material);
        for material in plies.chain(judged.map(|resin| resin.value)).map(|m| &scene.materials[m]) {
            if let Err(why) = material.value.thermal_expansion() {
                let help =
                    "give it, for example: alpha1 = \"-1e-6 1/K\", alpha2 = \"26e-6 1/K\"; or leave `effects.cure` out";
                return Err(source.error_at(&material.place, why.to_string(), help));
            }
        }
        Ok(())
    }

    fn alter(&self, nature: &mut Nature) {
        nature.strained = true;
    }

    fn on_stacks(
        &self,
        at_rest: bool,
        laminate: &Laminate,
        materials: &[Material],
        stacks: &mut [Stack],
    ) -> Result<(), MaterialError> {
        if at_rest { laminate.heat(stacks, materials, self.change) } else { Ok(()) }
    }

    fn forces(&self, body: &Body<'_>) -> Result<Option<(Vec<f64>, f64)>, Error> {
        Ok(Some(free_forces(body.plate, body.element, body.constraints)?))
    }

    /// Under loads at rest those that free strains leave in a plate held in its shape, in an impact those of the free plate.
    fn stresses(&self, body: &Body<'_>, recovery: &Recovery) -> Result<Option<Vec<f64>>, Error> {
        let Body { plate, element, laminates, materials, at_rest, .. } = *body;
        let cooled = laminates.iter().map(|laminate| Residual::new(laminate, materials, self.change));
        let cooled: Vec<Residual> = cooled.collect::<Result<_, _>>()?;
        let of_station = |quad: usize, region: usize, station: &Station| match at_rest {
            false => cooled[region].stress(&materials[station.material], station.angle, station.z),
            true => {
                let element = form(element, plate.plane.quads[quad].domain());
                let held = element.held_stress(&plate.stacks(region)[station.layer], station.part());
                Ok(Stress6::<Global>::new(held).to_ply(station.angle))
            }
        };
        let mut stresses = Vec::with_capacity(6 * recovery.sites());
        for (i, centre) in recovery.centres.iter().enumerate() {
            for station in recovery.stations_over(i) {
                let stress: Stress6<Ply> = of_station(centre.quad, plate.region(centre.quad), station)?;
                stresses.extend(stress.0);
            }
        }
        Ok(Some(stresses))
    }
}
