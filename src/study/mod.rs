//! What settings cost and what they leave: a scene run under variations, against a reference.

mod axes;
mod force;
mod table;

pub use axes::{Axis, Setting, full};
pub use table::{text, write};

use crate::error::Error;
use crate::model::Model;
use crate::registry::Registry;
use crate::run::{self, Outcome};
use fem_failure::scan::first_per_mode;
use fem_io::scene;
use force::Force;
use std::num::NonZeroUsize;
use std::path::Path;

/// A scene that was run under one setting.
#[derive(Debug, Clone)]
pub struct Run {
    /// Unknowns of the full model and of the march.
    pub unknowns: [usize; 2],
    /// Step, s.
    pub step: f64,
    force: Force,
    onsets: Vec<Onset>,
    /// Processor time to assemble, reduce and prepare the stresses, s.
    pub setup_s: f64,
    /// Processor time of the march, s.
    pub march_s: f64,
}

/// First reaching of a mode of failure.
#[derive(Debug, Clone)]
struct Onset {
    name: String,
    time: f64,
}

/// One line of a study.
#[derive(Debug, Clone)]
pub struct Row {
    /// What was varied.
    pub axis: &'static str,
    /// How.
    pub setting: String,
    /// What the run gave, or why it gave nothing.
    pub figures: Result<Figures, String>,
}

/// Errors against the reference, and cost.
#[derive(Debug, Clone, Copy)]
pub struct Figures {
    /// Unknowns of the march.
    pub unknowns_marched: usize,
    /// Step, s.
    pub step_s: f64,
    /// ‖F − F_ref‖ / ‖F_ref‖ over time.
    pub force_l2_error: f64,
    /// Relative error of the largest force.
    pub force_peak_error: f64,
    /// Largest difference of the time of a first onset, s; none where no mode is reached in both runs.
    pub onset_error_s: Option<f64>,
    /// First onsets found in one of the two runs alone.
    pub onsets_unmatched: usize,
    /// Processor time to assemble, reduce and prepare the stresses, s.
    pub setup_cpu_s: f64,
    /// Processor time of the march, s.
    pub march_cpu_s: f64,
}

/// Runs `path` with `setting` over its keys.
///
/// # Errors
/// Those of a run, and a march that stopped before its end.
pub fn run(path: &Path, setting: &str, registry: &Registry) -> Result<Run, Error> {
    let model = Model::new(scene::read_with(path, setting)?, registry)?;
    let prepared = run::prepare(&model, NonZeroUsize::MIN)?;
    let sizes = prepared.sizes;
    let outcome = run::march(prepared, |_| ())?;
    if let Some(why) = outcome.stopped {
        return Err(Error::Stopped(why));
    }
    let seconds = |of: &dyn Fn(&str) -> bool| outcome.phases.iter().filter(|p| of(p.name)).map(|p| p.cpu_s).sum();
    Ok(Run {
        unknowns: [sizes.unknowns, sizes.marched],
        step: sizes.step,
        force: Force::of(&outcome.history),
        onsets: onsets(&outcome),
        setup_s: seconds(&|name| !matches!(name, "march" | "scan")),
        march_s: seconds(&|name| name == "march"),
    })
}

fn onsets(outcome: &Outcome) -> Vec<Onset> {
    let first = first_per_mode(&outcome.events);
    first.into_iter().map(|e| Onset { name: format!("{} {}", e.criterion, e.mode), time: e.time }).collect()
}

/// Runs `path` under `setting` and compares.
pub fn compare(path: &Path, setting: &Setting, registry: &Registry, reference: &Run) -> Row {
    let keys = match setting.at_limit {
        true => longest_step(path, setting, registry).map(|step| setting.keys_with_step(AT_LIMIT * step)),
        false => Ok(setting.keys.clone()),
    };
    let run = keys.and_then(|keys| run(path, &keys, registry));
    let figures = run.map(|run| figures(&run, reference)).map_err(|why| why.to_string());
    Row { axis: setting.axis.name(), setting: setting.label.clone(), figures }
}

/// The longest step that is stable under `setting`, s.
fn longest_step(path: &Path, setting: &Setting, registry: &Registry) -> Result<f64, Error> {
    let model = Model::new(scene::read_with(path, &setting.keys_with_step(TINY))?, registry)?;
    Ok(run::prepare(&model, NonZeroUsize::MIN)?.sizes.longest_step)
}

/// A step that no limit forbids, s.
const TINY: f64 = 1e-11;

/// Share of its limit at which an integrator is tried.
const AT_LIMIT: f64 = 0.99;

fn figures(run: &Run, reference: &Run) -> Figures {
    let of = |name: &str, others: &[Onset]| others.iter().find(|o| o.name == name).map(|o| o.time);
    let (mut onset_error_s, mut onsets_unmatched) = (None::<f64>, 0);
    for onset in &reference.onsets {
        match of(&onset.name, &run.onsets) {
            Some(time) => onset_error_s = Some(onset_error_s.unwrap_or(0.0).max((time - onset.time).abs())),
            None => onsets_unmatched += 1,
        }
    }
    onsets_unmatched += run.onsets.iter().filter(|o| of(&o.name, &reference.onsets).is_none()).count();
    Figures {
        unknowns_marched: run.unknowns[1],
        step_s: run.step,
        force_l2_error: run.force.difference(&reference.force),
        force_peak_error: run.force.peak() / reference.force.peak() - 1.0,
        onset_error_s,
        onsets_unmatched,
        setup_cpu_s: run.setup_s,
        march_cpu_s: run.march_s,
    }
}
