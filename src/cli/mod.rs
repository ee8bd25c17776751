//! The command line, as a function of the registry.

mod advise;
mod cache;
mod check;
mod console;
mod deck;
mod envelope;
mod laminate;
mod list;
mod manual;
mod map;
mod matrices;
mod mesh;
mod messages;
mod modes;
mod new;
mod progress;
mod report;
mod run;
mod schema;
mod signals;
mod study;
mod sweep;

use crate::error::Error;
use crate::registry::Registry;
use cache::Keep;
use clap::{Parser, Subcommand};
use console::{Console, Format, Voice};
use fem_io::cache::Cache;
use fem_io::deck::Program;
use fem_io::scene::{self, Scene};
use std::ffi::OsString;
use std::io::Read;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Threads that are more than any machine of today has.
const MOST_THREADS: usize = 4096;
/// Bytes of a scene that are read from standard input.
const MOST_BYTES: u64 = 1 << 22;

/// Threads of a command.
#[derive(Debug, Clone, Copy, clap::Args)]
struct Threads {
    /// Threads that work at a time; results do not depend on it [default: as many as the machine offers]
    #[arg(long = "threads", value_name = "N", value_parser = threads)]
    asked: Option<NonZeroUsize>,
}

impl Threads {
    fn count(self) -> NonZeroUsize {
        self.asked.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN)
    }
}

/// A number of threads.
fn threads(text: &str) -> Result<NonZeroUsize, String> {
    match text.parse::<NonZeroUsize>() {
        Ok(threads) if threads.get() <= MOST_THREADS => Ok(threads),
        _ => Err(format!("must be a number from 1 to {MOST_THREADS}")),
    }
}

/// A number of cases.
fn samples(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|count| *count > 0).ok_or_else(|| "must be a number from 1 on".into())
}

/// A time above zero with its unit, s.
fn time(text: &str) -> Result<f64, String> {
    let spaced = text.rfind(|c: char| c.is_ascii_digit() || c == '.').map_or(text.to_owned(), |last| {
        let (number, unit) = text.split_at(last + 1);
        format!("{number} {}", unit.trim())
    });
    match fem_io::units::parse_as(&spaced, fem_core::plugin::Dimension::TIME) {
        Ok(seconds) if seconds > 0.0 => Ok(seconds),
        Ok(_) => Err("must be longer than zero".into()),
        Err(why) => Err(why.to_string()),
    }
}

/// A key of the scene and the value that it takes.
type Assignment = (String, String);

/// `key=value`.
fn assignment(text: &str) -> Result<Assignment, String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok((key.trim().to_owned(), value.trim().to_owned())),
        _ => Err("write a key of the scene and its value: 'impactor.velocity=2 m/s'".into()),
    }
}

/// The scene of a command.
#[derive(Debug, clap::Args)]
struct SceneFile {
    /// Scene file (TOML), or `-` for standard input; its mesh is looked for beside it
    #[arg(value_name = "SCENE")]
    path: PathBuf,
    /// Sets a key of the scene, for example impactor.velocity=2 or 'laminate.plies=[0/90]4s'; a number without unit has that of
    /// the scene. May be given again for other keys
    #[arg(long, value_name = "KEY=VALUE", value_parser = assignment)]
    set: Vec<Assignment>,
}

impl SceneFile {
    /// It with what is `set` in it; the mesh of one on standard input is looked for in the working folder.
    fn read(&self) -> Result<Scene, Error> {
        if self.path.as_os_str() != "-" {
            return Ok(scene::read_words(&self.path, &self.set)?);
        }
        let mut text = String::new();
        std::io::stdin().take(MOST_BYTES).read_to_string(&mut text).map_err(Error::Input)?;
        Ok(scene::parse_words(&text, Path::new("standard input"), &self.set)?)
    }
}

