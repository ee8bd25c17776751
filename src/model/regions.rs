//! Which cells have which laminate.

use super::Builder;
use fem_core::laminate::Laminate;
use fem_core::plate::Plate;
use fem_io::scene::{LaminateSpec, SceneError};

/// The laminates that differ, and which of them each of the scene's is: parts of a plate with equal plies are one region.
pub(super) fn distinct(specs: &[LaminateSpec]) -> (Vec<Laminate>, Vec<usize>) {
    let mut laminates: Vec<Laminate> = Vec::new();
    let number = |spec: &LaminateSpec| {
        let laminate = &spec.laminate.value;
        laminates.iter().position(|other| other == laminate).unwrap_or_else(|| {
            laminates.push(laminate.clone());
            laminates.len() - 1
        })
    };
    let of_specs = specs.iter().map(number).collect();
    (laminates, of_specs)
}

impl Builder<'_> {
    /// Quads of each region, where `of_specs` says which region each laminate of the scene makes.
    ///
    /// # Errors
    /// A group that the mesh lacks or that holds no cells, cells with two laminates or none.
    pub(super) fn regions(&self, plate: &Plate, of_specs: &[usize]) -> Result<Vec<Vec<u32>>, SceneError> {
        let specs = &self.scene.laminates;
        let mut of_quad: Vec<Option<usize>> = vec![None; plate.plane.quads.len()];
        let tag = |quad: usize| plate.plane.quad_tags[quad];
        for (number, spec) in specs.iter().enumerate() {
            let Some(group) = &spec.group else { continue };
            let quads = &self.group(plate, group)?.quads;
            if quads.is_empty() {
                let message = format!("the group `{}` holds no cells", group.value);
                return Err(self.error(group, message, "a laminate needs a physical surface"));
            }
            for quad in quads {
                let Some(other) = of_quad[*quad as usize].replace(number) else { continue };
                let other = specs[other].group.as_ref().map_or("", |group| group.value.as_str());
                let message =
                    format!("cell {} has two laminates, those of `{other}` and `{}`", tag(*quad as usize), group.value);
                return Err(self.error(group, message, "give laminates physical surfaces that do not overlap"));
            }
        }
        let rest = specs.iter().position(|spec| spec.group.is_none());
        let mut regions = vec![Vec::new(); of_specs.iter().max().map_or(1, |last| last + 1)];
        for (quad, spec) in of_quad.iter().enumerate() {
            let Some(spec) = spec.or(rest) else {
                let without = of_quad.iter().filter(|spec| spec.is_none()).count();
                let message = format!("{without} cells, among them cell {}, have no laminate", tag(quad));
                let help = "leave `group` out of one laminate: it is that of the rest of the plate";
                return Err(self.error(&specs[0].laminate, message, help));
            };
            regions[of_specs[spec]].push(quad as u32);
        }
        Ok(regions)
    }
}
