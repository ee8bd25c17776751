//! Effects that a scene leaves to the advisor.

use super::plate::AtRest;
use super::sampling::look_often;
use super::{Rim, advise, interfaces};
use crate::effect::{Decision, Expected};
use crate::error::Error;
use crate::model::{Model, Plan};
use fem_core::dof::Dof;
use fem_core::functional::Functional;
use fem_core::time::StepLimit;
use std::num::NonZeroUsize;

/// `model` with all effects decided that its scene leaves to the advisor, one more factorisation of K where there are any, and
/// with stresses that are judged often enough.
///
/// Each effect has a number of its own for what is expected of an impactor, or of loads at rest, and a threshold; the largest
/// number counts. Whether delaminations grow follows from a march of the plate in which they do not.
///
/// # Errors
/// As [`advise`].
pub fn decided(mut model: Model, threads: NonZeroUsize) -> Result<Model, Error> {
    let Some(grown) = model.grown.take() else { return decide_effects(model, threads) };
    let model = decide_effects(model, threads)?;
    let expected = match &grown.separation {
        Some(separation) if !separation.is_cracked() => interfaces::strained(&model, separation, threads)?,
        // What is open from the beginning can only be followed.
        _ => 1.0,
    };
    let threshold = interfaces::THRESHOLD;
    let on = expected > threshold;
    let mut model = if on { decide_effects(*grown, threads)? } else { model };
    let formula = "share of the tractions that damage an interface";
    model.decisions.push(Decision { effect: "delamination", on, formula, expected, threshold });
    Ok(model)
}

fn decide_effects(model: Model, threads: NonZeroUsize) -> Result<Model, Error> {
    let mut model = look_often(model);
    if !model.effects.undecided() {
        return Ok(model);
    }
    let expected = match &model.plan {
        Plan::Impact(_) => advise(&model, threads)?.iter().map(|advice| advice.expected).collect(),
        Plan::Static { forces, .. } => vec![at_rest(&model, forces, threads)?],
        // Refused before.
        Plan::Modes { .. } | Plan::Buckling { .. } => return Ok(model),
    };
    let decisions = model.effects.decide(|advice| expected.iter().map(advice.number).fold(0.0, f64::max));
    model.decisions = decisions;
    Ok(model)
}

/// Whether modes are followed, or the integrator needs the inertia of the plate.
pub(super) fn vibrates(model: &Model) -> bool {
    let Plan::Impact(impact) = &model.plan else { return false };
    let implicit = impact.integrator.limit() == StepLimit::None && impact.integrator.order() <= 2;
    model.output.modes.is_some() || !implicit
}

/// The linear plate under `forces`.
fn at_rest(model: &Model, forces: &[f64], threads: NonZeroUsize) -> Result<Expected, Error> {
    if model.plate.info().is_section() {
        return Err(Error::NoPlate { element: model.origin.element.clone() });
    }
    let nodal: Vec<(usize, f64)> = forces.iter().copied().enumerate().filter(|(_, force)| *force != 0.0).collect();
    let mut load = vec![0.0; model.constraints.ndof()];
    Functional(model.constraints.restrict(&nodal)).add_to(1.0, &mut load);
    let mut plate_at_rest = AtRest::of(model, &[], threads)?;
    let independent = plate_at_rest.displacements(&load)?;
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
        Some(held.coefficient_beside(plate_at_rest.buckling()))
    };
    let thickness = model.laminate.thickness();
    let Some((column, deflection)) = largest else { return Ok(Expected { thickness, ..Expected::default() }) };
    let held = coefficient(column);
    Ok(Expected {
        thickness,
        deflection,
        coefficient: held.unwrap_or(0.0),
        surrounded: held.is_some(),
        ..Expected::default()
    })
}
