//! Pictures of an impact: what moves, where the energy is, what failed.

mod histories;
mod maps;

pub use maps::{plan, section};

use crate::analyses::impact::Outcome;
use crate::effect::LedgerColumn;
use crate::error::Error;
use crate::model::Model;
use crate::output::damage::DamageMap;
use fem_failure::scan::FailureEvent;
use fem_io::files::OutputDir;
use fem_io::plot;
use fem_io::tables::HistoryRow;

/// What is drawn of a march.
#[derive(Debug)]
pub(crate) struct Drawn<'a> {
    pub(crate) title: &'a str,
    /// Names of the impactors; that of an only one is empty.
    pub(crate) names: Vec<&'a str>,
    /// Columns of effects.
    pub(crate) columns: Vec<&'a LedgerColumn>,
    pub(crate) rows: &'a [HistoryRow],
    /// Times, s, that the force is marked at, and why.
    pub(crate) marks: Vec<(f64, String)>,
}

/// Times of the first event of each mode.
pub(crate) fn first_of_modes(events: &[FailureEvent]) -> Vec<(f64, String)> {
    let mut marks: Vec<(f64, String)> = Vec::new();
    for e in events {
        if !marks.iter().any(|mark| mark.1 == e.mode) {
            marks.push((e.time, e.mode.to_owned()));
        }
    }
    marks
}

/// Draws `contact_force`, `displacement`, `energy` and `force_displacement`, each as SVG and PNG. A picture that would have
/// nothing to show is left out.
///
/// # Errors
/// As [`OutputDir::write`], and numbers that no plot can show.
pub(crate) fn write_curves(
    dir: &OutputDir,
    Drawn { title, names, columns, rows, marks }: &Drawn<'_>,
) -> Result<(), Error> {
    let times: Vec<f64> = rows.iter().map(|row| row.time_s).collect();
    let force = |i: usize| rows.iter().map(|row| row.impactors[i].contact_force_n).collect::<Vec<_>>();
    let called = |name: &'_ str| if name.is_empty() { "Contact force".to_owned() } else { name.to_owned() };
    let (of_forces, struck) = histories::shown(title, names, rows, 1);
    let labels: Vec<_> = struck.into_iter().map(|(i, name)| (i, called(name))).collect();
    let forces: Vec<_> = labels.iter().map(|(i, label)| (label.as_str(), force(*i))).collect();
    let lines = [
        ("contact_force", Some(plot::force_history(&of_forces, &times, &forces, marks)?)),
        ("displacement", histories::displacement(title, names, rows)),
        ("energy", histories::energy(title, columns, rows)),
        ("force_displacement", histories::force_displacement(title, names, rows)),
    ];
    for (name, picture) in lines {
        if let Some(picture) = picture {
            plot::line_plot(&picture)?.write(dir, name)?;
        }
    }
    Ok(())
}

/// Writes `damage_map` and `damage_section`, each as SVG and PNG, and `damage.json`, where anything was judged.
///
/// # Errors
/// As [`write_curves`].
pub(super) fn write_damage(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    let title = &model.origin.title;
    let Some(damage) = DamageMap::new(model, outcome) else { return Ok(()) };
    damage.write(dir)?;
    plot::map_plot(&plan(title, &damage))?.write(dir, "damage_map")?;
    if let Some(section) = section(title, &damage) {
        plot::map_plot(&section)?.write(dir, "damage_section")?;
    }
    Ok(())
}
