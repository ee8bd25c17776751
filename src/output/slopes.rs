//! Whether a plate stays as flat as its strains have it.

use crate::analyses::stress::strains;
use crate::model::Model;
use fem_core::plugin::Dimension;
use fem_core::recovery::Strains;

/// Deflection over the longest side of a plate from which on its slopes are not small: a cantilever that linear theory bends by
/// as much is 2.3 % too soft (the elastica), and four times as much at twice the load.
const STEEP: f64 = 0.15;

/// A warning where a plate that is held deflects so far that neither small displacements nor von Kármán's strains have it right.
pub(super) fn warn_of_slopes(model: &Model, deflection: f64) -> Option<String> {
    let (low, high) = model.plate.plane.bounds();
    let side = (high[0] - low[0]).max(high[1] - low[1]);
    let exact = strains(model) == Strains::Large && !model.plate.info().is_shell();
    (model.motions.is_empty() && !exact && deflection.abs() > STEEP * side).then(|| {
        format!(
            "the plate deflects by {}, {:.0} % of its longest side: its slopes are not small, as they are taken to be; look at the loads, \
             the moduli and their units, or compute with `effects.membrane`, a solid and no `reduction`, which take slopes as they are",
            Dimension::LENGTH.of(deflection.abs()),
            100.0 * deflection.abs() / side
        )
    })
}
