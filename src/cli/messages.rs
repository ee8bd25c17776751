//! Errors and warnings on standard error, for people or for programs.

use super::console::{Voice, printable, tell};
use clap::ValueEnum;
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, Report};
use serde::Serialize;
use std::io::{IsTerminal, Write};
use textwrap::WordSplitter;

/// For whom errors and warnings are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum MessageFormat {
    /// With the line of the scene and what to do.
    Human,
    /// A JSON document on each line.
    Json,
}

/// When errors have colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Color {
    /// On a terminal that knows them, unless NO_COLOR, CLICOLOR=0 or TERM=dumb says otherwise; CLICOLOR_FORCE=1 elsewhere too.
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

impl Color {
    fn holds(self) -> bool {
        match self {
            Self::Always => true,
            Self::Never => false,
            Self::Auto if anstyle_query::no_color() => false,
            Self::Auto if anstyle_query::clicolor_force() => true,
            Self::Auto => {
                anstyle_query::clicolor() != Some(false)
                    && anstyle_query::term_supports_color()
                    && std::io::stderr().is_terminal()
            }
        }
    }
}

/// An error or a warning as data.
#[derive(Serialize)]
struct Message {
    level: &'static str,
    message: String,
    /// What caused it, the nearest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    causes: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<String>,
    #[serde(flatten)]
    place: Option<MessagePlace>,
}

/// Where it is; line and column count from 1, the column in bytes.
#[derive(Serialize)]
struct MessagePlace {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    line: usize,
    column: usize,
    length: usize,
}

impl Message {
    /// A diagnostic and those related to it, each by itself.
    fn all_of(diagnostic: &dyn Diagnostic) -> Vec<Self> {
        let mut causes = Vec::new();
        let mut cause = diagnostic.source();
        while let Some(one) = cause {
            causes.push(one.to_string());
            cause = one.source();
        }
        let help = diagnostic.help().map(|help| help.to_string());
        let this =
            Self { level: "error", message: diagnostic.to_string(), causes, help, place: MessagePlace::of(diagnostic) };
        let others = diagnostic.related().into_iter().flatten().flat_map(Self::all_of);
        [this].into_iter().chain(others).collect()
    }

    fn tell(&self) {
        if let Ok(line) = serde_json::to_string(self) {
            tell(&(line + "\n"));
        }
    }
}

impl MessagePlace {
    fn of(diagnostic: &dyn Diagnostic) -> Option<Self> {
        let label = diagnostic.labels()?.next()?;
        let contents = diagnostic.source_code()?.read_span(label.inner(), 0, 0).ok()?;
        let file = contents.name().map(str::to_owned);
        Some(Self { file, line: contents.line() + 1, column: contents.column() + 1, length: label.len() })
    }
}

/// Shows an error with its causes, the place in the scene, and what to do; several at once where it holds several.
pub(super) fn print_report(report: &Report, voice: Voice) {
    if voice.message_format == MessageFormat::Json {
        return Message::all_of(report.as_ref()).iter().for_each(Message::tell);
    }
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    let text = render(report, if dumb { GraphicalTheme::none() } else { GraphicalTheme::unicode_nocolor() });
    // Colours are what else a terminal is steered by: they are left out where the texts have something of the kind.
    if voice.color.holds() && printable(&text) == text {
        let text = render(report, GraphicalTheme::unicode());
        let _ = write!(std::io::stderr(), "{}", headed(&text));
    } else {
        tell(&headed(&text));
    }
}

/// What is rendered begins with the code of an error that has one, and with a space otherwise.
fn headed(text: &str) -> String {
    format!("Error:{}{text}", if text.starts_with(' ') { "" } else { " " })
}

fn render(report: &Report, theme: GraphicalTheme) -> String {
    let mut text = String::new();
    // Names with hyphens stay whole, to be copied.
    let handler =
        GraphicalReportHandler::new_themed(theme).with_width(110).with_word_splitter(WordSplitter::NoHyphenation);
    let shown = handler.render_report(&mut text, report.as_ref());
    if shown.is_ok() { text } else { format!("{report:?}") }
}

/// Says on standard error what may explain why a model cannot be computed.
pub(super) fn warn(warnings: &[String], voice: Voice) {
    for warning in warnings {
        match voice.message_format {
            MessageFormat::Human => tell(&format!("Warning: {warning}\n")),
            MessageFormat::Json => {
                let (message, causes) = (warning.clone(), Vec::new());
                Message { level: "warning", message, causes, help: None, place: None }.tell();
            }
        }
    }
}
