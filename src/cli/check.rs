//! `fem check`.

use super::{print, warn};
use crate::advise;
use crate::error::Error;
use crate::fields;
use crate::memory::Estimate;
use crate::model::{Impact, Model, Plan};
use crate::registry::Registry;
use crate::run::{self, Sizes, Substructures};
use crate::statics::{digits, few_digits};
use crate::summary::{Advised, in_words};
use clap::Args;
use fem_core::counters::Counters;
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
    let model = advise::decided(Model::new(scene::read(&arguments.scene)?, registry)?, NonZeroUsize::MIN)?;
    let (mut lines, mut frames) = (plate(&model), 1);
    match &model.plan {
        Plan::Impact(impact) => {
            let sizes = run::prepare(&model, NonZeroUsize::MIN).inspect_err(|_| warn(&model))?.sizes;
            lines.extend(unknowns(&model, &sizes.memory));
            lines.extend(divided(sizes.substructures));
            lines.extend(march(impact, &sizes));
            frames = frames_of(&model, &sizes);
        }
        plan => {
            let counters = &mut Counters::default();
            let assembled = run::structure(&model, true, NonZeroUsize::MIN, counters);
            let mut assembled = assembled.inspect_err(|_| warn(&model))?;
            lines.extend(unknowns(&model, &assembled.memory));
            lines.extend(divided(assembled.substructures()));
            if model.held {
                let condition = assembled.structure.condition().map_err(Error::from).inspect_err(|_| warn(&model))?;
                lines.push(("stiffness", digits(condition)));
                lines.extend(few_digits(condition).map(|warning| ("warning", warning)));
            }
            lines.push(match plan {
                Plan::Modes { count } => {
                    frames = *count;
                    ("analysis", format!("the {count} lowest modes"))
                }
                _ => ("analysis", "static".to_owned()),
            });
        }
    }
    let criteria: Vec<_> = model.criteria.iter().map(|c| c.0.as_str()).collect();
    lines.push(("damage", if criteria.is_empty() { "off".into() } else { criteria.join(", ") }));
    lines.extend(fields::expected(&model, frames)?.map(|fields| ("fields", fields)));
    lines.extend(Advised::of(&model, |_| None).iter().map(|advised| ("advised", advised.to_string())));
    lines.extend(model.warnings.iter().map(|warning| ("warning", warning.clone())));
    let lines: String = lines.iter().map(|(what, text)| format!("  {what:<9} {text}\n")).collect();
    Ok(format!("{}\n{lines}  the scene is valid\n", model.scene.title))
}

type Line = (&'static str, String);

fn plate(model: &Model) -> Vec<Line> {
    let plate = &model.plate;
    vec![
        (
            "mesh",
            format!(
                "{} quads, {} nodes, groups {}{}",
                plate.plane.quads.len(),
                plate.plane.points.len(),
                plate.plane.groups.keys().map(String::as_str).collect::<Vec<_>>().join(", "),
                in_words(plate.symmetry().name())
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
    ]
}

fn unknowns(model: &Model, memory: &Estimate) -> [Line; 2] {
    let redundant = match model.constraints.redundant.len() {
        0 => String::new(),
        n => format!(" ({n} redundant equations)"),
    };
    let (independent, all) = (model.constraints.ndof(), model.plate.ndof());
    let memory = format!("about {:.0} MB at the peak: {memory}", memory.bytes() * 1e-6);
    [("unknowns", format!("{independent} of {all} after constraints{redundant}")), ("memory", memory)]
}

fn divided(substructures: Option<Substructures>) -> Option<Line> {
    substructures.map(|parts| ("divided", parts.to_string()))
}

/// Frames of the fields of a march.
fn frames_of(model: &Model, sizes: &Sizes) -> usize {
    let fields = model.scene.output.fields.as_ref();
    fields::frames(fields, fields.and_then(|fields| fields.every), sizes).len()
}

fn march(impact: &Impact, sizes: &Sizes) -> [Line; 3] {
    let known = [("lowest excited", sizes.lowest_frequency), ("highest", sizes.highest_frequency)];
    let frequencies: Vec<_> = known.iter().filter_map(|(name, f)| Some(format!("{name} {:.1} Hz", (*f)?))).collect();
    let stable = match sizes.longest_step {
        s if s.is_finite() => format!("stable up to {:.4} us", s * 1e6),
        _ => "no stability limit".to_owned(),
    };
    let spec = &impact.spec.march;
    [
        ("contact", format!("static stiffness of the plate {:.2} N/mm", sizes.static_stiffness * 1e-3)),
        ("frequency", if frequencies.is_empty() { "the march needs none".into() } else { frequencies.join(", ") }),
        (
            "march",
            format!(
                "{} unknowns, {} steps of {:.4} us to {:.4} ms with {} ({stable})",
                sizes.marched,
                sizes.steps,
                sizes.step * 1e6,
                spec.end.value * 1e3,
                spec.integrator.name.value
            ),
        ),
    ]
}
