//! `fem run`.

use super::progress::Progress;
use super::signals::Signals;
use super::{Console, Format, SceneFile, console};
use crate::cost::{Attained, Cost, Provenance};
use crate::error::Error;
use crate::job::{self, Finished, Follow, Found, Options, Results};
use crate::model::Model;
use crate::output::report;
use crate::registry::Registry;
use crate::study;
use clap::Args;
use fem_core::plugin::Dimension;
use fem_io::scene::{self, Scene, Setting};
use miette::miette;
use serde::Serialize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem run coupon/scene.toml --threads 4")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneFile,
    /// Folder of the results [default: results/<folder of the scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Continues from the checkpoint in the folder of the results: a march that was stopped or killed, or one with a
    /// later
    /// `march.end`. The files are those of a run in one piece.
    #[arg(long)]
    resume: bool,
    /// Largest relative error of the main results, for example 1% or 0.003: mesh, layers, reduction and step are raised until
    /// what that changes says so, before the run [default: what the scene says, or none]
    #[arg(long, value_name = "ERROR", value_parser = scene::parse_share)]
    accuracy: Option<f64>,
    /// Processor time that the search for that accuracy may take, for example 60s or 10min; what is run then depends on
    /// the machine [default: ten minutes of a common machine, the same runs everywhere]
    #[arg(long, value_name = "TIME", value_parser = super::time)]
    budget: Option<f64>,
    #[command(flatten)]
    threads: super::Threads,
    #[command(flatten)]
    format: Format,
}

/// What a job found, as `--json` prints it: the documents of its files, and where these lie.
#[derive(Serialize)]
struct Document<'a> {
    summary: &'a Found,
    cost: &'a Cost,
    results: Option<&'a Path>,
}

pub(super) fn run(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene.path, ""));
    let results = if arguments.resume { Results::Resumed(folder.clone()) } else { Results::Folder(folder.clone()) };
    let again = if arguments.resume { "" } else { " --resume" };
    let mut options = Options { results, threads: arguments.threads.count(), ..Options::default() };
    let scene = arguments.scene.read()?;
    let asked = arguments.accuracy.or_else(|| scene.accuracy.as_ref().map(|accuracy| accuracy.value));
    let Some(asked) = asked else {
        if arguments.budget.is_some() {
            let help = "give `--accuracy 1%` beside it, or `accuracy = \"1 %\"` in the scene";
            return Err(miette!(help = help, "`--budget` is for the search for an accuracy, and none is asked for"));
        }
        return compute(registry, &scene, options, again, arguments.format, console);
    };
    if arguments.resume {
        // What was raised for the accuracy lies there; whether the rest is the same is for the checkpoint to say.
        let raised = study::raised(&scene::read(&folder.join(report::SCENE))?);
        let scene = with(&scene, &raised)?;
        return compute(registry, &scene, options, again, arguments.format, console);
    }
    let attained = attain(registry, arguments, &scene, asked, console)?;
    let kept = attained.kept();
    let scene = with(&scene, &attained.setting)?;
    options.attained = Some(attained);
    let code = compute(registry, &scene, options, again, arguments.format, console)?;
    Ok(if kept { code } else { ExitCode::FAILURE })
}

/// The scene with `setting` in it, which need not be searched for again.
fn with(scene: &Scene, setting: &Setting) -> Result<Scene, Error> {
    Ok(scene::parse(&scene::rewrite(&scene.source, setting)?, Path::new(scene.source.name()))?)
}

/// Raises the settings of `scene`.
fn attain(
    registry: &Registry,
    arguments: &Arguments,
    scene: &Scene,
    asked: f64,
    console: &Console,
) -> miette::Result<Attained> {
    let model = Model::new(scene, registry)?;
    let progress = console.progress("accuracy", "accuracy: {msg}");
    let mut tell = |what: &str, error: Option<f64>| {
        let so_far = error.map_or(String::new(), |error| format!("{:.2} % so far, ", 1e2 * error));
        progress.message(&format!("{so_far}now {what}"));
    };
    let found = study::attain((scene, &model), registry, asked, arguments.budget, &mut tell, &mut ())?;
    progress.finish();
    Ok(found)
}

/// Does the job of `scene`; `again` is what the command line lacks to go on where a signal ends it.
pub(super) fn compute(
    registry: &Registry,
    scene: &Scene,
    mut options: Options,
    again: &str,
    format: Format,
    console: &Console,
) -> miette::Result<ExitCode> {
    options.provenance = Some(Provenance::of(scene.source.name()));
    let progress = console.progress("march", "march {bar:40} {percent:>3} %  {eta} left");
    let mut terminal = Terminal { console, format, progress, signals: None };
    let done = job::run(scene, registry, &options, &mut terminal);
    if let (Err(Error::Cancelled { time, share }), Some(signal)) = (&done, terminal.signal()) {
        let (time, share) = (Dimension::TIME.of(*time), share * 1e2);
        let command = options.provenance.map_or_else(String::new, |provenance| provenance.command);
        console::tell(&format!(
            "Stopped by a signal at {time}, {share:.0} % of the march. To continue: {command}{again}\n"
        ));
        return Ok(ExitCode::from(128 + signal));
    }
    let Finished { found, cost, folder, .. } = done?;
    let document = Document { summary: &found, cost: &cost, results: folder.as_deref() };
    let place = || folder.as_deref().map_or(String::new(), |folder| format!("  results   {}\n", folder.display()));
    console.show(format, &document, place)?;
    let cut = |found: &Found| matches!(found, Found::Static(of) if of.summary.path.as_ref().is_some_and(|path| path.stopped.is_some()));
    if let Some(signal) = terminal.signal().filter(|_| cut(&found)) {
        console::tell("Stopped by a signal: the path up to there is kept, and cannot be gone on with.\n");
        return Ok(ExitCode::from(128 + signal));
    }
    Ok(if found.completed() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A terminal that follows a job.
struct Terminal<'a> {
    console: &'a Console,
    format: Format,
    progress: Progress,
    /// From the beginning of a march on; before it there is nothing to keep, and signals do what they do by default.
    signals: Option<Signals>,
}

impl Terminal<'_> {
    fn signal(&self) -> Option<u8> {
        self.signals.as_ref().and_then(Signals::received)
    }
}

impl Follow for Terminal<'_> {
    fn marched(&mut self, share: f64) -> ControlFlow<()> {
        let signals = self.signals.get_or_insert_with(Signals::listen);
        self.progress.share(share);
        match signals.received() {
            Some(_) => ControlFlow::Break(()),
            None => ControlFlow::Continue(()),
        }
    }

    fn found(&mut self, found: &Found, cost: &Cost) {
        self.progress.finish();
        self.console.say(self.format, || found.text(cost));
    }

    fn failed(&mut self, warnings: &[String]) {
        self.console.warn(warnings);
    }
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
