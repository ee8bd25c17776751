//! The response to an impact: assemble, reduce, march, scan.

mod accuracy;
mod carried;
mod checkpoint;
mod contact;
mod frames;
mod ledger;
mod march;
mod modal;
mod prepare;
mod shared;
mod squeeze;

pub use accuracy::{Accuracy, Differences, MeshAccuracy, ReductionAccuracy, ReductionResidual, StepAccuracy};
pub use carried::CarriedPlate;
pub use checkpoint::Checkpoint;
pub(crate) use checkpoint::FILE as CHECKPOINT;
pub(crate) use contact::Follower;
pub use contact::{ContactRecord, StepForces};
pub(crate) use frames::frames;
pub use ledger::BALANCE_EVERY;
pub(crate) use ledger::history_row;
pub use march::{March, march};
pub use modal::{ModalHistory, ModeShare};
pub use prepare::{Prepared, prepare};
pub use shared::SharedPlate;
pub use squeeze::Squeeze;

use super::assembled::Substructures;
use super::delamination::Delaminated;
use super::samples::PlateSamples;
use super::stress::IndexHistory;
use crate::cost::Phase;
use crate::error::Error;
use crate::forecast::{MemoryEstimate, Size};
use crate::model::{Model, NamedCriterion};
use fem_core::counters::Counters;
use fem_core::material::Material;
use fem_core::time::Substeps;
use fem_failure::scan::{Extremes, FailureEvent, Peak, ScanSite};
use fem_io::tables::HistoryRow;
use std::sync::Arc;

/// Sizes and limits of a model that is ready to march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    /// Independent unknowns of the full model.
    pub unknowns: usize,
    /// How the plate is divided, if it is.
    pub substructures: Option<Substructures>,
    /// Unknowns of the march: modes of the reduced model, or those of the full one.
    pub marched: usize,
    /// Entries of one triangle of the stiffness.
    pub stiffness_entries: usize,
    /// Entries of its Cholesky factor.
    pub factor_entries: usize,
    /// The preload over the one that buckles the plate ([`Assembled::buckling`](super::assembled::Assembled::buckling)).
    pub buckling: Option<f64>,
    /// Memory that the run is expected to take at its peak.
    pub memory: MemoryEstimate,
    /// Contact force of the first impactor per deflection under it, N/m, of the plate as marched.
    pub static_stiffness: f64,
    /// Share of that deflection that supports of nodal values cost between the nodes, where it is worth a word
    /// ([`softness`](fem_core::assembly::softness)).
    pub softness: Option<f64>,
    /// Highest frequency of the plate as marched, Hz; `None` where no integrator limit asked for it.
    pub highest_frequency: Option<f64>,
    /// Lowest frequency of the reduced plate that the impact excites, Hz.
    pub lowest_frequency: Option<f64>,
    /// Longest stable step, s; infinite for unconditionally stable integrators.
    pub longest_step: f64,
    /// Number of steps.
    pub steps: u64,
    /// The step, s: the scene's, shortened so that a whole number of steps reaches the end.
    pub step: f64,
}

/// What a run found.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// What effects say of the model, by the key of the summary.
    pub quantities: Vec<(&'static str, f64)>,
    /// Of each impactor of the scene, what its contact was.
    pub contacts: Vec<ContactRecord>,
    /// What the law of each leaves to the plate, if anything.
    pub squeezes: Vec<Option<Squeeze>>,
    /// The force of all impactors at every step.
    pub forces: StepForces,
    /// Force, motion and energies over time, as rows.
    pub history: Vec<HistoryRow>,
    /// First reaching of index 1 per criterion, mode and place, by time.
    pub events: Vec<FailureEvent>,
    /// Largest index per criterion and mode.
    pub peaks: Vec<Peak>,
    /// Indices over time at the gauges of the model.
    pub histories: Vec<IndexHistory>,
    /// Largest index per criterion and site, if the scene asks for maps or plots.
    pub maxima: Vec<Maximum>,
    /// What has delaminated, where delaminations grow.
    pub delaminated: Option<Delaminated>,
    /// What each mode of plies that follow laws has dissipated, J, by its name, where the law tells them apart.
    pub plies: Vec<(&'static str, f64)>,
    /// What the lowest modes do, if the scene asks for it.
    pub modal: Option<ModalHistory>,
    /// Sites watched.
    pub sites: usize,
    /// Largest deviation of the total energy from the energy of the impact, relative to it.
    pub energy_error: f64,
    /// Substeps into which steps were divided by an estimate of their error, where they were.
    pub parts: Option<Substeps>,
    /// Estimates of other errors.
    pub accuracy: Accuracy,
    /// Work done.
    pub counters: Counters,
    /// Time per phase.
    pub phases: Vec<Phase>,
    /// Why the run ended before its time, if it did; everything above holds up to then.
    pub stopped: Option<String>,
    /// What the criteria saw, where they judged only what can be first or largest.
    pub samples: Option<Arc<PlateSamples>>,
}

impl Outcome {
    /// First and largest indices of the same march by these criteria and materials, which differ from those of the march in strengths
    /// alone; `None` where it has to be marched anew for them, as without [`Prepared::firsts_alone`].
    ///
    /// # Errors
    /// A criterion whose material lacks a constant, an index that is not a number.
    pub fn judged_anew(&self, criteria: &[NamedCriterion], materials: &[Material]) -> Result<Option<Extremes>, Error> {
        self.samples.as_ref().map_or(Ok(None), |samples| samples.judge(criteria, materials))
    }

    /// Sizes of the run, from which its time follows.
    pub fn size(&self, model: &Model, sizes: &Sizes) -> Size {
        Size {
            marched: sizes.marched,
            reduced: sizes.marched < sizes.unknowns,
            factor_entries: sizes.factor_entries,
            sites: self.sites,
            step_s: sizes.step,
            samples: (sizes.steps as f64 * sizes.step / model.sample_every) as u64,
            ..model.size(&self.counters)
        }
    }
}

/// The largest index of a criterion at a site over all samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Maximum {
    /// Number of the criterion in the model.
    pub criterion: usize,
    /// Its mode; `None` where no mode ever applied.
    pub mode: Option<usize>,
    /// The index.
    pub index: f64,
    /// Every mode that reached 1 there, and when it first did, s.
    pub reached: Vec<(usize, f64)>,
    /// Where.
    pub site: ScanSite,
}
