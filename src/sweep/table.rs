//! A sweep as tables.

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
            importance: match design.sampling {
                Sampling::Saltelli => importance(design, rows),
                _ => Vec::new(),
            },
            scatter: (random && rows.len() > failed).then(|| scatter(rows)),
        }
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
    let lines = rows.iter().zip(&values).map(|(row, values)| line(row, values, &header, sweep));
    tables::write_columns(dir, "sweep.csv", &header, lines)?;
    let costs = rows.iter().map(|row| vec![TableValue::Count(row.case as u64), TableValue::Number(row.seconds)]);
    tables::write_columns(dir, "cost.csv", &["case", "cpu_s"], costs)?;
    Ok(tables::write_json(dir, FILE, record)?)
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

/// Columns of each impactor, of the first damage and of all others.
const OF_IMPACTOR: [&str; 7] = [
    "energy_J",
    "peak_force_N",
    "peak_force_time_s",
    "impulse_N_s",
    "deflection_m",
    "contact_time_s",
    "absorbed_energy_J",
];
const OF_DAMAGE: [&str; 5] = ["damage_time_s", "damage_criterion", "damage_mode", "damage_ply", "damage_force_N"];

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
            header.extend(OF_IMPACTOR.map(|column| format!("{name}{column}")));
        }
        header.extend(OF_DAMAGE.map(str::to_owned));
        for mode in &one.modes {
            let name = &mode.name;
            header.extend([format!("{name} index"), format!("{name} time_s"), format!("{name} force_N")]);
        }
        header.extend(["energy_error", "warnings"].map(str::to_owned));
    }
    header
}

fn line<'a>(row: &'a CaseRow, values: &'a [String], header: &[&str], sweep: &Sweep<'_>) -> Vec<TableValue<'a>> {
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
        let each = [of.energy, of.peak_force, of.peak_force_time, of.impulse, of.deflection, of.contact_time];
        line.extend(each.into_iter().chain([of.absorbed_energy]).map(|value| number(Some(value))));
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
    line.extend([number(Some(figures.energy_error)), TableValue::Count(figures.warnings)]);
    line
}
