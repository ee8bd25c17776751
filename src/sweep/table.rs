//! A sweep as tables.

use super::page::{self, CasesPage};
use super::quantity::{CaseQuantity, OF_GROWTH, OF_IMPACTOR};
use super::runner::CaseRow;
use super::scatter::{Scatter, scatter};
use super::sensitivity::{Importance, importance};
use super::{Sweep, SweepRequest};
use crate::error::Error;
use fem_io::files::{FileError, OutputDir};
use fem_io::results::FORMAT;
use fem_io::scene::{Sampling, Scene, unit};
use fem_io::tables::{self, TableValue};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Of what a folder of results of a sweep is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// [`fem_io::results::FORMAT`].
    pub format: u32,
    /// Title of the scene.
    pub title: String,
    /// The file of the scene.
    pub scene: String,
    /// What was asked on the command line.
    pub asked: SweepRequest,
    /// How cases were chosen.
    pub design: String,
    /// What is varied.
    pub keys: Vec<String>,
    /// How many cases there are.
    pub cases: usize,
    /// How many of them have a row.
    pub done: usize,
    /// How many of these failed.
    pub failed: usize,
    /// What they say together.
    #[serde(skip_deserializing, skip_serializing_if = "Option::is_none")]
    pub scatter: Option<Scatter>,
    /// What was asked of each case.
    #[serde(skip_deserializing, skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<QuantityRange>,
    /// Cases that no other one beats in two quantities.
    #[serde(skip_deserializing, skip_serializing_if = "Option::is_none")]
    pub pareto_front: Option<Vec<usize>>,
    /// What matters, of a design that is made for it.
    #[serde(skip_deserializing, skip_serializing_if = "Vec::is_empty")]
    pub importance: Vec<Importance>,
}

impl Record {
    /// Of what `rows` of the cases of `scene`, the file `path`, say.
    pub fn new(scene: &Scene, path: &Path, asked: SweepRequest, sweep: &Sweep<'_>, rows: &[CaseRow]) -> Self {
        let design = &sweep.design;
        // Shares of blocks that are made for indices are no probabilities.
        let random = !matches!(design.sampling, Sampling::Grid | Sampling::Saltelli);
        let failed = rows.iter().filter(|row| row.result.is_err()).count();
        Self {
            format: FORMAT,
            title: scene.title.clone(),
            scene: std::path::absolute(path).unwrap_or_else(|_| path.to_owned()).display().to_string(),
            asked,
            design: design.sampling.name().to_owned(),
            keys: design.axes.iter().map(|axis| axis.key.clone()).collect(),
            cases: design.count,
            done: rows.len(),
            failed,
            quantities: QuantityRange::all(sweep, rows),
            pareto_front: sweep.objectives.as_ref().map(|_| {
                let on = marked(sweep, rows).filter(|(_, on)| *on == Some(true));
                on.map(|(row, _)| row.case).collect()
            }),
            importance: match design.sampling {
                Sampling::Saltelli => importance(sweep, rows),
                _ => Vec::new(),
            },
            scatter: (random && rows.len() > failed).then(|| scatter(rows)),
        }
    }
}

/// Between what values a quantity lies.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct QuantityRange {
    pub name: String,
    /// In SI units.
    pub unit: String,
    /// Cases that have it.
    pub cases: usize,
    pub least: f64,
    pub most: f64,
    /// Its number among those of the sweep.
    #[serde(skip)]
    pub number: usize,
}

impl QuantityRange {
    /// Of all that some case has.
    fn all(sweep: &Sweep<'_>, rows: &[CaseRow]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for (number, of) in sweep.quantities.iter().enumerate() {
            let found = rows.iter().filter_map(|row| Some((row.case - 1, row.result.as_ref().ok()?)));
            let values = found.filter_map(|(case, found)| of.value(&sweep.design.case(case), found));
            let range = values.fold((f64::INFINITY, f64::NEG_INFINITY, 0), |(a, b, n), v| (a.min(v), b.max(v), n + 1));
            let (least, most, cases) = range;
            if cases > 0 {
                all.push(Self { name: of.name.clone(), unit: of.unit(), cases, least, most, number });
            }
        }
        all
    }
}

const FILE: &str = "sweep.json";
const NONE: TableValue<'_> = TableValue::Text("");

/// Writes sweep.csv, a line a case with what it sets and finds or why it failed; cost.csv, its processor time, which alone differs
/// from sweep to sweep; and sweep.json.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite.
pub fn write(dir: &OutputDir, sweep: &Sweep<'_>, rows: &[CaseRow], record: &Record) -> Result<(), Error> {
    let header = header(sweep, rows);
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let values: Vec<Vec<String>> = rows.iter().map(|row| sweep.design.case(row.case - 1)).collect();
    let lines = marked(sweep, rows).zip(&values).map(|(row, values)| line(row, values, &header, sweep));
    tables::write_columns(dir, "sweep.csv", &header, lines)?;
    let costs = rows.iter().map(|row| vec![TableValue::Count(row.case as u64), TableValue::Number(row.seconds)]);
    tables::write_columns(dir, "cost.csv", &["case", "cpu_s"], costs)?;
    Ok(tables::write_json(dir, FILE, record)?)
}

