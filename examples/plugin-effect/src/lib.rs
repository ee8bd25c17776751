//! An elastic foundation under the plate (Winkler): an effect in one file.
//!
//! What to look at: the effect says what it is, what it cannot stand beside and what it keeps account of; it acts at two stages,
//! the stiffness of the assembled plate and the system that is marched. Nothing else of the program knows it.
use fem::Error;
use fem::core::assembly::Symmetric;
use fem::core::functional::Functional;
use fem::core::load::{Face, deflections};
use fem::core::plugin::Dimension;
use fem::core::structure::SolveError;
use fem::core::time::State;
use fem::dynamics::impact::{Energies, ImpactSystem};
use fem::dynamics::reduce::Reduced;
use fem::effect::{Body, Effect, EffectInfo, EffectPlugin, Exclusion, Feature, LedgerColumn, Wish};
use fem::forecast::Demand;
use fem::io::scene::{Form, SceneError, SceneValue, key};

// ANCHOR: state
/// Springs under the bottom face that push back by p = −k w, at rest as in an impact.
#[derive(Debug, Clone)]
pub struct Foundation {
    /// Modulus k, N/m³.
    modulus: f64,
    /// Of a march, the springs in its coordinates: what each is pressed by, and its stiffness, N/m.
    springs: Vec<(Functional, f64)>,
}

impl Foundation {
    /// A spring at every point of the integration over the bottom face.
    fn springs(&self, body: &Body<'_>) -> Vec<(Functional, f64)> {
        let points = deflections(body.plate, body.element, Face::Bottom);
        let spring = |(w, area): (Functional, f64)| (Functional(body.constraints.restrict(&w.0)), self.modulus * area);
        points.into_iter().map(spring).collect()
    }
}
// ANCHOR_END: state

// ANCHOR: plugin
impl EffectPlugin for Foundation {
    const INFO: EffectInfo = EffectInfo {
        key: key(
            "foundation",
            Form::OneOf(&[Form::Words(&["off"]), Form::Quantity(Dimension([-2.0, 1.0, -2.0, 0.0]))]),
            r#""50 N/mm^3""#,
            "an elastic foundation under the bottom face, force per area and deflection",
        )
        .default(r#""off""#),
        source: "Winkler 1867",
        columns: &[LedgerColumn { name: "foundation_J", unit: "J", label: "foundation", counts: false }],
        advice: None,
    };

    fn read(value: &SceneValue<'_>) -> Result<Wish, SceneError> {
        if value.is_word("off") {
            return Ok(Wish::Off);
        }
        let modulus = value.positive(Dimension([-2.0, 1.0, -2.0, 0.0]))?;
        Ok(Wish::On(Box::new(Self { modulus, springs: Vec::new() })))
    }
}
// ANCHOR_END: plugin

// ANCHOR: effect
impl Effect for Foundation {
    fn info(&self) -> &'static EffectInfo {
        &Self::INFO
    }

    fn excludes(&self) -> &'static [Exclusion] {
        const EXCLUDED: &[Exclusion] = &[
            Exclusion::new(
                Feature::Substructures,
                "a foundation does not reach the inside of condensed substructures",
                "leave one of `substructures` and `effects.foundation` out",
            ),
            Exclusion::new(
                Feature::Effect("membrane"),
                "the forces of large deflections are those of the cells, without a foundation",
                "leave one of `effects.membrane` and `effects.foundation` out",
            ),
        ];
        EXCLUDED
    }

    fn memory(&self, body: &Body<'_>, demand: &Demand) -> f64 {
        let weights = demand.contacts.map_or(body.plate.info().ndof(), |_| demand.vectors);
        (deflections(body.plate, body.element, Face::Bottom).len() * weights * size_of::<(usize, f64)>()) as f64
    }

    fn on_stiffness(&self, body: &Body<'_>, stiffness: &mut Symmetric) -> Result<(), Error> {
        for (w, k) in self.springs(body) {
            stiffness.add_spring(k, &w).map_err(SolveError::other)?;
        }
        Ok(())
    }

    fn on_system(&mut self, body: &Body<'_>, reduced: Option<&Reduced>, system: ImpactSystem) -> ImpactSystem {
        self.springs = self.springs(body);
        if let Some(reduced) = reduced {
            self.springs
                .iter_mut()
                .for_each(|(w, _)| *w = Functional(reduced.restrict(w).into_iter().enumerate().collect()));
        }
        system
    }

    fn values(&self, _: &ImpactSystem, state: &State, _: &Energies) -> Vec<f64> {
        vec![self.springs.iter().map(|(w, k)| 0.5 * k * w.of(&state.u).powi(2)).sum()]
    }
}
// ANCHOR_END: effect
