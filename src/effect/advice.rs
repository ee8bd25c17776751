//! What the advisor is told of an effect, and what it says.

use crate::forecast::Size;
use serde::Serialize;

/// What the user should know after a run, from what it reached, whether the effect acted, and whether the advisor had decided.
pub type Judgement = fn(&Hindsight, bool, bool) -> Option<String>;

/// How the advisor decides about an effect: a number, beforehand, against a threshold.
#[derive(Debug, Clone, Copy)]
pub struct AdviceRule {
    /// What is asked, a formula.
    pub formula: &'static str,
    /// Its value for what is expected of an impactor, or of loads at rest.
    pub number: fn(&Expected) -> f64,
    /// The value above which the key of the effect is set "on".
    pub threshold: f64,
    /// Whether the effect acts above the threshold, and not below.
    pub acts_above: bool,
    /// The answer of `fem advise`, where it has a question of its own; with the time of a run with it over that of one without,
    /// of the sizes of a run without.
    pub answer: Option<fn(&Expected, &Size) -> Answer>,
    /// What the user should know after a run.
    pub hindsight: Option<Judgement>,
}

/// What is expected of a plate under an impactor, or under loads at rest, before it is computed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Expected {
    /// Thickness of the plate, m.
    pub thickness: f64,
    /// Largest deflection, under an impactor until the march ends, m.
    pub deflection: f64,
    /// A of the force Kb w (1 + A (w/h)²) of a plate whose edge is held so, 0 where supports do not surround the place.
    pub coefficient: f64,
    /// Whether they do.
    pub surrounded: bool,
    /// Largest force without inertia of the plate, linear and with that A, N.
    pub forces: [f64; 2],
    /// Force of the first wave over that of the linear plate without inertia, at most 1.
    pub first_wave: f64,
    /// Whether the plate responds as if at rest.
    pub quasi_static: bool,
    /// Whether its vibrations are followed, or the integrator needs them.
    pub vibrates: bool,
}

/// How far the plate went in a run, beside what the advisor had to say of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hindsight {
    /// Largest A (w/h)².
    pub reached: f64,
    /// A.
    pub coefficient: f64,
    /// How the edge is held, in words.
    pub held: &'static str,
    /// Largest w/h.
    pub deflection: f64,
    /// Time of the largest deflection, s; `None` at rest.
    pub at: Option<f64>,
    /// From when on A (w/h)² is above the threshold, s.
    pub since: Option<f64>,
    /// Whether plies follow laws.
    pub lawful: bool,
}

/// A decision about an effect that the scene leaves to the advisor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// The effect, as the scene calls it.
    pub effect: &'static str,
    /// Its value.
    pub on: bool,
    /// What was asked, a formula.
    pub formula: &'static str,
    /// Its value as it is expected, beforehand.
    pub expected: f64,
    /// The value above which it is on.
    pub threshold: f64,
}

/// What the advisor says to a question.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Answer {
    /// What is asked.
    pub question: &'static str,
    /// The numbers that decide.
    pub numbers: Vec<Number>,
    /// What to do.
    pub choice: String,
    /// What is switched on or off, or may be wrong.
    pub effect: &'static str,
    /// What goes wrong then, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// Cost of a run with it over that of one without, by counts of work.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cost: Option<f64>,
}

/// A number that decides.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Number {
    /// Its formula.
    pub formula: &'static str,
    /// Its value, with its unit.
    pub value: String,
    /// What it is held against; empty where it only informs.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub threshold: String,
    /// Where it comes from.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub source: &'static str,
}

impl Number {
    /// A number that only informs.
    pub fn new(formula: &'static str, value: String) -> Self {
        Self { formula, value, threshold: String::new(), source: "" }
    }

    /// The same, held against `threshold`.
    #[must_use]
    pub fn threshold(self, threshold: impl Into<String>) -> Self {
        Self { threshold: threshold.into(), ..self }
    }

    /// The same, with where it comes from.
    #[must_use]
    pub fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }
}
