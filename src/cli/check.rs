//! `fem check`.

use super::{print, warn};
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
    /// Scene file (TOML); its mesh is looked for beside it.
    scene: PathBuf,
}

pub(super) fn check(registry: &Registry, arguments: &Arguments) -> miette::Result<ExitCode> {
    print(&report(registry, arguments)?);
    Ok(ExitCode::SUCCESS)
}

fn report(registry: &Registry, arguments: &Arguments) -> Result<String, Error> {
    let model = Model::new(scene::read(&arguments.scene)?, registry)?;
    let prepared = run::prepare(&model, NonZeroUsize::MIN).inspect_err(|_| warn(&model))?;
    let (impact, sizes) = (prepared.impact, prepared.sizes);
    let (plate, scene) = (&model.plate, &model.scene);
    let megabytes = |entries: usize| entries as f64 * 8e-6;
    let known = [("lowest excited", sizes.lowest_frequency), ("highest", sizes.highest_frequency)];
    let frequencies: Vec<_> = known.iter().filter_map(|(name, f)| Some(format!("{name} {:.1} Hz", (*f)?))).collect();
    let redundant = match model.constraints.redundant.len() {
        0 => String::new(),
        n => format!(" ({n} redundant equations)"),
    };
    let stable = match sizes.longest_step {
        s if s.is_finite() => format!("stable up to {:.4} us", s * 1e6),
        _ => "no stability limit".to_owned(),
    };
    let criteria: Vec<_> = model.criteria.iter().map(|c| c.0.as_str()).collect();
    let mut lines = vec![
        (
            "mesh",
            format!(
                "{} quads, {} nodes, groups {}",
                plate.plane.quads.len(),
                plate.plane.points.len(),
                plate.plane.groups.keys().map(String::as_str).collect::<Vec<_>>().join(", ")
            ),
        ),
        (
            "plate",
            format!(
                "{} plies, {:.4} mm, {} layers of cells",
                model.laminate.plies.len(),
                model.laminate.thickness() * 1e3,
                plate.layers()
            ),
        ),
        (
            "unknowns",
            format!("{} of {} after constraints{redundant}; {} marched", sizes.unknowns, plate.ndof(), sizes.marched),
        ),
        (
            "memory",
            format!(
                "stiffness {:.1} MB, factor {:.1} MB",
                2.0 * megabytes(sizes.stiffness_entries),
                megabytes(sizes.factor_entries)
            ),
        ),
        ("contact", format!("static stiffness of the plate {:.2} N/mm", sizes.static_stiffness * 1e-3)),
        ("frequency", if frequencies.is_empty() { "the march needs none".into() } else { frequencies.join(", ") }),
        (
            "march",
            format!(
                "{} steps of {:.4} us to {:.4} ms with {} ({stable})",
                sizes.steps,
                sizes.step * 1e6,
                impact.spec.march.end.value * 1e3,
                impact.spec.march.integrator.name.value
            ),
        ),
        ("damage", if criteria.is_empty() { "off".into() } else { criteria.join(", ") }),
    ];
    lines.extend(model.warnings.iter().map(|warning| ("warning", warning.clone())));
    let lines: String = lines.iter().map(|(what, text)| format!("  {what:<9} {text}\n")).collect();
    Ok(format!("{}\n{lines}  the scene is valid\n", scene.title))
}
