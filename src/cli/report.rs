//! `fem report`.

use super::print;
use crate::report;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder of the results of `fem run`; report.html is written into it.
    folder: PathBuf,
}

pub(super) fn report(arguments: &Arguments) -> miette::Result<ExitCode> {
    let page = report::write(&arguments.folder)?;
    print(&format!("  report    {}\n", page.display()));
    Ok(ExitCode::SUCCESS)
}
