//! How far the time of an onset is known.

use crate::analyses::impact::{Accuracy, Outcome};
use crate::model::Model;
use fem_core::plugin::Dimension;
use fem_core::tensor::Stress6;
use fem_failure::scan::{Climb, Crests, FailureEvent, Peak, first_per_mode};
use serde::Serialize;

/// How much lower or higher a strength is that a time is given for: the scatter of a good material.
const STRENGTH: f64 = 0.05;

/// What moves the first onset of a mode. A time that is not there is later than the run, or earlier than what was followed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct OnsetBand {
    pub criterion: String,
    pub mode: String,
    pub time_s: f64,
    /// Estimated error of the stress, of the force's history and of the strains under the contact together, and the times between
    /// which it leaves the onset.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stress_error_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub earliest_time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub latest_time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strength_5_percent_lower_time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strength_5_percent_higher_time_s: Option<f64>,
    /// Two crests of the index of which either may reach 1 first: the index that one of them does not pass, and when the next does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crest_index: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next_crest_time_s: Option<f64>,
}

/// Of the first event of each mode.
pub(super) fn bands(model: &Model, outcome: &Outcome) -> Vec<OnsetBand> {
    let error = stress_error(&outcome.accuracy);
    let firsts = first_per_mode(&outcome.events).into_iter();
    firsts.filter_map(|event| OnsetBand::of(model, &outcome.peaks, error, event)).collect()
}

impl OnsetBand {
    /// Of the first event of a mode whose stresses have this error.
    fn of(model: &Model, peaks: &[Peak], error: Option<f64>, event: &FailureEvent) -> Option<Self> {
        let peak = peaks.iter().find(|peak| peak.criterion == event.criterion && peak.mode == event.mode)?;
        let climb = &peak.climb;
        // The index that reaches 1 where all stresses are `factor` times as large.
        let level = |factor: f64| Some(1.0 / index(model, event, factor)?);
        let at = |factor: f64| time(climb, event, level(factor)?);
        let ends = [level(1.0 / (1.0 - STRENGTH)), level(1.0 / (1.0 + STRENGTH))];
        let crests = match ends {
            [Some(low), Some(high)] => climb.crests(low, high),
            _ => None,
        };
        Some(Self {
            criterion: event.criterion.clone(),
            mode: event.mode.to_owned(),
            time_s: event.time,
            stress_error_relative: error,
            earliest_time_s: error.and_then(|error| at(1.0 + error)),
            latest_time_s: error.and_then(|error| at(1.0 / (1.0 + error))),
            strength_5_percent_lower_time_s: at(1.0 / (1.0 - STRENGTH)),
            strength_5_percent_higher_time_s: at(1.0 / (1.0 + STRENGTH)),
            crest_index: crests.map(|Crests { first, .. }| first),
            next_crest_time_s: crests.map(|Crests { next, .. }| next).filter(|next| next.is_finite()),
        })
    }

    /// As people read it, after the onset's own time.
    pub(super) fn text(&self) -> String {
        let at = |time: Option<f64>| time.map_or_else(|| "not reached".to_owned(), |t| Dimension::TIME.of(t));
        let errors = match self.stress_error_relative {
            None => "errors not estimated".to_owned(),
            Some(error) => {
                let (from, to) = (at(self.earliest_time_s), at(self.latest_time_s));
                format!("{from} to {to} for stresses {:.1} % larger or smaller", 1e2 * error)
            }
        };
        let [lower, higher] = [self.strength_5_percent_lower_time_s, self.strength_5_percent_higher_time_s].map(at);
        let crests = self.crest_index.map_or_else(String::new, |index| {
            let next = self.next_crest_time_s.map_or("none until the end".to_owned(), |t| Dimension::TIME.of(t));
            format!("; crests compete: one reaches an index of {index:.2}, the next to pass it comes at {next}")
        });
        format!("{errors}; strengths 5 % lower {lower}, 5 % higher {higher}{crests}")
    }
}

/// Of the history of the force and of the strains under the contact, which have nothing to do with each other.
fn stress_error(accuracy: &Accuracy) -> Option<f64> {
    Some(accuracy.results()?.force.hypot(accuracy.mesh?.at_rest))
}

/// The index of the mode of `event` under `factor` times its stress.
fn index(model: &Model, event: &FailureEvent, factor: f64) -> Option<f64> {
    let (_, criterion) = model.criteria.iter().find(|(name, _)| *name == event.criterion)?;
    let info = criterion.info();
    let mut indices = vec![0.0; info.modes.len()];
    let stress = Stress6::new(event.stress.0.map(|s| factor * s));
    criterion.indices(&stress, &model.materials[usize::from(event.material)], &mut indices);
    let mode = info.modes.iter().position(|mode| *mode == event.mode)?;
    Some(indices[mode]).filter(|index| index.is_finite() && *index > 0.0)
}

/// When the index first passed `level`: what was followed begins at half of 1, and the onset itself is known better.
fn time(climb: &Climb, event: &FailureEvent, level: f64) -> Option<f64> {
    let time = climb.at(level)?;
    Some(if level < 1.0 { time.min(event.time) } else { time.max(event.time) })
}
