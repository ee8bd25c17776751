//! How far a command is, on standard error.

use super::console::{printable, tell};
use clap::ValueEnum;
use fem_core::plugin::Dimension;
use indicatif::{ProgressBar, ProgressStyle};
use std::cell::{Cell, RefCell};
use std::io::IsTerminal;
use std::time::Instant;

/// How progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ProgressForm {
    /// A bar on a terminal, nothing elsewhere.
    Auto,
    /// A line for each tenth, for logs.
    Plain,
    /// Nothing.
    None,
}

/// Parts of a whole that a bar counts.
const PARTS: u64 = 1000;

/// The progress of one command.
pub(super) enum Progress {
    /// Not shown.
    Hidden,
    /// A bar that is drawn anew.
    Bar(ProgressBar),
    /// Lines that stay.
    Plain(Lines),
}

/// Lines of a progress for logs.
pub(super) struct Lines {
    what: &'static str,
    begun: Instant,
    tenths: Cell<u64>,
    message: RefCell<String>,
}

impl Progress {
    /// Of `what` ("march"), drawn by `template` where it is a bar.
    pub(super) fn new(form: ProgressForm, what: &'static str, template: &str) -> Self {
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        match form {
            ProgressForm::Plain => Self::Plain(Lines {
                what,
                begun: Instant::now(),
                tenths: Cell::new(0),
                message: RefCell::new(String::new()),
            }),
            ProgressForm::Auto if std::io::stderr().is_terminal() && !dumb => {
                let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
                Self::Bar(ProgressBar::new(PARTS).with_style(style))
            }
            ProgressForm::Auto | ProgressForm::None => Self::Hidden,
        }
    }

    /// What is done now.
    pub(super) fn message(&self, text: &str) {
        match self {
            Self::Hidden => {}
            Self::Bar(bar) => {
                bar.set_message(printable(text).into_owned());
                bar.tick();
            }
            Self::Plain(lines) => {
                if *lines.message.borrow() != text {
                    lines.say(text);
                    text.clone_into(&mut lines.message.borrow_mut());
                }
            }
        }
    }

    /// How much of it is done.
    pub(super) fn share(&self, share: f64) {
        match self {
            Self::Hidden => {}
            Self::Bar(bar) => bar.set_position((share * PARTS as f64) as u64),
            Self::Plain(lines) => {
                let tenths = (10.0 * share + 1e-9) as u64;
                if tenths > lines.tenths.replace(tenths.max(lines.tenths.get())) {
                    lines.say(&format!("{} %", 10 * tenths));
                }
            }
        }
    }

    /// Prints by `print` beside it.
    pub(super) fn suspend(&self, print: impl FnOnce()) {
        match self {
            Self::Bar(bar) => bar.suspend(print),
            Self::Hidden | Self::Plain(_) => print(),
        }
    }

    /// Takes it away.
    pub(super) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

impl Lines {
    fn say(&self, text: &str) {
        let since = Dimension::TIME.of(self.begun.elapsed().as_secs_f64());
        tell(&format!("{}: {text}, after {since}\n", self.what));
    }
}
