//! `fem modes`.

use super::run::{cost_of, default_folder, keep_scene};
use super::{print, warn};
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::modes::{self, Summary};
use crate::registry::Registry;
use clap::Args;
use fem_io::files::OutputDir;
use fem_io::scene::{self, DEFAULT_MODES};
use fem_io::tables;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file (TOML) of any analysis.
    scene: PathBuf,
    /// How many modes [default: what the scene says, or 10]
    #[arg(long, value_name = "N")]
    count: Option<NonZeroUsize>,
    /// Folder of the results [default: results/<folder of the scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads for the integration of element matrices; results do not depend on it.
    #[arg(long, value_name = "N", default_value = "1")]
    threads: NonZeroUsize,
}

pub(super) fn modes(registry: &Registry, arguments: &Arguments) -> miette::Result<ExitCode> {
    let model = Model::new(scene::read(&arguments.scene)?, registry)?;
    let own = match model.plan {
        Plan::Modes { count } => count,
        _ => DEFAULT_MODES,
    };
    let count = arguments.count.map_or(own, NonZeroUsize::get);
    let folder = || arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene));
    Ok(compute(&model, count, arguments.threads, folder)?)
}

pub(super) fn compute(
    model: &Model,
    count: usize,
    threads: NonZeroUsize,
    folder: impl Fn() -> PathBuf,
) -> Result<ExitCode, Error> {
    let solution = modes::solve(model, count, threads).inspect_err(|_| warn(model))?;
    let summary = Summary::new(model, &solution);
    let cost = cost_of(model, threads, &solution.phases);
    print(&summary.text(&cost));
    let dir = OutputDir::create(folder())?;
    keep_scene(&dir, model)?;
    modes::write(&dir, &solution, &summary)?;
    tables::write_json(&dir, "cost.json", &cost)?;
    print(&format!("  results   {}\n", dir.path().display()));
    Ok(ExitCode::SUCCESS)
}
