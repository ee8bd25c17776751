//! When a headline is not to be trusted, in a line each: what stands at the top.

use super::{ImpactFigures, ImpactSummary};
use crate::analyses::delamination::Delaminated;
use crate::analyses::impact::{Outcome, Squeeze};
use crate::model::{Model, Plan};
use fem_core::plugin::{Dimension, digits};
use fem_failure::scan::{FailureEvent, first_per_mode};
use fem_io::scene::Window;

/// Share of the peak that a force must have at the end for the impact not to be over.
const OVER: f64 = 0.01;

/// Share of the energy of the impact that may be lost by the integrator.
const DAMPED: f64 = 0.01;

/// What the effect of damping says of the lowest mode.
const DAMPING_RATIO: &str = "damping_ratio_of_lowest_mode";

/// Ratio of the lowest mode to critical damping that no laminate has.
const STICKY: f64 = 0.3;

/// Estimated error above which a result is named.
const LARGE: f64 = 0.05;

/// Steps in a contact from which on samples at their ends show it.
const SAMPLES: f64 = 10.0;

/// Deflection that the energy of a plate could cause, over the largest that it had, from which on the march ended early.
const FURTHER: f64 = 1.2;

/// All of them.
pub(super) fn cautions(model: &Model, outcome: &Outcome, summary: &ImpactSummary) -> Vec<String> {
    let mut found = Vec::new();
    found.extend(unfinished(model, outcome, summary));
    match &outcome.delaminated {
        None => found.extend(delaminated(summary)),
        Some(grown) => {
            found.extend(bordered(grown));
            found.extend(damped(outcome));
        }
    }
    found.extend(swinging(model, outcome, summary));
    found.extend(between_samples(model, outcome));
    found.extend(sticky(outcome));
    found.extend(rough(summary));
    found.extend(outcome.squeezes.iter().zip(&summary.impact).filter_map(stiff));
    found.extend(first_per_mode(&outcome.events).into_iter().filter_map(|event| onset(model, event)));
    found
}

/// A peak of what was computed, and not of the impact.
fn unfinished(model: &Model, outcome: &Outcome, summary: &ImpactSummary) -> Option<String> {
    let last = outcome.history.last()?;
    let (figures, row) = summary
        .impact
        .iter()
        .zip(&last.impactors)
        .find(|(figures, row)| row.contact_force_n > OVER * figures.peak_force_N && figures.peak_force_N > 0.0)?;
    let name = figures.name.as_ref().map_or(String::new(), |name| format!(" of {name}"));
    let rising = if figures.peak_force_time_s > (1.0 - OVER) * last.time_s { "; it is still rising" } else { "" };
    let Plan::Impact(_) = &model.plan else { return None };
    let help = if outcome.stopped.is_none() { "; make `march.end` later" } else { "" };
    Some(format!(
        "the impact{name} is not over at {}, its force is {}{rising}: peak force, impulse, deflection and `not reached` \
         hold up to then{help}",
        Dimension::TIME.of(last.time_s),
        Dimension::FORCE.of(row.contact_force_n)
    ))
}

/// Delaminations that would have grown on.
fn bordered(grown: &Delaminated) -> Option<String> {
    grown.at_border.then(|| {
        "damage has come to the border of where interfaces may open: enlarge `delamination.radius`, or leave it out"
            .to_owned()
    })
}

/// A plate whose energy could deflect it further, w² = 2 E/k, than it was when its impactors left.
fn swinging(model: &Model, outcome: &Outcome, summary: &ImpactSummary) -> Option<String> {
    let Plan::Impact(impact) = &model.plan else { return None };
    let [figures] = &summary.impact[..] else { return None };
    let last = outcome.history.last()?;
    let energy = last.plate_kinetic_j + last.plate_strain_j;
    let possible = (2.0 * energy / summary.model.static_stiffness_N_m).sqrt();
    // What flies has energy that deflects nothing.
    let further = model.motions.is_empty() && possible > FURTHER * figures.peak_plate_displacement_m;
    (impact.spec.march.until_separation && outcome.stopped.is_none() && further).then(|| {
        format!(
            "the march ended with the separation, at {}, while the plate has the energy to deflect by up to {}: its largest deflection and \
             indices may come later, and it may strike the impactor again; write a time as `march.end`",
            Dimension::TIME.of(last.time_s),
            Dimension::LENGTH.of(possible)
        )
    })
}

/// Contacts that lie between two samples of a march whose steps are divided.
fn between_samples(model: &Model, outcome: &Outcome) -> Option<String> {
    outcome.parts?;
    let Plan::Impact(impact) = &model.plan else { return None };
    let dt = impact.spec.march.step.value;
    let means = outcome
        .contacts
        .iter()
        .filter(|contact| contact.count > 0)
        .map(|contact| contact.duration / f64::from(contact.count));
    let shortest = means.fold(f64::INFINITY, f64::min);
    (shortest < SAMPLES * dt).then(|| {
        format!(
            "a contact lasts {} on average, and steps of {} are divided to follow it: rows of histories, stresses and indices are those at \
             the ends of whole steps, and miss what lies between; make `march.step` at most {}",
            Dimension::TIME.of(shortest),
            Dimension::TIME.of(dt),
            Dimension::TIME.of(shortest / SAMPLES)
        )
    })
}

/// Energy that is neither in the plate nor in its cracks.
fn damped(outcome: &Outcome) -> Option<String> {
    let share = outcome.energy_error;
    (share > DAMPED).then(|| {
        format!(
            "{:.1} % of the energy of the impact was lost in waves that the integrator damps, and not in cracks: halve `march.step`",
            1e2 * share
        )
    })
}

