//! What the command says: results on standard output, everything else on standard error.

use super::messages::{self, Color, MessageFormat};
use super::progress::{Progress, ProgressForm};
use clap::Args;
use fem_io::results::FORMAT;
use fem_io::tables;
use miette::{IntoDiagnostic, miette};
use serde::Serialize;
use std::borrow::Cow;
use std::cell::OnceCell;
use std::io::{self, Write};
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
    /// When errors have colours: `always`, `never`, or `auto`, on a terminal unless NO_COLOR, CLICOLOR or TERM say otherwise.
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto", hide_possible_values = true)]
    pub(super) color: Color,
    /// How errors and warnings are said: `human`, or `json` for a document on each line of standard error.
    #[arg(long, global = true, value_name = "FORMAT", default_value = "human", hide_possible_values = true)]
    pub(super) message_format: MessageFormat,
    /// How progress is shown on standard error: `auto` for a bar on a terminal, `plain` for lines in a log, `none`.
    #[arg(long, global = true, value_name = "FORM", default_value = "auto", hide_possible_values = true)]
    progress: ProgressForm,
}

impl Voice {
    /// Does `work` with its log on standard error, if one is asked for.
    pub(super) fn logging<T>(self, work: impl FnOnce() -> T) -> T {
        let level = match self.verbose {
            0 => return work(),
            1 => LevelFilter::INFO,
            _ => LevelFilter::DEBUG,
        };
        let log = tracing_subscriber::fmt().with_max_level(level).with_writer(|| Stderr).with_target(false);
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

/// Results with the version of their format.
#[derive(Serialize)]
struct Versioned<'a, T> {
    format: u32,
    #[serde(flatten)]
    data: &'a T,
}

impl Console {
    pub(super) fn new(voice: Voice) -> Self {
        Self { voice, lost: OnceCell::new() }
    }

    /// Prints text.
    pub(super) fn print(&self, text: &str) {
        if !self.voice.quiet {
            self.write_bytes(printable(text).as_bytes());
        }
    }

    /// Prints results: `text` for people, or `data` for programs, whose fields follow the version of the format.
    pub(super) fn show(
        &self,
        format: Format,
        data: &impl Serialize,
        text: impl FnOnce() -> String,
    ) -> miette::Result<()> {
        self.show_plain(format, &Versioned { format: FORMAT, data }, text)
    }

    /// The same of a list, or of what says its version itself.
    pub(super) fn show_plain(
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
        self.write_bytes(escape_json(&text).as_bytes());
        Ok(())
    }

    /// Writes what is our own to standard output as it is; a closed pipe ends quietly, a full disk at the end of the command.
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

    /// The progress of `what`, drawn by `template` where it is a bar; nothing beside a log.
    pub(super) fn progress(&self, what: &'static str, template: &str) -> Progress {
        let logs = self.voice.verbose > 0 && self.voice.progress == ProgressForm::Auto;
        Progress::new(if self.voice.quiet || logs { ProgressForm::None } else { self.voice.progress }, what, template)
    }

    /// Says on standard error what may explain why a model cannot be computed.
    pub(super) fn warn(&self, warnings: &[String]) {
        messages::warn(warnings, self.voice);
    }
}

/// Says something on standard error.
pub(super) fn tell(text: &str) {
    let _ = io::stderr().write_all(printable(text).as_bytes());
}

/// Standard error for a log.
struct Stderr;

impl Write for Stderr {
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        tell(&String::from_utf8_lossy(line));
        Ok(line.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A text with a mark for every character that would do something to a terminal: names and messages come from files that may
/// be anyone's.
pub(super) fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let lines = text.replace("\r\n", "\n");
    Cow::Owned(lines.chars().map(|c| if steers(c) { char::REPLACEMENT_CHARACTER } else { c }).collect())
}

/// The same of a JSON document, whose texts keep what they are. It has such characters in texts alone.
fn escape_json(text: &str) -> Cow<'_, str> {
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let escape = |c: char| -> String {
        let mut units = [0; 2];
        if !steers(c) {
            return c.to_string();
        }
        c.encode_utf16(&mut units).iter().map(|unit| format!("\\u{unit:04x}")).collect()
    };
    Cow::Owned(text.chars().map(escape).collect())
}

/// Whether a character moves the cursor, colours, rings, turns the direction of writing or hides itself.
fn steers(c: char) -> bool {
    match c {
        '\n' | '\t' => false,
        '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' => true,
        '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}' => true,
        c => c.is_control(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn nothing_but_text_reaches_a_terminal() {
        let plain = "names of 16 plies: [0₂/±45]s, µs, 積層板\n\tand a tab\n";
        assert!(matches!(printable(plain), Cow::Borrowed(_)) && matches!(escape_json(plain), Cow::Borrowed(_)));
        assert_eq!(printable("a\r\nb\x1b[2Jc\x07\u{9b}31md\u{202e}e\rf\x7f"), "a\nb�[2Jc��31md�e�f�");
        let odd = "\x7f\u{9b}\u{202e}\u{e0041}\x1b";
        let text = escape_json(&serde_json::to_string(odd).unwrap()).into_owned();
        assert!(text.is_ascii() && !text.contains(steers), "{text}");
        assert_eq!(serde_json::from_str::<String>(&text).unwrap(), odd);
    }
}
