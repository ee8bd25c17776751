//! What every criterion's file needs.

pub(crate) use crate::terms::{Terms, from_terms};
pub(crate) use fem_core::failure::{CriterionInfo, FailureCriterion, Site, StressRange, UnmetCondition};
pub(crate) use fem_core::interval::Interval;
pub(crate) use fem_core::material::{Material, Strength};
pub(crate) use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
pub(crate) use fem_core::tensor::{Ply, Stress6};

/// ⟨v⟩: v if positive, else 0. NaN stays NaN, which `f64::max` would drop.
#[inline]
pub(crate) fn macaulay(v: f64) -> f64 {
    if v < 0.0 { 0.0 } else { v }
}

/// The bound of a mode that applies to a stress alone where a condition is met, which some of a range do or none.
#[inline]
pub(crate) fn when(some: bool, bound: f64) -> f64 {
    if some { bound.max(0.0) } else { 0.0 }
}

/// Sums of numbers may be off by this share of the numbers, which may cancel.
const ROUNDING: f64 = 1e-12;

/// What no sum of numbers in these `terms` exceeds.
#[inline]
pub(crate) fn most_of_sum<const N: usize>(terms: [Interval; N]) -> f64 {
    terms.iter().map(|term| term.high + ROUNDING * term.magnitude()).sum()
}