/// Low-velocity impact on laminated composites.
#[derive(Debug, Parser)]
#[command(
    name = "fem",
    version,
    arg_required_else_help = true,
    after_help = "To begin with:\n  fem new coupon && fem run coupon/scene.toml"
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    voice: Voice,
    #[command(flatten)]
    keep: Keep,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Creates a folder with a first scene, every key explained.
    ///
    /// The scene runs at once. Keys that it leaves out are there as comments, with the values that hold without them.
    /// Beside it lies a JSON Schema, by which editors complete and check the scene.
    New(new::Arguments),
    /// Computes a scene: force history, stresses, first damage.
    ///
    /// Prints a summary and writes summary.json, cost.json, history.csv, events.csv, scene.toml, damage.json, and pictures of
    /// forces, displacements, energies and damage as SVG and PNG; modes, and failure indices over time and over the plate,
    /// where the scene asks for them. Fails, and keeps what it had, when the march meets a number that is not finite or loses
    /// its energy balance. Writes a checkpoint now and then, at the end and when it is stopped (Ctrl-C, SIGTERM, SIGHUP: exit
    /// status 130, 143, 129), from which `--resume` goes on.
    Run(run::Arguments),
    /// Validates a scene with its mesh and prints sizes; marches nothing.
    Check(check::Arguments),
    /// Says which effects an impact calls for, before it is computed: regime, membrane, contact, shear, delamination, mesh.
    ///
    /// Each answer with its number, threshold and source, the error without the effect and the cost with it. Solves for the
    /// plate at rest once, marches nothing, writes nothing.
    Advise(advise::Arguments),
    /// Draws and tabulates failure envelopes of a material.
    Envelope(envelope::Arguments),
    /// Shows a laminate: A, B, D, moduli, couplings, what warmth and loads do, and which ply fails first.
    ///
    /// By classical laminate theory, of plies that are named or those of a scene. Writes nothing.
    Laminate(laminate::Arguments),
    /// Finds the lowest natural frequencies of a scene's plate and writes modes.csv.
    Modes(modes::Arguments),
    /// Shows what accuracy costs: where the error of a scene comes from, and the cheapest setting for a smaller one.
    ///
    /// Runs the scene along ladders of finer and finer settings, each by itself and the cheapest levels of all together, and
    /// in other ways. Errors count from the finest joint run, extrapolated along every ladder that converges. Says what it
    /// will run, prints tables, writes study.csv, study.md and pictures of errors over time; every run is kept at once in
    /// study.bin, from which `--resume` goes on.
    Study(study::Arguments),
    /// Runs many cases of a scene: any of its keys over lists, ranges and distributions, one table.
    ///
    /// Cases that differ only in the impactor, the contact and strengths share their plate, so that each takes its march alone; the
    /// rows are those of `fem run`. Writes sweep.csv, sweep.json, cost.csv and pictures. A case that fails has a row that says
    /// why, and the exit status is then 1. Every few seconds what is done is kept in sweep.bin, from which `--resume` goes on.
    Sweep(Box<sweep::Arguments>),
    /// Finds the range of impacts that a plate bears: where damage begins over two keys of a scene, by which mode.
    ///
    /// Computes few impacts, each where the lines are known least, until all lines are known to the tolerance, and says how well
    /// they are. Writes map.json, border.csv, impacts.csv and a picture; over mass and velocity with lines of equal energy. Fails
    /// where an impact fails or the tolerance is not reached.
    Map(map::Arguments),
    /// Makes a page from a folder of results: report.html, which opens from disk.
    ///
    /// One file with everything in it: summary, pictures, curves and damage to move through, events, errors, costs, the scene.
    /// Reads the files of the folder alone.
    Report(report::Arguments),
    /// Shows the plates that are kept for later runs, or removes them.
    Cache(cache::Arguments),
    /// Writes stiffness and mass (Matrix Market) with the names of their unknowns.
    Matrices(matrices::Arguments),
    /// Runs a deck of LAMCEL: condenses a cell of elements on its masters, or prints stresses of its elements.
    Lamcel(deck::Arguments),
    /// Runs a deck of LAMSUB: condenses a plate of stacks of elements on its masters, or prints stresses of its elements.
    Lamsub(deck::Arguments),
    /// Runs a deck of TRADYR: puts pieces together by node numbers and marches an impact.
    Tradyr(deck::TradyrArguments),
    /// Works with decks of LAMCEL, LAMSUB and TRADYR and with what they leave.
    #[command(subcommand)]
    Deck(deck::Command),
    /// Shows a mesh: sizes, groups, quality; writes it for gmsh.
    ///
    /// Of a mesh file or of a scene, with what the scene makes of it. Lengths are printed in `--unit`, JSON is in SI units.
    Mesh(mesh::Arguments),
    /// Lists what a scene can name, with parameters and sources.
    List(list::Arguments),
    /// Prints the JSON Schema of scenes, for editors.
    #[command(after_help = "In the first line of a scene: #:schema ./scene.schema.json")]
    Schema,
    /// Prints a script that completes this command line in a shell.
    Completions(manual::CompletionsArguments),
    /// Prints the manual page, or writes one per command.
    Man(manual::ManArguments),
}

/// Runs the command line of this process with the plug-ins of `registry`.
pub fn main(registry: Registry) -> ExitCode {
    run_with(registry, std::env::args_os())
}

/// Runs the command line `arguments` (the first is the program's name).
///
/// Results go to standard output, with `--json` as one document; everything else to standard error. The exit status is 0 only when what was asked was
/// done, 1 when it was not, 2 for a command line that makes no sense.
pub fn run_with(registry: Registry, arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    let console = Console::new(arguments.voice);
    let registry = registry.with_cache(arguments.keep.cache());
    let done = arguments.voice.logging(|| dispatch(&registry, &arguments.command, &console));
    registry.cache().into_iter().flat_map(Cache::words).for_each(|word| console::tell(&format!("{word}\n")));
    match done.and_then(|code| console.close().map(|()| code)) {
        Ok(code) => code,
        Err(report) => {
            messages::print_report(&report, arguments.voice);
            ExitCode::FAILURE
        }
    }
}

fn dispatch(registry: &Registry, command: &Command, console: &Console) -> miette::Result<ExitCode> {
    match command {
        Command::New(a) => new::new(registry, a, console),
        Command::Run(a) => run::run(registry, a, console),
        Command::Check(a) => check::check(registry, a, console),
        Command::Envelope(a) => envelope::envelope(registry, a, console),
        Command::Advise(a) => advise::advise(registry, a, console),
        Command::Laminate(a) => laminate::laminate(registry, a, console),
        Command::Modes(a) => modes::modes(registry, a, console),
        Command::Study(a) => study::study(registry, a, console),
        Command::Sweep(a) => sweep::sweep(registry, a, console),
        Command::Map(a) => map::map(registry, a, console),
        Command::Report(a) => report::report(registry, a, console),
        Command::Mesh(a) => mesh::mesh(a, console),
        Command::Cache(a) => cache::cache(a, console),
        Command::Matrices(a) => matrices::matrices(registry, a, console),
        Command::Lamcel(a) => deck::piece(registry, Program::Lamcel, a, console),
        Command::Lamsub(a) => deck::piece(registry, Program::Lamsub, a, console),
        Command::Tradyr(a) => deck::tradyr(registry, a, console),
        Command::Deck(a) => deck::deck(a, console),
        Command::List(a) => list::list(registry, a, console),
        Command::Schema => schema::schema(registry, console),
        Command::Completions(a) => manual::completions(a, console),
        Command::Man(a) => manual::man(a, console),
    }
}
