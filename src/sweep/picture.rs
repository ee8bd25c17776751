//! A sweep as pictures.

use super::runner::CaseRow;
use super::table::Record;
use super::{CaseFigures, Scatter, Sweep, chart};
use crate::error::Error;
use fem_io::files::OutputDir;
use fem_io::plot::{
    Axis, Fill, LinePlot, MapCell, MapPlot, Mark, Panel, Picture, Series, Stroke, Style, line_plot, map_plot,
};
use fem_io::scene::Sampling;
use std::collections::BTreeMap;

/// Most curves of a picture.
const MOST_CURVES: usize = 8;
/// Most histories of a picture.
const MOST_HISTORIES: usize = 40;
/// Most cells of a map.
const MOST_CELLS: usize = 40_000;

/// A case with its numbers.
struct Point<'a> {
    values: Vec<String>,
    found: &'a CaseFigures,
}

/// Draws what the design shows, each as SVG and PNG: curves over the only number that varies, `peak_force` and `damage_index`; a
/// map over two, `damage_map`; `force_at_damage`, how the force at first damage scatters; `force_histories` of a few cases, one over
/// the other; `importance_*`, Sobol's indices of each result; `pareto_front`. A picture that would have nothing to show is left out. The
/// pictures as SVG.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_pictures(
    dir: &OutputDir,
    title: &str,
    sweep: &Sweep<'_>,
    rows: &[CaseRow],
    record: &Record,
) -> Result<Vec<String>, Error> {
    let mut album = Album { dir, pictures: Vec::new() };
    let point = |row: &CaseRow| sweep.design.case(row.case - 1);
    let points: Vec<Point<'_>> = rows
        .iter()
        .filter_map(|row| Some(Point { values: point(row), found: row.result.as_ref().ok()? }))
        .filter(|point| !point.found.impactors.is_empty())
        .collect();
    if points.is_empty() {
        return Ok(album.pictures);
    }
    let varied: Vec<usize> =
        (0..sweep.design.axes.len()).filter(|axis| sweep.design.axes[*axis].variation.count() != Some(1)).collect();
    let is_number = |axis: &usize| points.iter().all(|point| number(&point.values, *axis).is_some());
    let numeric: Vec<usize> = varied.iter().copied().filter(is_number).collect();
    match (&numeric[..], sweep.design.sampling) {
        ([x], Sampling::Grid) => {
            let peak = |found: &CaseFigures| Some(found.impactors[0].peak_force);
            let first = |found: &CaseFigures| Some(found.first.as_ref()?.force);
            let mut series = curves(&points, (*x, &varied), "peak", &peak);
            series.extend(curves(&points, (*x, &varied), "at first damage", &first));
            draw(&mut album, "peak_force", title, sweep, *x, ("Contact force", "N"), series)?;
            let modes = points[0].found.modes.iter().enumerate();
            let index = |k: usize| move |found: &CaseFigures| found.modes.get(k).map(|mode| mode.index);
            let mut series: Vec<Series> =
                modes.flat_map(|(k, mode)| curves(&points, (*x, &varied), &mode.name, &index(k))).collect();
            if let Some(ends) = ends(&series) {
                let points = ends.map(|x| (x, 1.0)).to_vec();
                series.push(Series { label: "damage".into(), points, style: Style::Guide });
            }
            draw(&mut album, "damage_index", title, sweep, *x, ("Largest failure index", ""), series)?;
        }
        ([x, y], Sampling::Grid) if varied.len() == 2 => {
            if let Some(map) = map(title, sweep, &points, [*x, *y]) {
                album.put("damage_map", map_plot(&map)?)?;
            }
        }
        _ => {}
    }
    overlay(&mut album, title, &points, &varied)?;
    if let Some(scatter) = &record.scatter {
        histogram(&mut album, title, &points, scatter)?;
    }
    for of in record.importance.chunk_by(|a, b| a.result == b.result) {
        let name = of[0].result.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
        album.put(&format!("importance_{name}"), map_plot(&chart::bars(title, of))?)?;
    }
    let words = varied.iter().copied().find(|axis| !numeric.contains(axis));
    if let Some(plot) = chart::front(title, sweep, rows, words) {
        album.put("pareto_front", line_plot(&plot)?)?;
    }
    Ok(album.pictures)
}

/// Pictures that were written.
struct Album<'a> {
    dir: &'a OutputDir,
    pictures: Vec<String>,
}

impl Album<'_> {
    fn put(&mut self, name: &str, picture: Picture) -> Result<(), Error> {
        picture.write(self.dir, name)?;
        self.pictures.push(picture.svg);
        Ok(())
    }
}

