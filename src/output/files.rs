//! Tables and pictures of an impact.

use super::pictures::Drawn;
use super::summary::{event_row, threshold_reached};
use super::{delamination, indices, modal, pictures};
use crate::analyses::impact::Outcome;
use crate::error::Error;
use crate::model::Model;
use fem_io::files::OutputDir;
use fem_io::tables::{self, EventRow};

/// Writes the tables of a run; each file appears whole or not at all.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite.
pub fn write_tables(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    let (impactors, effects) = columns(model);
    tables::write_history(dir, &impactors, &effects, &outcome.history)?;
    tables::write_events(dir, &events(model, outcome))?;
    modal::write_table(dir, outcome)?;
    delamination::write_table(dir, model, outcome.delaminated.as_ref())?;
    indices::write_tables(dir, model, outcome)
}

/// Impactors and columns of effects, by which [`tables::history_columns`] names the values of a row.
fn columns(model: &Model) -> (Vec<&str>, Vec<&str>) {
    let impactors = model.impactors().iter().map(|impactor| impactor.name.as_str()).collect();
    (impactors, model.effects.columns().map(|column| column.name).collect())
}

/// Names of the values of each row of [`Outcome::history`].
pub fn history_columns(model: &Model) -> Vec<String> {
    let (impactors, effects) = columns(model);
    tables::history_columns(&impactors, &effects)
}

/// The rows of `events.csv`.
pub fn events(model: &Model, outcome: &Outcome) -> Vec<EventRow> {
    outcome.events.iter().map(|event| event_row(model, event)).collect()
}

/// Draws [`pictures`]: curves over time, the contact forces with the first event of each mode; the indices at the gauges; damage.
///
/// # Errors
/// As [`write_tables`], and numbers that no plot can show.
pub fn write_plots(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    let mut marks = pictures::first_of_modes(&outcome.events);
    let several = model.threshold.is_some_and(|threshold| threshold.interfaces > 1);
    for (which, of) in [(0, " of all"), (1, " of one")] {
        if !several && which > 0 {
            continue;
        }
        marks.extend(threshold_reached(model, outcome, which).map(|(t, name)| {
            let by = name.map_or(String::new(), |name| format!(" by {name}"));
            (t, format!("delamination threshold{}{by}", if several { of } else { "" }))
        }));
    }
    let drawn = Drawn {
        title: &model.origin.title,
        names: model.impactors().iter().map(|impactor| model.label(impactor).unwrap_or("")).collect(),
        columns: model.effects.columns().collect(),
        rows: &outcome.history,
        marks,
    };
    pictures::write_curves(dir, &drawn)?;
    modal::write_plot(dir, model, outcome)?;
    delamination::write_plot(dir, model, outcome.delaminated.as_ref())?;
    indices::write_plots(dir, model, outcome)?;
    pictures::write_damage(dir, model, outcome)
}
