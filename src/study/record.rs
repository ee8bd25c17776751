//! A scene that was run under one setting.

use super::force::Force;
use super::quantity::{self, FORCE_HISTORY, Figure};
use crate::advise;
use crate::analyses::impact;
use crate::cost;
use crate::error::Error;
use crate::forecast::{PHASES, Size, seconds_per_phase};
use crate::job::{self, Finished, Follow, Found, Options};
use crate::model::Model;
use crate::registry::Registry;
use fem_io::scene::{self, SceneSource, Setting};
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;

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
    /// Runs the scene of `source` with `setting` over its keys; `follow` is heard before the run, whatever it is, and at every step of a march.
    ///
    /// # Errors
    /// Those of a run, and a march that stopped before its end.
    pub fn of(
        source: &SceneSource,
        setting: &Setting,
        registry: &Registry,
        follow: &mut dyn Follow,
    ) -> Result<Self, Error> {
        if follow.marched(0.0).is_break() {
            return Err(Error::Cancelled { time: 0.0, share: 0.0 });
        }
        cost::forget_peak_memory();
        let scene = scene::under(source, setting)?;
        let Finished { model, found, cost, .. } = job::run(&scene, registry, &Options::default(), follow)?;
        let (size, figures, force) = match &found {
            Found::Impact(own) => {
                if let Some(why) = &own.outcome.stopped {
                    return Err(Error::Stopped(why.clone()));
                }
                let size = own.outcome.size(&model, &own.sizes);
                (size, quantity::of_impact(&model, own), Some(Force::of(&own.outcome.forces, own.sizes.steps as usize)))
            }
            Found::Static(own) => {
                let solution = &own.solution;
                let size = Size { factor_entries: solution.factor_entries, ..model.size(&solution.counters) };
                (size, quantity::of_statics(&scene, &model, own)?, None)
            }
            Found::Buckling(own) => {
                let solution = &own.solution;
                let size = Size { factor_entries: solution.factor_entries, ..model.size(&solution.counters) };
                (size, quantity::of_buckling(&solution.buckling.factors), None)
            }
            Found::Modes(own) => {
                let solution = &own.solution;
                let size = Size { factor_entries: solution.factor_entries, ..model.size(&solution.counters) };
                (size, quantity::of_modes(&solution.modes.omega), None)
            }
        };
        let (seconds, memory) = (seconds_per_phase(&cost.phases), cost::peak_memory());
        Ok(Self { size, figures, force, seconds, memory })
    }

    /// Value of the figure `name`.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.figures.iter().find(|f| f.name == name).map(|f| f.value)
    }

    /// Relative difference of the quantity `name` to `reference`; `None` where one of the two lacks it, or where it is none
    /// there.
    pub fn difference(&self, reference: &Self, name: &str) -> Option<f64> {
        if name == FORCE_HISTORY {
            let difference = self.force.as_ref()?.difference(reference.force.as_ref()?);
            return Some(difference).filter(|difference| difference.is_finite());
        }
        let (value, exact) = (self.value(name)?, reference.value(name)?);
        Some((value - exact) / exact.abs()).filter(|difference| difference.is_finite())
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
pub(super) fn longest_step(source: &SceneSource, setting: &Setting, registry: &Registry) -> Result<f64, Error> {
    let model = advise::decided(Model::new(scene::under(source, setting)?, registry)?, NonZeroUsize::MIN)?;
    Ok(impact::prepare(&model, NonZeroUsize::MIN)?.sizes.longest_step)
}
