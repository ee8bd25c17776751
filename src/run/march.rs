//! The march in time, watched.

use super::ledger::Ledger;
use super::prepare::{Prepared, unmarchable};
use super::{Maximum, Outcome};
use crate::error::Error;
use crate::stress::Watch;
use fem_failure::scan::Scan;

/// Energy error, relative to the energy of the impact, at which a run stops.
const ENERGY_TOLERANCE: f64 = 1e-2;

/// Rows of the history unless the scene says otherwise.
const HISTORY_ROWS: u64 = 2000;

/// Marches a prepared model to its end; `progress` hears the share of the steps done.
///
/// A march that meets a number that is not finite, or whose energy error exceeds its tolerance, stops and keeps what it
/// had ([`Outcome::stopped`]).
///
/// # Errors
/// Trouble before the first step: a criterion whose material lacks a constant, a singular mass.
pub fn march(prepared: Prepared<'_>, mut progress: impl FnMut(f64)) -> Result<Outcome, Error> {
    let Prepared { model, impact, mut system, reduced, sizes, mut counters, mut stopwatch } = prepared;
    let mut watch = match model.criteria.is_empty() {
        true => None,
        false => Some(Watch::new(model, reduced.as_ref())?),
    };
    stopwatch.lap("prepare stresses");
    let scene = &model.scene;
    let every = |interval: f64| ((interval / sizes.step).round() as u64).max(1);
    let scan_every = every(scene.failure.every);
    let row_every = scene.output.history_every.map_or(sizes.steps.div_ceil(HISTORY_ROWS), every);
    let mut integrator = impact.integrator.clone();
    let mut state = system.initial();
    integrator.start(&mut system, &mut state).map_err(|e| unmarchable(model, impact, e))?;

    let mut ledger = Ledger::new(&system, &state, model.threshold.map(|threshold| threshold.force))?;
    let n = sizes.marched;
    if let Some(watch) = &mut watch {
        watch.sample(0.0, &state.u[..n])?;
    }
    let mut stopped = None;
    for step in 1..=sizes.steps {
        let mut advance = || -> Result<(), Error> {
            integrator.step(&mut system, &mut state, sizes.step)?;
            // A sum of steps drifts; the product does not.
            state.t = step as f64 * sizes.step;
            counters.steps += 1;
            ledger.contacts(&system, &state);
            if step.is_multiple_of(row_every) || step == sizes.steps {
                ledger.row(&system, &state)?;
            }
            if let Some(watch) = watch.as_mut().filter(|_| step.is_multiple_of(scan_every) || step == sizes.steps) {
                stopwatch.lap("march");
                watch.sample(state.t, &state.u[..n])?;
                stopwatch.lap("scan");
            }
            Ok(())
        };
        if let Err(error) = advance() {
            stopped = Some(format!("step {step} (t = {:.6e} s): {}", state.t, chain(&error)));
            break;
        }
        if !(ledger.error <= ENERGY_TOLERANCE) {
            stopped = Some(format!(
                "step {step} (t = {:.6e} s): the energy error is {:.3e} of the impact energy, more than {ENERGY_TOLERANCE:.0e}; \
                 shorten `march.step`",
                state.t, ledger.error
            ));
            break;
        }
        if step.is_multiple_of(64) {
            progress(step as f64 / sizes.steps as f64);
        }
    }
    stopwatch.lap("march");
    let (mut events, mut peaks, mut sites) = (Vec::new(), Vec::new(), 0);
    let (mut histories, mut maxima) = (Vec::new(), Vec::new());
    if let Some(watch) = &mut watch {
        if let (Err(error), None) = (watch.flush(), &stopped) {
            stopped = Some(chain(&error));
        }
        events = watch.scan().events();
        peaks = watch.scan().peaks();
        sites = watch.sites();
        histories = watch.histories().cloned().collect();
        if scene.output.maps {
            maxima = (0..model.criteria.len()).flat_map(|criterion| largest(watch.scan(), criterion)).collect();
        }
        counters.criterion_calls = watch.scan().evaluations();
        stopwatch.lap("scan");
    }
    counters.contact_calls = system.contact_calls();
    let (factorisations, solves) = system.structure().work();
    counters.factorisations = counters.factorisations.max(factorisations);
    counters.solves = counters.solves.max(solves);
    Ok(Outcome {
        contacts: ledger.records().collect(),
        history: ledger.rows,
        events,
        peaks,
        histories,
        maxima,
        sites,
        energy_error: ledger.error,
        counters,
        phases: stopwatch.phases().to_vec(),
        stopped,
    })
}

/// Largest index of a criterion at each of its sites.
fn largest(scan: &Scan, criterion: usize) -> impl Iterator<Item = Maximum> {
    scan.maxima(criterion).map(move |(site, maxima)| {
        let (mode, index) =
            maxima.iter().enumerate().fold((None, 0.0), |m, (k, &v)| if v > m.1 { (Some(k), v) } else { m });
        Maximum { criterion, mode, index, site: *site }
    })
}

/// An error with its causes, on one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text.push_str(": ");
        text.push_str(&cause.to_string());
        source = cause.source();
    }
    text
}
