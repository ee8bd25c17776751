//! What settings cost and what they leave: a scene run under variations, against a reference.

mod axes;
mod force;
mod table;

pub use axes::{Axis, Setting};
pub use table::{text, write};

use crate::error::Error;
use crate::model::Model;
use crate::registry::Registry;
use crate::run::{self, Outcome};
use fem_failure::scan::first_per_mode;
use fem_io::scene;
use force::Force;
use serde::Serialize;
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
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct Row {
    pub axis: &'static str,
    pub setting: String,
    pub unknowns_marched: usize,
    pub step_s: f64,
    /// ‖F − F_ref‖ / ‖F_ref‖ over time.
    pub force_L2_error: f64,
    /// Relative error of the largest force.
    pub force_peak_error: f64,
    /// Largest difference of the time of a first onset, s; none where no mode is reached in both runs.
    pub onset_error_s: Option<f64>,
    /// First onsets found in one of the two runs alone.
    pub onsets_unmatched: usize,
    pub setup_cpu_s: f64,
    pub march_cpu_s: f64,
    /// Why there are no figures, where there are none.
    pub refused: Option<String>,
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

/// The line of a run under `setting`, or of why there is none.
pub fn row(setting: &Setting, run: &Result<Run, Error>, reference: &Run) -> Row {
    let mut row = Row {
        axis: setting.axis.name(),
        setting: setting.label.clone(),
        unknowns_marched: 0,
        step_s: f64::NAN,
        force_L2_error: f64::NAN,
        force_peak_error: f64::NAN,
        onset_error_s: None,
        onsets_unmatched: 0,
        setup_cpu_s: f64::NAN,
        march_cpu_s: f64::NAN,
        refused: None,
    };
    let run = match run {
        Ok(run) => run,
        Err(why) => return Row { refused: Some(why.to_string()), ..row },
    };
    let of = |name: &str, others: &[Onset]| others.iter().find(|o| o.name == name).map(|o| o.time);
    for onset in &reference.onsets {
        match of(&onset.name, &run.onsets) {
            Some(time) => row.onset_error_s = row.onset_error_s.max(Some((time - onset.time).abs())),
            None => row.onsets_unmatched += 1,
        }
    }
    row.onsets_unmatched += run.onsets.iter().filter(|o| of(&o.name, &reference.onsets).is_none()).count();
    Row {
        unknowns_marched: run.unknowns[1],
        step_s: run.step,
        force_L2_error: run.force.difference(&reference.force),
        force_peak_error: run.force.peak() / reference.force.peak() - 1.0,
        setup_cpu_s: run.setup_s,
        march_cpu_s: run.march_s,
        ..row
    }
}