/// Writes report.html, a page of all cases with these `pictures`, unless there are too many.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_page(
    dir: &OutputDir,
    title: &str,
    sweep: &Sweep<'_>,
    rows: &[CaseRow],
    pictures: Vec<String>,
) -> Result<(), Error> {
    let columns = header(sweep, rows);
    let names: Vec<&str> = columns.iter().map(String::as_str).collect();
    let shown = &rows[..rows.len().min(page::MOST + 1)];
    let values: Vec<Vec<String>> = shown.iter().map(|row| sweep.design.case(row.case - 1)).collect();
    let page = CasesPage {
        title,
        columns: &columns,
        rows: marked(sweep, shown).zip(&values).map(|(row, values)| line(row, values, &names, sweep)).collect(),
        histories: shown.iter().map(|row| row.result.as_ref().map_or(&[][..], |of| of.history.as_slice())).collect(),
        varied: sweep.design.axes.len(),
        pictures,
    };
    page.write(dir)
}

/// What `folder` holds.
///
/// # Errors
/// No results of a sweep.
pub fn read_record(folder: &Path) -> Result<Record, Error> {
    let path = folder.join(FILE);
    let none = |why: String| Error::Sweep {
        message: format!("`{}` holds no results of `fem sweep`: {why}", folder.display()),
        help: "name the folder that `fem sweep` printed after `results`".into(),
    };
    let text = std::fs::read_to_string(&path).map_err(|why| none(format!("{FILE}: {why}")))?;
    serde_json::from_str(&text).map_err(|cause| FileError::Json { file: path.display().to_string(), cause }.into())
}

/// Columns of the first damage.
const OF_DAMAGE: [&str; 5] = ["damage_time_s", "damage_criterion", "damage_mode", "damage_ply", "damage_force_N"];

const OVER_THRESHOLD: &str = "force_over_delamination_threshold";

/// Each row with whether it is on the front, where it has a place there.
fn marked<'a>(sweep: &Sweep<'_>, rows: &'a [CaseRow]) -> impl Iterator<Item = (&'a CaseRow, Option<bool>)> + Clone {
    rows.iter().zip(sweep.front(rows)).map(|(row, of)| (row, of.map(|(_, on)| on)))
}

fn header(sweep: &Sweep<'_>, rows: &[CaseRow]) -> Vec<String> {
    let mut header = vec!["case".to_owned()];
    header.extend(sweep.design.axes.iter().map(|axis| match axis.variation.unit() {
        Some(unit) => format!("{} [{unit}]", axis.key),
        None => axis.key.clone(),
    }));
    header.push("failed".to_owned());
    if let Some(one) = rows.iter().find_map(|row| row.result.as_ref().ok()) {
        for impactor in &one.impactors {
            let name = impactor.name.as_ref().map_or(String::new(), |name| format!("{name} "));
            header.extend(OF_IMPACTOR.map(|(column, unit, ..)| format!("{name}{column}_{unit}")));
        }
        header.extend(OF_DAMAGE.map(str::to_owned));
        for mode in &one.modes {
            let name = &mode.name;
            header.extend([format!("{name} index"), format!("{name} time_s"), format!("{name} force_N")]);
        }
        let found = || rows.iter().filter_map(|row| row.result.as_ref().ok());
        header.extend(found().any(|of| of.over_threshold.is_some()).then(|| OVER_THRESHOLD.to_owned()));
        if found().any(|of| of.grown.is_some()) {
            header.extend(OF_GROWTH.map(|(column, unit, ..)| format!("{column}_{unit}")));
        }
        header.extend(["energy_error", "warnings"].map(str::to_owned));
        header.extend(sweep.quantities.iter().map(CaseQuantity::column));
        header.extend(sweep.objectives.as_ref().map(|_| "on_pareto_front".to_owned()));
    }
    header
}

fn line<'a>(
    (row, on_front): (&'a CaseRow, Option<bool>),
    values: &'a [String],
    header: &[&str],
    sweep: &Sweep<'_>,
) -> Vec<TableValue<'a>> {
    let mut line = vec![TableValue::Count(row.case as u64)];
    line.extend(values.iter().zip(&sweep.design.axes).map(|(value, axis)| {
        let number = match axis.variation.unit() {
            Some(of) => value.strip_suffix(of).filter(|_| unit(value) == Some(of)).map(str::trim),
            None => Some(value.as_str()),
        };
        number.and_then(|number| number.parse().ok()).map_or(TableValue::Text(value), TableValue::Number)
    }));
    let number = |value: Option<f64>| value.filter(|value| value.is_finite()).map_or(NONE, TableValue::Number);
    let figures = match &row.result {
        Err(why) => {
            line.push(TableValue::Text(why));
            line.resize_with(header.len(), || NONE);
            return line;
        }
        Ok(figures) => figures,
    };
    line.push(NONE);
    for of in &figures.impactors {
        line.extend(OF_IMPACTOR.map(|(.., at)| number(Some(at(of)))));
    }
    match &figures.first {
        None => line.extend([(); OF_DAMAGE.len()].map(|()| NONE)),
        Some(first) => {
            line.push(number(Some(first.time)));
            line.extend([&first.criterion, &first.mode, &first.ply].map(|text| TableValue::Text(text)));
            line.push(number(Some(first.force)));
        }
    }
    for mode in &figures.modes {
        line.extend([Some(mode.index), mode.onset.map(|onset| onset.0), mode.onset.map(|onset| onset.1)].map(number));
    }
    // What some case has is a column of all.
    let has = |column: &str| header.contains(&column);
    line.extend(has(OVER_THRESHOLD).then(|| number(figures.over_threshold)));
    for (column, unit, _, at) in OF_GROWTH {
        line.extend(has(&format!("{column}_{unit}")).then(|| number(figures.grown.as_ref().map(at))));
    }
    line.extend([number(Some(figures.energy_error)), TableValue::Count(figures.warnings)]);
    line.extend(sweep.quantities.iter().map(|quantity| number(quantity.value(values, figures))));
    line.extend(sweep.objectives.as_ref().map(|_| on_front.map_or(NONE, |on| TableValue::Count(on.into()))));
    line
}
