//! An impact: prepare, march, sum up, write.

use super::folder::{begin_run, keep_scene, saved};
use super::{Follow, Found, ImpactFound, Options, Part, Results};
use crate::analyses::impact::{self, Checkpoint, March};
use crate::error::Error;
use crate::forecast::{one_level_better, seconds_per_phase};
use crate::model::Model;
use crate::output::fields::MarchFields;
use crate::output::summary::ImpactSummary;
use crate::output::{write_plots, write_tables};
use fem_io::files::OutputDir;
use fem_io::tables::write_json;
use std::path::PathBuf;
use std::time::{Duration, Instant};

pub(super) fn run(model: &Model, options: &Options, follow: &mut dyn Follow) -> Result<Part, Error> {
    let checkpoint = match &options.results {
        Results::Resumed(folder) => saved(folder, Checkpoint::read(folder, model))?,
        _ => None,
    };
    let prepared = impact::prepare(model, options.threads).inspect_err(|_| follow.failed(&model.warnings))?;
    let sizes = prepared.sizes;
    let goes_on = checkpoint.is_some();
    let mut march = match checkpoint {
        None => March::start(prepared)?,
        Some(checkpoint) => March::resume(prepared, checkpoint)?,
    };
    // After all that can be refused, so that a refusal leaves no folder; before the march, so that none is in vain.
    let source = &model.origin.source;
    let begin = |folder: &PathBuf| begin_run(folder, source, goes_on.then_some(impact::CHECKPOINT));
    let dir = options.folder().map(begin).transpose()?;
    advance(model, &mut march, dir.as_ref(), follow)?;
    let outcome = march.finish();
    let summary = ImpactSummary::new(model, &sizes, &outcome);
    let mut cost = options.cost(&outcome.phases);
    let size = outcome.size(model, &sizes);
    cost.one_level_better = one_level_better(&size, seconds_per_phase(&outcome.phases));
    if let Some(dir) = &dir {
        keep_scene(dir, source)?;
        write_tables(dir, model, &outcome)?;
        write_json(dir, "summary.json", &summary)?;
        write_json(dir, "cost.json", &cost)?;
    }
    let found = Found::Impact(Box::new(ImpactFound { sizes, outcome, summary }));
    follow.found(&found, &cost);
    if let (Some(dir), Found::Impact(own)) = (&dir, &found) {
        if model.output.plots {
            write_plots(dir, model, &own.outcome)?;
        }
        dir.remove_older()?;
    }
    Ok((found, cost, dir.map(|dir| dir.path().to_owned())))
}

/// The files of a march.
struct Files<'a> {
    dir: &'a OutputDir,
    fields: MarchFields<'a>,
}

impl Files<'_> {
    fn save(&mut self, march: &mut March<'_>) -> Result<(), Error> {
        self.fields.flush(march)?;
        march.save(self.dir)
    }
}

/// Marches to the end. A checkpoint is written there, and before whenever the interval of the scene has passed since the last
/// one.
///
/// # Errors
/// [`Error::Cancelled`] where `follow` broke the march off, after a checkpoint.
pub(super) fn advance(
    model: &Model,
    march: &mut March<'_>,
    dir: Option<&OutputDir>,
    follow: &mut dyn Follow,
) -> Result<(), Error> {
    // An interval beyond what a clock counts is never over.
    let interval = Duration::try_from_secs_f64(model.output.checkpoint_every).unwrap_or(Duration::MAX);
    let mut files = dir.map(|dir| Files { dir, fields: MarchFields::new(model, dir) });
    let mut saved = Instant::now();
    let mut goes_on = follow.marched(march.share()).is_continue();
    if let Some(files) = &mut files {
        files.fields.take(march)?;
    }
    while !march.done() && goes_on {
        march.advance();
        if let Some(files) = &mut files {
            files.fields.take(march)?;
            if saved.elapsed() >= interval {
                files.save(march)?;
                saved = Instant::now();
            }
        }
        goes_on = follow.marched(march.share()).is_continue();
    }
    if let Some(files) = &mut files {
        files.save(march)?;
    }
    if march.done() { Ok(()) } else { Err(Error::Cancelled { time: march.time(), share: march.share() }) }
}
