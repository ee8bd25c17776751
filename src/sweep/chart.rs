//! What matters, and what is best, as pictures.

use super::Sweep;
use super::pareto::Objective;
use super::runner::CaseRow;
use super::sensitivity::Importance;
use fem_io::plot::{Axis, Fill, LinePlot, MapCell, MapPlot, Panel, Series, Stroke, Style};

/// Most groups of cases that are told apart by colour.
const MOST_GROUPS: usize = 8;

/// Sobol's indices of one result, `all` of that name: of each key a bar for what it does alone and one for what it does in all, with
/// their intervals.
pub(super) fn bars(title: &str, all: &[Importance]) -> MapPlot {
    let (mut panel, mut rows) = (Panel::default(), Vec::new());
    for (row, of) in all.iter().rev().enumerate() {
        let at = row as f64 + 1.0;
        let indices = [([of.first, of.first_low, of.first_high], 0.2), ([of.total, of.total_low, of.total_high], -0.2)];
        for (class, ([index, low, high], up)) in indices.into_iter().enumerate() {
            let (bottom, middle, top) = (at + up - 0.18, at + up, at + up + 0.18);
            let corners = vec![[0.0, bottom], [index, bottom], [index, top], [0.0, top]];
            panel.cells.push(MapCell { corners, fill: Fill::Class(class) });
            panel.lines.push(Stroke { points: vec![[low, middle], [high, middle]], class: 2 });
        }
        rows.push((at, of.key.clone()));
    }
    let of = all.first().map_or("", |of| of.result.as_str());
    MapPlot {
        title: title.to_owned(),
        x: Axis::linear(format!("Share of the variance of {of}"), ""),
        y: Axis::linear("Keys", ""),
        rows,
        equal_aspect: false,
        scale: None,
        classes: vec!["alone".into(), "in all".into(), "95 % interval".into()],
        outlines: Vec::new(),
        panels: vec![panel],
    }
}

/// The cases over both objectives, in a colour for each value of the key `by` that is a word, and their front; `None` without points.
pub(super) fn front(title: &str, sweep: &Sweep<'_>, rows: &[CaseRow], by: Option<usize>) -> Option<LinePlot> {
    let objectives = sweep.objectives.as_ref()?;
    let placed: Vec<(usize, [f64; 2], bool)> =
        rows.iter().zip(sweep.front(rows)).filter_map(|(row, of)| of.map(|(at, on)| (row.case - 1, at, on))).collect();
    let mut series: Vec<Series> = Vec::new();
    for (case, [x, y], _) in &placed {
        let label = by.map_or_else(|| "cases".to_owned(), |axis| sweep.design.case(*case)[axis].clone());
        match series.iter_mut().find(|series| series.label == label) {
            Some(series) => series.points.push((*x, *y)),
            None => series.push(Series { label, points: vec![(*x, *y)], style: Style::Dots }),
        }
    }
    if series.len() > MOST_GROUPS {
        let points = series.into_iter().flat_map(|series| series.points).collect();
        series = vec![Series { label: "cases".into(), points, style: Style::Dots }];
    }
    let mut best: Vec<(f64, f64)> = placed.iter().filter(|(.., on)| *on).map(|(_, [x, y], _)| (*x, *y)).collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    if best.is_empty() {
        return None;
    }
    series.push(Series { label: "front".into(), points: best, style: Style::Guide });
    let axis = |k: usize| {
        let Objective { quantity, most } = &objectives[k];
        let label = format!("{}, {}", quantity.name, if *most { "most" } else { "least" });
        match quantity.unit().is_empty() {
            true => (Axis::linear(label, ""), 1.0),
            false => Axis::fitting(&label, quantity.dimension, placed.iter().map(|(_, at, _)| at[k])),
        }
    };
    let [(x, in_x), (y, in_y)] = [0, 1].map(axis);
    for point in series.iter_mut().flat_map(|series| &mut series.points) {
        *point = (in_x * point.0, in_y * point.1);
    }
    Some(LinePlot { title: title.to_owned(), x, y, series, marks: Vec::new(), doubts: Vec::new() })
}
