//! The error of the mesh, under a contact at rest.

use crate::model::Model;
use fem_core::assembly::Condensation;
use fem_core::element::ElementError;
use fem_core::estimate::mesh_error;
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::reduce::Reduced;

/// Relative error in the energy norm of the deflection at rest under the first impactor, as [`mesh_error`] estimates it.
///
/// # Errors
/// A cell that the element refuses.
pub(in crate::analyses::impact) fn estimate(
    model: &Model,
    system: &ImpactSystem,
    reduced: &Reduced,
    condensation: Option<&Condensation>,
) -> Result<Option<f64>, ElementError> {
    let Some(impactor) = system.impactors().first() else { return Ok(None) };
    let mut q: Vec<f64> = reduced.modal.compliances().collect();
    let mut load = vec![0.0; q.len()];
    impactor.load.iter().for_each(|(j, w)| load[*j] += w);
    q.iter_mut().zip(&load).for_each(|(q, load)| *q *= load);
    let masters = condensation.map_or(model.constraints.ndof(), Condensation::ndof);
    let mut independent = vec![0.0; masters];
    reduced.expand(&q, &mut independent);
    if let Some(condensation) = condensation {
        independent = condensation.expand(&independent);
    }
    let mut u = vec![0.0; model.plate.ndof()];
    model.constraints.expand(&independent, &mut u);
    mesh_error(&model.plate, &*model.element, &u)
}
