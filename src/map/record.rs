//! A map as tables.

use super::lines::{pieces, zeros};
use super::{BorderMap, MapFound};
use crate::error::Error;
use crate::sweep::CasesPage;
use fem_io::files::OutputDir;
use fem_io::results::FORMAT;
use fem_io::tables::{self, TableValue};
use serde::Serialize;

/// What the first damage of all is called.
const FIRST: &str = "first damage";

/// What a map says.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct MapRecord {
    /// [`fem_io::results::FORMAT`].
    pub format: u32,
    pub title: String,
    /// Keys that it is over, with their units.
    pub axes: Vec<String>,
    /// The key that has a list.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub list: Option<String>,
    pub tolerance: f64,
    /// Impacts that were computed, and how many of them failed.
    pub impacts: usize,
    pub failed: usize,
    /// Whether all lines are known to the tolerance.
    pub reached: bool,
    pub lines: Vec<MapLine>,
}

/// A line of a map: where an index, or the force over its threshold, is 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct MapLine {
    pub name: String,
    /// The value of the list that it is for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<String>,
    /// How far it may lie off: relative on axes that count in ratios, else as a share of the axis. None where too few impacts are
    /// known to say.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Its points by the axes, sorted.
    pub points: Vec<Vec<f64>>,
}

impl MapRecord {
    /// Of what `map` found.
    pub fn new(map: &BorderMap<'_>, found: &MapFound) -> Self {
        let mut lines = Vec::new();
        for strip in 0..found.strips.len() {
            lines.extend(lines_of(map, found, strip));
        }
        let axes = map.axes.iter().map(super::MapAxis::column).collect();
        let known = |line: &MapLine| line.error.is_some_and(|error| error <= map.asked.tolerance);
        let strips = map.list.as_ref().map_or(1, |(_, values)| values.len());
        Self {
            format: FORMAT,
            title: map.scene.title.clone(),
            axes,
            list: map.list.as_ref().map(|(key, _)| key.clone()),
            tolerance: map.asked.tolerance,
            impacts: found.points.len(),
            failed: found.points.iter().filter(|point| point.result.is_err()).count(),
            reached: found.strips.len() == strips
                && found.strips.iter().all(|strip| !strip.levels.is_empty())
                && lines.iter().all(known),
            lines,
        }
    }
}

/// The lines for value number `strip` of the list that are somewhere on the map, that of the first damage first.
fn lines_of(map: &BorderMap<'_>, found: &MapFound, strip: usize) -> Vec<MapLine> {
    let (of, dimensions) = (&found.strips[strip], map.axes.len());
    let failures = found.failures();
    let values = |p: [f64; 2]| map.axes.iter().zip(p).map(|(axis, share)| axis.value(share)).collect::<Vec<f64>>();
    let line = |name: &str, points: &[[f64; 2]], error: f64| {
        let mut points: Vec<Vec<f64>> = points.iter().map(|p| values(*p)).collect();
        points.sort_by(|a, b| {
            a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(a.len().cmp(&b.len()))
        });
        let value = map.list.as_ref().map(|(_, values)| values[strip].clone());
        MapLine { name: name.to_owned(), value, error: Some(error).filter(|error| error.is_finite()), points }
    };
    if of.levels.is_empty() {
        return Vec::new();
    }
    let mut lines = Vec::new();
    if failures > 0 {
        let points = zeros(&|p| found.damage(strip, p), dimensions);
        // There, the mode that is 1 says how well it is known.
        let governs =
            |p: [f64; 2]| (0..failures).max_by(|a, b| of.levels[*a].value(p).total_cmp(&of.levels[*b].value(p)));
        let error = points.iter().filter_map(|p| Some(of.error(governs(*p)?, *p))).reduce(f64::max);
        lines.extend(error.map(|error| line(FIRST, &points, error)));
    }
    for (name, (level, error)) in found.names.iter().zip(of.levels.iter().zip(&of.errors)) {
        let points = zeros(&|p| level.value(p), dimensions);
        lines.extend(error.filter(|_| !points.is_empty()).map(|error| line(name, &points, error)));
    }
    lines
}

