//! Pictures of an impact: what moves, where the energy is, what failed.

mod histories;
mod maps;

pub use maps::{plan, section};

use crate::analyses::impact::Outcome;
use crate::error::Error;
use crate::model::Model;
use crate::output::damage::DamageMap;
use fem_io::files::OutputDir;
use fem_io::plot;

/// Writes `displacement`, `energy`, `force_displacement`, `damage_map` and `damage_section`, each as SVG and PNG, and
/// `damage.json`. A picture that would have nothing to show is left out.
///
/// # Errors
/// As [`OutputDir::write`], and numbers that no plot can show.
pub fn write(dir: &OutputDir, model: &Model, outcome: &Outcome) -> Result<(), Error> {
    let (title, rows) = (&model.origin.title, &outcome.history);
    let names: Vec<_> = model.impactors().iter().map(|impactor| model.label(impactor).unwrap_or("")).collect();
    let columns: Vec<_> = model.effects.columns().collect();
    let lines = [
        ("displacement", histories::displacement(title, &names, rows)),
        ("energy", histories::energy(title, &columns, rows)),
        ("force_displacement", histories::force_displacement(title, &names, rows)),
    ];
    for (name, picture) in lines {
        if let Some(picture) = picture {
            plot::line_plot(&picture)?.write(dir, name)?;
        }
    }
    let Some(damage) = DamageMap::new(model, outcome) else { return Ok(()) };
    damage.write(dir)?;
    plot::map_plot(&plan(title, &damage))?.write(dir, "damage_map")?;
    if let Some(section) = section(title, &damage) {
        plot::map_plot(&section)?.write(dir, "damage_section")?;
    }
    Ok(())
}
