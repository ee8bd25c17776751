//! The weight of plate and impactors.

use super::OFF;
use crate::effect::{Body, Effect, EffectInfo, EffectPlugin, Exclusion, Feature, LedgerColumn, Nature, Wish};
use crate::error::Error;
use fem_core::assembly::SparseStructure;
use fem_core::functional::Functional;
use fem_core::load;
use fem_core::plugin::Dimension;
use fem_core::structure::Structure;
use fem_core::time::State;
use fem_dynamics::impact::{Energies, ImpactSystem, Weight};
use fem_dynamics::reduce::Reduced;
use fem_io::scene::{Form, SceneError, SceneValue, key};

/// Gravity along the way of the impactors. The plate has sagged before they arrive, and its unknowns count from there.
#[derive(Debug, Clone)]
pub struct Gravity {
    /// m/s².
    acceleration: f64,
    /// Weight of the plate, N, in coordinates of the march once there are some.
    load: Vec<f64>,
    /// Displacements under it.
    sag: Vec<f64>,
}

impl EffectPlugin for Gravity {
    const INFO: EffectInfo = EffectInfo {
        key: key(
            "gravity",
            Form::OneOf(&[OFF, Form::Quantity(Dimension::ACCELERATION)]),
            r#""9.81 m/s^2""#,
            "weight of impactors and plate along the direction of impact",
        )
        .default(r#""off""#),
        source: "Newton 1687",
        columns: &[LedgerColumn { name: "gravity_potential_J", unit: "J", label: "weight", counts: true }],
        advice: None,
    };

    fn read(value: &SceneValue<'_>) -> Result<Wish, SceneError> {
        if value.is_word("off") {
            return Ok(Wish::Off);
        }
        let acceleration = value.positive(Dimension::ACCELERATION)?;
        Ok(Wish::On(Box::new(Self { acceleration, load: Vec::new(), sag: Vec::new() })))
    }
}

impl Effect for Gravity {
    fn info(&self) -> &'static EffectInfo {
        &Self::INFO
    }

    fn excludes(&self) -> &'static [Exclusion] {
        const EXCLUDED: &[Exclusion] = &[
            Exclusion::new(
                Feature::PlyLaws,
                "the sag is that of linear elastic plies, but plies follow a law",
                "leave it out, or the `law` of the material",
            ),
            Exclusion::new(
                Feature::NoImpact,
                "`effects.gravity` needs an impact, and this analysis has none",
                "leave it out; at rest it is a load: load = [{ gravity = [...] }]",
            ),
            Exclusion::new(
                Feature::StruckFromBelow,
                "`effects.gravity` pulls along the way of an impactor from above, and one strikes the bottom face",
                "turn the laminate over and strike the top face, or leave it out",
            ),
            Exclusion::new(
                Feature::Substructures,
                "gravity is not carried inside condensed substructures",
                "leave one of `substructures` and `effects.gravity` out",
            ),
        ];
        EXCLUDED
    }

    fn alter(&self, nature: &mut Nature) {
        nature.pull += self.acceleration;
    }

    fn vectors(&mut self, body: &Body<'_>, structure: &mut SparseStructure) -> Result<Vec<f64>, Error> {
        let mut forces = vec![0.0; body.plate.ndof()];
        load::gravity(body.plate, body.element, [0.0, 0.0, -self.acceleration], &mut forces)?;
        let forces: Vec<(usize, f64)> = forces.into_iter().enumerate().collect();
        self.load = vec![0.0; body.constraints.ndof()];
        Functional(body.constraints.restrict(&forces)).add_to(1.0, &mut self.load);
        if structure.moves_under(&Functional(self.load.iter().copied().enumerate().collect())) {
            return Err(Error::Unheld { load: "its weight", inertia: true });
        }
        self.sag = self.load.clone();
        structure.solve_shifted(0.0, &mut self.sag, 1)?;
        Ok(self.sag.clone())
    }

    fn on_system(&mut self, _: &Body<'_>, reduced: Option<&Reduced>, system: ImpactSystem) -> ImpactSystem {
        if let Some(reduced) = reduced {
            let load = std::mem::take(&mut self.load);
            self.load = reduced.restrict(&Functional(load.into_iter().enumerate().collect()));
            self.sag = self.load.iter().zip(reduced.modal.compliances()).map(|(f, c)| f * c).collect();
        }
        let sag = 0.5 * self.load.iter().zip(&self.sag).map(|(f, u)| f * u).sum::<f64>();
        system.with_weight(Some(Weight { acceleration: self.acceleration, load: self.load.clone(), sag }))
    }

    fn offset(&self) -> Option<&[f64]> {
        Some(&self.sag)
    }

    fn quantities(&self, system: &ImpactSystem) -> Vec<(&'static str, f64)> {
        vec![("plate_sag_m", system.deflection(0, &self.sag))]
    }

    fn values(&self, _: &ImpactSystem, _: &State, energies: &Energies) -> Vec<f64> {
        vec![energies.weight]
    }
}
