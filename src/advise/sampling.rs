//! How often the criteria look at the stresses of an impact.

use super::estimate::{Blow, first_rise};
use crate::model::{Model, Plan, Strike, count_steps};
use fem_core::plugin::Dimension;
use fem_io::scene::ImpactorSpec;

/// Looks within the rise of a contact force to its peak, a quarter of a period: of a sine that is sampled so, a peak is missed by
/// 1 − cos(π/16) = 1.9 % at most.
const LOOKS: f64 = 4.0;

/// `model` with stresses that are judged [`LOOKS`] times or more while a contact force rises: the first contact with an infinite
/// plate, whose rise no edge makes shorter. A scene that asks for fewer is told so.
pub(super) fn look_often(mut model: Model) -> Model {
    let Plan::Impact(impact) = &model.plan else { return model };
    let stiffness = model.laminate.effective_bending_stiffness(&model.materials);
    let rise = |(spec, strike): (&ImpactorSpec, &Strike)| {
        let time = impact.spec.march.end.value;
        let blow = Blow { mass: spec.mass, velocity: spec.velocity, time, law: &*strike.law };
        first_rise(model.areal_mass, stiffness, &blow)
    };
    // Of a law without a peak there is no rise.
    let rises = impact.spec.impactors.iter().zip(&impact.strikes).map(rise).filter(|rise| *rise > 0.0);
    let shortest = rises.fold(f64::INFINITY, f64::min);
    // Whole steps, so that what is said is what is done.
    let (_, step) = impact.spec.march.steps();
    let every = (shortest / LOOKS / step).floor().max(1.0) * step;
    let asked = count_steps(model.sample_every, step) as f64 * step;
    if !model.criteria.is_empty() && shortest.is_finite() && every < asked {
        model.warnings.push(format!(
            "the criteria look every {} and not every {}, because the contact force rises within {}: set \
             `failure.every` to no more than that",
            Dimension::TIME.of(every),
            Dimension::TIME.of(model.sample_every),
            Dimension::TIME.of(shortest)
        ));
        model.sample_every = every;
    }
    model
}
