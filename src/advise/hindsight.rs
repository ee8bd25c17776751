//! A choice held against what happened.

use super::rim::Rim;
use crate::analyses::impact::ContactRecord;
use crate::effect::Hindsight;
use crate::model::{Model, Plan};

/// How far a run of `model` went beyond a linear plate, and when A (w/h)² passed `threshold`: of the impactor under which the
/// plate went farthest, beside the share of its `buckling` load that it carries; `None` where supports do not surround it.
pub fn hindsight(
    model: &Model,
    contacts: &[ContactRecord],
    buckling: Option<f64>,
    threshold: f64,
) -> Option<Hindsight> {
    let Plan::Impact(impact) = &model.plan else { return None };
    let each = impact.strikes.iter().zip(contacts).filter_map(|(strike, contact)| {
        let held = Rim::around(model, strike.centre)?.held?;
        let (coefficient, thickness) = (held.coefficient_beside(buckling), model.thickness_at(strike.centre));
        let number = |w: f64| coefficient * w * w;
        let over: Vec<(f64, f64)> = contact.growth.iter().map(|(t, w)| (*t, w / thickness)).collect();
        let (at, deflection) = over.last().copied().unwrap_or_default();
        let beyond = over.windows(2).find(|pair| number(pair[1].1) > threshold);
        let since = beyond.map(|pair| crossing(pair[0], pair[1], (threshold / coefficient).sqrt()));
        let (reached, held, at) = (number(deflection), held.name(), Some(at));
        Some(Hindsight { reached, coefficient, held, deflection, at, since, lawful: model.laws.is_some() })
    });
    each.max_by(|a, b| a.reached.total_cmp(&b.reached))
}

/// The same of a plate at rest whose largest deflection is `w` at `place`.
pub fn hindsight_at_rest(model: &Model, w: f64, place: [f64; 2], buckling: Option<f64>) -> Option<Hindsight> {
    let held = Rim::around(model, place)?.held?;
    let (coefficient, deflection) = (held.coefficient_beside(buckling), w.abs() / model.thickness_at(place));
    let reached = coefficient * deflection * deflection;
    let (held, lawful) = (held.name(), model.laws.is_some());
    Some(Hindsight { reached, coefficient, held, deflection, at: None, since: None, lawful })
}

/// When a value passes `level` between two times, by a straight line.
fn crossing((before, low): (f64, f64), (after, high): (f64, f64), level: f64) -> f64 {
    before + (after - before) * (level - low) / (high - low)
}
