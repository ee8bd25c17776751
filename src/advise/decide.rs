//! Effects that a scene leaves to the advisor.

use super::plate::AtRest;
use super::{Rim, advise, membrane};
use crate::error::Error;
use crate::model::{Decision, INERTIA, MEMBRANE, Model, Plan};
use fem_core::dof::Dof;
use fem_core::functional::Functional;
use fem_core::time::StepLimit;
use std::num::NonZeroUsize;

/// Error of the largest force from which on a plate is not left without its inertia.
const INERTIA_MATTERS: f64 = 0.05;

/// `model` with all effects decided that its scene leaves to the advisor; one more factorisation of K where there are any.
///
/// Membrane stiffening is switched on where A (w/h)² is expected to exceed 5 %: of an impact with the deflection of its energy
/// balance before the march ends, of loads at rest with the largest deflection of the linear plate. The inertia of the plate is
/// switched off where every impactor is so heavy that twice the force of the first wave, as edges send waves back, is below 5 % of
/// the force at rest, unless modes are followed or the integrator needs inertia.
///
/// # Errors
/// As [`advise`].
pub fn decided(mut model: Model, threads: NonZeroUsize) -> Result<Model, Error> {
    if !model.undecided() {
        return Ok(model);
    }
    let (stiffening, inertia) = match &model.plan {
        Plan::Impact(impact) => {
            let (mut stiffening, mut inertia) = (0.0_f64, 0.0_f64);
            for advice in advise(&model, threads)? {
                stiffening = stiffening.max(advice.plate.stiffening(advice.estimate.deflection));
                inertia =
                    inertia.max(if advice.quasi_static(1.0) { 2.0 * advice.estimate.inertia_error() } else { 1.0 });
            }
            let implicit = impact.integrator.limit() == StepLimit::None && impact.integrator.order() <= 2;
            let vibrates = model.scene.output.modes.is_some() || !implicit;
            (stiffening, if vibrates { 1.0 } else { inertia })
        }
        Plan::Static { forces } => (at_rest(&model, forces, threads)?, 0.0),
        // Refused before.
        Plan::Modes { .. } => return Ok(model),
    };
    if model.leaves(MEMBRANE) {
        model.effects.membrane = stiffening > membrane::THRESHOLD;
        model.decisions.push(Decision {
            effect: MEMBRANE,
            on: model.effects.membrane,
            formula: membrane::FORMULA,
            expected: stiffening,
            threshold: membrane::THRESHOLD,
        });
    }
    if model.leaves(INERTIA) {
        model.effects.inertia = inertia > INERTIA_MATTERS;
        model.decisions.push(Decision {
            effect: INERTIA,
            on: model.effects.inertia,
            formula: "2 x force of the first wave / static force",
            expected: inertia,
            threshold: INERTIA_MATTERS,
        });
    }
    Ok(model)
}

/// A (w/h)² of the linear plate under `forces`.
fn at_rest(model: &Model, forces: &[f64], threads: NonZeroUsize) -> Result<f64, Error> {
    let nodal: Vec<(usize, f64)> = forces.iter().copied().enumerate().filter(|(_, force)| *force != 0.0).collect();
    let mut load = vec![0.0; model.constraints.ndof()];
    Functional(model.constraints.restrict(&nodal)).add_to(1.0, &mut load);
    let independent = AtRest::of(model, threads)?.displacements(&load)?;
    let plate = &model.plate;
    let mut u = vec![0.0; plate.ndof()];
    model.constraints.expand(&independent, &mut u);
    let deflection = |column: usize| {
        let at = |level| Dof::new(3, 0).and_then(|dof| plate.dofs_at(column, level, dof).next());
        (0..plate.levels.len()).filter_map(at).map(|dof| u[dof].abs()).fold(0.0, f64::max)
    };
    let vertices = 0..plate.plane.points.len();
    let largest = vertices.map(|column| (column, deflection(column))).max_by(|a, b| a.1.total_cmp(&b.1));
    let coefficient = |column: usize| {
        let held = Rim::around(model, plate.columns[column])?.held?;
        Some(held.coefficient())
    };
    let number = |(column, w): (usize, f64)| Some(coefficient(column)? * (w / model.laminate.thickness()).powi(2));
    Ok(largest.and_then(number).unwrap_or(0.0))
}
