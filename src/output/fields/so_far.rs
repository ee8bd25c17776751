//! What the criteria have found up to a frame: the largest index in each cell, and when each mode first reached 1 there.

use crate::analyses::impact::Maximum;
use crate::model::{FieldPlan, Model};
use crate::output::damage::Unfolding;
use fem_core::failure::Site;
use fem_failure::scan::PlyOrInterface;
use fem_io::vtu::Array;

/// From the sites of a march to the cells of a series.
#[derive(Debug)]
pub(super) struct SoFar<'a> {
    unfolding: Unfolding<'a>,
    /// Position of each quad of the plate among those that are shown.
    shown: Vec<Option<usize>>,
}

impl<'a> SoFar<'a> {
    pub(super) fn new(model: &'a Model, plan: &FieldPlan) -> Self {
        let mut shown = vec![None; model.plate.plane.quads.len()];
        plan.quads.iter().enumerate().for_each(|(position, quad)| shown[*quad] = Some(position));
        Self { unfolding: Unfolding::new(model), shown }
    }

    /// For each criterion that looks at `site` its largest index in cells of which those over each quad begin at `starts`, and a time for
    /// each of its modes; none where the march judged nothing, or where nothing reached 1.
    pub(super) fn arrays(&self, model: &Model, maxima: &[Maximum], site: Site, starts: &[usize]) -> Vec<Array> {
        let count = starts[starts.len() - 1];
        let region = |quad: usize| model.plate.region(quad);
        let mut arrays = Vec::new();
        for (number, (name, criterion)) in model.criteria.iter().enumerate() {
            let modes = criterion.info().modes;
            if criterion.info().site != site {
                continue;
            }
            let (mut largest, mut onsets) = (vec![None; count], vec![vec![None; count]; modes.len()]);
            for maximum in maxima.iter().filter(|maximum| maximum.criterion == number) {
                let (PlyOrInterface::Ply(sheet) | PlyOrInterface::Interface(sheet)) = maximum.site.place;
                for quad in self.unfolding.quads(&maximum.site) {
                    let here = region(*quad) == region(maximum.site.cell as usize);
                    let Some(position) = self.shown[*quad].filter(|_| here) else { continue };
                    let cell = starts[position] + usize::from(sheet);
                    let index = maximum.index.min(f64::from(f32::MAX));
                    largest[cell] = Some(largest[cell].map_or(index, |before: f64| before.max(index)));
                    for &(mode, time) in &maximum.reached {
                        let onset = &mut onsets[mode][cell];
                        *onset = Some(onset.map_or(time, |before: f64| before.min(time)));
                    }
                }
            }
            arrays.push(Array::where_known(format!("{name} index so far"), &largest));
            let named = modes.iter().zip(&onsets);
            arrays.extend(named.map(|(mode, onset)| Array::where_known(format!("{name} {mode} onset"), onset)));
        }
        arrays
    }
}
