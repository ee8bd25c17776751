//! Strains that jump where elements with derivatives at their nodes keep them continuous.

use super::builder::Builder;
use fem_core::hold::SupportKind;
use fem_core::laminate::Laminate;
use fem_core::material::Material;
use fem_core::mesh::Sides;
use fem_core::plate::Plate;
use fem_io::scene::{SceneError, Support};

/// How many times as stiff in bending a laminate is as the one beside it from which on the user should know: in cells of an eighth of a
/// cantilever, of two laminates, the strain energy is 0.2 % too small at 2 and 4 % at 10.
const STIFFER: f64 = 2.0;

impl Builder<'_> {
    /// What the user should know of laminates side by side, and of clamps inside the plate, where the curvature jumps.
    pub(super) fn jumps(
        &self,
        plate: &Plate,
        laminates: &[Laminate],
        materials: &[Material],
    ) -> Result<Vec<String>, SceneError> {
        let shares_strains = plate.info().dofs.iter().any(|dof| dof.n() < 3 && matches!(dof.m(), 1 | 2));
        if !shares_strains {
            return Ok(Vec::new());
        }
        let element = &self.scene.element.name.value;
        let others = if plate.info().is_section() { "" } else { ", or take kind = \"hex20\" or \"mitc4\"" };
        let remedy = format!(
            "the plate comes out too stiff there, by an error that falls no faster than the width of the cells and that the estimate of \
             the mesh does not see: make cells there small{others}"
        );
        let ratio = ratio_of_neighbours(plate, laminates, materials);
        let mut warnings: Vec<String> = (ratio >= STIFFER)
            .then(|| {
                format!(
                    "laminates beside each other differ {ratio:.1} times in their bending stiffness, where strains jump, which \
                     `{element}` shares at nodes: {remedy}"
                )
            })
            .into_iter()
            .collect();
        let inside = plate.plane.inside();
        for support in &self.scene.supports {
            let Support::Kind { area, kind: SupportKind::Clamped, stiffness: None, .. } = support else { continue };
            let columns = plate.columns_of_group(&self.area(plate, area)?);
            let within = |column: &u32| inside.get(*column as usize).copied().unwrap_or(false);
            if columns.len() > 1 && columns.iter().any(within) {
                warnings.push(format!(
                    "{}, clamped, lies inside the plate, where strains jump, which `{element}` shares at nodes: {remedy}",
                    area.value
                ));
            }
        }
        Ok(warnings)
    }
}

/// The largest ratio of bending stiffnesses, along x or along y, of laminates that have a side of cells in common; 1 where none have.
fn ratio_of_neighbours(plate: &Plate, laminates: &[Laminate], materials: &[Material]) -> f64 {
    if laminates.len() < 2 {
        return 1.0;
    }
    let bending: Vec<_> = laminates.iter().map(|laminate| laminate.bending_stiffness(materials)).collect();
    let sides = Sides::of(&plate.plane);
    let ratios = sides.all().iter().filter_map(|side| {
        let beside = sides.opposite(side.nodes)?;
        let [one, two] = [side, beside].map(|side| bending[plate.region(side.cell as usize)]);
        Some((one[(0, 0)] / two[(0, 0)]).max(one[(1, 1)] / two[(1, 1)]))
    });
    ratios.fold(1.0, f64::max)
}
