//! `fem schema`.

use super::Console;
use crate::registry::Registry;
use fem_io::scene;
use std::process::ExitCode;

pub(super) fn schema(registry: &Registry, console: &Console) -> miette::Result<ExitCode> {
    console.document(&scene::schema(&|kind| registry.choices(kind), &registry.effect_keys()))?;
    Ok(ExitCode::SUCCESS)
}
