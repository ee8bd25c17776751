//! Effects that a scene leaves to the advisor.

use super::plate::AtRest;
use super::{Rim, advise, membrane};
use crate::error::Error;
use crate::model::{Decision, MEMBRANE, Model, Plan};
use fem_core::dof::Dof;
use fem_core::reduction::Functional;
use std::num::NonZeroUsize;

/// `model` with all effects decided that its scene leaves to the advisor; one more factorisation of K where there are any.
///
/// Membrane stiffening is switched on where A (w/h)² is expected to exceed 5 %: of an impact with the deflection of its energy
/// balance before the march ends, of loads at rest with the largest deflection of the linear plate.
///
/// # Errors
/// As [`advise`].
pub fn decided(mut model: Model, threads: NonZeroUsize) -> Result<Model, Error> {
    if !model.undecided() {
        return Ok(model);
    }
    let expected = match &model.plan {
        Plan::Impact(_) => {
            let each = advise(&model, threads)?.into_iter();
            each.map(|advice| advice.plate.stiffening(advice.estimate.deflection)).fold(0.0, f64::max)
        }
        Plan::Static { forces } => at_rest(&model, forces, threads)?,
        // Refused before.
        Plan::Modes { .. } => return Ok(model),
    };
    let on = expected > membrane::THRESHOLD;
    model.effects.membrane = on;
    let (formula, threshold) = (membrane::FORMULA, membrane::THRESHOLD);
    model.decisions.push(Decision { effect: MEMBRANE, on, formula, expected, threshold });
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
