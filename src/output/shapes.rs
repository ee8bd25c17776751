//! Pictures of natural modes and of buckling.

use crate::analyses::statics::dof_of;
use crate::model::Model;
use crate::output::outlines::{drawn, outlines};
use fem_io::plot::{Axis, Fill, MapCell, MapPlot, Panel};

/// Most modes on a picture.
const SHEET: usize = 12;

/// The first of `shapes` in plan, each under its title: cells by their deflection, from white, down, to dark, up.
pub(super) fn shapes(model: &Model, shapes: &[f64], titles: impl Iterator<Item = String>) -> MapPlot {
    let shapes = shapes.chunks_exact(model.constraints.ndof().max(1));
    let each = shapes.zip(titles).take(SHEET);
    let panels = each.map(|(shape, title)| Panel { title, cells: cells(model, shape), ..Panel::default() });
    MapPlot {
        title: model.origin.title.clone(),
        x: Axis::linear("x", "mm"),
        y: Axis::linear("y", "mm"),
        equal_aspect: true,
        scale: Some("deflection, 0.5 at rest".into()),
        classes: Vec::new(),
        outlines: drawn(&outlines(model)),
        panels: panels.collect(),
    }
}

fn cells(model: &Model, shape: &[f64]) -> Vec<MapCell> {
    let plate = &model.plate;
    let mut u = vec![0.0; plate.ndof()];
    model.constraints.expand(shape, &mut u);
    let deflection = |column: usize| {
        let levels = plate.outer_levels().into_iter().chain(plate.mid_level());
        let dofs = levels.filter_map(|level| plate.dofs_at(column, level, dof_of(3)).next());
        dofs.map(|dof| u[dof]).next().unwrap_or(0.0)
    };
    let quads = &plate.plane.quads;
    let means = quads.iter().map(|quad| {
        let nodes = quad.iter().map(|node| deflection(*node as usize));
        nodes.sum::<f64>() / quad.iter().count() as f64
    });
    let means: Vec<f64> = means.collect();
    let largest = means.iter().fold(f64::MIN_POSITIVE, |most, w| w.abs().max(most));
    let cell = |(quad, w): (usize, &f64)| MapCell {
        corners: plate.plane.corners(quad).into_iter().map(|p| p.map(|v| v * 1e3)).collect(),
        fill: Fill::Share(0.5 + 0.5 * w / largest),
    };
    means.iter().enumerate().map(cell).collect()
}
