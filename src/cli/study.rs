//! `fem study`.

use super::run::default_folder;
use super::{print, progress};
use crate::error::Error;
use crate::registry::Registry;
use crate::study::{self, Axis, Setting};
use clap::Args;
use clap::builder::PossibleValuesParser;
use fem_io::files::OutputDir;
use fem_io::scene;
use std::path::PathBuf;
use std::process::ExitCode;

/// Step of the reference over that of the scene.
const REFERENCE_STEP: f64 = 0.25;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file (TOML) of an impact.
    scene: PathBuf,
    /// What is varied [default: everything]
    #[arg(long, value_delimiter = ',', value_name = "AXES", value_parser = PossibleValuesParser::new(Axis::ALL.map(Axis::name)))]
    axis: Vec<String>,
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
    let asked = |axis: &Axis| arguments.axis.is_empty() || arguments.axis.iter().any(|name| name == axis.name());
    let settings: Vec<Setting> =
        Axis::ALL.iter().filter(|axis| asked(axis)).flat_map(|axis| axis.settings(registry, step)).collect();
    let folder = arguments.out.clone().unwrap_or_else(|| {
        let mut folder = default_folder(path).into_os_string();
        folder.push("-study");
        folder.into()
    });
    let bar = progress(settings.len() as u64 + 1, "study {bar:40} {pos}/{len}  {msg}");
    bar.set_message("reference");
    let reference = study::run(path, &study::full(REFERENCE_STEP * step), registry)?;
    let dir = OutputDir::create(folder)?;
    let mut rows = Vec::new();
    for setting in &settings {
        bar.inc(1);
        bar.set_message(setting.label.clone());
        rows.push(study::compare(path, setting, registry, &reference));
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
