//! The impact of TRADYR: governors and impactor in time.

use super::model::Model;
use crate::analyses::impact::{BALANCE_EVERY, ContactRecord, Follower, StepForces, history_row};
use crate::error::Error;
use fem_core::assembly::FactorError;
use fem_core::counters::Counters;
use fem_core::time::{Integrator, SecondOrderSystem, State};
use fem_dynamics::contact::SunYang;
use fem_dynamics::guard::{Alarm, Guard};
use fem_dynamics::impact::{ImpactSystem, Impactor};
use fem_dynamics::integrate::{Rk1, Rk2, Rk3, Rk4};
use fem_io::deck::{DeckSource, Fault, ImpactDeck, MarchCard};
use fem_io::tables::HistoryRow;

/// Most bytes of motions that are held for printing.
const MOST_BYTES: usize = 1 << 31;

/// A print step.
#[derive(Debug, Clone)]
pub(super) struct Print {
    /// Steps of this run so far.
    pub(super) step: usize,
    pub(super) time: f64,
    pub(super) force: f64,
    /// Δ and Δmax.
    pub(super) indentation: [f64; 2],
    /// u, v, a of the impactor.
    pub(super) impactor: [f64; 3],
    /// u, v, a of all degrees of freedom.
    pub(super) motion: [Vec<f64>; 3],
}

/// A march that was made.
#[derive(Debug)]
pub(super) struct Marched {
    pub(super) prints: Vec<Print>,
    /// What an impact's history holds, at its beginning and at print steps.
    pub(super) rows: Vec<HistoryRow>,
    pub(super) contact: ContactRecord,
    /// The force at every step of this run.
    pub(super) forces: StepForces,
    /// When this run began.
    pub(super) begin: f64,
    pub(super) counters: Counters,
    pub(super) state: State,
    /// Largest change of the energy, relative to that of the impact.
    pub(super) error: f64,
    /// Why it ended before its last step.
    pub(super) stopped: Option<String>,
}

/// The governors and what strikes them.
///
/// # Errors
/// More governors than can be numbered.
pub(super) fn system(deck: &ImpactDeck, model: &Model) -> Result<ImpactSystem, FactorError> {
    let card = &deck.impactor;
    let struck = deck.freedom.kept.iter().position(|dof| *dof == deck.struck).unwrap_or_default();
    let impactor = Impactor {
        mass: card.mass,
        velocity: card.velocity.abs(),
        start: 0.0,
        load: vec![(struck, card.velocity.signum())],
        law: Box::new(SunYang::new([card.k, card.n], card.m, card.c, card.i)),
    };
    Ok(ImpactSystem::new(Box::new(model.structure()?), vec![impactor]))
}

/// Marches from `from`, or from the beginning; one that does what no impact can do stops, and keeps what it had.
///
/// # Errors
/// More print steps than can be held.
pub(super) fn march(
    source: &DeckSource,
    deck: &ImpactDeck,
    march: &MarchCard,
    model: &Model,
    from: Option<State>,
) -> Result<Marched, Error> {
    let prints = march.steps / march.every;
    if prints.saturating_mul(24 * deck.freedom.ndof()) > MOST_BYTES {
        let found = format!("{prints} print steps of {} degrees of freedom", deck.freedom.ndof());
        let help = "they are held in memory: a longer NPRINT makes fewer of them";
        return Err(source.error(march.step.place.clone(), Fault::TooLarge, found, help).into());
    }
    let card = &deck.impactor;
    let side = card.velocity.signum();
    let mut system = system(deck, model)?;
    let mut fresh = system.initial();
    // Not -0 of an impactor that strikes against DIR.
    fresh.u[deck.freedom.kept.len()] = side * card.position + 0.0;
    // An initial indentation counts as the largest so far.
    system.commit(&mut fresh)?;
    // Of a restart as well, so that what is lost in all runs together counts.
    let guard = Guard::begun(&mut system, &fresh);
    let mut integrator: Box<dyn Integrator> = match march.order {
        1 => Box::new(Rk1::default()),
        2 => Box::new(Rk2::default()),
        3 => Box::new(Rk3::default()),
        _ => Box::new(Rk4::default()),
    };
    let mut state = match from {
        Some(state) => {
            integrator.resume(&mut system);
            state
        }
        None => {
            integrator.start(&mut system, &mut fresh)?;
            fresh
        }
    };
    let (begin, mut work) = (state.t, Vec::new());
    let begun = system.energies(&state, &mut work);
    let mut rows = vec![history_row(&system, &state, &begun, guard.energy())];
    let (mut contact, mut forces) = (Follower::since(begin), StepForces::new(march.step.value));
    let mut printed = Vec::with_capacity(prints);
    let (mut error, mut stopped, mut steps) = (0.0_f64, None, 0);
    for step in 1..=march.steps {
        let stepped = integrator.step(&mut system, &mut state, march.step.value);
        let touch = system.touch(0, &state);
        let sound = stepped.map_err(|why| why.to_string()).and_then(|_| guard.touch(0, touch).map_err(broken));
        let prints = step % march.every == 0;
        let looked = sound.and_then(|()| {
            if !(prints || (step as u64).is_multiple_of(BALANCE_EVERY) || step == march.steps) {
                return Ok(None);
            }
            let energies = system.energies(&state, &mut work);
            if let Err(Alarm::Energy(change)) = guard.balance(&energies) {
                error = error.max(change.abs());
            }
            guard.balance(&energies).map(|change| Some((change, energies))).map_err(broken)
        });
        let looked = match looked {
            Ok(looked) => looked,
            Err(why) => {
                stopped =
                    Some(format!("the march stopped in step {step} of {}, at {:.6e}: {why}", march.steps, state.t));
                break;
            }
        };
        steps += 1;
        contact.take(state.t, touch);
        forces.take(step as u64, touch.force);
        let Some((change, energies)) = looked else { continue };
        error = error.max(change.abs());
        if prints {
            printed.push(print(step, side, &system, model, &state));
            rows.push(history_row(&system, &state, &energies, guard.energy()));
        }
    }
    let (factorisations, solves) = system.structure().work();
    let counters =
        Counters { factorisations, solves, steps, contact_calls: system.contact_calls(), ..Counters::default() };
    Ok(Marched { prints: printed, rows, contact: contact.finish(), forces, begin, counters, state, error, stopped })
}

/// What no impact can do, without units, which a deck need not have.
fn broken(alarm: Alarm) -> String {
    match alarm {
        Alarm::NotFinite(what) => format!("{what} is not a finite number"),
        Alarm::Energy(change) => {
            let which = if change > 0.0 { "grown" } else { "fallen" };
            format!("the energy has {which} by {:.3e} of that of the impact", change.abs())
        }
        Alarm::Speed { .. } => {
            "the impactor is faster than 1.5 times the energy of the impact could make it".to_owned()
        }
        Alarm::Penetration { .. } => {
            "the contact is deeper than 1.5 times the energy of the impact could press it".to_owned()
        }
        other => other.to_string(),
    }
}

fn print(step: usize, side: f64, system: &ImpactSystem, model: &Model, state: &State) -> Print {
    let governors = model.omega.len();
    let touch = system.touch(0, state);
    let parts = [&state.u, &state.v, &state.a];
    Print {
        step,
        time: state.t,
        force: touch.force,
        indentation: [touch.indentation, state.histories.contacts[0][0]],
        impactor: parts.map(|x| side * x[governors]),
        motion: parts.map(|x| model.way.expand(&x[..governors])),
    }
}
