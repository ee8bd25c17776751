//! Delaminations as a table and as a picture in plan, a C-scan.

use crate::analyses::impact::{Delaminated, DelaminatedCell, Outcome};
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::output::outlines::{drawn, outlines};
use fem_core::plugin::Dimension;
use fem_io::files::OutputDir;
use fem_io::plot::{self, Axis, Fill, MapCell, MapPlot, Panel};
use fem_io::tables::{self, DelaminationRow};

/// Most interfaces of a sheet, beside their projection.
const SHEET: usize = 11;

/// Cells in view beyond those that are damaged, as a share of what these span.
const AROUND: f64 = 0.6;

/// The cells of the mesh that are damaged, with those that a symmetry maps one onto.
fn cells<'a>(model: &'a Model, grown: &'a Delaminated) -> impl Iterator<Item = (usize, &'a DelaminatedCell)> {
    let symmetry = model.plate.symmetry();
    let mut images = vec![Vec::new(); model.plate.plane.quads.len()];
    (0..images.len()).for_each(|quad| images[symmetry.quad(quad)].push(quad));
    grown.cells.iter().flat_map(move |cell| images[cell.quad].clone().into_iter().map(move |quad| (quad, cell)))
}

fn name(below: usize) -> String {
    format!("{below}|{}", below + 1)
}

/// Writes `delaminations.csv`, where delaminations grow: every cell of every interface that is damaged.
///
/// # Errors
/// As [`OutputDir::write`].
pub(crate) fn write_table(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    let Some(grown) = &outcome.delaminated else { return Ok(()) };
    let mesh = &model.plate.plane;
    let row = |(quad, cell): (usize, &DelaminatedCell)| {
        let [x, y] = mesh.corners(quad).centroid();
        DelaminationRow {
            interface: name(cell.below),
            cell: mesh.quad_tags[quad],
            x_m: x,
            y_m: y,
            area_m2: mesh.quality(quad).area,
            delaminated: cell.share,
            damage: cell.damage,
            since_s: cell.since,
        }
    };
    Ok(tables::write_delaminations(dir, &cells(model, grown).map(row).collect::<Vec<_>>())?)
}

/// Draws `c_scan`, where something is damaged: the projection, each cell in the colour of the uppermost interface that has delaminated
/// there, then each interface.
///
/// # Errors
/// As [`OutputDir::write`], and numbers that no plot can show.
pub(crate) fn write_plot(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    let Some(grown) = outcome.delaminated.as_ref().filter(|grown| !grown.cells.is_empty()) else { return Ok(()) };
    Ok(plot::map_plot(&c_scan(model, grown))?.write(dir, "c_scan")?)
}

fn c_scan(model: &Model, grown: &Delaminated) -> MapPlot {
    let mesh = &model.plate.plane;
    let view = view(model, grown);
    let crosses: Vec<[f64; 2]> = match &model.plan {
        Plan::Impact(impact) => impact.strikes.iter().map(|strike| strike.centre.map(|x| x * 1e3)).collect(),
        _ => Vec::new(),
    };
    let panel = |title: String, fills: Vec<Fill>| Panel {
        title,
        cells: view
            .iter()
            .map(|quad| MapCell {
                corners: mesh.corners(*quad).into_iter().map(|p| p.map(|x| x * 1e3)).collect(),
                fill: fills[*quad],
            })
            .collect(),
        crosses: crosses.clone(),
        ..Panel::default()
    };
    let blank = || vec![Fill::Blank; mesh.quads.len()];
    let shown: Vec<_> = grown.interfaces.iter().filter(|one| one.area > 0.0).collect();
    let mut projection = blank();
    let mut each = vec![blank(); shown.len()];
    for (quad, cell) in cells(model, grown) {
        let Some(number) = shown.iter().position(|one| one.below == cell.below) else { continue };
        each[number][quad] = Fill::Share(cell.share);
        if cell.share >= 0.5 {
            projection[quad] = match projection[quad] {
                Fill::Class(upper) => Fill::Class(upper.max(number)),
                _ => Fill::Class(number),
            };
        }
    }
    let mut panels = vec![panel(format!("projection: {}", Dimension::AREA.of(grown.projected)), projection)];
    let titles = shown.iter().map(|one| format!("interface {}: {}", name(one.below), Dimension::AREA.of(one.area)));
    panels.extend(titles.zip(each).take(SHEET).map(|(title, fills)| panel(title, fills)));
    MapPlot {
        title: format!("Delaminations. {}", model.origin.title),
        x: Axis::linear("x", "mm"),
        y: Axis::linear("y", "mm"),
        equal_aspect: true,
        scale: Some("delaminated share".into()),
        classes: shown.iter().map(|one| name(one.below)).collect(),
        outlines: drawn(&outlines(model)),
        panels,
    }
}

/// Cells near those that are damaged.
fn view(model: &Model, grown: &Delaminated) -> Vec<usize> {
    let mesh = &model.plate.plane;
    let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for (quad, _) in cells(model, grown) {
        for p in mesh.corners(quad) {
            low = [0, 1].map(|d| low[d].min(p[d]));
            high = [0, 1].map(|d| high[d].max(p[d]));
        }
    }
    let half = 0.5 * (1.0 + AROUND) * (high[0] - low[0]).max(high[1] - low[1]);
    let inside = |quad: &usize| {
        let centre = mesh.corners(*quad).centroid();
        (0..2).all(|d| (centre[d] - 0.5 * (low[d] + high[d])).abs() <= half)
    };
    (0..mesh.quads.len()).filter(inside).collect()
}
