//! `fem map`.

use super::run::default_folder;
use super::signals::Signals;
use super::{Assignment, Console, Format, console};
use crate::error::Error;
use crate::job::folder;
use crate::map::{self, BorderMap, MapFound, MapRecord, MapRequest};
use crate::registry::Registry;
use clap::Args;
use fem_io::files::OutputDir;
use fem_io::scene;
use miette::miette;
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fem map coupon/scene.toml --set impactor.mass=0.5..8 --set impactor.velocity=0.3..3\n  \
                  fem map coupon/scene.toml --set 'laminate.plies=[0/90]4s,[45/-45]4s' --set 'impactor.energy=0.5..8 J'\n  \
                  fem map coupon/scene.toml --set 'impactor.at.x=-15..15 mm' --set 'impactor.at.y=-15..15 mm' --tolerance 5%"
)]
pub(super) struct Arguments {
    /// Scene file (TOML)
    scene: PathBuf,
    /// What a key of the scene becomes: a range `0.5..8` for two keys, or for one beside a list `a,b` of another; one value for any
    /// other. A number without unit has that of the scene [default: mass and velocity from a quarter to four times those of the scene]
    #[arg(long, value_name = "KEY=VALUES", value_parser = super::assignment)]
    set: Vec<Assignment>,
    /// Error of the lines: relative for a range whose ends are 3 times apart or more, a share of any other
    #[arg(long, value_name = "ERROR", default_value = "1%", value_parser = scene::parse_share)]
    tolerance: f64,
    /// Most impacts that are computed, for each value of a list
    #[arg(long, value_name = "N", default_value = "100", value_parser = super::samples)]
    impacts: usize,
    /// Impacts that are marched at a time; the map does not depend on it
    #[arg(long, value_name = "N", default_value = "1", value_parser = super::threads)]
    threads: NonZeroUsize,
    /// Continues the map in the folder of the results; impacts that are there are not computed again
    #[arg(long)]
    resume: bool,
    /// Folder of the results [default: results/<folder of the scene>-map]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

pub(super) fn map(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let Arguments { scene: path, set, tolerance, impacts, threads, resume, out, format } = arguments;
    if path.as_os_str() == "-" {
        return Err(miette!(help = "give the scene as a file", "a map takes no scene on standard input"));
    }
    let scene = scene::read(path)?;
    let asked = MapRequest { set: set.clone(), tolerance: *tolerance, most: *impacts };
    let over = BorderMap::new(&scene, registry, &asked)?;
    let folder = out.clone().unwrap_or_else(|| default_folder(path, "-map"));
    let known = if *resume { over.saved(&folder)? } else { Vec::new() };
    let dir = folder::results(&folder, &scene.source).map_err(Error::from)?;
    dir.begin_run();
    let signals = Signals::listen();
    let progress = console.progress("map", "map {bar:40} {msg}");
    let most = impacts * over.list.as_ref().map_or(1, |(_, values)| values.len());
    let found = over.run(&dir, &known, *threads, &mut |done| {
        progress.share(done as f64 / most as f64);
        progress.message(&format!("{done} impacts, at most {most}"));
        if signals.received().is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    progress.finish();
    let record = MapRecord::new(&over, &found);
    map::write_map(&dir, &over, &found, &record)?;
    if scene.output.plots {
        let picture = map::write_map_picture(&dir, &over, &found)?;
        map::write_map_page(&dir, &over, &found, &record, picture)?;
    }
    dir.remove_older().map_err(Error::from)?;
    console.show_plain(*format, &record, || text(&record, &found, &dir))?;
    if let Some(signal) = signals.received() {
        console::tell("Stopped by a signal. To continue: the same command with --resume\n");
        return Ok(ExitCode::from(128 + signal));
    }
    if !record.reached {
        console::tell("Not all lines are known to the tolerance: allow more with --impacts, or a larger --tolerance\n");
    }
    Ok(if record.reached && record.failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// What a map says of itself.
fn text(record: &MapRecord, found: &MapFound, dir: &OutputDir) -> String {
    let mut text = format!("{}\n", record.title);
    let _ = writeln!(text, "  map       over {}", record.axes.join(" and "));
    let _ = writeln!(text, "  impacts   {} computed, {} failed", record.impacts, record.failed);
    for line in &record.lines {
        let off = line
            .error
            .map_or_else(|| "nobody knows how well".to_owned(), |error| format!("known to {:.2} %", 1e2 * error));
        let of = line.value.as_ref().map_or_else(String::new, |value| format!("{value}: "));
        let from = match &line.points[..] {
            [point, ..] if point.len() == 1 => format!(" at {:.4},", point[0]),
            _ => String::new(),
        };
        let _ = writeln!(text, "  line      {of}{}{from} {off}", line.name);
    }
    let nowhere = |name: &&String| !record.lines.iter().any(|line| line.name == **name);
    for name in found.names.iter().filter(nowhere) {
        let _ = writeln!(text, "  line      {name}: nowhere on the map");
    }
    for point in found.points.iter().filter(|point| point.result.is_err()).take(3) {
        let why = point.result.as_ref().err().map_or("", String::as_str);
        let _ = writeln!(text, "  failed    {:?}: {why}", point.values);
    }
    let _ = writeln!(text, "  results   {}", dir.path().display());
    text
}
