//! `fem lamcel`, `fem lamsub`, `fem tradyr` and `fem deck`.

use super::run::default_folder;
use super::{Console, Format};
use crate::cost::Provenance;
use crate::decks::{self, DeckOptions, DeckOutcome, Project, Shown, UnitSystem};
use crate::envelope::criteria;
use crate::error::Error;
use crate::registry::Registry;
use clap::{Args, Subcommand};
use fem_core::plugin::Dimension;
use fem_io::deck::{DeckSource, Fault, Program};
use fem_io::files::OutputDir;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The deck: lines of items between commas.
    deck: PathBuf,
    /// Folder of the results by name [default: results/<folder of the deck>-project]
    #[arg(long, value_name = "DIR")]
    project: Option<PathBuf>,
    /// What the deck's numbers are called in the listing: force, length, time.
    ///
    /// An impact then leaves tables, a summary, failure and pictures in SI units in a folder named as the deck, of which `fem
    /// report` makes a page.
    #[arg(long, value_parser = units)]
    units: Option<UnitSystem>,
    /// Criteria by name, parameters after colons: of an impact with `--units` those that judge it [default: those of the report];
    /// of back substitution those whose indices are written besides.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    criteria: Vec<String>,
    #[command(flatten)]
    format: Format,
}

/// Units by their name.
fn units(text: &str) -> Result<UnitSystem, String> {
    let known = UnitSystem::ALL.iter().find(|(name, _)| name.eq_ignore_ascii_case(text));
    known
        .map(|(_, units)| *units)
        .ok_or_else(|| format!("known are {}", UnitSystem::ALL.map(|(name, _)| name).join(", ")))
}

#[derive(Serialize)]
struct Done<'a> {
    deck: String,
    #[serde(flatten)]
    outcome: &'a DeckOutcome,
    project: &'a Path,
}

#[derive(Debug, Args)]
pub(super) struct TradyrArguments {
    #[command(flatten)]
    deck: Arguments,
    /// Displacement set whose analysis a restart goes on with [default: the last analysis]
    #[arg(long, value_name = "NAME")]
    restart_of: Option<String>,
}

/// Criteria that judge an impact where none are asked for: eqs 38 to 42.
const OF_REPORT: [&str; 2] = ["hashin-report", "octahedral"];

pub(super) fn tradyr(registry: &Registry, arguments: &TradyrArguments, console: &Console) -> miette::Result<ExitCode> {
    let TradyrArguments { deck, restart_of } = arguments;
    let of_report = || OF_REPORT.map(str::to_owned).to_vec();
    let asked = if deck.criteria.is_empty() { of_report() } else { deck.criteria.clone() };
    if !deck.criteria.is_empty() && deck.units.is_none() {
        let help = "give `--units` as well: what judges an impact has to know what its numbers mean";
        let found = "`--criteria` judges nothing without `--units`";
        return Err(DeckSource::read(&deck.deck)?.error(0..0, Fault::NoUnits, found, help).into());
    }
    let criteria = criteria(registry, &asked, None)?;
    let options = DeckOptions { restart_of: restart_of.clone(), criteria, ..DeckOptions::default() };
    run(Program::Tradyr, deck, options, console)
}

pub(super) fn piece(
    registry: &Registry,
    program: Program,
    arguments: &Arguments,
    console: &Console,
) -> miette::Result<ExitCode> {
    let criteria = criteria(registry, &arguments.criteria, None)?;
    run(program, arguments, DeckOptions { criteria, ..DeckOptions::default() }, console)
}

fn run(program: Program, arguments: &Arguments, options: DeckOptions, console: &Console) -> miette::Result<ExitCode> {
    let source = DeckSource::read(&arguments.deck)?;
    let folder = arguments.project.clone().unwrap_or_else(|| default_folder(&arguments.deck, "-project"));
    let mut project = Project::open(&folder).map_err(Error::from)?;
    let provenance = Some(Provenance::of(source.name()));
    let options = DeckOptions { units: arguments.units, provenance, ..options };
    let outcome = decks::run(&source, program, &mut project, &options)?;
    console.warn(&outcome.warnings);
    let done = Done { deck: source.name().to_owned(), outcome: &outcome, project: &folder };
    console.show(arguments.format, &done, || text(&outcome, &folder))?;
    Ok(ExitCode::SUCCESS)
}

