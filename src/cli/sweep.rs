//! `fem sweep`.

mod parts;

use super::run::{compute, default_folder};
use super::signals::Signals;
use super::{Assignment, Console, Format, console};
use crate::error::Error;
use crate::job::{Options, Results, folder};
use crate::registry::Registry;
use crate::sweep::{self, Engine, Record, Scatter, Sweep, SweepRequest};
use clap::{Args, Subcommand};
use fem_io::files::{OutputDir, is_own};
use fem_io::scene;
use miette::miette;
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Examples:\n  fem sweep coupon/scene.toml --set impactor.velocity=1..5:9 --threads 4\n  \
                  fem sweep coupon/scene.toml --set 'laminate.plies=[0/90]4s,[45/-45]4s' --set impactor.mass=1..3:5\n  \
                  fem sweep coupon/scene.toml --set 'materials.cfrp.Yt=normal(50 MPa, 8 %)' --samples 300\n  \
                  fem sweep show results/coupon-sweep 7"
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    /// Scene file (TOML)
    #[arg(required = true)]
    scene: Option<PathBuf>,
    /// What a key of the scene becomes: a list `a,b`, a range `1..5:9` of nine values, a range `1..5` for samples, or normal,
    /// lognormal, weibull, uniform, as in 'normal(50 MPa, 8 %) within 30..70'. A number without unit has that of the scene. May
    /// be given again for other keys, and goes over those of the table `[sweep]`
    #[arg(long, value_name = "KEY=VALUES", value_parser = super::assignment)]
    set: Vec<Assignment>,
    /// How cases are chosen; `saltelli` for Sobol's indices, which say what matters [default: what the scene says, or a grid, or random where numbers scatter]
    #[arg(long, value_name = "DESIGN", value_parser = ["grid", "random", "latin-hypercube", "sobol", "saltelli"])]
    design: Option<String>,
    /// How many cases a design of samples has [default: what the scene says, or 100]
    #[arg(long, value_name = "N", value_parser = super::samples)]
    samples: Option<usize>,
    /// What random numbers follow from [default: what the scene says, or 1]
    #[arg(long, value_name = "SEED")]
    seed: Option<u64>,
    /// Correlation of two keys that scatter, between -1 and 1, for example materials.cfrp.Yt,materials.cfrp.S12=0.6; once a pair
    #[arg(long, value_name = "KEY,KEY=R")]
    correlate: Vec<String>,
    /// A formula of columns of the table and keys that vary, as a column of its own: 'lost = absorbed_energy / energy'. May be given again
    #[arg(long, value_name = "NAME=FORMULA")]
    quantity: Vec<String>,
    /// Two quantities that cases are weighed by: those that no other case beats are marked and drawn
    #[arg(long, value_name = "'least FORMULA, most FORMULA'")]
    pareto: Option<String>,
    /// Cases that are marched at a time; the table does not depend on it [default: one on each core, as far as their plates fit the
    /// memory; one of a part]
    #[arg(long, value_name = "N", value_parser = super::threads)]
    threads: Option<NonZeroUsize>,
    /// Continues the sweep in the folder of the results; cases that are there are not run again
    #[arg(long)]
    resume: bool,
    /// Runs part K of N alone, in a folder of its own in that of the results, for another process or machine
    #[arg(long, value_name = "K/N", value_parser = part, conflicts_with = "gather")]
    part: Option<(usize, usize)>,
    /// Runs nothing: makes the table of the parts in the folder of the results
    #[arg(long)]
    gather: bool,
    /// Runs nothing: prints the cases
    #[arg(long, conflicts_with_all = ["part", "gather", "resume"])]
    expand: bool,
    /// Has a scheduler run the parts, waits for them, gives out again what was lost, and makes the table
    #[arg(long, value_name = "ENGINE", value_parser = ["slurm", "hyperqueue"], conflicts_with_all = ["part", "gather", "expand"])]
    engine: Option<String>,
    /// How many parts the scheduler is given [default: 16, or as many as there are cases]
    #[arg(long, value_name = "N", value_parser = super::samples, requires = "engine")]
    parts: Option<usize>,
    /// An option for the scheduler, as in --engine-option=--partition=short. May be given again
    #[arg(long, value_name = "OPTION", requires = "engine", allow_hyphen_values = true)]
    engine_option: Vec<String>,
    /// Folder of the results [default: results/<folder of the scene>-sweep]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Runs a case of a sweep whole, as `fem run` does.
    Show(ShowArguments),
}

