//! `fem matrices`.

use super::print;
use super::run::default_folder;
use crate::error::Error;
use crate::matrices;
use crate::model::Model;
use crate::registry::Registry;
use clap::Args;
use fem_io::files::OutputDir;
use fem_io::scene;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file (TOML) of any analysis.
    scene: PathBuf,
    /// Folder of the results [default: results/<folder of the scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn matrices(registry: &Registry, arguments: &Arguments) -> miette::Result<ExitCode> {
    Ok(compute(registry, arguments)?)
}

fn compute(registry: &Registry, arguments: &Arguments) -> Result<ExitCode, Error> {
    let model = Model::new(scene::read(&arguments.scene)?, registry)?;
    let dir = OutputDir::create(arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene)))?;
    matrices::write(&dir, &model, NonZeroUsize::MIN)?;
    print(&format!("{} unknowns\n  results   {}\n", model.constraints.ndof(), dir.path().display()));
    Ok(ExitCode::SUCCESS)
}