fn text(outcome: &DeckOutcome, folder: &Path) -> String {
    let mut text = format!("{}\n", outcome.title);
    for (name, count) in &outcome.counts {
        let _ = writeln!(text, "  {name:<22}{count:>9}");
    }
    if !outcome.analysed {
        text.push_str("  data check only: NCHECK is 0\n");
    }
    if let Some(impact) = &outcome.impact {
        let i = &impact.impact;
        let _ = writeln!(
            text,
            "  force     peak {} at {}; deflection {}; {} contact{}",
            Dimension::FORCE.of(i.peak_force_N),
            Dimension::TIME.of(i.peak_force_time_s),
            Dimension::LENGTH.of(i.peak_plate_displacement_m),
            i.contacts,
            if i.contacts == 1 { "" } else { "s" }
        );
        for first in &impact.first_damage {
            let event = &first.event;
            let _ = writeln!(
                text,
                "  damage    {:>9}  {} {}, substructure {} element {} ply {}",
                Dimension::TIME.of(event.time_s),
                event.criterion,
                event.mode,
                event.substructure.unwrap_or_default(),
                event.cell,
                event.ply
            );
        }
    }
    if let Some(error) = outcome.energy_error {
        let _ = writeln!(text, "  energy    error {error:.1e} of that of the impact");
    }
    if outcome.analysed && outcome.impact.is_none() && outcome.counts.iter().any(|(name, _)| *name == "governors") {
        text.push_str(
            "  units     not named: with `--units` history, failure and pictures are written in SI units as well\n",
        );
    }
    let _ = writeln!(text, "  project   {}", folder.display());
    for file in &outcome.files {
        let _ = writeln!(text, "            {file}");
    }
    text
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Checks all decks of a folder, in the order in which they need each other; writes nothing.
    ///
    /// Generations come first, then analyses, restarts and back substitutions. Everything is done but the march in time. The
    /// exit status is 0 where all decks are good.
    Check(CheckArguments),
    /// Says what lies in a project under a name: matrices with their masters, displacements with their print steps.
    Show(NamedArguments),
    /// Writes a result for other programs: K, M and masters as Matrix Market, NumPy and CSV files, displacements as NumPy files.
    Export(ExportArguments),
}

#[derive(Debug, Args)]
pub(super) struct NamedArguments {
    /// Name of the result: NAME6 of a generation or NAME1 of an analysis.
    name: String,
    /// Folder of the results by name.
    #[arg(long, value_name = "DIR", default_value = ".")]
    project: PathBuf,
    #[command(flatten)]
    format: Format,
}

#[derive(Debug, Args)]
pub(super) struct ExportArguments {
    #[command(flatten)]
    named: NamedArguments,
    /// Folder of what is exported [default: that of the project]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// Folder of decks: its files that end in .dat or .deck.
    folder: PathBuf,
    #[command(flatten)]
    format: Format,
}

pub(super) fn deck(command: &Command, console: &Console) -> miette::Result<ExitCode> {
    match command {
        Command::Check(arguments) => check(arguments, console),
        Command::Show(arguments) => show(arguments, console),
        Command::Export(arguments) => export(arguments, console),
    }
}

fn show(arguments: &NamedArguments, console: &Console) -> miette::Result<ExitCode> {
    let project = Project::open(&arguments.project).map_err(Error::from)?;
    let shown = decks::show(&project, &arguments.name)?;
    console.show_plain(arguments.format, &shown, || shown.iter().map(described).collect())?;
    Ok(ExitCode::SUCCESS)
}

fn described(shown: &Shown) -> String {
    match shown {
        Shown::Matrices { name, deck, program, names, elements, masters, checksum } => format!(
            "{name}: matrices of {} masters, {elements} elements\n  {program}   {deck}\n  names     {}\n  masters   {}\n  checksum  \
             {checksum}\n",
            masters.len(),
            names[..5].join(", "),
            masters.join(", "),
        ),
        Shown::Displacements { name, deck, substructures, print_steps, last_time, stale } => format!(
            "{name}: displacements of {print_steps} print steps to {last_time:.6e}\n  TRADYR   {deck}\n  made of   {}\n{}",
            substructures.join(", "),
            stale.as_ref().map_or(String::new(), |why| format!("  stale     {why}\n"))
        ),
    }
}

#[derive(Serialize)]
struct Exported<'a> {
    files: &'a [String],
    folder: &'a Path,
}

fn export(ExportArguments { named, out }: &ExportArguments, console: &Console) -> miette::Result<ExitCode> {
    let project = Project::open(&named.project).map_err(Error::from)?;
    let other = out.as_ref().map(OutputDir::open).transpose().map_err(Error::from)?;
    let Some(dir) = other.as_ref().or(project.dir()) else { return Ok(ExitCode::FAILURE) };
    let files = decks::export(&project, &named.name, dir)?;
    let done = Exported { files: &files, folder: dir.path() };
    console.show(named.format, &done, || format!("{}\n  results   {}\n", files.join("\n"), dir.path().display()))?;
    Ok(ExitCode::SUCCESS)
}

fn check(arguments: &CheckArguments, console: &Console) -> miette::Result<ExitCode> {
    let checked = decks::check(&arguments.folder)?;
    let good = checked.iter().all(|deck| deck.error.is_none());
    console.show_plain(arguments.format, &checked, || {
        let mut text = String::new();
        for deck in &checked {
            let what = deck.error.as_ref().map_or_else(
                || "good".to_owned(),
                |fault| format!("line {}: {}\n{:>12}{}", fault.line, fault.message, "", fault.remedy),
            );
            let _ = writeln!(text, "{} ({}): {what}", deck.deck, deck.program);
            deck.warnings.iter().for_each(|warning| {
                let _ = writeln!(text, "{:>12}warning: {warning}", "");
            });
        }
        text
    })?;
    Ok(if good { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
