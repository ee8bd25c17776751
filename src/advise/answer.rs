//! An answer of the advisor, as it is printed.

use serde::Serialize;

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
    pub(super) fn new(formula: &'static str, value: String) -> Self {
        Self { formula, value, threshold: String::new(), source: "" }
    }

    pub(super) fn threshold(self, threshold: impl Into<String>) -> Self {
        Self { threshold: threshold.into(), ..self }
    }

    pub(super) fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }
}
