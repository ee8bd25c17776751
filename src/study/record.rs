//! A scene that was run under one setting.

use super::force::Force;
use super::quantity::{self, FORCE_HISTORY, Figure};
use crate::advise;
use crate::cost::{self, Phase};
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::registry::Registry;
use crate::run::{self, Outcome, Sizes};
use crate::{modes, statics};
use fem_core::counters::Counters;
use fem_io::scene::{self, Setting};
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;
use std::path::Path;

/// What a run gave and what it cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
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

/// Parts of a run: their times grow with different work.
pub const PHASES: [&str; 5] = ["assemble", "solve", "stresses", "march", "scan"];

/// Sizes of a model and the work that it takes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Size {
    /// Cells.
    pub cells: usize,
    /// Layers of cells.
    pub layers: usize,
    /// Edge of a square as large as a cell is on average, m.
    pub cell_m: f64,
    /// Columns of nodes.
    pub columns: usize,
    /// Independent unknowns.
    pub unknowns: usize,
    /// Unknowns of the march.
    pub marched: usize,
    /// Whether the march is that of a reduced model.
    pub reduced: bool,
    /// Entries of the factor of K.
    pub factor_entries: usize,
    /// Places whose stresses are judged.
    pub sites: usize,
    /// Step, s; zero where nothing is marched.
    pub step_s: f64,
    /// Samples of the stresses.
    pub samples: u64,
    /// Work done.
    pub work: Counters,
}

impl Size {
    fn of(model: &Model, counters: &Counters) -> Self {
        let plane = &model.plate.plane;
        Self {
            cells: model.plate.cells(),
            layers: model.plate.layers(),
            cell_m: (plane.area() / plane.quads.len() as f64).sqrt(),
            columns: model.plate.columns.len(),
            unknowns: model.constraints.ndof(),
            work: *counters,
            ..Self::default()
        }
    }

    /// Of an impact.
    pub fn of_impact(model: &Model, sizes: &Sizes, outcome: &Outcome) -> Self {
        Self {
            marched: sizes.marched,
            reduced: sizes.marched < sizes.unknowns,
            factor_entries: sizes.factor_entries,
            sites: outcome.sites,
            step_s: sizes.step,
            samples: (sizes.steps as f64 * sizes.step / model.scene.failure.every) as u64,
            ..Self::of(model, &outcome.counters)
        }
    }
}

impl Record {
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
        Self { size, figures, force, seconds: seconds(phases), memory: None }
    }

    fn of_impact(model: &Model) -> Result<Self, Error> {
        let prepared = run::prepare(model, NonZeroUsize::MIN)?;
        let sizes = prepared.sizes;
        let outcome = run::march(prepared, |_| ())?;
        if let Some(why) = outcome.stopped {
            return Err(Error::Stopped(why));
        }
        let size = Size::of_impact(model, &sizes, &outcome);
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

/// Seconds per [`PHASES`] of what a run calls its phases.
pub fn seconds(phases: &[Phase]) -> [f64; PHASES.len()] {
    let mut seconds = [0.0; PHASES.len()];
    for phase in phases {
        let place = match phase.name {
            "assemble" => 0,
            "reduce" | "solve" | "modes" | "accuracy" => 1,
            "prepare stresses" | "stresses" => 2,
            "march" => 3,
            _ => 4,
        };
        seconds[place] += phase.cpu_s;
    }
    seconds
}

/// The longest step that is stable under `setting`, s.
///
/// # Errors
/// Those of a preparation.
pub(super) fn longest_step(path: &Path, setting: &Setting, registry: &Registry) -> Result<f64, Error> {
    let model = advise::decided(Model::new(scene::read_with(path, setting)?, registry)?, NonZeroUsize::MIN)?;
    Ok(run::prepare(&model, NonZeroUsize::MIN)?.sizes.longest_step)
}
