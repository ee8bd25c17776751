//! What a case found.

use crate::analyses::impact::{Accuracy, Outcome, Sizes};
use crate::model::Model;
use crate::output::summary::{ImpactFigures, ImpactSummary};
use crate::words::name_ply;
use fem_failure::scan::FailureEvent;
use serde::{Deserialize, Serialize};

/// What a case found; SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseFigures {
    /// Of each impactor.
    pub impactors: Vec<StruckFigures>,
    /// The first damage of all, if there was some.
    pub first: Option<FirstDamage>,
    /// Of each mode of each criterion.
    pub modes: Vec<ModeFigures>,
    /// Largest deviation of the energy from that of the impact, relative to it.
    pub energy_error: f64,
    /// How many warnings and cautions `fem run` would say, but for those that follow from estimates of errors.
    pub warnings: u64,
}

/// What an impactor did.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct StruckFigures {
    /// Its name, where there are several.
    pub name: Option<String>,
    pub energy: f64,
    pub peak_force: f64,
    pub peak_force_time: f64,
    pub impulse: f64,
    pub deflection: f64,
    pub contact_time: f64,
    /// What of its energy it does not have at the end.
    pub absorbed_energy: f64,
}

impl From<&ImpactFigures> for StruckFigures {
    fn from(of: &ImpactFigures) -> Self {
        Self {
            name: of.name.clone(),
            energy: of.energy_J,
            peak_force: of.peak_force_N,
            peak_force_time: of.peak_force_time_s,
            impulse: of.impulse_N_s,
            deflection: of.peak_plate_displacement_m,
            contact_time: of.contact_time_s,
            absorbed_energy: of.energy_J - 0.5 * of.mass_kg * of.final_impactor_velocity_m_s.powi(2),
        }
    }
}

/// First damage: when, by what, where, and the contact force then.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct FirstDamage {
    pub time: f64,
    pub criterion: String,
    pub mode: String,
    pub ply: String,
    pub force: f64,
}

/// What a mode of a criterion came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModeFigures {
    /// Criterion and mode.
    pub name: String,
    /// Its largest index anywhere; 0 where it never applied.
    pub index: f64,
    /// When it first reached 1, s, and the contact force then, N.
    pub onset: Option<(f64, f64)>,
}

impl CaseFigures {
    /// Of a march that ended.
    pub(super) fn of(model: &Model, sizes: &Sizes, mut outcome: Outcome) -> Self {
        outcome.accuracy = Accuracy::default();
        let summary = ImpactSummary::new(model, sizes, &outcome);
        let force = |event: &FailureEvent| outcome.forces.at(event.time);
        let earliest = |event: &&FailureEvent, of: &str, mode: &str| event.criterion == of && event.mode == mode;
        let mode = |of: &str, mode: &str| ModeFigures {
            name: format!("{of} {mode}"),
            index: outcome.peaks.iter().find(|peak| peak.criterion == of && peak.mode == mode).map_or(0.0, |p| p.index),
            onset: outcome
                .events
                .iter()
                .find(|event| earliest(event, of, mode))
                .map(|event| (event.time, force(event))),
        };
        let modes = model
            .criteria
            .iter()
            .flat_map(|(name, criterion)| criterion.info().modes.iter().map(|of| mode(name, of)).collect::<Vec<_>>());
        Self {
            modes: modes.collect(),
            first: outcome.events.first().map(|event| FirstDamage {
                time: event.time,
                criterion: event.criterion.clone(),
                mode: event.mode.to_owned(),
                ply: name_ply(event.place),
                force: force(event),
            }),
            impactors: summary.impact.iter().map(StruckFigures::from).collect(),
            energy_error: outcome.energy_error,
            warnings: (summary.warnings.len() + summary.cautions.len()) as u64,
        }
    }
}
