//! The command line, as a function of the registry.

mod advise;
mod check;
mod envelope;
mod list;
mod matrices;
mod modes;
mod report;
mod run;
mod signals;
mod study;

use crate::model::Model;
use crate::registry::Registry;
use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use miette::{GraphicalReportHandler, GraphicalTheme, Report, miette};
use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use std::sync::OnceLock;
use textwrap::WordSplitter;

/// Low-velocity impact on laminated composites.
#[derive(Debug, Parser)]
#[command(
    name = "fem",
    version,
    arg_required_else_help = true,
    after_help = "To begin with: fem run examples/as4-3502-16ply-50mm/scene.toml"
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Computes a scene: force history, stresses, first damage.
    ///
    /// Prints a summary and writes summary.json, cost.json, history.csv, events.csv, scene.toml, damage.json, and pictures of
    /// forces, displacements, energies and damage as SVG and PNG; modes, and failure indices over time and over the plate,
    /// where the scene asks for them. Fails, and keeps what it had, when the march meets a number that is not finite or loses
    /// its energy balance. Writes a checkpoint now and then, at the end and when it is stopped (Ctrl-C, SIGTERM, SIGHUP: exit
    /// status 130, 143, 129), from which `--resume` goes on.
    Run(run::Arguments),
    /// Validates a scene with its mesh and prints sizes and the stable step; marches nothing.
    Check(check::Arguments),
    /// Says which effects an impact calls for, before it is computed: regime, membrane, contact, shear, delamination, mesh.
    ///
    /// Each answer with its number, threshold and source, the error without the effect and the cost with it. Solves for the
    /// plate at rest once, marches nothing, writes nothing.
    Advise(advise::Arguments),
    /// Draws and tabulates failure envelopes of a material.
    Envelope(envelope::Arguments),
    /// Finds the lowest natural frequencies of a scene's plate and writes modes.csv.
    Modes(modes::Arguments),
    /// Shows what accuracy costs: where the error of a scene comes from, and the cheapest setting for a smaller one.
    ///
    /// Runs the scene along ladders of finer and finer settings, each by itself and the cheapest levels of all together, and
    /// in other ways. Errors count from the finest joint run, extrapolated along every ladder that converges. Says what it
    /// will run, prints tables, writes study.csv, study.md and pictures of errors over time; every run is kept at once in
    /// study.bin, from which `--resume` goes on.
    Study(study::Arguments),
    /// Makes a page of a folder of results: report.html, which opens from disk.
    ///
    /// One file with everything in it: summary, pictures, curves and damage to move through, events, errors, costs, the scene.
    /// Reads the files of the folder alone.
    Report(report::Arguments),
    /// Writes stiffness and mass (Matrix Market) with the names of their unknowns.
    Matrices(matrices::Arguments),
    /// Lists what a scene can name, with parameters and sources.
    List(list::Arguments),
}

/// Runs the command line of this process with the plug-ins of `registry`.
pub fn main(registry: Registry) -> ExitCode {
    run_with(registry, std::env::args_os())
}

/// Runs the command line `arguments` (the first is the program's name).
///
/// Results go to standard output, everything else to standard error; the exit status is 0 only when what was asked was
/// done, 1 when it was not, 2 for a command line that makes no sense.
pub fn run_with(registry: Registry, arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    let done = match arguments.command {
        Command::Run(a) => run::run(&registry, &a),
        Command::Check(a) => check::check(&registry, &a),
        Command::Envelope(a) => envelope::envelope(&registry, &a),
        Command::Advise(a) => advise::advise(&registry, &a),
        Command::Modes(a) => modes::modes(&registry, &a),
        Command::Study(a) => study::study(&registry, &a),
        Command::Report(a) => report::report(&a),
        Command::Matrices(a) => matrices::matrices(&registry, &a),
        Command::List(a) => list::list(&registry, &a),
    };
    let lost = || LOST.get().map_or(Ok(()), |why| Err(miette!("cannot write to standard output: {why}")));
    match done.and_then(|code| lost().map(|()| code)) {
        Ok(code) => code,
        Err(report) => {
            complain(&report);
            ExitCode::FAILURE
        }
    }
}

/// Shows an error with its causes, the place in the scene, and what to do.
fn complain(report: &Report) {
    let theme =
        if std::io::stderr().is_terminal() { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
    let mut text = String::new();
    // Names with hyphens stay whole, to be copied.
    let handler =
        GraphicalReportHandler::new_themed(theme).with_width(110).with_word_splitter(WordSplitter::NoHyphenation);
    let shown = handler.render_report(&mut text, report.as_ref());
    let text = if shown.is_ok() { text } else { format!("{report:?}") };
    let _ = write!(std::io::stderr(), "Error:{text}");
}

/// Says on standard error what may explain why `model` cannot be computed.
fn warn(model: &Model) {
    for warning in &model.warnings {
        let _ = writeln!(std::io::stderr(), "Warning: {warning}");
    }
}

/// Why standard output did not take all that was printed, if it did not.
static LOST: OnceLock<io::Error> = OnceLock::new();

/// Prints to standard output; a closed pipe ends quietly, a full disk at the end of the command.
fn print(text: &str) {
    if let Err(why) = io::stdout().write_all(text.as_bytes())
        && why.kind() != io::ErrorKind::BrokenPipe
    {
        let _ = LOST.set(why);
    }
}

/// A bar on a terminal, nothing elsewhere.
fn progress(length: u64, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style)
}
