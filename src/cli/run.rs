//! `fem run`.

use super::signals::Signals;
use super::{Console, Format, warn};
use crate::advise;
use crate::analyses::impact::{self, Checkpoint, March, Outcome};
use crate::analyses::statics;
use crate::cost::{Cost, Phase, Provenance};
use crate::error::Error;
use crate::forecast::{one_level_better, seconds_per_phase};
use crate::model::{Model, Plan};
use crate::output;
use crate::output::fields::{self, MarchFields};
use crate::output::report;
use crate::output::summary::ImpactSummary;
use crate::registry::Registry;
use clap::Args;
use fem_io::files::{FileError, OutputDir};
use fem_io::{scene, tables};
use indicatif::ProgressBar;
use serde::Serialize;
use std::io::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

#[derive(Debug, Args)]
#[command(after_help = "Example: fem run coupon/scene.toml --threads 4")]
pub(super) struct Arguments {
    /// Scene file (TOML); its mesh is looked for beside it.
    scene: PathBuf,
    /// Folder of the results [default: results/<folder of the scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Continue from the checkpoint in the folder of the results: a march that was stopped or killed, or one with a
    /// later
    /// `march.end`. The files are those of a run in one piece.
    #[arg(long)]
    resume: bool,
    /// Threads for the integration of element matrices; results do not depend on it.
    #[arg(long, value_name = "N", default_value = "1")]
    threads: NonZeroUsize,
    #[command(flatten)]
    format: Format,
}

/// What a computation found, as `--json` prints it: the documents of its files, and where these lie.
#[derive(Serialize)]
pub(super) struct Results<'a, S> {
    pub(super) summary: &'a S,
    pub(super) cost: &'a Cost,
    pub(super) results: &'a Path,
}

impl<S: Serialize> Results<'_, S> {
    pub(super) fn show(&self, format: Format, console: &Console) -> miette::Result<()> {
        console.show(format, self, || format!("  results   {}\n", self.results.display()))
    }
}

pub(super) fn run(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let scene = scene::read(&arguments.scene)?;
    let model = advise::decided(Model::new(scene, registry)?, arguments.threads)?;
    let folder = || arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene, ""));
    match model.plan {
        Plan::Impact(_) => impact(&model, arguments, &folder(), console),
        _ if arguments.resume => Err(Error::NotMarched.into()),
        Plan::Static { .. } => at_rest(&model, arguments, folder(), console),
        Plan::Modes { count } => {
            super::modes::compute(&model, count, arguments.threads, folder, arguments.format, console)
        }
    }
}

fn at_rest(model: &Model, arguments: &Arguments, folder: PathBuf, console: &Console) -> miette::Result<ExitCode> {
    let solution = statics::solve(model, arguments.threads).inspect_err(|_| warn(model))?;
    let summary = output::statics::StaticSummary::new(model, &solution);
    let mut cost = cost_of(model, arguments.threads, &solution.phases);
    console.say(arguments.format, || summary.text(&cost));
    let mut write = || {
        let dir = OutputDir::create(&folder)?;
        keep_scene(&dir, model)?;
        output::statics::write(&dir, model, &solution, &summary)?;
        cost.phases.extend(fields::write_static(&dir, model, &solution)?);
        tables::write_json(&dir, "cost.json", &cost)?;
        dir.supersede()?;
        Ok::<_, Error>(dir)
    };
    let dir = write()?;
    Results { summary: &summary, cost: &cost, results: dir.path() }.show(arguments.format, console)?;
    Ok(ExitCode::SUCCESS)
}

