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
        rows: Vec::new(),
        equal_aspect: true,
        scale: Some("deflection, 0.5 at rest".into()),
        classes: Vec::new(),
        outlines: drawn(&outlines(model)),
        panels: panels.collect(),
    }
}

fn cells(model: &Model, shape: &[f64]) -> Vec<MapCell> {
    let mut u = vec![0.0; model.plate.ndof()];
    model.constraints.expand(shape, &mut u);
    let means = means(model, &deflections(model, &u));
    let largest = means.iter().fold(f64::MIN_POSITIVE, |most, w| w.abs().max(most));
    let shares = means.iter().map(|w| 0.5 + 0.5 * w / largest);
    filled(model, shares)
}

/// The cells of the mesh, mm, each with its share.
pub(super) fn filled(model: &Model, shares: impl Iterator<Item = f64>) -> Vec<MapCell> {
    let plane = &model.plate.plane;
    let outline = |quad| plane.outline(quad).into_iter().map(|p| p.map(|v| v * 1e3)).collect();
    shares.enumerate().map(|(quad, share)| MapCell { corners: outline(quad), fill: Fill::Share(share) }).collect()
}

/// Deflection of the mid-plane at each node of the mesh under the displacements `u` (before elimination of constraints), m; of the lowest
/// level where there is no other.
pub(super) fn deflections(model: &Model, u: &[f64]) -> Vec<f64> {
    let plate = &model.plate;
    let of_node = |node| plate.dofs_at(node, plate.reference_level(node), dof_of(3)).next().map_or(0.0, |dof| u[dof]);
    (0..plate.plane.points.len()).map(of_node).collect()
}

/// Mean over the corners of each cell of values at the nodes of the mesh.
pub(super) fn means(model: &Model, of_nodes: &[f64]) -> Vec<f64> {
    let quads = model.plate.plane.quads.iter();
    let mean = quads.map(|quad| {
        let sum: f64 = quad.iter().map(|node| of_nodes[*node as usize]).sum();
        sum / quad.iter().count() as f64
    });
    mean.collect()
}