/// The forces of few cases over time, each by the values that vary where they are few enough to be told apart.
fn overlay(album: &mut Album<'_>, title: &str, points: &[Point<'_>], varied: &[usize]) -> Result<(), Error> {
    let with: Vec<&Point<'_>> = points.iter().filter(|point| point.found.history.len() > 1).collect();
    if !(2..=MOST_HISTORIES).contains(&with.len()) {
        return Ok(());
    }
    let name = |point: &Point<'_>| match with.len() > MOST_CURVES {
        true => "cases".to_owned(),
        false => varied.iter().map(|axis| point.values[*axis].as_str()).collect::<Vec<_>>().join(", "),
    };
    let series = with.iter().map(|point| Series {
        label: name(point),
        points: point.found.history.iter().map(|[t, f]| (1e3 * f64::from(*t), f64::from(*f))).collect(),
        style: Style::Solid,
    });
    let plot = LinePlot {
        title: title.to_owned(),
        x: Axis::linear("Time", "ms"),
        y: Axis::linear("Contact force", "N"),
        series: series.collect(),
        marks: Vec::new(),
        doubts: Vec::new(),
    };
    album.put("force_histories", line_plot(&plot)?)
}

/// The number that an axis has in a case.
fn number(values: &[String], axis: usize) -> Option<f64> {
    values[axis].split_whitespace().next()?.parse().ok()
}

/// A curve over axis `x` for each combination of the others that vary.
fn curves(
    points: &[Point<'_>],
    (x, varied): (usize, &[usize]),
    what: &str,
    of: &dyn Fn(&CaseFigures) -> Option<f64>,
) -> Vec<Series> {
    let mut series: Vec<Series> = Vec::new();
    for point in points {
        let others = varied.iter().filter(|axis| **axis != x).map(|axis| point.values[*axis].as_str());
        let label = others.fold(what.to_owned(), |label, value| format!("{label}, {value}"));
        let Some(place) = number(&point.values, x).zip(of(point.found)) else { continue };
        match series.iter_mut().find(|series| series.label == label) {
            Some(series) => series.points.push(place),
            None => series.push(Series { label, points: vec![place], style: Style::Joined }),
        }
    }
    series
}

fn ends(series: &[Series]) -> Option<[f64; 2]> {
    let xs = || series.iter().flat_map(|series| &series.points).map(|point| point.0);
    let (low, high) = (xs().reduce(f64::min)?, xs().reduce(f64::max)?);
    (low < high).then_some([low, high])
}

fn axis(sweep: &Sweep<'_>, k: usize) -> Axis {
    let axis = &sweep.design.axes[k];
    Axis::linear(axis.key.as_str(), axis.variation.unit().unwrap_or(""))
}

fn draw(
    album: &mut Album<'_>,
    name: &str,
    title: &str,
    sweep: &Sweep<'_>,
    x: usize,
    (label, unit): (&str, &str),
    series: Vec<Series>,
) -> Result<(), Error> {
    let drawn = ends(&series).is_some() && series.len() <= MOST_CURVES;
    if drawn {
        let (x, y) = (axis(sweep, x), Axis::linear(label, unit));
        let plot = LinePlot { title: title.to_owned(), x, y, series, marks: Vec::new(), doubts: Vec::new() };
        album.put(name, line_plot(&plot)?)?;
    }
    Ok(())
}

/// The largest index of all modes over two numbers, with a line for each mode where its own is 1.
fn map(title: &str, sweep: &Sweep<'_>, points: &[Point<'_>], axes: [usize; 2]) -> Option<MapPlot> {
    let of = |axis: usize| {
        let mut levels: Vec<f64> = points.iter().filter_map(|point| number(&point.values, axis)).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        levels
    };
    let [xs, ys] = axes.map(of);
    if xs.len() < 2 || ys.len() < 2 || xs.len() * ys.len() > MOST_CELLS {
        return None;
    }
    let place = |levels: &[f64], x: f64| levels.iter().position(|level| *level == x);
    let mut grid: BTreeMap<(usize, usize), &CaseFigures> = BTreeMap::new();
    for point in points {
        let [x, y] = axes.map(|axis| number(&point.values, axis));
        grid.insert((place(&xs, x?)?, place(&ys, y?)?), point.found);
    }
    let edge = |levels: &[f64], i: usize| {
        [i.saturating_sub(1), i + 1].map(|j| 0.5 * (levels[i] + levels[j.min(levels.len() - 1)]))
    };
    let largest = |found: &CaseFigures| found.modes.iter().map(|mode| mode.index).fold(0.0, f64::max);
    let cells = grid.iter().map(|(&(i, j), found)| {
        let ([left, right], [low, high]) = (edge(&xs, i), edge(&ys, j));
        let corners = vec![[left, low], [right, low], [right, high], [left, high]];
        MapCell { corners, fill: Fill::Share(largest(found).min(1.0)) }
    });
    let modes = &points[0].found.modes;
    let mut panel = Panel { cells: cells.collect(), ..Panel::default() };
    let mut classes = Vec::new();
    for (k, mode) in modes.iter().enumerate() {
        let index = |i: usize, j: usize| Some(grid.get(&(i, j))?.modes.get(k)?.index);
        let strokes = border(&xs, &ys, &index);
        if !strokes.is_empty() {
            panel.lines.extend(strokes.into_iter().map(|points| Stroke { points, class: classes.len() }));
            classes.push(mode.name.clone());
        }
    }
    let [x, y] = axes.map(|k| axis(sweep, k));
    Some(MapPlot {
        title: title.to_owned(),
        x,
        y,
        rows: Vec::new(),
        equal_aspect: false,
        scale: Some("largest failure index".into()),
        classes,
        outlines: Vec::new(),
        panels: vec![panel],
    })
}

