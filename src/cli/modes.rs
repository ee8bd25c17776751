//! `fem modes`.

use super::run::{compute, default_folder};
use super::{Console, Format, SceneFile};
use crate::job::{Options, Results, Task};
use crate::registry::Registry;
use clap::Args;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem modes coupon/scene.toml --count 20")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneFile,
    /// How many modes [default: what the scene says, or 10]
    #[arg(long, value_name = "N")]
    count: Option<NonZeroUsize>,
    /// Folder of the results [default: results/<folder of the scene>-modes]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    threads: super::Threads,
    #[command(flatten)]
    format: Format,
}

pub(super) fn modes(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene.path, "-modes"));
    let (task, results) = (Task::Modes(arguments.count), Results::Folder(folder));
    let options = Options { task, results, threads: arguments.threads.count(), ..Options::default() };
    compute(registry, &arguments.scene.read()?, options, "", arguments.format, console)
}
