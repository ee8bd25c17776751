//! `fem advise`.

use super::{Console, Format, SceneFile};
use crate::advise::{self, Advice};
use crate::effect::Answer;
use crate::model::Model;
use crate::registry::Registry;
use clap::Args;
use serde::Serialize;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem advise coupon/scene.toml")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneFile,
    #[command(flatten)]
    threads: super::Threads,
    #[command(flatten)]
    format: Format,
}

/// The summary of an impactor; units are in the key names.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct Said<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    impactor: Option<&'a str>,
    mass_kg: f64,
    velocity_m_s: f64,
    peak_force_N: f64,
    answers: &'a [Answer],
}

impl<'a> From<&'a Advice> for Said<'a> {
    fn from(advice: &'a Advice) -> Self {
        Self {
            impactor: advice.impactor.as_deref(),
            mass_kg: advice.mass,
            velocity_m_s: advice.velocity,
            peak_force_N: advice.estimate.force(),
            answers: &advice.answers,
        }
    }
}

#[derive(Serialize)]
struct Document<'a> {
    title: &'a str,
    impact: Vec<Said<'a>>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    warnings: &'a [String],
}

pub(super) fn advise(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let model = arguments.scene.read().and_then(|scene| Model::new(scene, registry))?;
    let all = advise::advise(&model, arguments.threads.count()).inspect_err(|_| console.warn(&model.warnings))?;
    let title = &model.origin.title;
    let data = Document { title, impact: all.iter().map(Said::from).collect(), warnings: &model.warnings };
    let text = || format!("{title}\n{}", all.iter().map(ToString::to_string).collect::<String>());
    console.show(arguments.format, &data, text)?;
    Ok(ExitCode::SUCCESS)
}
