//! What the user should know of the contacts of an impact.

use crate::advise::warn_of_coarse_cells;
use crate::analyses::impact::{ContactRecord, Outcome, Sizes};
use crate::model::{Model, Plan};
use crate::words::warn_of_softness;
use fem_core::plugin::Dimension;

/// All of it.
pub(super) fn of_contacts(model: &Model, sizes: &Sizes, outcome: &Outcome) -> impl Iterator<Item = String> {
    let coarse = warn_of_coarse_cells(model, &outcome.contacts);
    let soft = sizes.softness.map(warn_of_softness);
    soft.into_iter()
        .chain(deep(model, outcome))
        .chain(long_steps(model, sizes, outcome))
        .chain(few_looks(model, sizes, outcome))
        .chain(rare_rows(outcome))
        .chain(coarse)
}

/// Indentation over thickness above which a plate is not a half-space to an impactor; the shipped examples reach 0.05.
const DEEP: f64 = 0.25;

/// A warning of each contact that went deeper than contact laws are made for.
fn deep(model: &Model, outcome: &Outcome) -> impl Iterator<Item = String> {
    let thickness = model.laminate.thickness();
    let deep = outcome.contacts.iter().filter(move |contact| contact.deepest > DEEP * thickness);
    deep.map(move |contact| {
        format!(
            "the impactor is pressed {} deep into a plate of {}: contact laws hold for indentations that \
             are small compared with the thickness, unless it is the impactor that yields",
            Dimension::LENGTH.of(contact.deepest),
            Dimension::LENGTH.of(thickness)
        )
    })
}

/// Steps in a period of the force below which a step counts as too long, and those of a better one.
const COARSE: f64 = 20.0;
const FINE: f64 = 60.0;
/// Estimated error of the force from which on a step counts as too long.
const WRONG: f64 = 0.05;

/// A warning where steps are too long and the energy cannot show it.
fn long_steps(model: &Model, sizes: &Sizes, outcome: &Outcome) -> Option<String> {
    let Plan::Impact(impact) = &model.plan else { return None };
    if !impact.integrator.conserves_energy() || outcome.parts.is_some() {
        return None;
    }
    let frequency = outcome.contacts.iter().filter_map(ContactRecord::frequency).fold(0.0, f64::max);
    let steps = 1.0 / (frequency * sizes.step);
    let error = outcome.accuracy.step.map(|step| step.error.force).filter(|error| *error > WRONG);
    let (why, shorter) = match error {
        _ if steps < COARSE => {
            (format!("the contact force changes in {steps:.1} steps a period"), 1.0 / (FINE * frequency))
        }
        Some(error) => {
            (format!("the step leaves about {:.0} % of the contact force", 100.0 * error), 0.25 * sizes.step)
        }
        None => return None,
    };
    Some(format!(
        "{why}, and an integrator that keeps the energy at every step does not show it there: set `march.step` to {}",
        Dimension::TIME.of(shorter)
    ))
}

/// Looks at a contact below which its stresses may have been missed.
const LOOKS: f64 = 4.0;

/// A warning where the criteria looked at a contact too seldom, although steps are short enough.
fn few_looks(model: &Model, sizes: &Sizes, outcome: &Outcome) -> Option<String> {
    let ends = |(i, contact): (usize, &ContactRecord)| {
        let touches = outcome.history.last().is_some_and(|row| row.impactors[i].contact_force_n > 0.0);
        (contact.count > 0 && !touches).then_some(contact.duration)
    };
    let shortest = outcome.contacts.iter().enumerate().filter_map(ends).fold(f64::INFINITY, f64::min);
    let seldom = shortest < LOOKS * model.sample_every && model.sample_every > sizes.step;
    (seldom && !model.criteria.is_empty()).then(|| {
        format!(
            "a contact lasted {} in all, and the criteria looked every {}: damage may have come and gone between two looks; \
             set `failure.every` to {}",
            Dimension::TIME.of(shortest),
            Dimension::TIME.of(model.sample_every),
            Dimension::TIME.of((shortest / LOOKS).max(sizes.step))
        )
    })
}

/// Share of a peak that the rows of a history may miss without a word.
const MISSED: f64 = 0.01;

/// A warning where the rows of the history, and with them its pictures, do not show the largest force.
fn rare_rows(outcome: &Outcome) -> Option<String> {
    let shown = |i: usize| outcome.history.iter().map(|row| row.impactors[i].contact_force_n).fold(0.0, f64::max);
    let mut each = outcome.contacts.iter().enumerate().map(|(i, contact)| (contact, shown(i)));
    let (contact, shown) = each.find(|(contact, shown)| *shown < (1.0 - MISSED) * contact.force.0)?;
    Some(format!(
        "the rows of history.csv, and pictures of them, show a largest force of {}, and it was {}: set \
         `output.history_every` to {} or less",
        Dimension::FORCE.of(shown),
        Dimension::FORCE.of(contact.force.0),
        Dimension::TIME.of(contact.duration / f64::from(contact.count) / ROWS)
    ))
}

/// Rows that show a contact.
const ROWS: f64 = 20.0;
