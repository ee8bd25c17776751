//! `fem report`.

use super::{Console, Format};
use crate::output::report;
use crate::registry::Registry;
use clap::Args;
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fem report results/coupon --measured drop.csv\n  fem report results/coupon results/thicker"
)]
pub(super) struct Arguments {
    /// Folders of the results of `fem run`: report.html is written into an only one, comparison.html into the first of several.
    #[arg(required = true, value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// Table of a measured force over time, laid over the computed one: its first line names the units, `time_ms,force_kN`.
    #[arg(long, value_name = "CSV")]
    measured: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

/// Where the report is.
#[derive(Serialize)]
struct Written {
    report: PathBuf,
}

pub(super) fn report(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let written =
        Written { report: report::write(&arguments.folders, arguments.measured.as_deref(), &registry.columns())? };
    console.show(arguments.format, &written, || format!("  report    {}\n", written.report.display()))?;
    Ok(ExitCode::SUCCESS)
}
