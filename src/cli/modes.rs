//! `fem modes`.

use super::run::{Results, cost_of, default_folder, keep_scene};
use super::{Console, Format, warn};
use crate::analyses::modes::{self, ModesSolution};
use crate::cost::Cost;
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::output;
use crate::output::fields;
use crate::output::modes::ModesSummary;
use crate::registry::Registry;
use clap::Args;
use fem_io::files::OutputDir;
use fem_io::scene::{self, DEFAULT_MODES};
use fem_io::tables;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem modes coupon/scene.toml --count 20")]
pub(super) struct Arguments {
    /// Scene file (TOML) of any analysis.
    scene: PathBuf,
    /// How many modes [default: what the scene says, or 10]
    #[arg(long, value_name = "N")]
    count: Option<NonZeroUsize>,
    /// Folder of the results [default: results/<folder of the scene>-modes]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads for the integration of element matrices; results do not depend on it.
    #[arg(long, value_name = "N", default_value = "1")]
    threads: NonZeroUsize,
    #[command(flatten)]
    format: Format,
}

pub(super) fn modes(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let model = Model::new(scene::read(&arguments.scene)?, registry)?;
    let own = match model.plan {
        Plan::Modes { count } => count,
        _ => DEFAULT_MODES,
    };
    let count = arguments.count.map_or(own, NonZeroUsize::get);
    let folder = || arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene, "-modes"));
    compute(&model, count, arguments.threads, folder, arguments.format, console)
}

pub(super) fn compute(
    model: &Model,
    count: usize,
    threads: NonZeroUsize,
    folder: impl Fn() -> PathBuf,
    format: Format,
    console: &Console,
) -> miette::Result<ExitCode> {
    let solution = modes::solve(model, count, threads).inspect_err(|_| warn(model))?;
    let summary = ModesSummary::new(model, &solution);
    let mut cost = cost_of(model, threads, &solution.phases);
    console.say(format, || summary.text(&cost));
    let dir = write(model, folder(), &solution, &summary, &mut cost)?;
    Results { summary: &summary, cost: &cost, results: dir.path() }.show(format, console)?;
    Ok(ExitCode::SUCCESS)
}

fn write(
    model: &Model,
    folder: PathBuf,
    solution: &ModesSolution,
    summary: &ModesSummary,
    cost: &mut Cost,
) -> Result<OutputDir, Error> {
    let dir = OutputDir::create(folder)?;
    keep_scene(&dir, model)?;
    output::modes::write(&dir, solution, summary)?;
    cost.phases.extend(fields::write_modes(&dir, model, solution)?);
    tables::write_json(&dir, "cost.json", cost)?;
    dir.supersede()?;
    Ok(dir)
}
