//! A map as a picture.

use super::interpolant::Interpolant;
use super::lines::zeros;
use super::record::strokes;
use super::{BorderMap, MapAxis, MapFound};
use crate::error::Error;
use fem_core::plugin::Dimension;
use fem_io::files::OutputDir;
use fem_io::plot::{Axis, Fill, MapCell, MapOutline, MapPlot, Panel, Scale, Stroke, map_plot};
use fem_io::units::parse_as;

/// Cells along each side.
const CELLS: usize = 60;
/// Parts of a line of equal energy.
const PARTS: usize = 60;
/// Most lines of equal energy.
const MOST: usize = 6;
/// Grey of a cell where all modes have failed.
const DARKEST: f64 = 0.6;

/// Draws the lines, a cell the darker the more modes have failed there, dots where impacts were computed, and lines of equal energy
/// over mass and velocity: `border_map.svg` and `.png`; it as SVG. Nothing where nothing was found.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_map_picture(dir: &OutputDir, map: &BorderMap<'_>, found: &MapFound) -> Result<Option<String>, Error> {
    if found.strips.iter().all(|strip| strip.levels.is_empty()) {
        return Ok(None);
    }
    let plot = if map.axes.len() > 1 { plane(map, found) } else { strips(map, found) };
    let picture = map_plot(&plot)?;
    picture.write(dir, "border_map")?;
    Ok(Some(picture.svg))
}

fn axis(of: &MapAxis) -> Axis {
    let scale = if of.logarithmic { Scale::Logarithmic } else { Scale::Linear };
    Axis { scale, ..Axis::linear(of.key.as_str(), of.unit.clone().unwrap_or_default()) }
}

/// How dark a point is.
fn shade(map: &MapFound, strip: usize, p: [f64; 2]) -> Fill {
    let levels = &map.strips[strip].levels;
    let failed = levels.iter().filter(|level| level.value(p) >= 0.0).count();
    Fill::Share(DARKEST * failed as f64 / levels.len().max(1) as f64)
}

fn plane(map: &BorderMap<'_>, found: &MapFound) -> MapPlot {
    let [x, y] = [&map.axes[0], &map.axes[1]];
    let share = |k: usize| k as f64 / CELLS as f64;
    let cell = |i: usize, j: usize| {
        let ([left, right], [low, high]) = ([share(i), share(i + 1)], [share(j), share(j + 1)]);
        let corners = [[left, low], [right, low], [right, high], [left, high]];
        let corners = corners.map(|[u, v]| [x.value(u), y.value(v)]).to_vec();
        MapCell { corners, fill: shade(found, 0, [0.5 * (left + right), 0.5 * (low + high)]) }
    };
    let mut panel =
        Panel { cells: (0..CELLS * CELLS).map(|k| cell(k % CELLS, k / CELLS)).collect(), ..Panel::default() };
    let mut classes = Vec::new();
    for (line, name) in found.names.iter().enumerate() {
        let pieces = strokes(map, found, Some(line));
        if !pieces.is_empty() {
            panel.lines.extend(pieces.into_iter().map(|points| Stroke { points, class: classes.len() }));
            classes.push(name.clone());
        }
    }
    panel.dots = found.points.iter().map(|point| ([point.values[0], point.values[1]], classes.len())).collect();
    classes.push("impacts computed".into());
    let energies = energies(x, y);
    panel.notes = energies.iter().map(|(at, words, _)| (*at, words.clone())).collect();
    let lines: Vec<_> = energies.into_iter().map(|(.., line)| line).collect();
    let first = MapOutline { name: "first damage".into(), lines: strokes(map, found, None), dashed: false };
    let equal = MapOutline { name: "equal energy".into(), lines, dashed: true };
    MapPlot {
        title: map.scene.title.clone(),
        x: axis(x),
        y: axis(y),
        rows: Vec::new(),
        equal_aspect: [x, y].map(|axis| axis.key.ends_with(".at.x") || axis.key.ends_with(".at.y")) == [true; 2],
        scale: None,
        classes,
        outlines: vec![equal, first],
        panels: vec![panel],
    }
}