#[derive(Debug, Args)]
struct ShowArguments {
    /// Folder of the results of the sweep
    results: PathBuf,
    /// The case, a number of the first column of sweep.csv
    case: NonZeroUsize,
    /// Folder of the results [default: case-<CASE> in that of the sweep]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

/// `k/n`.
fn part(text: &str) -> Result<(usize, usize), String> {
    let part = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    part.filter(|(k, n)| (1..=*n).contains(k)).ok_or_else(|| "write it as in 1/4, the first of four".into())
}

pub(super) fn sweep(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    if let Some(Command::Show(arguments)) = &arguments.command {
        return show(registry, arguments, console);
    }
    let Some(path) = arguments.scene.as_deref().filter(|path| path.as_os_str() != "-") else {
        let help = "give the scene as a file: `fem sweep show` reads it again";
        return Err(miette!(help = help, "a sweep takes no scene on standard input"));
    };
    let scene = scene::read(path)?;
    let Arguments { set, design, samples, seed, correlate, quantity, pareto, .. } = arguments;
    let asked = SweepRequest {
        set: set.clone(),
        design: design.clone(),
        samples: *samples,
        seed: *seed,
        correlate: correlate.clone(),
        quantities: quantity.clone(),
        pareto: pareto.clone(),
    };
    let sweep = Sweep::new(&scene, registry, &asked)?;
    if arguments.expand {
        console.print(&expanded(&sweep));
        return Ok(ExitCode::SUCCESS);
    }
    let whole = arguments.out.clone().unwrap_or_else(|| default_folder(path, "-sweep"));
    let out = arguments.part.map_or(whole.clone(), |part| sweep::part_folder(&whole, part));
    let signals = Signals::listen();
    let engine = Engine::ALL.iter().find(|(name, _)| Some(*name) == arguments.engine.as_deref());
    if let Some((_, engine)) = engine {
        parts::run(*engine, &sweep, arguments, (path, &whole), console, &signals)?;
    }
    let gathered = arguments.gather || engine.is_some();
    let mut rows = match (gathered, arguments.resume) {
        (true, _) => sweep.gather(&whole)?,
        // A part that nobody has begun begins.
        (false, true) if arguments.part.is_none() || is_own(&out) => sweep.saved(&out)?,
        (false, _) => Vec::new(),
    };
    if arguments.gather && rows.is_empty() {
        let help = "run them first: `fem sweep SCENE --part 1/4`";
        return Err(miette!(help = help, "`{}` holds no parts of this sweep", whole.display()));
    }
    // Beside the parts that are gathered.
    let dir = if gathered { OutputDir::open(&out) } else { folder::results(&out, &scene.source) };
    let dir = dir.map_err(Error::from)?;
    dir.begin_run();
    let cases = if gathered { Vec::new() } else { sweep.part(arguments.part) };
    if !rows.is_empty() && !gathered {
        console.say(arguments.format, || format!("  {} cases are there from before\n", rows.len()));
    }
    let threads = match (arguments.threads, arguments.part) {
        (Some(threads), _) => threads,
        (None, Some(_)) => NonZeroUsize::MIN,
        (None, None) => sweep.workers()?,
    };
    let progress = console.progress("sweep", "sweep {bar:40} {percent:>3} %  {msg}  {eta} left");
    let run = sweep.run(&dir, &cases, threads, &mut rows, &mut |done| {
        progress.share(done as f64 / cases.len().max(1) as f64);
        progress.message(&format!("{done} of {}", cases.len()));
        if signals.received().is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    progress.finish();
    if let Err(source) = run {
        if !rows.is_empty() && !arguments.gather {
            console::tell(
                "What was saved is kept. To continue once the error is mended: the same command with --resume\n",
            );
        }
        return Err(source.into());
    }
    let record = Record::new(&scene, path, asked, &sweep, &rows);
    sweep::write(&dir, &sweep, &rows, &record)?;
    if scene.output.plots {
        let pictures = sweep::write_pictures(&dir, &scene.title, &sweep, &rows, &record)?;
        sweep::write_page(&dir, &scene.title, &sweep, &rows, pictures)?;
    }
    dir.remove_older().map_err(Error::from)?;
    console.show_plain(arguments.format, &record, || text(&sweep, &record, &rows, &dir))?;
    let expected = if gathered { sweep.design.count } else { cases.len() };
    if let Some(signal) = signals.received() {
        console::tell(&format!(
            "Stopped by a signal after {} of {expected} cases. To continue: the same command with --resume\n",
            rows.len()
        ));
        return Ok(ExitCode::from(128 + signal));
    }
    if rows.len() < expected {
        console::tell(&format!(
            "{} of {expected} cases are missing: run the parts that lack, with --resume\n",
            expected - rows.len()
        ));
    }
    Ok(if record.failed == 0 && rows.len() >= expected { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Cases that are named in a line.
const FEW: usize = 12;

/// The cases as a table of what they set.
fn expanded(sweep: &Sweep<'_>) -> String {
    let keys: Vec<&str> = sweep.design.axes.iter().map(|axis| axis.key.as_str()).collect();
    let mut text = format!("case\t{}\n", keys.join("\t"));
    for case in 0..sweep.design.count {
        let _ = writeln!(text, "{}\t{}", case + 1, sweep.design.case(case).join("\t"));
    }
    text
}

/// What a sweep says of itself.
fn text(sweep: &Sweep<'_>, record: &Record, rows: &[sweep::CaseRow], dir: &OutputDir) -> String {
    let mut text = format!("{}\n", record.title);
    let keys = record.keys.join(", ");
    let _ = writeln!(text, "  cases     {} of {}, {} over {keys}", record.done, record.cases, record.design);
    let found = || rows.iter().filter_map(|row| row.result.as_ref().ok());
    let peaks = || found().filter_map(|case| case.impactors.first()).map(|impactor| impactor.peak_force);
    let newton = |force: f64| fem_core::plugin::Dimension::FORCE.of(force);
    if let (Some(low), Some(high)) = (peaks().reduce(f64::min), peaks().reduce(f64::max)) {
        let _ = writeln!(text, "  force     peaks from {} to {}", newton(low), newton(high));
        let damaged = found().filter(|case| case.first.is_some()).count();
        let _ = writeln!(text, "  damage    in {damaged} of {} cases", found().count());
    }
    for of in &record.quantities {
        let [low, high] = [of.least, of.most].map(|value| sweep.quantities[of.number].dimension.of(value));
        let _ = writeln!(text, "  quantity  {}: from {low} to {high} in {} cases", of.name, of.cases);
    }
    for of in sweep.quantities.iter().filter(|of| !record.quantities.iter().any(|range| range.name == of.name)) {
        let _ = writeln!(text, "  quantity  {}: in no case a number", of.name);
    }
    if let Some(front) = &record.pareto_front {
        let few = front.iter().take(FEW).map(usize::to_string).collect::<Vec<_>>().join(", ");
        let more = if front.len() > FEW { ", ..." } else { "" };
        let _ = writeln!(text, "  front     no case beats {} of them: {few}{more}", front.len());
    }
    if let Some(scatter) = &record.scatter {
        scattered(&mut text, scatter);
    }
    let first = record.importance.first().map(|of| of.result.as_str());
    for of in record.importance.iter().filter(|of| Some(of.result.as_str()) == first) {
        let (alone, total) = (of.first, of.total);
        let [a, b, c, d] = [of.first_low, of.first_high, of.total_low, of.total_high];
        let _ = writeln!(
            text,
            "  matters   {} of {}: alone {alone:.2} ({a:.2} to {b:.2}), in all {total:.2} ({c:.2} to {d:.2})",
            of.key, of.result
        );
    }
    for row in rows.iter().filter(|row| row.result.is_err()).take(3) {
        let why = row.result.as_ref().err().map_or("", String::as_str);
        let _ = writeln!(text, "  failed    case {}: {why}", row.case);
    }
    let seconds: f64 = rows.iter().map(|row| row.seconds).sum();
    let time = fem_core::plugin::Dimension::TIME;
    let each = time.of(seconds / rows.len().max(1) as f64);
    let _ = writeln!(text, "  time      {} of processor, {each} a case", time.of(seconds));
    let _ = writeln!(text, "  results   {}", dir.path().display());
    text
}

fn scattered(text: &mut String, scatter: &Scatter) {
    for of in scatter.damage.iter().filter(|of| of.cases > 0) {
        let [share, low, high] = [of.probability, of.low, of.high].map(|share| 1e2 * share);
        let _ = writeln!(text, "  share     {}: {share:.1} %, with 95 % confidence {low:.1} to {high:.1} %", of.what);
    }
    for basis in &scatter.bases {
        let force = fem_core::plugin::Dimension::FORCE.of(basis.force_N);
        let how = match basis.method {
            "normal" => format!("mean - {:.3} s, if they are normal", basis.factor),
            _ => format!("number {} from the least, whatever their distribution", basis.factor),
        };
        let _ = writeln!(text, "  {}-basis   force at first damage {force}: {how}", basis.basis);
    }
}

fn show(registry: &Registry, arguments: &ShowArguments, console: &Console) -> miette::Result<ExitCode> {
    let record = sweep::read_record(&arguments.results)?;
    let path = Path::new(&record.scene);
    let scene = scene::read(path)?;
    let sweep = Sweep::new(&scene, registry, &record.asked)?;
    let case = arguments.case.get();
    if case > sweep.design.count {
        let help = format!("cases are numbered from 1 to {}", sweep.design.count);
        return Err(miette!(help = help, "the sweep has no case {case}"));
    }
    let set: Vec<Assignment> = sweep.setting(case - 1).into_iter().collect();
    let out = arguments.out.clone().unwrap_or_else(|| arguments.results.join(format!("case-{case}")));
    let options = Options { results: Results::Folder(out), ..Options::default() };
    compute(registry, &scene::parse_set(scene.source.text(), path, &set)?, options, "", arguments.format, console)
}
