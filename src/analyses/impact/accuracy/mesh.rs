//! The error of the mesh: of the static response to a contact, of the modes, and what the latter does to an impact.

use super::companion::{Companion, Differences, Pace};
use crate::model::Model;
use fem_core::assembly::Condensation;
use fem_core::element::ElementError;
use fem_core::estimate::mesh_errors;
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::reduce::{MembranePlate, Reduced};

/// Share of a mode's stiffness that its mesh adds, at most: beyond, it is no mode of the plate.
const MOST: f64 = 0.5;

/// Estimated errors of a mesh.
///
/// What a mesh does to an impact is found from a march of the plate whose modes are as much softer as the estimate says that the
/// mesh makes them stiffer, k (1 − η²), η the error of the mode in the energy norm: that a mode is too stiff is the first
/// effect of a mesh of elements made of displacements, and the shapes follow with the square. The deflection at rest is not made softer than
/// its own estimate says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshAccuracy {
    /// Error in the energy norm of the deflection at rest under the first impactor, relative ([`mesh_errors`]).
    pub at_rest: f64,
    /// What changes with the stiffness.
    pub response: Option<Differences>,
}

/// Errors in the energy norm: of the deflection at rest under the first impactor, and of each mode.
#[derive(Debug)]
pub(in crate::analyses::impact) struct OfFields {
    pub(super) at_rest: f64,
    modes: Vec<f64>,
}

/// Asks for the modes 1, 2, 3, 5, 9 … and the last; the others lie between.
///
/// # Errors
/// A cell that the element refuses.
pub(in crate::analyses::impact) fn estimate(
    model: &Model,
    system: &ImpactSystem,
    reduced: &Reduced,
    condensation: Option<&Condensation>,
) -> Result<Option<OfFields>, ElementError> {
    let Some(impactor) = system.impactors().first() else { return Ok(None) };
    let stiffnesses = reduced.modal.stiffnesses();
    let (modes, free) = (stiffnesses.len(), stiffnesses.iter().take_while(|k| **k == 0.0).count());
    let mut at_rest = vec![0.0; modes];
    impactor.load.iter().for_each(|(j, w)| at_rest[*j] += w);
    at_rest.iter_mut().zip(reduced.modal.compliances()).for_each(|(q, c)| *q *= c);
    let powers = std::iter::successors(Some(1), |n| Some(2 * n)).map(|n| free + n).take_while(|n| n + 1 < modes);
    let mut asked: Vec<usize> = [free].into_iter().chain(powers).chain([modes - 1]).collect();
    asked.dedup();
    let masters = condensation.map_or(model.constraints.ndof(), Condensation::ndof);
    let (mut fields, mut independent) = (vec![0.0; (1 + asked.len()) * model.plate.ndof()], vec![0.0; masters]);
    let unit = |k: usize| (0..modes).map(|j| f64::from(u8::from(j == k))).collect();
    let coordinates = [at_rest].into_iter().chain(asked.iter().map(|k| unit(*k)));
    for (q, u) in coordinates.zip(fields.chunks_exact_mut(model.plate.ndof())) {
        reduced.expand(&q, &mut independent);
        match condensation {
            Some(condensation) => model.constraints.expand(&condensation.expand(&independent), u),
            None => model.constraints.expand(&independent, u),
        }
    }
    let Some(errors) = mesh_errors(&model.plate, &*model.element, &model.constraints, &fields)? else {
        return Ok(None);
    };
    let known: Vec<(f64, f64)> =
        asked.iter().zip(&errors[1..]).map(|(k, error)| (((k - free + 1) as f64).ln(), *error)).collect();
    let between = |k: usize| {
        let at = ((k + 1).saturating_sub(free).max(1) as f64).ln();
        let next = known.partition_point(|(x, _)| *x < at).clamp(1, known.len().max(2) - 1);
        match known.get(next - 1..=next) {
            Some([(x0, e0), (x1, e1)]) => e0 + (e1 - e0) * (at - x0) / (x1 - x0),
            _ => known[0].1,
        }
    };
    Ok(Some(OfFields { at_rest: errors[0], modes: (0..modes).map(between).collect() }))
}

impl OfFields {
    /// Shares of the stiffness of each mode that the mesh adds: η², all of them by one factor less where together they would make
    /// the deflection at rest larger than its own error says: errors of the vectors that a contact calls for cancel in it.
    fn shares(&self, system: &ImpactSystem, reduced: &Reduced) -> Vec<f64> {
        let mut shares: Vec<f64> = self.modes.iter().map(|error| (error * error).min(MOST)).collect();
        let mut load = vec![0.0; shares.len()];
        system.impactors().iter().take(1).flat_map(|first| &first.load).for_each(|(j, w)| load[*j] += w);
        let (mut whole, mut more) = (0.0, 0.0);
        for ((compliance, p), share) in reduced.modal.compliances().zip(&load).zip(&shares) {
            whole += compliance * p * p;
            more += compliance * p * p * share / (1.0 - share);
        }
        let factor = (whole * self.at_rest * self.at_rest / more).min(1.0);
        if factor.is_finite() {
            shares.iter_mut().for_each(|share| *share *= factor);
        }
        shares
    }

    /// What the errors do to the impact that `base` is the march of.
    pub(super) fn judge(
        &self,
        system: &ImpactSystem,
        plate: (&Reduced, Option<&MembranePlate>),
        pace: &Pace,
        base: &Companion,
    ) -> MeshAccuracy {
        MeshAccuracy {
            at_rest: self.at_rest,
            response: pace.soften(system, plate, base, &self.shares(system, plate.0)),
        }
    }
}