/// Pieces of the line of level number `line`, or with `None` of the first damage, in values of the axes.
pub(super) fn strokes(map: &BorderMap<'_>, found: &MapFound, line: Option<usize>) -> Vec<Vec<[f64; 2]>> {
    let level = |p: [f64; 2]| line.map_or_else(|| found.damage(0, p), |line| found.strips[0].levels[line].value(p));
    let values = |p: [f64; 2]| [map.axes[0].value(p[0]), map.axes[1].value(p[1])];
    pieces(&level).into_iter().map(|piece| piece.into_iter().map(values).collect()).collect()
}

/// Writes map.json, border.csv, the points of all lines, and impacts.csv, a line for each impact that was computed.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_map(dir: &OutputDir, map: &BorderMap<'_>, found: &MapFound, record: &MapRecord) -> Result<(), Error> {
    let mut header = vec!["line".to_owned()];
    header.extend(map.list.iter().map(|(key, _)| key.clone()));
    header.extend(record.axes.iter().cloned().chain(["error".to_owned()]));
    let names: Vec<&str> = header.iter().map(String::as_str).collect();
    let lines = record.lines.iter().flat_map(|line| {
        line.points.iter().map(move |point| {
            let start = [TableValue::Text(&line.name)].into_iter().chain(line.value.as_deref().map(TableValue::Text));
            let rest = point.iter().copied().chain([line.error.unwrap_or(f64::NAN)]);
            start.chain(rest.map(number)).collect()
        })
    });
    tables::write_columns(dir, "border.csv", &names, lines)?;

    let (header, lines) = impacts(map, found, record);
    let names: Vec<&str> = header.iter().map(String::as_str).collect();
    tables::write_columns(dir, "impacts.csv", &names, lines.into_iter())?;
    Ok(tables::write_json(dir, "map.json", record)?)
}

/// The impacts as a table: its header, its lines.
fn impacts<'a>(
    map: &'a BorderMap<'_>,
    found: &'a MapFound,
    record: &MapRecord,
) -> (Vec<String>, Vec<Vec<TableValue<'a>>>) {
    let mut header = vec!["impact".to_owned()];
    header.extend(record.axes.iter().cloned());
    header.extend(map.list.iter().map(|(key, _)| key.clone()));
    header.extend(["failed", "energy_J", "peak_force_N", "damage_time_s", "damage_force_N"].map(str::to_owned));
    header.extend(found.names.iter().map(|name| format!("{name} index")));
    let lines = found.points.iter().enumerate().map(|(k, point)| {
        let mut line = vec![TableValue::Count(k as u64 + 1)];
        line.extend(point.values.iter().map(|value| number(*value)));
        line.extend(map.list.as_ref().map(|(_, values)| TableValue::Text(&values[point.strip])));
        match &point.result {
            Err(why) => line.push(TableValue::Text(why)),
            Ok(of) => {
                let (first, striker) = (of.first.as_ref(), of.impactors.first());
                line.push(TableValue::Text(""));
                let figures = [
                    striker.map(|of| of.energy),
                    striker.map(|of| of.peak_force),
                    first.map(|first| first.time),
                    first.map(|first| first.force),
                ];
                line.extend(figures.map(|value| number(value.unwrap_or(f64::NAN))));
                line.extend(of.modes.iter().map(|mode| number(mode.index)).chain(of.over_threshold.map(number)));
            }
        }
        line.resize_with(header.len(), || TableValue::Text(""));
        line
    });
    let lines = lines.collect();
    (header, lines)
}

/// A number, or nothing where there is none.
fn number<'a>(value: f64) -> TableValue<'a> {
    if value.is_finite() { TableValue::Number(value) } else { TableValue::Text("") }
}

/// Writes report.html, a page of all impacts with this `picture`.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_map_page(
    dir: &OutputDir,
    map: &BorderMap<'_>,
    found: &MapFound,
    record: &MapRecord,
    picture: Option<String>,
) -> Result<(), Error> {
    let (columns, rows) = impacts(map, found, record);
    let page = CasesPage {
        title: &record.title,
        columns: &columns,
        rows,
        histories: found.points.iter().map(|p| p.result.as_ref().map_or(&[][..], |of| of.history.as_slice())).collect(),
        varied: map.axes.len(),
        pictures: picture.into_iter().collect(),
    };
    page.write(dir)
}
