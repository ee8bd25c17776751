//! `fem study`.

use super::print;
use super::run::default_folder;
use crate::error::Error;
use crate::registry::Registry;
use crate::study::{self, Axis, Setting};
use clap::Args;
use fem_io::files::OutputDir;
use fem_io::scene;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::PathBuf;
use std::process::ExitCode;

/// Step of the reference over that of the scene.
const REFERENCE_STEP: f64 = 0.25;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file (TOML) of an impact.
    scene: PathBuf,
    /// What is varied [default: everything]
    #[arg(long, value_delimiter = ',', value_name = "AXES")]
    axis: Vec<Axis>,
    /// Folder of the results [default: results/<folder of the scene>-study]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn study(registry: &Registry, arguments: &Arguments) -> miette::Result<ExitCode> {
    Ok(compute(registry, arguments)?)
}

fn compute(registry: &Registry, arguments: &Arguments) -> Result<ExitCode, Error> {
    let path = &arguments.scene;
    let step = scene::read(path)?.impact().ok_or(Error::NoImpact)?.march.step.value;
    let axes: &[Axis] = if arguments.axis.is_empty() { &[Axis::Reduction, Axis::Integrator] } else { &arguments.axis };
    let settings: Vec<Setting> = axes.iter().flat_map(|axis| axis.settings(registry, step)).collect();
    let folder = arguments.out.clone().unwrap_or_else(|| {
        let mut folder = default_folder(path).into_os_string();
        folder.push("-study");
        folder.into()
    });
    let bar = ProgressBar::new(settings.len() as u64 + 1).with_style(style());
    bar.set_message("reference");
    let reference = study::run(path, &study::full(REFERENCE_STEP * step), registry)?;
    let dir = OutputDir::create(folder)?;
    let mut rows = Vec::new();
    for setting in &settings {
        bar.inc(1);
        bar.set_message(setting.label.clone());
        rows.push(study::row(setting, &study::run_under(path, setting, registry), &reference));
        study::write(&dir, &rows)?;
    }
    bar.finish_and_clear();
    print(&format!(
        "Errors against the full model of {} unknowns at steps of {:.4} us ({:.1} s of processor time)\n\n{}\n  results   {}\n",
        reference.unknowns[0],
        reference.step * 1e6,
        reference.setup_s + reference.march_s,
        study::text(&rows),
        dir.path().display()
    ));
    Ok(ExitCode::SUCCESS)
}

/// A bar on a terminal, nothing elsewhere.
fn style() -> ProgressStyle {
    let style = ProgressStyle::with_template("study {bar:40} {pos}/{len}  {msg}");
    style.unwrap_or_else(|_| ProgressStyle::default_bar())
}
