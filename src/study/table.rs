//! A study as a table for machines.

use super::converge::ErrorBar;
use super::record::RunRecord;
use super::report::{Report, Row};
use crate::error::Error;
use crate::forecast::PHASES;
use fem_core::counters::Counters;
use fem_io::files::OutputDir;
use fem_io::tables::{self, TableValue};
use serde_json::{Map, Value};

const SIZES: [&str; 20] = [
    "axis",
    "setting",
    "keys",
    "refused",
    "best_for_its_work",
    "cells",
    "layers",
    "cell_m",
    "unknowns",
    "unknowns_marched",
    "factor_entries",
    "step_s",
    "elements",
    "factorisations",
    "solves",
    "steps",
    "contact_calls",
    "criterion_calls",
    "nominal_s",
    "worst_error",
];

/// Writes study.csv, whole or not at all: a line per run with its keys, sizes and work; values and errors of all quantities,
/// how much larger these may be and whether they are known to a third; seconds and memory, which alone differ from study to study.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite.
pub(super) fn write(dir: &OutputDir, report: &Report) -> Result<(), Error> {
    let header = header(report);
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let keys: Vec<String> = report.rows.iter().map(keys).collect();
    Ok(tables::write_columns(dir, "study.csv", &header, lines(report, &keys))?)
}

/// The lines of study.csv by the names of its columns; what is empty there is left out.
pub(super) fn named(report: &Report) -> Vec<Map<String, Value>> {
    let header = header(report);
    let keys: Vec<String> = report.rows.iter().map(keys).collect();
    let named = |line: Vec<TableValue<'_>>| {
        let columns = header.iter().zip(line).filter(|(_, field)| !matches!(field, TableValue::Text("")));
        columns.map(|(name, field)| (name.clone(), field.into())).collect()
    };
    lines(report, &keys).map(named).collect()
}

fn figures(report: &Report) -> Vec<&str> {
    report.base().result.iter().flat_map(|record| &record.figures).map(|f| f.name.as_str()).collect()
}

fn header(report: &Report) -> Vec<String> {
    let mut header: Vec<String> = SIZES.map(str::to_owned).to_vec();
    header.extend(figures(report).into_iter().map(str::to_owned));
    for of in ["error", "of its axis"] {
        header.extend(report.asked.iter().map(|name| format!("{name} {of}")));
        for part in ["bar", "known"] {
            header.extend(report.asked.iter().map(|name| format!("{name} {of}: {part}")));
        }
    }
    header.extend(PHASES.map(|phase| format!("{phase}_cpu_s")));
    header.extend(["expected_cpu_s", "peak_memory_MB"].map(str::to_owned));
    header
}

fn lines<'a>(report: &'a Report, keys: &'a [String]) -> impl Iterator<Item = Vec<TableValue<'a>>> + Clone {
    let names = figures(report);
    report.rows.iter().zip(keys).map(move |(row, keys)| line(row, keys, &names, report.asked.len()))
}

fn keys(row: &Row) -> String {
    row.level.setting.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join("; ")
}

const NONE: TableValue<'_> = TableValue::Text("");

fn number(value: Option<f64>) -> TableValue<'static> {
    value.filter(|value| value.is_finite()).map_or(NONE, TableValue::Number)
}

fn line<'a>(row: &'a Row, keys: &'a str, names: &[&str], asked: usize) -> Vec<TableValue<'a>> {
    let (record, why) = match &row.result {
        Ok(record) => (Some(record), ""),
        Err(why) => (None, why.as_str()),
    };
    let count = |of: fn(&RunRecord) -> u64| record.map_or(NONE, |r| TableValue::Count(of(r)));
    let mut line = vec![
        TableValue::Text(&row.axis),
        TableValue::Text(&row.level.label),
        TableValue::Text(keys),
        TableValue::Text(why),
        TableValue::Text(if row.front { "yes" } else { "" }),
        count(|r| r.size.cells as u64),
        count(|r| r.size.layers as u64),
        number(record.map(|r| r.size.cell_m)),
        count(|r| r.size.unknowns as u64),
        count(|r| r.size.marched as u64),
        count(|r| r.size.factor_entries as u64),
        number(record.map(|r| r.size.step_s)),
    ];
    let work: [fn(&Counters) -> u64; 6] =
        [|w| w.elements, |w| w.factorisations, |w| w.solves, |w| w.steps, |w| w.contact_calls, |w| w.criterion_calls];
    line.extend(work.map(|of| record.map_or(NONE, |r| TableValue::Count(of(&r.size.work)))));
    line.push(number(Some(row.work())));
    line.push(number(row.worst().map(|worst| worst.error)));
    line.extend(names.iter().map(|name| number(record.and_then(|r| r.value(name)))));
    for errors in [&row.errors, &row.own] {
        let each = || (0..asked).map(|q| errors.get(q).copied().flatten());
        line.extend(each().map(|error| number(error.map(|e| e.error))));
        line.extend(each().map(|error| number(error.map(|e| e.bar))));
        let known =
            |error: Option<ErrorBar>| error.map_or(NONE, |e| TableValue::Text(if e.is_known() { "yes" } else { "no" }));
        line.extend(each().map(known));
    }
    line.extend((0..PHASES.len()).map(|k| number(record.map(|r| r.seconds[k]))));
    line.push(number(Some(row.expected_s)));
    line.push(number(record.and_then(|r| r.memory).map(|bytes| bytes as f64 / 1e6)));
    line
}