/// Lines of equal energy over a mass and a velocity: where each ends at the right edge, or the last value of the vertical axis, what it
/// is called, its points.
fn energies(x: &MapAxis, y: &MapAxis) -> Vec<(f64, String, Vec<[f64; 2]>)> {
    if !(x.key.ends_with("impactor.mass") && y.key.ends_with("impactor.velocity")) {
        return Vec::new();
    }
    let si = |axis: &MapAxis, value: f64, dimension| parse_as(&axis.words(value), dimension).unwrap_or(f64::NAN);
    let [mass, per] = [(x, Dimension::MASS), (y, Dimension::VELOCITY)].map(|(axis, of)| si(axis, 1.0, of));
    let energy = |x: f64, y: f64| 0.5 * mass * x * (per * y).powi(2);
    let [low, high] = [0, 1].map(|end| energy(x.ends[1], y.ends[end]));
    let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let round = decades.flat_map(|k| [1.0, 2.0, 5.0].map(|m| m * 10.0_f64.powi(k)));
    let inside: Vec<f64> = round.filter(|e| (1.05 * low..0.97 * high).contains(e)).collect();
    let every = inside.len().div_ceil(MOST).max(1);
    let line = |e: f64| {
        let at = |x: f64| (e / (0.5 * mass * x)).sqrt() / per;
        let points = (0..=PARTS).map(|k| x.value(k as f64 / PARTS as f64)).map(|x| [x, at(x)]);
        let points = points.filter(|p| (y.ends[0]..=y.ends[1]).contains(&p[1]));
        (at(x.ends[1]), Dimension::ENERGY.of(e), points.collect())
    };
    inside.into_iter().rev().step_by(every).map(line).collect()
}

/// One number over the values of a list: a strip for each.
fn strips(map: &BorderMap<'_>, found: &MapFound) -> MapPlot {
    let x = &map.axes[0];
    let values = map.list.as_ref().map_or(&[][..], |(_, values)| values.as_slice());
    let (mut panel, mut rows) = (Panel::default(), Vec::new());
    let mut classes = found.names.clone();
    for (strip, of) in found.strips.iter().enumerate().filter(|(_, of)| !of.levels.is_empty()) {
        let height = |share: f64| strip as f64 + 0.6 + 0.8 * share;
        let places = |level: &Interpolant| zeros(&|p| level.value(p), 1).into_iter().map(|[share, _]| share).collect();
        let places: Vec<Vec<f64>> = of.levels.iter().map(places).collect();
        for (class, share) in
            places.iter().enumerate().flat_map(|(class, of)| of.iter().map(move |share| (class, share)))
        {
            let points = [0.0, 1.0].map(|end| [x.value(*share), height(end)]).to_vec();
            panel.lines.push(Stroke { points, class });
        }
        // Between its lines nothing changes in a strip.
        let mut ends: Vec<f64> = places.concat().into_iter().chain([0.0, 1.0]).collect();
        ends.sort_by(f64::total_cmp);
        for pair in ends.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|share| x.value(share));
            let corners = vec![[a, height(0.0)], [b, height(0.0)], [b, height(1.0)], [a, height(1.0)]];
            panel.cells.push(MapCell { corners, fill: shade(found, strip, [0.5 * (pair[0] + pair[1]), 0.0]) });
        }
        rows.push((strip as f64 + 1.0, values.get(strip).cloned().unwrap_or_default()));
    }
    let place = |point: &super::MapPoint| ([point.values[0], point.strip as f64 + 1.0], classes.len());
    panel.dots = found.points.iter().map(place).collect();
    classes.push("impacts computed".into());
    MapPlot {
        title: map.scene.title.clone(),
        x: axis(x),
        y: Axis::linear(map.list.as_ref().map_or("", |(key, _)| key.as_str()), ""),
        rows,
        equal_aspect: false,
        scale: None,
        classes,
        outlines: Vec::new(),
        panels: vec![panel],
    }
}
