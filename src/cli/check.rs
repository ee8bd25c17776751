//! `fem check`.

use super::print;
use crate::error::Error;
use crate::model::Model;
use crate::registry::Registry;
use crate::run;
use clap::Args;
use fem_io::scene;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The scene file.
    scene: PathBuf,
}

pub(super) fn check(registry: &Registry, arguments: &Arguments) -> miette::Result<ExitCode> {
    print(&report(registry, arguments)?);
    Ok(ExitCode::SUCCESS)
}

fn report(registry: &Registry, arguments: &Arguments) -> Result<String, Error> {
    let model = Model::new(scene::read(&arguments.scene)?, registry)?;
    let sizes = run::prepare(&model, NonZeroUsize::MIN)?.sizes;
    let megabytes = |entries: usize| entries as f64 * 8e-6;
    let frequency = |f: Option<f64>| f.map_or("not computed".to_owned(), |f| format!("{f:.1} Hz"));
    let stable = match sizes.longest_step {
        s if s.is_finite() => format!("stable up to {:.4} us", s * 1e6),
        _ => "no stability limit".to_owned(),
    };
    let scene = &model.scene;
    let mut text = format!(
        "{}\n  mesh      {} quads, {} nodes, groups {}\n  plate     {} plies, {:.4} mm, {} layers of cells\n  \
         unknowns  {} of {} after constraints{}; {} marched\n  memory    stiffness {:.1} MB, factor {:.1} MB\n  \
         contact   static stiffness {:.2} N/mm\n  frequency lowest excited {}, highest {}\n  march     {} steps of {:.4} us to {:.4} ms with {} ({stable})\n  \
         damage    {}\n",
        scene.title,
        model.plate.plane.quads.len(),
        model.plate.plane.points.len(),
        model.plate.plane.groups.keys().map(String::as_str).collect::<Vec<_>>().join(", "),
        model.laminate.plies.len(),
        model.laminate.thickness() * 1e3,
        model.plate.layers(),
        sizes.unknowns,
        model.plate.ndof(),
        match model.constraints.redundant.len() {
            0 => String::new(),
            n => format!(" ({n} redundant equations)"),
        },
        sizes.marched,
        2.0 * megabytes(sizes.stiffness_entries),
        megabytes(sizes.factor_entries),
        sizes.static_stiffness * 1e-3,
        frequency(sizes.lowest_frequency),
        frequency(sizes.highest_frequency),
        sizes.steps,
        sizes.step * 1e6,
        scene.march.end.value * 1e3,
        scene.march.integrator.name.value,
        match model.criteria.len() {
            0 => "off".to_owned(),
            _ => model.criteria.iter().map(|c| c.0.as_str()).collect::<Vec<_>>().join(", "),
        },
    );
    for warning in &model.warnings {
        text.push_str(&format!("  warning   {warning}\n"));
    }
    text.push_str("  the scene is valid\n");
    Ok(text)
}
