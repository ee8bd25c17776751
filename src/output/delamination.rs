//! Delaminations as a table and as a picture in plan, a C-scan.

use crate::analyses::delamination::{Delaminated, DelaminatedCell};
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::output::outlines::{drawn, outlines};
use fem_core::plugin::Dimension;
use fem_io::files::OutputDir;
use fem_io::plot::{self, Axis, Fill, MapCell, MapPlot, Panel};
use fem_io::tables::{self, DelaminationRow};

/// Most interfaces of a sheet, beside their projection.
const SHEET: usize = 11;

/// Spans of time that have a colour each.
const SPANS: usize = 6;

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
pub(crate) fn write_table(dir: &OutputDir, model: &Model, grown: Option<&Delaminated>) -> Result<(), Error> {
    let Some(grown) = grown else { return Ok(()) };
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
/// there, then each interface, or, as long as nothing has delaminated, the damage of each; and `c_scan_times`, where something has
/// delaminated: when it first was.
///
/// # Errors
/// As [`OutputDir::write`], and numbers that no plot can show.
pub(crate) fn write_plot(dir: &OutputDir, model: &Model, grown: Option<&Delaminated>) -> Result<(), Error> {
    let Some(grown) = grown.filter(|grown| !grown.cells.is_empty()) else { return Ok(()) };
    plot::map_plot(&c_scan(model, grown))?.write(dir, "c_scan")?;
    match times(model, grown) {
        Some(times) => Ok(plot::map_plot(&times)?.write(dir, "c_scan_times")?),
        None => Ok(()),
    }
}

/// A panel of the cells of the mesh that are in `view`.
fn panel(model: &Model, view: &[usize], title: String, fills: &[Fill]) -> Panel {
    let outline = |quad: usize| model.plate.plane.outline(quad).into_iter().map(|p| p.map(|x| x * 1e3)).collect();
    let crosses = match &model.plan {
        Plan::Impact(impact) => impact.strikes.iter().map(|strike| strike.centre.map(|x| x * 1e3)).collect(),
        _ => Vec::new(),
    };
    let cells = view.iter().map(|quad| MapCell { corners: outline(*quad), fill: fills[*quad] }).collect();
    Panel { title, cells, crosses, ..Panel::default() }
}

/// A sheet without panels.
fn sheet(model: &Model, title: &str) -> MapPlot {
    MapPlot {
        title: format!("{title}. {}", model.origin.title),
        x: Axis::linear("x", "mm"),
        y: Axis::linear("y", "mm"),
        rows: Vec::new(),
        equal_aspect: true,
        scale: None,
        classes: Vec::new(),
        outlines: drawn(&outlines(model)),
        panels: Vec::new(),
    }
}

/// When cells first delaminated at a point: the first interface of each place, then each interface; `None` where none has.
fn times(model: &Model, grown: &Delaminated) -> Option<MapPlot> {
    let view = view(model, grown);
    let grew = |cell: &DelaminatedCell| cell.since.filter(|since| *since > 0.0);
    let all = || grown.cells.iter().filter_map(grew);
    let [first, last] = [all().reduce(f64::min)?, all().reduce(f64::max)?];
    let part = |since: f64| ((since - first) / (last - first) * SPANS as f64) as usize;
    // Of a delamination that was there at the start it is the last class.
    let class = |since: f64| if since > 0.0 { part(since).min(SPANS - 1) } else { SPANS };
    let mut sheets = vec![vec![f64::INFINITY; model.plate.plane.quads.len()]; 1 + grown.interfaces.len()];
    for (quad, cell) in cells(model, grown) {
        let Some(number) = grown.interfaces.iter().position(|one| one.below == cell.below) else { continue };
        let since = cell.since.unwrap_or(f64::INFINITY);
        for sheet in [0, 1 + number] {
            sheets[sheet][quad] = sheets[sheet][quad].min(since);
        }
    }
    let end = |k: usize| first + (last - first) * (k + 1) as f64 / SPANS as f64;
    let spans = (0..SPANS).map(|k| format!("until {}", Dimension::TIME.of(end(k))));
    let titles = [format!("first of all, from {}", Dimension::TIME.of(first))].into_iter();
    let titles = titles.chain(grown.interfaces.iter().map(|one| format!("interface {}", name(one.below))));
    let fill = |since: &f64| if since.is_finite() { Fill::Class(class(*since)) } else { Fill::Blank };
    let panels = titles.zip(&sheets).filter(|(_, times)| times.iter().any(|since| since.is_finite()));
    let panels = panels
        .take(1 + SHEET)
        .map(|(title, times)| panel(model, &view, title, &times.iter().map(fill).collect::<Vec<_>>()));
    Some(MapPlot {
        classes: spans.chain(["from the beginning".to_owned()]).collect(),
        panels: panels.collect(),
        ..sheet(model, "When it delaminated")
    })
}

fn c_scan(model: &Model, grown: &Delaminated) -> MapPlot {
    let view = view(model, grown);
    let blank = || vec![Fill::Blank; model.plate.plane.quads.len()];
    let delaminated = grown.interfaces.iter().any(|one| one.area > 0.0);
    let damaged = |below: usize| grown.cells.iter().any(|cell| cell.below == below);
    let shown = grown.interfaces.iter().filter(|one| if delaminated { one.area > 0.0 } else { damaged(one.below) });
    let shown: Vec<_> = shown.collect();
    let mut projection = blank();
    let mut each = vec![blank(); shown.len()];
    for (quad, cell) in cells(model, grown) {
        let Some(number) = shown.iter().position(|one| one.below == cell.below) else { continue };
        each[number][quad] = Fill::Share(if delaminated { cell.share } else { cell.damage });
        if cell.share >= 0.5 {
            projection[quad] = match projection[quad] {
                Fill::Class(upper) => Fill::Class(upper.max(number)),
                _ => Fill::Class(number),
            };
        }
    }
    let mut panels = Vec::new();
    if delaminated {
        let title = format!("projection: {}", Dimension::AREA.of(grown.projected));
        panels.push(panel(model, &view, title, &projection));
    }
    let area = |area: f64| if delaminated { format!(": {}", Dimension::AREA.of(area)) } else { String::new() };
    let titles = shown.iter().map(|one| format!("interface {}{}", name(one.below), area(one.area)));
    panels.extend(titles.zip(each).take(SHEET).map(|(title, fills)| panel(model, &view, title, &fills)));
    MapPlot {
        scale: Some(if delaminated { "delaminated share" } else { "mean damage" }.into()),
        classes: if delaminated { shown.iter().map(|one| name(one.below)).collect() } else { Vec::new() },
        panels,
        ..sheet(model, if delaminated { "Delaminations" } else { "Damaged interfaces, none delaminated" })
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
