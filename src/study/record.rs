//! A scene that was run under one setting.

use super::force::Force;
use super::quantity::{self, FORCE_HISTORY, Figure};
use crate::advise;
use crate::analyses::{impact, modes, statics};
use crate::cost::{self, Phase};
use crate::error::Error;
use crate::forecast::{PHASES, Size, seconds_per_phase};
use crate::model::{Model, Plan};
use crate::registry::Registry;
use fem_io::scene::{self, Setting};
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;
use std::path::Path;

/// What a run gave and what it cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Sizes and work: equal from run to run.
    pub size: Size,
    /// What it found.
    pub figures: Vec<Figure>,
    pub(super) force: Option<Force>,
    /// Processor time, s, per [`PHASES`].
    pub seconds: [f64; PHASES.len()],
    /// Largest memory of the process during the run, bytes; `None` where the system does not tell.
    pub memory: Option<u64>,
}

impl RunRecord {
    /// Runs `path` with `setting` over its keys.
    ///
    /// # Errors
    /// Those of a run, and a march that stopped before its end.
    pub fn of(path: &Path, setting: &Setting, registry: &Registry) -> Result<Self, Error> {
        cost::forget_peak_memory();
        let model = advise::decided(Model::new(scene::read_with(path, setting)?, registry)?, NonZeroUsize::MIN)?;
        let mut record = match &model.plan {
            Plan::Impact(_) => Self::of_impact(&model)?,
            Plan::Static { .. } => {
                let solution = statics::solve(&model, NonZeroUsize::MIN)?;
                let size = Size { factor_entries: solution.factor_entries, ..Size::of(&model, &solution.counters) };
                Self::new(size, quantity::of_statics(&model, &solution)?, None, &solution.phases)
            }
            Plan::Modes { count } => {
                let solution = modes::solve(&model, *count, NonZeroUsize::MIN)?;
                let size = Size { factor_entries: solution.factor_entries, ..Size::of(&model, &solution.counters) };
                Self::new(size, quantity::of_modes(&solution.modes.omega), None, &solution.phases)
            }
        };
        record.memory = cost::peak_memory();
        Ok(record)
    }

    fn new(size: Size, figures: Vec<Figure>, force: Option<Force>, phases: &[Phase]) -> Self {
        Self { size, figures, force, seconds: seconds_per_phase(phases), memory: None }
    }

    fn of_impact(model: &Model) -> Result<Self, Error> {
        let prepared = impact::prepare(model, NonZeroUsize::MIN)?;
        let sizes = prepared.sizes;
        let outcome = impact::march(prepared, |_| ())?;
        if let Some(why) = outcome.stopped {
            return Err(Error::Stopped(why));
        }
        let size = outcome.size(model, &sizes);
        let force = Force::of(&outcome.history);
        Ok(Self::new(size, quantity::of_impact(model, &sizes, &outcome), Some(force), &outcome.phases))
    }

    /// Value of the figure `name`.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.figures.iter().find(|f| f.name == name).map(|f| f.value)
    }

    /// Relative difference of the quantity `name` to `reference`; `None` where one of the two lacks it.
    pub fn difference(&self, reference: &Self, name: &str) -> Option<f64> {
        if name == FORCE_HISTORY {
            return Some(self.force.as_ref()?.difference(reference.force.as_ref()?));
        }
        let (value, exact) = (self.value(name)?, reference.value(name)?);
        Some((value - exact) / exact.abs())
    }

    /// Processor time, s.
    pub fn total(&self) -> f64 {
        self.seconds.iter().sum()
    }
}

/// The longest step that is stable under `setting`, s.
///
/// # Errors
/// Those of a preparation.
pub(super) fn longest_step(path: &Path, setting: &Setting, registry: &Registry) -> Result<f64, Error> {
    let model = advise::decided(Model::new(scene::read_with(path, setting)?, registry)?, NonZeroUsize::MIN)?;
    Ok(impact::prepare(&model, NonZeroUsize::MIN)?.sizes.longest_step)
}
