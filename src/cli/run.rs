//! `fem run`.

use super::{print, warn};
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::registry::Registry;
use crate::summary::{self, Summary};
use crate::{run, statics};
use clap::Args;
use fem_io::files::OutputDir;
use fem_io::{scene, tables};
use indicatif::{ProgressBar, ProgressStyle};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file (TOML); its mesh is looked for beside it.
    scene: PathBuf,
    /// Folder of the results [default: results/<folder of the scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads for the integration of element matrices; results do not depend on it.
    #[arg(long, value_name = "N", default_value = "1")]
    threads: NonZeroUsize,
}

pub(super) fn run(registry: &Registry, arguments: &Arguments) -> miette::Result<ExitCode> {
    Ok(compute(registry, arguments)?)
}

fn compute(registry: &Registry, arguments: &Arguments) -> Result<ExitCode, Error> {
    let model = Model::new(scene::read(&arguments.scene)?, registry)?;
    let folder = || arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene));
    match model.plan {
        Plan::Impact(_) => impact(&model, arguments.threads, folder),
        Plan::Static { .. } => {
            let solution = statics::solve(&model, arguments.threads).inspect_err(|_| warn(&model))?;
            let summary = statics::Summary::new(&model, &solution);
            print(&summary.text());
            let dir = OutputDir::create(folder())?;
            statics::write(&dir, &model, &solution, &summary)?;
            print(&format!("  results   {}\n", dir.path().display()));
            Ok(ExitCode::SUCCESS)
        }
        Plan::Modes { count } => super::modes::compute(&model, count, arguments.threads, folder),
    }
}

fn impact(model: &Model, threads: NonZeroUsize, folder: impl Fn() -> PathBuf) -> Result<ExitCode, Error> {
    let prepared = run::prepare(model, threads).inspect_err(|_| warn(model))?;
    // After all that can be refused, so that a refusal leaves no folder; before the march, so that none is in vain.
    let dir = OutputDir::create(folder())?;
    let sizes = prepared.sizes;
    let bar = progress();
    let outcome = run::march(prepared, |share| bar.set_position((share * 1000.0) as u64));
    bar.finish_and_clear();
    let outcome = outcome?;
    let summary = Summary::new(model, &sizes, &outcome);
    summary::write_tables(&dir, model, &outcome)?;
    tables::write_json(&dir, "summary.json", &summary)?;
    print(&summary.text());
    if model.scene.output.plots {
        summary::write_plots(&dir, model, &outcome)?;
    }
    print(&format!("  results   {}\n", dir.path().display()));
    Ok(if summary.completed { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// `results/<folder of the scene>`; for a scene in the working folder the name of that folder.
pub(super) fn default_folder(scene: &Path) -> PathBuf {
    let folder = scene.parent().filter(|p| p.file_name().is_some()).map(Path::to_owned);
    let folder = folder.or_else(|| std::path::absolute(scene).ok()?.parent().map(Path::to_owned));
    let name = folder.as_deref().and_then(Path::file_name).map(PathBuf::from);
    Path::new("results").join(name.unwrap_or_else(|| PathBuf::from("scene")))
}

/// A bar on a terminal, nothing elsewhere.
fn progress() -> ProgressBar {
    let style = ProgressStyle::with_template("march {bar:40} {percent:>3} %  {eta} left");
    ProgressBar::new(1000).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
