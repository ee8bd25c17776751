//! What the layers of cells do to an impact.

use crate::model::Model;
use fem_core::element::ElementError;
use fem_core::waves::LayerShares;
use fem_dynamics::reduce::Reduced;

/// Share of a mode's stiffness that layers may add, at most.
const MOST: f64 = 0.5;

/// Shares of the stiffness of each mode that the division of the thickness into layers of cells adds: those of waves of the mode's
/// frequency in the laminate under the first impactor. Nothing for a theory of plates.
///
/// # Errors
/// A cell that the element refuses.
pub(in crate::analyses::impact) fn estimate(
    model: &Model,
    reduced: &Reduced,
) -> Result<Option<Vec<f64>>, ElementError> {
    let plate = &model.plate;
    let waves = LayerShares::of(&*model.element, plate.z_derivatives(), &model.laminate, &model.materials)?;
    let share = |waves: LayerShares| reduced.modal.frequencies().map(|omega| waves.at(omega).min(MOST)).collect();
    Ok(waves.map(share))
}
