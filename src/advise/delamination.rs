//! Whether a laminate will delaminate.

use super::estimate::Estimate;
use super::regime::Regime;
use crate::effect::{Answer, Number};
use crate::model::Model;
use fem_core::plugin::Dimension;
use fem_failure::delamination::DelaminationThreshold;

/// Force over threshold up to which a plate without delaminations will do, and from which on it will not: GIIc is known to
/// about 50 %, which is 25 % of the force.
const SAFE: f64 = 0.8;
const BEYOND: f64 = 1.2;

/// Threshold of a small mass over that of a large one (Olsson, Donadon and Falzon 2006).
const DYNAMIC: f64 = 1.21;

/// What an impact does to the interfaces of a laminate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DelaminationAdvice {
    /// The force at which it delaminates, N, and what it follows from.
    pub threshold: DelaminationThreshold,
    /// Largest force of the impact over the threshold of one delamination and over that of all interfaces, which count 1.21 times for
    /// a small mass.
    pub ratios: [f64; 2],
}

/// What the threshold says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delaminates {
    /// No: an elastic run is enough.
    No,
    /// It may.
    Perhaps,
    /// Yes: what an elastic run finds after the threshold is not to be trusted.
    Yes,
}

impl DelaminationAdvice {
    /// `None` where no material gives GIIc.
    pub(super) fn new(model: &Model, estimate: &Estimate) -> Option<Self> {
        let resin = model.interface;
        let threshold = DelaminationThreshold::of(&model.laminate, &model.materials, resin)?;
        let dynamic = if estimate.regime == Regime::SmallMass { DYNAMIC } else { 1.0 };
        let ratios = [threshold.force, threshold.force_of_all].map(|force| estimate.force() / (dynamic * force));
        Some(Self { threshold, ratios })
    }

    /// What that means.
    pub fn verdict(&self) -> Delaminates {
        match self.ratios {
            [one, _] if one > BEYOND => Delaminates::Yes,
            [_, all] if all < SAFE => Delaminates::No,
            _ => Delaminates::Perhaps,
        }
    }
}

pub(super) fn answer(found: Option<&DelaminationAdvice>) -> Answer {
    let answer = |numbers, choice: &str| Answer {
        question: "delamination",
        numbers,
        choice: choice.into(),
        effect: "delamination",
        error: None,
        cost: None,
    };
    let Some(found) = found else {
        return answer(Vec::new(), "unknown: no material gives its toughness `GIIc`, or there is one ply alone");
    };
    let DelaminationThreshold { force, interfaces, force_of_all, giic, .. } = found.threshold;
    let choice = match found.verdict() {
        Delaminates::No => "an elastic run is enough",
        Delaminates::Perhaps => "it may delaminate: look at when the thresholds are reached",
        Delaminates::Yes => {
            "it will delaminate: trust the run up to the threshold, interfaces that open are not simulated"
        }
    };
    let [one, all] = found.ratios;
    let numbers = vec![
        Number::new("F / F_1", format!("{one:.3}"))
            .threshold(format!("yes above {BEYOND}"))
            .source("Davies and Zhang 1995; small mass 1.21 F_n, Olsson 2006"),
        Number::new("F / F_n", format!("{all:.3}")).threshold(format!("no below {SAFE}")),
        Number::new(
            "F_n = pi sqrt(32 D* GIIc/(n+2))",
            format!("{} at n = 1 and GIIc {giic:.0} J/m^2", Dimension::FORCE.of(force)),
        )
        .source("50 % more or less GIIc changes F_n by about 25 %"),
        Number::new("interfaces of unlike plies", format!("n = {interfaces}: {}", Dimension::FORCE.of(force_of_all))),
    ];
    answer(numbers, choice)
}
