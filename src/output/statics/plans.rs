//! Pictures of a plate at rest in plan: how it deflects, and the stresses of its outer plies.

use crate::analyses::{Stressed, stress};
use crate::error::Error;
use crate::model::Model;
use crate::output::outlines::{drawn, outlines};
use crate::output::shapes::{deflections, filled, means};
use fem_core::plugin::Dimension;
use fem_io::files::OutputDir;
use fem_io::plot::{self, Axis, MapPlot, Panel};

/// Components of the stress that are drawn, by their places in a state, with their names.
const DRAWN: [(usize, &str); 3] = [(0, "\u{3c3}11"), (1, "\u{3c3}22"), (3, "\u{3c4}12")];

/// Draws `deflection`, unless the mid-plane stays where it is, and `ply_stresses`, each as SVG and PNG, of the displacements `u` (before
/// elimination of constraints).
///
/// # Errors
/// A cell that the element refuses, a folder that cannot be written.
pub(super) fn write(dir: &OutputDir, model: &Model, u: &[f64]) -> Result<(), Error> {
    if let Some(plan) = deflection(model, u) {
        plot::map_plot(&plan)?.write(dir, "deflection")?;
    }
    plot::map_plot(&stresses(model, u)?)?.write(dir, "ply_stresses")?;
    Ok(())
}

/// Shares of the largest value that are rounding.
const NOTHING: f64 = 1e-9;

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

fn plan(model: &Model, scale: String, panels: Vec<Panel>) -> MapPlot {
    MapPlot {
        title: model.origin.title.clone(),
        x: Axis::linear("x", "mm"),
        y: Axis::linear("y", "mm"),
        rows: Vec::new(),
        equal_aspect: true,
        scale: Some(scale),
        classes: Vec::new(),
        outlines: drawn(&outlines(model)),
        panels,
    }
}

/// Least and largest of some values and 0.
fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((0.0, 0.0), |(least, most), v| (v.min(least), v.max(most)))
}

/// Cells by their values, from white at one to dark at another.
fn panel(model: &Model, values: &[f64], (white, dark): (f64, f64), title: String) -> Panel {
    let range = if dark == white { 1.0 } else { dark - white };
    Panel { title, cells: filled(model, values.iter().map(|v| (v - white) / range)), ..Panel::default() }
}

/// Dark where the mid-plane deflects most, whichever way, on the scale of its nodes; `None` where all of it is rounding.
fn deflection(model: &Model, u: &[f64]) -> Option<MapPlot> {
    let of_nodes = deflections(model, u);
    let (least, most) = range(&of_nodes);
    if most - least <= NOTHING * largest(u) {
        return None;
    }
    let (white, dark) = if most < -least { (most, least) } else { (least, most) };
    let title = format!("deflection, {}", Dimension::LENGTH.list(&[white, dark]).replace(", ", " to "));
    Some(plan(
        model,
        "from the least to the largest".into(),
        vec![panel(model, &means(model, &of_nodes), (white, dark), title)],
    ))
}

/// Three digits of a number, short enough for the heading of a small panel.
fn short(value: f64) -> String {
    let digits = (2.0 - value.abs().max(1e-3).log10().floor()).clamp(0.0, 5.0);
    if value == 0.0 { "0".to_owned() } else { format!("{value:.*}", digits as usize) }
}

/// Stresses at the middle of the lowest and of the highest ply, in its axes: means over the windows that criteria see.
fn stresses(model: &Model, u: &[f64]) -> Result<MapPlot, Error> {
    let quads: Vec<usize> = (0..model.plate.plane.quads.len()).collect();
    let recovery = stress::recovery(model, &quads, &[], false);
    let mut stresses = vec![0.0; 6 * recovery.sites()];
    stress::recover(model, &recovery, &Stressed::of(u.to_vec()), 1, Some(&stress::virgin(model)), &mut stresses)?;
    stress::add(&mut stresses, &stress::residual(model, &recovery)?);
    let nothing = NOTHING * largest(&stresses);
    stresses.iter_mut().filter(|stress| stress.abs() <= nothing).for_each(|stress| *stress = 0.0);
    let last = model.laminate.plies.len() - 1;
    let apart = !model.region_names.is_empty();
    let mut panels = Vec::new();
    for highest in [true, false].into_iter().take(if last > 0 || apart { 2 } else { 1 }) {
        let name = match (highest, apart) {
            (true, true) => "top".to_owned(),
            (false, true) => "bottom".to_owned(),
            (highest, false) => format!("ply {}", if highest { last + 1 } else { 1 }),
        };
        for (component, symbol) in DRAWN {
            let of_cell = |cell: usize| {
                let sites = recovery.sites_over(cell);
                stresses[6 * (if highest { sites.end - 1 } else { sites.start }) + component]
            };
            let values: Vec<f64> = quads.iter().map(|cell| of_cell(*cell)).collect();
            let (least, most) = range(&values);
            let title = format!("{name} {symbol}: {} to {}", short(least * 1e-6), short(most * 1e-6));
            panels.push(panel(model, &values, (least, most), title));
        }
    }
    Ok(plan(model, "from the least to the largest, MPa".into(), panels))
}
