//! `fem report`.

use super::{Console, Format};
use crate::output::report;
use crate::registry::Registry;
use clap::Args;
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder of the results of `fem run`; report.html is written into it.
    folder: PathBuf,
    #[command(flatten)]
    format: Format,
}

/// Where the report is.
#[derive(Serialize)]
struct Written {
    report: PathBuf,
}

pub(super) fn report(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let written = Written { report: report::write(&arguments.folder, &registry.columns())? };
    console.show(arguments.format, &written, || format!("  report    {}\n", written.report.display()))?;
    Ok(ExitCode::SUCCESS)
}
