//! Tables and pictures of an impact.

use super::summary::{event_row, threshold_reached};
use super::{indices, modal, pictures};
use crate::analyses::impact::Outcome;
use crate::error::Error;
use crate::model::Model;
use fem_io::files::OutputDir;
use fem_io::plot;
use fem_io::tables;

/// Writes the tables of a run; each file appears whole or not at all.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite.
pub fn write_tables(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    let names: Vec<_> = model.impactors().iter().map(|impactor| impactor.name.as_str()).collect();
    let columns: Vec<_> = model.effects.columns().map(|column| column.name).collect();
    tables::write_history(dir, &names, &columns, &outcome.history)?;
    let events: Vec<_> = outcome.events.iter().map(|event| event_row(model, event)).collect();
    tables::write_events(dir, &events)?;
    modal::write_table(dir, outcome)?;
    indices::write_tables(dir, model, outcome)
}

/// Draws the contact forces over time with the first event of each mode, the indices at the gauges, and [`pictures`].
///
/// # Errors
/// As [`write_tables`], and numbers that no plot can show.
pub fn write_plots(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    let times: Vec<f64> = outcome.history.iter().map(|r| r.time_s).collect();
    let force = |i: usize| outcome.history.iter().map(|r| r.impactors[i].contact_force_n).collect::<Vec<_>>();
    let named = |impactor| model.label(impactor).unwrap_or("Contact force");
    let forces: Vec<_> = model.impactors().iter().enumerate().map(|(i, spec)| (named(spec), force(i))).collect();
    let mut marks: Vec<(f64, String)> = Vec::new();
    for e in &outcome.events {
        let label = e.mode.to_owned();
        if !marks.iter().any(|m| m.1 == label) {
            marks.push((e.time, label));
        }
    }
    marks.extend(threshold_reached(model, outcome).map(|(t, name)| {
        let by = name.map_or(String::new(), |name| format!(" by {name}"));
        (t, format!("delamination threshold{by}"))
    }));
    let picture = plot::line_plot(&plot::force_history(&model.origin.title, &times, &forces, &marks)?)?;
    picture.write(dir, "contact_force")?;
    modal::write_plot(dir, model, outcome)?;
    indices::write_plots(dir, model, outcome)?;
    pictures::write(dir, model, outcome)
}
