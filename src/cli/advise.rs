//! `fem advise`.

use super::{print, warn};
use crate::advise;
use crate::model::Model;
use crate::registry::Registry;
use clap::Args;
use fem_io::scene;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file (TOML) of an impact.
    scene: PathBuf,
    /// Threads for the integration of element matrices; results do not depend on it.
    #[arg(long, value_name = "N", default_value = "1")]
    threads: NonZeroUsize,
}

pub(super) fn advise(registry: &Registry, arguments: &Arguments) -> miette::Result<ExitCode> {
    let model = scene::read(&arguments.scene).map_err(Into::into).and_then(|scene| Model::new(scene, registry))?;
    let all = advise::advise(&model, arguments.threads).inspect_err(|_| warn(&model))?;
    print(&format!("{}\n", model.scene.title));
    all.iter().for_each(|advice| print(&advice.to_string()));
    Ok(ExitCode::SUCCESS)
}
