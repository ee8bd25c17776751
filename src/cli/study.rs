//! `fem study`.

use super::run::default_folder;
use super::{Console, Format, SceneFile};
use crate::error::Error;
use crate::job;
use crate::model::Model;
use crate::registry::Registry;
use crate::study::{self, ErrorBar, Progress, Report, Session};
use clap::Args;
use fem_core::plugin::Dimension;
use fem_io::scene::{self, Scene, Setting};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem study coupon/scene.toml --axis mesh,step --budget 60s --tolerance 1%")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneFile,
    /// What is varied, of mesh, layers, reduction, step, geometry, z-derivatives, quadrature, reductions, integrators,
    /// element, mass, contact, window and the scene's own axes [default: what the scene says, or all that fit it]
    #[arg(long, value_delimiter = ',', value_name = "AXES")]
    axis: Vec<String>,
    /// Processor time that the study may take, for example 60s or 10min; what is run then depends on the machine
    /// [default: four minutes of a common machine, the same runs everywhere]
    #[arg(long, value_name = "TIME", value_parser = super::time)]
    budget: Option<f64>,
    /// Writes scene.toml, the scene with the cheapest setting whose error is within this, for example 1% or 0.003
    #[arg(long, value_name = "ERROR", value_parser = scene::parse_share)]
    tolerance: Option<f64>,
    /// Continues the study in the folder of the results; what has run there is not run again
    #[arg(long)]
    resume: bool,
    /// Folder of the results [default: results/<folder of the scene>-study]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

pub(super) fn study(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let format = arguments.format;
    let scene = arguments.scene.read()?;
    let model = Model::new(&scene, registry)?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scene.path, "-study"));
    let axes = study::axes(&scene, &model, registry, &arguments.axis)?;
    for name in arguments.axis.iter().filter(|name| axes.iter().all(|axis| axis.name != **name)) {
        console.say(format, || format!("  the axis `{name}` is left out: this scene has no two levels of it\n"));
    }
    let dir = job::folder::results(&folder, &model.origin.source).map_err(Error::from)?;
    let mut session = Session::open(&scene, &model, registry, dir, arguments.resume)?;
    let progress = console.progress("study", "study {bar:40} {percent:>3} %  {msg}");
    let found = session.found();
    if found > 0 {
        console.say(format, || format!("  {found} runs are there from before\n"));
    }
    let mut tell = |told: Progress<'_>| match told {
        Progress::Planned(plan) => progress.suspend(|| console.say(format, || format!("{plan}\n"))),
        Progress::Together([]) => {}
        Progress::Together(runs) => {
            let each: String =
                runs.iter().map(|r| format!("\n    {} ({})", r.level.label, Dimension::TIME.of(r.seconds))).collect();
            progress.suspend(|| console.say(format, || format!("  ladders climbed; now together:{each}\n\n")));
        }
        Progress::Runs { what, share } => {
            progress.share(share);
            progress.message(&what);
        }
    };
    let report = study::study(&mut session, &scene, &model, &axes, arguments.budget, &mut tell, &mut ())?;
    progress.finish();
    study::write_results(session.dir(), &report)?;
    console.say(format, || study::text(&report));
    let cheapest = arguments.tolerance.and_then(|tolerance| cheapest(&report, tolerance));
    if let Some(setting) = cheapest {
        write_scene(&session, &scene, setting)?;
    }
    session.dir().remove_older().map_err(Error::from)?;
    console.say(format, || describe_cheapest(&session, arguments.tolerance, cheapest, &report));
    let data = study::Document::new(&report, cheapest, session.dir().path());
    console.show(format, &data, || format!("\n  results   {}\n", session.dir().path().display()))?;
    let kept = arguments.tolerance.is_none() || cheapest.is_some();
    Ok(if kept { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The cheapest setting that keeps `tolerance` in all quantities.
fn cheapest(report: &Report, tolerance: f64) -> Option<&Setting> {
    let all: Vec<usize> = (0..report.asked.len()).collect();
    report.cheapest(&all, tolerance).map(|row| &row.level.setting)
}

/// Writes the scene with `setting`.
fn write_scene(session: &Session<'_>, scene: &Scene, setting: &Setting) -> Result<(), Error> {
    let text = scene::rewrite(&scene.source, setting)?;
    Ok(session.dir().write("scene.toml", |out| out.write_all(text.as_bytes()))?)
}

/// Whether a tolerance, if one was asked for, is kept.
fn describe_cheapest(
    session: &Session<'_>,
    tolerance: Option<f64>,
    cheapest: Option<&Setting>,
    report: &Report,
) -> String {
    match (tolerance, cheapest) {
        (None, _) => String::new(),
        (Some(tolerance), Some(_)) => {
            let file = session.dir().path().join("scene.toml");
            format!("\n  {tolerance} in all quantities is met by {}\n", file.display())
        }
        (Some(tolerance), None) => {
            let best = report.rows.iter().filter_map(|row| row.worst()).map(ErrorBar::most).reduce(f64::min);
            let best = best.filter(|best| best.is_finite());
            let best = best.map_or(String::new(), |best| format!("; the best run may have {best:.1e}"));
            format!(
                "\n  no run is certain to meet {tolerance} in all quantities{best}: allow more time or a larger error\n"
            )
        }
    }
}
