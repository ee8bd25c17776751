//! A study as a document, and the files that hold it.

use super::converge::ErrorBar;
use super::ladder::{Ladder, Limit};
use super::report::Report;
use super::{picture, table, text};
use crate::error::Error;
use fem_io::files::OutputDir;
use fem_io::scene::Setting;
use serde::Serialize;
use serde_json::{Map, Value};
use std::path::Path;

/// Writes `study.csv`, `study.md` and the pictures.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite.
pub fn write_results(dir: &OutputDir, report: &Report) -> Result<(), Error> {
    table::write(dir, report)?;
    picture::write_pictures(dir, report)?;
    dir.write("study.md", |out| write!(out, "{}{}", text::text(report), text::tables(report)))?;
    Ok(())
}

/// What a study found, its runs as `study.csv` has them.
#[derive(Debug, Serialize)]
pub struct Document<'a> {
    title: &'a str,
    asked: &'a [String],
    tolerance: f64,
    runs: Vec<Map<String, Value>>,
    ladders: Vec<LadderPart<'a>>,
    notes: &'a [String],
    /// Keys of the cheapest setting that keeps the tolerance that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    kept_by: Option<&'a Setting>,
    results: &'a Path,
}

impl<'a> Document<'a> {
    /// Of a study whose files are in `results`, and what it names as the setting that keeps a tolerance.
    pub fn new(report: &'a Report, kept_by: Option<&'a Setting>, results: &'a Path) -> Self {
        Self {
            title: &report.title,
            asked: &report.asked,
            tolerance: report.tolerance,
            runs: table::named(report),
            ladders: report.ladders.iter().map(LadderPart::new).collect(),
            notes: &report.notes,
            kept_by,
            results,
        }
    }
}

/// What the finest level of a ladder leaves of each quantity.
#[derive(Debug, Serialize)]
struct LadderPart<'a> {
    axis: &'a str,
    levels: Vec<&'a str>,
    /// Why no finer level ran.
    end: &'a str,
    leaves: Vec<Leaves<'a>>,
}

/// What is left of a quantity; an error or a bar that nothing bounds is left out.
#[derive(Debug, Serialize)]
struct Leaves<'a> {
    quantity: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    order: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bar: Option<f64>,
    known: bool,
}

impl<'a> LadderPart<'a> {
    fn new(ladder: &'a Ladder) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        let leaves = |limit: &'a Limit| {
            let left = ErrorBar { error: limit.convergence.left(), bar: limit.convergence.bar() };
            let (error, bar) = (finite(left.error), finite(left.bar));
            Leaves { quantity: &limit.quantity, order: limit.convergence.order(), error, bar, known: left.is_known() }
        };
        let levels = ladder.levels.iter().map(|rung| rung.level.label.as_str()).collect();
        Self { axis: &ladder.axis, levels, end: &ladder.end, leaves: ladder.limits.iter().map(leaves).collect() }
    }
}
