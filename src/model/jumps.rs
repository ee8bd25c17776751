//! Strains that jump where elements with derivatives at their nodes would keep them continuous.

use super::builder::Builder;
use fem_core::hold::SupportKind;
use fem_core::laminate::Laminate;
use fem_core::plate::Plate;
use fem_io::scene::{SceneError, Support};

/// Whether strains jump where these laminates lie beside each other.
pub(super) fn are_unlike(one: &Laminate, two: &Laminate) -> bool {
    one.plies != two.plies || one.middle != two.middle
}

impl Builder<'_> {
    /// What the user should know of clamps inside the plate, where the curvature jumps.
    pub(super) fn jumps(&self, plate: &Plate) -> Result<Vec<String>, SceneError> {
        let mut warnings = Vec::new();
        if !plate.shares_strains() {
            return Ok(warnings);
        }
        let element = &self.scene.element.name.value;
        let others = if plate.info().is_section() { "" } else { ", or take kind = \"hex20\" or \"mitc4\"" };
        let inside = plate.plane.inside();
        for support in &self.scene.supports {
            let Support::Kind { area, kind: SupportKind::Clamped, stiffness: None, .. } = support else { continue };
            let columns = plate.columns_of_group(&self.area(plate, area)?);
            let within = |column: &u32| inside.get(*column as usize).copied().unwrap_or(false);
            if columns.len() > 1 && columns.iter().any(within) {
                warnings.push(format!(
                    "{}, clamped, lies inside the plate, where strains jump, which `{element}` shares at nodes: the plate comes out too \
                     stiff there, by an error that falls no faster than the width of the cells and that the estimate of the mesh does not \
                     see: make cells there small{others}",
                    area.value
                ));
            }
        }
        Ok(warnings)
    }
}
