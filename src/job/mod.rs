//! A job: a scene becomes what it asks for, in a folder of results or in memory.
//!
//! [`run`] is what the command, a study and any other program call; nothing else knows the steps from a scene to its results.
//! Who strikes one plate many times keeps it: [`KeptPlate`].

pub(crate) mod folder;
mod impact;
mod plate;
mod rest;
mod what_if;

pub use plate::KeptPlate;
pub use what_if::what_if;

use crate::advise;
use crate::analyses::impact::{Outcome, Sizes};
use crate::analyses::{buckling, modes, statics};
use crate::cost::{Attained, Cost, Phase, Provenance};
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::output;
use crate::registry::Registry;
use fem_io::scene::{DEFAULT_MODES, Scene};
use serde::{Serialize, Serializer};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// How a job is done.
#[derive(Debug, Clone)]
pub struct Options {
    /// What is computed.
    pub task: Task,
    /// Where the results go.
    pub results: Results,
    /// Threads for the integration of element matrices; results do not depend on it.
    pub threads: NonZeroUsize,
    /// What it takes to make the run again, for `cost.json`.
    pub provenance: Option<Provenance>,
    /// The search for an accuracy that found its settings, for `cost.json`.
    pub attained: Option<Attained>,
}

/// The analysis of the scene, on one thread, in memory.
impl Default for Options {
    fn default() -> Self {
        Self {
            task: Task::Scene,
            results: Results::InMemory,
            threads: NonZeroUsize::MIN,
            provenance: None,
            attained: None,
        }
    }
}

/// What is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Task {
    /// The analysis that the scene asks for.
    Scene,
    /// So many of the lowest natural modes, whatever the scene asks for; by default as many as it says, or
    /// [`DEFAULT_MODES`].
    Modes(Option<NonZeroUsize>),
}

/// Where results go.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Results {
    /// Nowhere: they are returned alone.
    InMemory,
    /// Into this folder, which is made where there is none.
    Folder(PathBuf),
    /// Into this folder, in which the checkpoint of an earlier march lies, from which the job goes on.
    Resumed(PathBuf),
}

/// Who follows a job. Every method may be left out; `()` lets a job run to its end.
pub trait Follow {
    /// This share of the steps of a march is done: heard at its beginning and after every step. A march that is broken off
    /// leaves a checkpoint in its folder, from which [`Results::Resumed`] goes on. Of a path of loads at rest, which ends where it is
    /// broken off, it is the share of the displacement.
    fn marched(&mut self, _share: f64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// The result is there; files may still be written.
    fn found(&mut self, _found: &Found, _cost: &Cost) {}

    /// The model cannot be computed, which these warnings may explain.
    fn failed(&mut self, _warnings: &[String]) {}
}

impl Follow for () {}

/// A job that is done.
#[derive(Debug, Clone)]
pub struct Finished {
    /// The model of the scene, with effects that the scene leaves to the advisor decided.
    pub model: Model,
    /// What was found.
    pub found: Found,
    /// What it cost.
    pub cost: Cost,
    /// Where the files are, if there are any.
    pub folder: Option<PathBuf>,
}

/// What a job found; as data it is its summary.
#[derive(Debug, Clone)]
pub enum Found {
    /// The response to an impact.
    Impact(Box<ImpactFound>),
    /// Displacements and stresses under loads at rest.
    Static(Box<StaticFound>),
    /// Natural modes.
    Modes(Box<ModesFound>),
    /// Load factors of buckling.
    Buckling(Box<BucklingFound>),
}

/// The response to an impact.
#[derive(Debug, Clone)]
#[allow(missing_docs)]
pub struct ImpactFound {
    pub sizes: Sizes,
    pub outcome: Outcome,
    pub summary: output::summary::ImpactSummary,
}

/// Displacements and stresses under loads at rest.
#[derive(Debug, Clone)]
#[allow(missing_docs)]
pub struct StaticFound {
    pub solution: statics::StaticSolution,
    pub summary: output::statics::StaticSummary,
}

/// Natural modes.
#[derive(Debug, Clone)]
#[allow(missing_docs)]
pub struct ModesFound {
    pub solution: modes::ModesSolution,
    pub summary: output::modes::ModesSummary,
}

/// Load factors of buckling.
#[derive(Debug, Clone)]
#[allow(missing_docs)]
pub struct BucklingFound {
    pub solution: buckling::BucklingSolution,
    pub summary: output::buckling::BucklingSummary,
}

impl Found {
    /// Whether all was computed that the scene asks for: a march that meets what no impact can do stops before its end.
    pub fn completed(&self) -> bool {
        match self {
            Self::Impact(found) => found.summary.completed,
            Self::Static(_) | Self::Modes(_) | Self::Buckling(_) => true,
        }
    }

    /// The summary as people read it.
    pub fn text(&self, cost: &Cost) -> String {
        match self {
            Self::Impact(found) => found.summary.text(cost),
            Self::Static(found) => found.summary.text(cost),
            Self::Modes(found) => found.summary.text(cost),
            Self::Buckling(found) => found.summary.text(cost),
        }
    }
}

impl Serialize for Found {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Impact(found) => found.summary.serialize(serializer),
            Self::Static(found) => found.summary.serialize(serializer),
            Self::Modes(found) => found.summary.serialize(serializer),
            Self::Buckling(found) => found.summary.serialize(serializer),
        }
    }
}

/// Computes `scene` with the plug-ins of `registry`.
///
/// # Errors
/// What the scene, its mesh or its plug-ins are refused for; a computation that fails; a folder that cannot be written;
/// [`Error::Cancelled`] where `follow` broke a march off.
pub fn run(scene: &Scene, registry: &Registry, options: &Options, follow: &mut dyn Follow) -> Result<Finished, Error> {
    let mut model = Model::new(scene, registry)?;
    let asked = match options.task {
        Task::Modes(count) => {
            model.whole()?;
            let sound = model.sound.take();
            model = sound.map_or(model, |sound| *sound);
            Some(count)
        }
        Task::Scene => {
            model = advise::decided(model, options.threads)?;
            None
        }
    };
    let (found, cost, folder) = match (asked, &model.plan) {
        (None, Plan::Impact(_)) => impact::run(&model, options, follow)?,
        _ if matches!(options.results, Results::Resumed(_)) => return Err(Error::NotMarched),
        (None, Plan::Static { .. }) => rest::statics(&model, options, follow)?,
        (None, Plan::Buckling { count }) => rest::buckling(&model, *count, options, follow)?,
        (asked, plan) => {
            let own = match plan {
                Plan::Modes { count } => *count,
                _ => DEFAULT_MODES,
            };
            rest::modes(&model, asked.flatten().map_or(own, NonZeroUsize::get), options, follow)?
        }
    };
    Ok(Finished { model, found, cost, folder })
}

/// What a part of a job gives: what it found, its cost, its folder.
type Part = (Found, Cost, Option<PathBuf>);

impl Options {
    fn folder(&self) -> Option<&PathBuf> {
        match &self.results {
            Results::InMemory => None,
            Results::Folder(folder) | Results::Resumed(folder) => Some(folder),
        }
    }

    fn cost(&self, phases: &[Phase]) -> Cost {
        let (provenance, accuracy_asked) = (self.provenance.clone(), self.attained.clone());
        Cost { provenance, accuracy_asked, ..Cost::new(self.threads, phases.to_vec()) }
    }
}
