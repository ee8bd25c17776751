//! What the command says: results on standard output, everything else on standard error.

use clap::Args;
use fem_io::tables;
use indicatif::{ProgressBar, ProgressStyle};
use miette::{IntoDiagnostic, miette};
use serde::Serialize;
use std::cell::OnceCell;
use std::io::{self, Write as _};
use tracing::level_filters::LevelFilter;

/// How much is said.
#[derive(Debug, Clone, Copy, Args)]
#[command(next_help_heading = "What is said")]
pub(super) struct Voice {
    /// Prints errors only, and the document that --json asks for.
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Says on standard error what is done: mesh, plug-ins, phases with their seconds, files; -vv says more.
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    verbose: u8,
}

impl Voice {
    /// Does `work` with its log on standard error, if one is asked for.
    pub(super) fn logging<T>(self, work: impl FnOnce() -> T) -> T {
        let level = match self.verbose {
            0 => return work(),
            1 => LevelFilter::INFO,
            _ => LevelFilter::DEBUG,
        };
        let log = tracing_subscriber::fmt().with_max_level(level).with_writer(io::stderr).with_target(false);
        let log = log.with_timer(tracing_subscriber::fmt::time::uptime()).with_ansi(false).finish();
        tracing::subscriber::with_default(log, work)
    }
}

/// Results as data.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Format {
    /// Prints the results as one JSON document, with the names that the files use.
    #[arg(long)]
    pub(super) json: bool,
}

/// Standard output, and progress on standard error.
#[derive(Debug)]
pub(super) struct Console {
    voice: Voice,
    /// Why standard output did not take all that was printed, if it did not.
    lost: OnceCell<io::Error>,
}

impl Console {
    pub(super) fn new(voice: Voice) -> Self {
        Self { voice, lost: OnceCell::new() }
    }

    /// Prints text.
    pub(super) fn print(&self, text: &str) {
        if !self.voice.quiet {
            self.write_bytes(text.as_bytes());
        }
    }

    /// Prints results: `text` for people or `data` for programs.
    pub(super) fn show(
        &self,
        format: Format,
        data: &impl Serialize,
        text: impl FnOnce() -> String,
    ) -> miette::Result<()> {
        if format.json {
            return self.document(data);
        }
        self.print(&text());
        Ok(())
    }

    /// Prints what only people read.
    pub(super) fn say(&self, format: Format, text: impl FnOnce() -> String) {
        if !format.json {
            self.print(&text());
        }
    }

    /// Prints one JSON document.
    pub(super) fn document(&self, data: &impl Serialize) -> miette::Result<()> {
        let text = tables::json_text("standard output", data).into_diagnostic()?;
        self.write_bytes(text.as_bytes());
        Ok(())
    }

    /// Writes to standard output; a closed pipe ends quietly, a full disk at the end of the command.
    pub(super) fn write_bytes(&self, bytes: &[u8]) {
        if let Err(why) = io::stdout().write_all(bytes)
            && why.kind() != io::ErrorKind::BrokenPipe
        {
            let _ = self.lost.set(why);
        }
    }

    /// Fails where something printed was lost.
    pub(super) fn close(&self) -> miette::Result<()> {
        self.lost.get().map_or(Ok(()), |why| Err(miette!("cannot write to standard output: {why}")))
    }

    /// A bar on a terminal, nothing elsewhere or beside a log.
    pub(super) fn progress(&self, length: u64, template: &str) -> ProgressBar {
        if self.voice.quiet || self.voice.verbose > 0 {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        ProgressBar::new(length).with_style(style)
    }
}