fn impact(model: &Model, arguments: &Arguments, folder: &Path, console: &Console) -> miette::Result<ExitCode> {
    let bar = console.progress(1000, "march {bar:40} {percent:>3} %  {eta} left");
    let (dir, found) = match march(model, arguments, folder, &bar)? {
        Ended::Stopped(signal) => return Ok(ExitCode::from(128 + signal)),
        Ended::Done(dir, found) => (dir, found),
    };
    let (summary, cost, outcome) = &*found;
    console.say(arguments.format, || summary.text(cost));
    if model.scene.output.plots {
        output::write_plots(&dir, model, outcome)?;
    }
    dir.supersede().map_err(Error::from)?;
    Results { summary, cost, results: dir.path() }.show(arguments.format, console)?;
    Ok(if summary.completed { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// How a march ended.
enum Ended {
    /// By this signal.
    Stopped(u8),
    /// With tables in this folder.
    Done(OutputDir, Box<(ImpactSummary, Cost, Outcome)>),
}

fn march(model: &Model, arguments: &Arguments, folder: &Path, bar: &ProgressBar) -> Result<Ended, Error> {
    let checkpoint = if arguments.resume { Some(Checkpoint::read(folder, model)?) } else { None };
    let prepared = impact::prepare(model, arguments.threads).inspect_err(|_| warn(model))?;
    let sizes = prepared.sizes;
    let mut march = match checkpoint {
        None => March::start(prepared)?,
        Some(checkpoint) => March::resume(prepared, checkpoint)?,
    };
    // After all that can be refused, so that a refusal leaves no folder; before the march, so that none is in vain.
    let dir = OutputDir::create(folder)?;
    own_scene(&dir, model)?;
    if let Some(signal) = advance(model, &mut march, &dir, bar)? {
        let again = if arguments.resume { "" } else { " --resume" };
        let command: Vec<_> = std::env::args().collect();
        let (t, share) = (march.time() * 1e3, march.share() * 1e2);
        let command = command.join(" ");
        let _ = writeln!(
            std::io::stderr(),
            "Stopped by a signal at {t:.4} ms, {share:.0} % of the march. To continue: {command}{again}"
        );
        return Ok(Ended::Stopped(signal));
    }
    let outcome = march.finish();
    let summary = ImpactSummary::new(model, &sizes, &outcome);
    let mut cost = cost_of(model, arguments.threads, &outcome.phases);
    let size = outcome.size(model, &sizes);
    cost.one_level_better = one_level_better(&size, seconds_per_phase(&outcome.phases));
    keep_scene(&dir, model)?;
    output::write_tables(&dir, model, &outcome)?;
    tables::write_json(&dir, "summary.json", &summary)?;
    tables::write_json(&dir, "cost.json", &cost)?;
    Ok(Ended::Done(dir, Box::new((summary, cost, outcome))))
}

/// What `phases` cost, with what it takes to make the run again.
pub(super) fn cost_of(model: &Model, threads: NonZeroUsize, phases: &[Phase]) -> Cost {
    let provenance = Some(Provenance::of(model.scene.source.name()));
    Cost { provenance, ..Cost::new(threads, phases.to_vec()) }
}

/// Leaves a copy of the scene with its results, from which `fem report` shows it.
pub(super) fn keep_scene(dir: &OutputDir, model: &Model) -> Result<(), Error> {
    if own_scene(dir, model)? {
        return Ok(());
    }
    Ok(dir.write(report::SCENE, |out| out.write_all(model.scene.source.text().as_bytes()))?)
}

/// Whether the folder of the results is that of the scene, which then needs no copy.
///
/// # Errors
/// Another `scene.toml`, which no run has left there.
pub(super) fn own_scene(dir: &OutputDir, model: &Model) -> Result<bool, Error> {
    let copy = dir.path().join(report::SCENE);
    let same = |a: &Path, b: &Path| matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
    if same(&copy, Path::new(model.scene.source.name())) {
        return Ok(true);
    }
    if copy.exists() && !dir.path().join("cost.json").exists() {
        return Err(FileError::Taken { path: copy }.into());
    }
    Ok(false)
}

/// Marches to the end or to a signal, whose number it returns. A checkpoint is written there, and before whenever
/// the interval of the scene has passed since the last one.
fn advance(model: &Model, march: &mut March<'_>, dir: &OutputDir, bar: &ProgressBar) -> Result<Option<u8>, Error> {
    let signals = Signals::heed();
    // An interval beyond what a clock counts is never over.
    let interval = Duration::try_from_secs_f64(model.scene.output.checkpoint_every).unwrap_or(Duration::MAX);
    let (mut saved, mut signal) = (Instant::now(), None);
    let mut fields = MarchFields::new(model, dir);
    fields.take(march)?;
    while !march.done() && signal.is_none() {
        march.advance();
        fields.take(march)?;
        if saved.elapsed() >= interval {
            fields.flush(march)?;
            march.save(dir)?;
            saved = Instant::now();
        }
        bar.set_position((march.share() * 1000.0) as u64);
        signal = signals.received();
    }
    fields.flush(march)?;
    march.save(dir)?;
    bar.finish_and_clear();
    Ok(signal.filter(|_| !march.done()))
}

/// `results/<folder of the scene>` with an ending that keeps what other commands find apart from what `fem run` does; for a
/// scene in the working folder the name of that folder.
pub(super) fn default_folder(scene: &Path, ending: &str) -> PathBuf {
    let folder = scene.parent().filter(|p| p.file_name().is_some()).map(Path::to_owned);
    let folder = folder.or_else(|| std::path::absolute(scene).ok()?.parent().map(Path::to_owned));
    let name = folder.as_deref().and_then(Path::file_name).map(PathBuf::from);
    let mut name = name.unwrap_or_else(|| PathBuf::from("scene")).into_os_string();
    name.push(ending);
    Path::new("results").join(name)
}
