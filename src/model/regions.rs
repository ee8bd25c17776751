//! Which cells have which laminate.

use super::Builder;
use fem_core::laminate::{CutPly, Laminate};
use fem_core::mesh::Group;
use fem_core::plate::Plate;
use fem_core::plugin::Dimension;
use fem_io::scene::{LaminateSpec, SceneError};
use std::collections::HashMap;

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

/// What results call each region, where plies of one number do not lie at one height in all of them; nothing else.
pub(super) fn names(laminates: &[Laminate], specs: &[LaminateSpec], of_specs: &[usize]) -> Vec<String> {
    let heights = laminates[0].boundaries();
    let same = |laminate: &Laminate| {
        let z = laminate.boundaries();
        z.len() == heights.len()
            && z.iter().zip(&heights).all(|(a, b)| (a - b).abs() <= SAME_HEIGHT * laminate.thickness())
    };
    if laminates.iter().all(same) {
        return Vec::new();
    }
    let name = |region: usize| {
        let own = specs.iter().zip(of_specs).filter(|(_, of)| **of == region);
        own.map(|(spec, _)| spec.name()).collect::<Vec<_>>().join(", ")
    };
    (0..laminates.len()).map(name).collect()
}

/// Heights that differ by less than this fraction of the thickness are one.
const SAME_HEIGHT: f64 = 1e-9;

impl Builder<'_> {
    /// One layer of cells for all plies, where the scene names none: what a shell needs.
    pub(super) fn hold_whole(&self, laminates: &mut [Laminate], of_specs: &[usize]) {
        for (region, laminate) in laminates.iter_mut().enumerate() {
            let mut own = self.scene.laminates.iter().zip(of_specs).filter(|(_, of)| **of == region);
            if own.all(|(spec, _)| !spec.layered) {
                laminate.layers = vec![laminate.plies.len()];
            }
        }
    }

    /// Divides layers of cells where those of regions beside them end.
    ///
    /// # Errors
    /// A ply that this would cut.
    pub(super) fn share_levels(&self, laminates: &mut [Laminate], of_specs: &[usize]) -> Result<(), SceneError> {
        Laminate::share_levels(laminates).map_err(|CutPly { laminate, ply, by, parts }| {
            let spec = |region: usize| {
                let number = of_specs.iter().position(|of| *of == region).unwrap_or(0);
                &self.scene.laminates[number]
            };
            let [below, above] = parts.map(|part| Dimension::LENGTH.of(part));
            let message = format!(
                "layers of cells of `{}` end inside ply {} of `{}`: {below} above its lower face and {above} below its upper one, and a \
                 layer holds whole plies",
                spec(by).name(),
                ply + 1,
                spec(laminate).name()
            );
            let help = "write this ply as two that meet there, with types under `ply` of these thicknesses, or choose `layers` and \
                        `align` so that faces meet";
            self.error(&spec(laminate).laminate, message, help)
        })
    }

    /// Refuses regions side by side whose heights have nothing in common.
    pub(super) fn check_steps(&self, plate: &Plate, of_specs: &[usize]) -> Result<(), SceneError> {
        if !plate.is_stepped() {
            return Ok(());
        }
        let mut beside: HashMap<[u32; 2], usize> = HashMap::new();
        for (quad, corners) in plate.plane.quads.iter().enumerate() {
            for [a, b] in corners.sides() {
                let Some(other) = beside.insert([a.min(b), a.max(b)], quad) else { continue };
                let [one, two] = [other, quad].map(|quad| plate.faces_over(quad));
                let [low, high] = [one[0].max(two[0]), one[1].min(two[1])];
                if low < high && !plate.same_height(low, high) {
                    continue;
                }
                let spec = |quad: usize| {
                    let number = of_specs.iter().position(|of| *of == plate.region(quad)).unwrap_or(0);
                    &self.scene.laminates[number]
                };
                let describe = |quad: usize, [low, high]: [f64; 2]| {
                    let (tag, [low, high]) =
                        (plate.plane.quad_tags[quad], [low, high].map(|z| Dimension::LENGTH.of(z)));
                    format!("cell {tag} of `{}` from z = {low} to {high}", spec(quad).name())
                };
                let message =
                    format!("faces of a step do not touch: {} and {}", describe(other, one), describe(quad, two));
                let help = "move one of the laminates with `align` or `offset`, so that both have heights in common";
                let later = if spec(quad).group.is_some() { quad } else { other };
                return Err(self.error(&spec(later).laminate, message, help));
            }
        }
        Ok(())
    }

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
            let Group { dim, quads, .. } = self.group(plate, group)?;
            // Cells may have been left out.
            if quads.is_empty() && *dim < 2 {
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
