//! Which fields of a plate are written, and over which of its cells.

use super::builder::{Builder, is_within};
use fem_core::plate::Plate;
use fem_io::scene::{FieldCells, FieldSeries, Region, SceneError};
use std::collections::BTreeSet;

/// Fields that are written, made concrete.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldPlan {
    /// Quads of the whole plate, ascending.
    pub quads: Vec<usize>,
    /// The series, each once.
    pub series: Vec<FieldSeries>,
    /// What the cells of the plate become.
    pub cells: FieldCells,
}

impl Builder<'_> {
    /// What `output.fields` asks for, where interfaces may open if `growing`.
    pub(super) fn fields(
        &self,
        plate: &Plate,
        centres: &[[f64; 2]],
        growing: bool,
    ) -> Result<Option<FieldPlan>, SceneError> {
        let Some(fields) = &self.scene.output.fields else { return Ok(None) };
        let all = 0..plate.plane.quads.len();
        let quads: Vec<usize> = match &fields.region {
            None => all.collect(),
            Some(Region::Group(group)) => {
                let own: BTreeSet<u32> = self.group(plate, group)?.quads.iter().copied().collect();
                let quads: Vec<usize> = own.into_iter().map(|quad| quad as usize).collect();
                if quads.is_empty() {
                    let message = format!("group `{}` has no cells", group.value);
                    return Err(self.error(group, message, "name a group of cells"));
                }
                quads
            }
            Some(Region::Radius(radius)) if centres.is_empty() => {
                let message = "a radius is measured from the impact, and this analysis has none";
                return Err(self.error(radius, message, "name a `group` of cells, or leave `region` out"));
            }
            Some(Region::Radius(radius)) => {
                let quads: Vec<usize> = all.filter(is_within(plate, centres, radius.value)).collect();
                if quads.is_empty() {
                    let message = "no cell has its centre within this radius of the impact";
                    return Err(self.error(radius, message, "enlarge it, or leave `region` out"));
                }
                quads
            }
        };
        let interfaces = growing || self.scene.interface.is_some();
        let interfaces = interfaces && self.scene.laminates.iter().any(|spec| spec.laminate.value.plies.len() > 1);
        let mut series = Vec::new();
        for part in fields.parts.iter().flatten() {
            if part.value == FieldSeries::Interfaces && !interfaces {
                let message = "the scene has no interfaces between plies";
                return Err(self.error(part, message, "give `laminate.interface`, or leave \"interfaces\" out"));
            }
            if !series.contains(&part.value) {
                series.push(part.value);
            }
        }
        if fields.parts.is_none() {
            series.extend([FieldSeries::Plate, FieldSeries::Plies]);
            series.extend(interfaces.then_some(FieldSeries::Interfaces));
        }
        Ok(Some(FieldPlan { quads, series, cells: fields.cells }))
    }
}
