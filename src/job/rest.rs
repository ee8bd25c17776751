//! Loads at rest, natural modes and buckling: solve, sum up, write.

use super::folder::{begin_run, keep_scene};
use super::{BucklingFound, Follow, Found, ModesFound, Options, Part, StaticFound};
use crate::analyses::{buckling, modes, statics};
use crate::cost::Phase;
use crate::error::Error;
use crate::model::Model;
use crate::output::{self, fields};
use fem_io::files::OutputDir;
use fem_io::tables::write_json;

pub(super) fn statics(model: &Model, options: &Options, follow: &mut dyn Follow) -> Result<Part, Error> {
    let solution = statics::solve_watched(model, options.threads, &mut |share| follow.marched(share))
        .inspect_err(|_| follow.failed(&model.warnings))?;
    let (summary, phases) = (output::statics::StaticSummary::new(model, &solution), solution.phases.clone());
    hand_over(model, Found::Static(Box::new(StaticFound { solution, summary })), &phases, options, follow)
}

pub(super) fn modes(model: &Model, count: usize, options: &Options, follow: &mut dyn Follow) -> Result<Part, Error> {
    let solution = modes::solve(model, count, options.threads).inspect_err(|_| follow.failed(&model.warnings))?;
    let (summary, phases) = (output::modes::ModesSummary::new(model, &solution), solution.phases.clone());
    hand_over(model, Found::Modes(Box::new(ModesFound { solution, summary })), &phases, options, follow)
}

pub(super) fn buckling(model: &Model, count: usize, options: &Options, follow: &mut dyn Follow) -> Result<Part, Error> {
    let solution = buckling::solve(model, count, options.threads).inspect_err(|_| follow.failed(&model.warnings))?;
    let (summary, phases) = (output::buckling::BucklingSummary::new(model, &solution), solution.phases.clone());
    hand_over(model, Found::Buckling(Box::new(BucklingFound { solution, summary })), &phases, options, follow)
}

fn hand_over(
    model: &Model,
    found: Found,
    phases: &[Phase],
    options: &Options,
    follow: &mut dyn Follow,
) -> Result<Part, Error> {
    let mut cost = options.cost(phases);
    follow.found(&found, &cost);
    let Some(folder) = options.folder() else { return Ok((found, cost, None)) };
    let dir = begin_run(folder, &model.origin.source, None)?;
    keep_scene(&dir, &model.origin.source)?;
    cost.phases.extend(write(&dir, model, &found)?);
    write_json(&dir, "cost.json", &cost)?;
    dir.remove_older()?;
    Ok((found, cost, Some(dir.path().to_owned())))
}

/// Writes what was found; the time that fields take.
fn write(dir: &OutputDir, model: &Model, found: &Found) -> Result<Option<Phase>, Error> {
    match found {
        Found::Static(own) => {
            output::statics::write(dir, model, &own.solution, &own.summary)?;
            fields::write_static(dir, model, &own.solution)
        }
        Found::Modes(own) => {
            output::modes::write(dir, model, &own.solution, &own.summary)?;
            fields::write_modes(dir, model, &own.solution)
        }
        Found::Buckling(own) => {
            output::buckling::write(dir, model, &own.solution, &own.summary)?;
            fields::write_buckling(dir, model, &own.solution)
        }
        // A march writes as it goes on.
        Found::Impact(_) => Ok(None),
    }
}
