//! `fem report`.

use super::{Console, Format};
use crate::error::Error;
use crate::job;
use crate::output::report::{self, WhatIf};
use crate::registry::Registry;
use clap::Args;
use fem_io::results::{read_document, read_text};
use fem_io::scene;
use miette::miette;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fem report results/coupon --what-if\n  fem report results/coupon --measured drop.csv\n  \
                  fem report results/coupon results/thicker"
)]
pub(super) struct Arguments {
    /// Folders of the results of `fem run`: a single one gets report.html, the first of several comparison.html.
    #[arg(required = true, value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// Table of a measured force over time, laid over the computed one: its first line names the units, `time_ms,force_kN`.
    #[arg(long, value_name = "CSV")]
    measured: Option<PathBuf>,
    /// The page marches impacts of its own: it takes mass, velocity, contact stiffness and strengths from sliders. The plate is made again
    /// for it from the scene in the folder and its mesh.
    #[arg(long)]
    what_if: bool,
    #[command(flatten)]
    format: Format,
}

/// Where the report is.
#[derive(Serialize)]
struct Written {
    report: PathBuf,
}

/// Largest difference of the peak force from that of the run, relative: where it is more, scene or mesh have changed.
const CHANGED: f64 = 1e-9;

pub(super) fn report(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let Arguments { folders, measured, what_if, format } = arguments;
    let what_if = match (what_if, &folders[..]) {
        (false, _) => None,
        (true, [folder]) => Some(of_folder(registry, folder)?),
        (true, _) => return Err(miette!(help = "give one folder", "`--what-if` belongs to the page of one run")),
    };
    let page = report::write(folders, measured.as_deref(), &registry.columns(), what_if.as_ref())?;
    console.show(*format, &Written { report: page.clone() }, || format!("  report    {}\n", page.display()))?;
    if let Some(WhatIf::Missing { why }) = what_if {
        console.say(*format, || format!("  what if   not on the page: {why}\n"));
    }
    Ok(ExitCode::SUCCESS)
}

/// What the page of the results in `folder` marches: their scene, with the mesh beside the scene that was run.
fn of_folder(registry: &Registry, folder: &Path) -> miette::Result<WhatIf> {
    let read = |name: &str| read_document(&folder.join(name)).map_err(Error::from);
    let scene = read_text(&folder.join(report::SCENE)).map_err(Error::from)?;
    let (Some(scene), Some(summary)) = (scene, read("summary.json")?) else {
        let help = "run the scene to its end first";
        return Err(miette!(help = help, "`{}` has no scene and results to march on with", folder.display()));
    };
    let cost = read("cost.json")?.unwrap_or_default();
    let was = |key: &str| cost["provenance"][key].as_str().unwrap_or_default().to_owned();
    let path = Path::new(&was("folder")).join(was("scene"));
    let scene = scene::parse(&scene, &path)?;
    let (what_if, peak) = job::what_if(&scene, registry, std::num::NonZeroUsize::MIN)?;
    let before = summary["impact"]["peak_force_N"].as_f64();
    if let Some((peak, before)) = peak.zip(before).filter(|(peak, before)| (peak - before).abs() > CHANGED * before) {
        let help = "the mesh, the materials or the program have changed since: run the scene again";
        return Err(miette!(help = help, "the peak force of the run is {before} N, and is {peak} N now"));
    }
    Ok(what_if)
}