/// The lines on which `index` is 1, a piece for each cell of the grid that they cross: marching triangles, linear between the
/// points.
pub(crate) fn border(xs: &[f64], ys: &[f64], index: &dyn Fn(usize, usize) -> Option<f64>) -> Vec<Vec<[f64; 2]>> {
    let mut pieces = Vec::new();
    for i in 1..xs.len() {
        for j in 1..ys.len() {
            let corner = |di: usize, dj: usize| Some(([xs[i - di], ys[j - dj]], index(i - di, j - dj)? - 1.0));
            let corners = [corner(1, 1), corner(0, 1), corner(0, 0), corner(1, 0)];
            let [Some(a), Some(b), Some(c), Some(d)] = corners else { continue };
            for triangle in [[a, b, c], [a, c, d]] {
                let sides = [(0, 1), (1, 2), (2, 0)].map(|(p, q)| (triangle[p], triangle[q]));
                let crossed = sides.into_iter().filter(|((_, p), (_, q))| (*p < 0.0) != (*q < 0.0));
                let piece: Vec<[f64; 2]> =
                    crossed.map(|((a, p), (b, q))| [0, 1].map(|k| a[k] + (b[k] - a[k]) * p / (p - q))).collect();
                if piece.len() == 2 {
                    pieces.push(piece);
                }
            }
        }
    }
    pieces
}

/// How the force at first damage scatters, with basis values.
fn histogram(album: &mut Album<'_>, title: &str, points: &[Point<'_>], scatter: &Scatter) -> Result<(), Error> {
    let forces: Vec<f64> = points.iter().filter_map(|point| Some(point.found.first.as_ref()?.force)).collect();
    let (low, high) = forces.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), f| (low.min(*f), high.max(*f)));
    if forces.len() < 10 || !(high > low) {
        return Ok(());
    }
    let bins = (forces.len() as f64).sqrt().ceil().min(40.0) as usize;
    let width = (high - low) / bins as f64;
    let mut counts = vec![0_usize; bins];
    for force in &forces {
        counts[(((force - low) / width) as usize).min(bins - 1)] += 1;
    }
    let mut stairs = vec![(low, 0.0)];
    for (k, count) in counts.iter().enumerate() {
        let share = *count as f64 / points.len() as f64;
        stairs.extend([(low + k as f64 * width, share), (low + (k + 1) as f64 * width, share)]);
    }
    stairs.push((high, 0.0));
    let marks = scatter.bases.iter().filter(|basis| basis.force_N > 0.0);
    let marks =
        marks.map(|basis| Mark { x: basis.force_N, y: 0.0, label: format!("{}-basis, {}", basis.basis, basis.method) });
    let plot = LinePlot {
        title: title.to_owned(),
        x: Axis::linear("Contact force at first damage", "N"),
        y: Axis::linear("Share of the cases", ""),
        series: vec![Series { label: "cases".into(), points: stairs, style: Style::Solid }],
        marks: marks.collect(),
        doubts: Vec::new(),
    };
    album.put("force_at_damage", line_plot(&plot)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_border_is_where_the_index_is_one() {
        let levels = [0.0, 1.0, 2.0];
        let pieces = border(&levels, &levels, &|i, _| Some(0.6 * i as f64));
        assert!(!pieces.is_empty() && pieces.iter().flatten().all(|p| (p[0] - 5.0 / 3.0).abs() < 1e-12), "{pieces:?}");
    }
}
