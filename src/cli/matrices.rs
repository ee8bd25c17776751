//! `fem matrices`.

use super::run::default_folder;
use super::{Console, Format, SceneFile};
use crate::analyses::matrices;
use crate::error::Error;
use crate::job;
use crate::model::Model;
use crate::registry::Registry;
use clap::Args;
use fem_io::files::OutputDir;
use serde::Serialize;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem matrices coupon/scene.toml --out matrices")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneFile,
    /// Folder of the results [default: results/<folder of the scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

#[derive(Serialize)]
struct Written<'a> {
    unknowns: usize,
    results: &'a Path,
}

pub(super) fn matrices(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let (unknowns, dir) = write(registry, arguments)?;
    let written = Written { unknowns, results: dir.path() };
    console
        .show(arguments.format, &written, || format!("{unknowns} unknowns\n  results   {}\n", dir.path().display()))?;
    Ok(ExitCode::SUCCESS)
}

fn write(registry: &Registry, arguments: &Arguments) -> Result<(usize, OutputDir), Error> {
    let model = Model::new(arguments.scene.read()?, registry)?;
    let model = model.whole()?;
    let dir = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene.path, ""));
    let dir = job::folder::results(&dir, &model.origin.source)?;
    matrices::write(&dir, model, NonZeroUsize::MIN)?;
    Ok((model.constraints.ndof(), dir))
}
