//! What was reached of an accuracy that was asked for, and its price.

use fem_core::plugin::Dimension;
use fem_io::scene::Setting;
use serde::Serialize;
use std::fmt;

/// By how much smaller the error is whose price is told.
pub(crate) const FURTHER: f64 = 0.3;

/// What was reached of an accuracy that was asked for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Attained {
    /// Largest relative error asked for.
    pub asked: f64,
    /// Estimated error of the worst of the quantities; nothing where a finer run lacks one of them, or none could be afforded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reached: Option<f64>,
    /// What accuracy is asked of.
    pub quantities: Vec<Worth>,
    /// What each part of the settings is set to, and leaves.
    pub parts: Vec<RaisedPart>,
    /// What is not judged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_judged: Option<&'static str>,
    /// Runs made.
    pub runs: usize,
    /// Processor time of these, s.
    pub cpu_s: f64,
    /// Expected processor time of the run that was chosen, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expected_cpu_s: Option<f64>,
    /// Why no more was done, where less was reached than asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
    /// Expected processor time of a run with 0.3 times the error asked for, s, where settings can be raised that far.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub further_cpu_s: Option<f64>,
    /// Keys that were set.
    pub setting: Setting,
}

/// A part of the settings.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RaisedPart {
    /// Name of its axis.
    pub axis: String,
    /// Its level.
    pub level: String,
    /// Estimated error that it leaves in the worst of the quantities; nothing where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leaves: Option<f64>,
}

/// A quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worth {
    /// Its name.
    pub name: String,
    /// Its estimated error; nothing where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
}

impl Attained {
    /// Whether what was asked for is reached.
    pub fn kept(&self) -> bool {
        self.reached.is_some_and(|reached| reached <= self.asked)
    }
}

/// As people read it.
impl fmt::Display for Attained {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |error: f64| format!("{:.2} %", 1e2 * error);
        let known = |error: Option<f64>| error.map_or("unknown".to_owned(), percent);
        let asked = percent(self.asked);
        let reached =
            self.reached.map_or("errors unknown".to_owned(), |error| format!("errors within {}", percent(error)));
        let (runs, seconds) = (self.runs, self.cpu_s);
        let runs = if runs == 1 { "a run".to_owned() } else { format!("{runs} runs") };
        writeln!(f, "  asked     {asked}: {reached}, by what changes in {runs} ({})", Dimension::TIME.of(seconds))?;
        let parts = self.parts.iter().map(|p| format!("{} {} leaves {}", p.axis, p.level, known(p.leaves)));
        writeln!(f, "            {}", parts.collect::<Vec<_>>().join(", "))?;
        let each = self.quantities.iter().map(|q| format!("{} {}", q.name, known(q.error)));
        writeln!(f, "            {}", each.collect::<Vec<_>>().join(", "))?;
        if let Some(what) = self.not_judged {
            writeln!(f, "            not judged: {what}")?;
        }
        if let Some(why) = &self.stopped {
            writeln!(f, "            not reached: {why}")?;
        }
        let smaller = percent(FURTHER * self.asked);
        match self.further_cpu_s {
            Some(seconds) => {
                write!(f, "            {smaller} would cost a run of about {}", Dimension::TIME.of(seconds))
            }
            None if self.reached.is_none() => write!(f, "            what {smaller} would cost is unknown"),
            None => write!(f, "            {smaller} is beyond what can be raised"),
        }
    }
}
