//! What the lowest modes of an impact do, as a table and a picture.

use crate::analyses::impact::{ModeShare, Outcome};
use crate::error::Error;
use crate::model::Model;
use fem_core::plugin::Dimension;
use fem_io::files::OutputDir;
use fem_io::plot;
use fem_io::tables::{self, TableValue};

/// Writes `modal_coordinates.csv` where the scene follows modes.
///
/// # Errors
/// As [`OutputDir::write`].
pub(crate) fn write_table(dir: &OutputDir, outcome: &Outcome) -> Result<(), Error> {
    let Some(modal) = &outcome.modal else { return Ok(()) };
    let n = modal.modes.len();
    let names: Vec<String> = (1..=n).map(|i| format!("C_{i}_m")).collect();
    let header: Vec<&str> = ["time_s"].into_iter().chain(names.iter().map(String::as_str)).collect();
    let rows = outcome.history.iter().zip(modal.coordinates.chunks_exact(n));
    let row = |(h, c): (&tables::HistoryRow, &[f64])| {
        [h.time_s].into_iter().chain(c.iter().copied()).map(TableValue::Number).collect()
    };
    Ok(tables::write_columns(dir, "modal_coordinates.csv", &header, rows.map(row))?)
}

/// Draws the deflection under the impactor, the part of each mode in it, and what is left to the others.
///
/// # Errors
/// As [`OutputDir::write`], and numbers that no plot can show.
pub(crate) fn write_plot(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    let Some(modal) = &outcome.modal else { return Ok(()) };
    let n = modal.modes.len();
    let over_time = |value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
        outcome.history.iter().enumerate().map(|(i, row)| (row.time_s, value(i))).collect()
    };
    let sum = over_time(&|i| outcome.history[i].impactors[0].plate_displacement_m);
    let part = |(k, mode): (usize, &ModeShare)| {
        let label = format!("mode {}, {}", k + 1, Dimension::FREQUENCY.of(mode.frequency_Hz));
        (label, over_time(&|i| modal.coordinates[i * n + k]))
    };
    let above = |i: usize| sum[i].1 - modal.coordinates[i * n..(i + 1) * n].iter().sum::<f64>();
    let mut parts: Vec<_> = modal.modes.iter().enumerate().map(part).collect();
    parts.push(("the other modes".to_owned(), over_time(&above)));
    let picture = plot::line_plot(&plot::modal_history(&model.origin.title, sum, parts))?;
    Ok(picture.write(dir, "modal_coordinates")?)
}