/// Damping that is no longer that of a plate, where its modes are known.
fn sticky(outcome: &Outcome) -> Option<String> {
    let (_, ratio) = outcome.quantities.iter().find(|(key, _)| *key == DAMPING_RATIO)?;
    (*ratio > STICKY).then(|| {
        format!(
            "`effects.damping` damps the lowest mode of the plate by {} times what is critical, where laminates have some hundredths: is its \
             size right?",
            digits(*ratio)
        )
    })
}

/// Interfaces that should have opened.
fn delaminated(summary: &ImpactSummary) -> Option<String> {
    let threshold = summary.delamination_threshold.as_ref()?;
    let time = threshold.time_of_all_s?;
    let peak = summary.impact.iter().map(|impact| impact.peak_force_N).fold(0.0, f64::max);
    let what = match threshold.interfaces {
        1 => "the laminate delaminates".to_owned(),
        n => format!(
            "all {n} interfaces between unlike plies delaminate (one alone at {})",
            Dimension::FORCE.of(threshold.force_N)
        ),
    };
    let too = if threshold.time_s.is_some() { "too large" } else { "probably too large" };
    Some(format!(
        "the force passes {}, at which {what}, at {} and reaches {:.2} times that: from then on it is the force on a plate \
         without damage, and {too}",
        Dimension::FORCE.of(threshold.force_of_all_N),
        Dimension::TIME.of(time),
        peak / threshold.force_of_all_N
    ))
}

/// Results whose estimated error is large.
fn rough(summary: &ImpactSummary) -> Option<String> {
    let errors = summary.accuracy.results?;
    let each = [
        ("peak force", errors.peak_force_relative),
        ("force history", errors.force_history_L2_relative),
        ("impulse", errors.impulse_relative),
        ("deflection", errors.deflection_relative),
    ];
    let large: Vec<String> = each
        .iter()
        .filter(|(_, error)| *error > LARGE)
        .map(|(name, error)| format!("{name} {:.0} %", 1e2 * error))
        .collect();
    (!large.is_empty())
        .then(|| format!("estimated errors are large: {}; `fem study` says what to refine", large.join(", ")))
}

/// A squeeze that was not, or not all, taken from the contact law.
fn stiff((squeeze, figures): (&Option<Squeeze>, &ImpactFigures)) -> Option<String> {
    let Squeeze { compliance, force_limit: limit } = (*squeeze)?;
    let name = figures.name.as_ref().map_or(String::new(), |name| format!(" of {name}"));
    if !(compliance > 0.0) {
        return Some(format!(
            "nothing was taken from the contact law{name}: in these cells the plate thickens under its bending by more than the patch \
             squeezes it, so that `indentation_from` changes nothing; use cells of half the patch there"
        ));
    }
    (figures.peak_force_N > limit).then(|| {
        format!(
            "beyond {} the contact law{name} is so stiff that the plate gives more than half of what the law does: what more it gives there \
             counts twice (`indentation_from`)",
            Dimension::FORCE.of(limit)
        )
    })
}

/// Whether there is a caution about the place of an onset.
pub(crate) fn follows_mesh(model: &Model, event: &FailureEvent) -> bool {
    onset(model, event).is_some()
}

/// An onset whose place is chosen by the mesh or by where the criteria look.
fn onset(model: &Model, event: &FailureEvent) -> Option<String> {
    let [x, y, _] = event.position;
    placed(model, (&event.criterion, event.mode, "time"), event.cell as usize, [x, y])
}

/// How much longer than a window cells may be that it cuts around an impact or a load: of a margin they make some 5 %.
const AROUND: f64 = 1.25;

/// The longest side of a cell, m; of a section, along which nothing changes across, that along the strip.
fn length(model: &Model, quad: usize) -> f64 {
    let section = model.plate.info().is_section();
    let sides = model.plate.plane.corners(quad).sides();
    let long = |[a, b]: [[f64; 2]; 2]| (a[0] - b[0]).hypot(if section { 0.0 } else { a[1] - b[1] });
    sides.map(long).fold(0.0, f64::max)
}

/// A mode of a criterion whose `what` follows the mesh or where the criteria look, by the place of a cell at which it is found.
pub(crate) fn placed(
    model: &Model,
    (criterion, mode, what): (&str, &str, &str),
    quad: usize,
    [x, y]: [f64; 2],
) -> Option<String> {
    let mesh = &model.plate.plane;
    let hangs_on_cell = model.centres.iter().all(|centre| centre.at != [x, y]);
    let name = || format!("{criterion} {mode} at x, y = {}", Dimension::LENGTH.list(&[x, y]));
    let symmetry = model.plate.symmetry();
    let judged = |other: usize| model.watched.binary_search(&symmetry.quad(other)).is_ok();
    let corners = &mesh.quads[quad];
    let beside = (0..mesh.quads.len()).filter(|other| mesh.quads[*other].iter().any(|node| corners.contains(node)));
    if hangs_on_cell && beside.into_iter().any(|other| !judged(other)) {
        return Some(format!("{} is at the border of what is judged: enlarge `failure.radius`", name()));
    }
    let length = length(model, quad);
    // Cells as wide as the window are no longer than it, but for rounding.
    let resolved = if hangs_on_cell { 1.0 + 1e-9 } else { AROUND };
    match model.window {
        Window::Square(side) if length > resolved * side => Some(format!(
            "{} is in a cell {} long, longer than the window of {}: its {what} follows the mesh; refine there",
            name(),
            Dimension::LENGTH.of(length),
            Dimension::LENGTH.of(side)
        )),
        _ => None,
    }
}
