//! What a case found.

use crate::analyses::impact::{Accuracy, Outcome, Sizes, StepForces};
use crate::model::{Model, NamedCriterion};
use crate::output::summary::{ImpactFigures, ImpactSummary};
use crate::words::name_ply;
use fem_failure::scan::{Extremes, first_per_mode};
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
    /// Largest contact force over that at which all interfaces between unlike plies delaminate, where that is known.
    pub over_threshold: Option<f64>,
    /// What has delaminated, where delaminations grow.
    pub grown: Option<GrownFigures>,
    /// Largest deviation of the energy from that of the impact, relative to it.
    pub energy_error: f64,
    /// How many warnings and cautions `fem run` would say, but for those that follow from estimates of errors.
    pub warnings: u64,
    /// The force of all impactors, N, over time, s, at some hundreds of steps at most, to be drawn; none of a march that is judged again.
    pub history: Vec<[f32; 2]>,
}

/// Most points of a history that is drawn.
const DRAWN: usize = 200;

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
    /// What of its energy it does not have at the end, the work of its weight counted.
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
            absorbed_energy: of.absorbed_energy_J,
        }
    }
}

/// What has delaminated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct GrownFigures {
    /// Of the plate under which some interface has delaminated.
    pub projected_area: f64,
    /// Of all interfaces.
    pub area: f64,
    /// In the interfaces.
    pub dissipated_energy: f64,
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
    pub(super) fn of(model: &Model, sizes: &Sizes, outcome: &mut Outcome) -> Self {
        outcome.accuracy = Accuracy::default();
        let summary = ImpactSummary::new(model, sizes, outcome);
        let index = |of: &str, mode: &str| {
            let peak = outcome.peaks.iter().find(|peak| peak.criterion == of && peak.mode == mode);
            peak.map_or(f64::NEG_INFINITY, |peak| peak.index)
        };
        let modes =
            |(name, criterion): &NamedCriterion| criterion.info().modes.iter().map(|m| index(name, m)).collect();
        let found = Extremes {
            largest: model.criteria.iter().map(modes).collect(),
            firsts: first_per_mode(&outcome.events).into_iter().cloned().collect(),
        };
        let none = Self {
            modes: Vec::new(),
            first: None,
            impactors: summary.impact.iter().map(StruckFigures::from).collect(),
            over_threshold: summary.delamination_threshold.as_ref().map(|threshold| {
                summary.impact.iter().map(|of| of.peak_force_N).fold(0.0, f64::max) / threshold.force_of_all_N
            }),
            grown: summary.delamination.as_ref().map(|grown| GrownFigures {
                projected_area: grown.projected_area_mm2 * 1e-6,
                area: grown.area_mm2 * 1e-6,
                dissipated_energy: grown.dissipated_J,
            }),
            energy_error: outcome.energy_error,
            warnings: (summary.warnings.len() + summary.cautions.len()) as u64,
            history: Vec::new(),
        };
        let end = outcome.history.last().map_or(0.0, |row| row.time_s);
        let found = none.judged(&model.criteria, &found, &outcome.forces);
        Self { history: drawn(&outcome.forces, end), ..found }
    }

    /// Of the same march, where these were `found` by criteria.
    pub(super) fn judged(&self, criteria: &[NamedCriterion], found: &Extremes, forces: &StepForces) -> Self {
        let mode = |of: &str, mode: &str, index: f64| ModeFigures {
            name: format!("{of} {mode}"),
            index: if index > f64::NEG_INFINITY { index } else { 0.0 },
            onset: found
                .firsts
                .iter()
                .find(|event| event.criterion == of && event.mode == mode)
                .map(|event| (event.time, forces.at(event.time))),
        };
        let each = criteria.iter().zip(&found.largest).flat_map(|((name, criterion), largest)| {
            let modes = criterion.info().modes.iter().zip(largest);
            modes.map(|(of, index)| mode(name, of, *index)).collect::<Vec<_>>()
        });
        Self {
            modes: each.collect(),
            first: found.firsts.first().map(|event| FirstDamage {
                time: event.time,
                criterion: event.criterion.clone(),
                mode: event.mode.to_owned(),
                ply: name_ply(event.place),
                force: forces.at(event.time),
            }),
            impactors: self.impactors.clone(),
            history: Vec::new(),
            ..*self
        }
    }
}

/// A force until the time `end`, s.
fn drawn(forces: &StepForces, end: f64) -> Vec<[f32; 2]> {
    let steps = (end / forces.step()).round() as usize;
    let every = steps.div_ceil(DRAWN).max(1);
    let points = (0..=steps).step_by(every).map(|step| [step as f64 * forces.step(), forces.after(step)]);
    points.map(|point| point.map(|number| number as f32)).collect()
}
