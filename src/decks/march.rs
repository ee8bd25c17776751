//! The impact of TRADYR: governors and impactor in time.

use super::model::Model;
use crate::analyses::impact::{ContactRecord, Follower, StepForces, history_row};
use crate::error::Error;
use fem_core::counters::Counters;
use fem_core::time::{Integrator, SecondOrderSystem, State};
use fem_dynamics::contact::SunYang;
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
}

/// Marches from `from`, or from the beginning.
///
/// # Errors
/// More print steps than can be held, a state that is not finite.
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
    let struck = deck.freedom.kept.iter().position(|dof| *dof == deck.struck).unwrap_or_default();
    let impactor = Impactor {
        mass: card.mass,
        velocity: card.velocity.abs(),
        start: 0.0,
        load: vec![(struck, side)],
        law: Box::new(SunYang::new([card.k, card.n], card.m, card.c, card.i)),
    };
    let mut system = ImpactSystem::new(Box::new(model.structure()?), vec![impactor]);
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
            let mut state = system.initial();
            let governors = deck.freedom.kept.len();
            // Not -0 of an impactor that strikes against DIR.
            state.u[governors] = side * card.position + 0.0;
            // An initial indentation counts as the largest so far.
            system.commit(&mut state)?;
            integrator.start(&mut system, &mut state)?;
            state
        }
    };
    let (begin, mut work) = (state.t, Vec::new());
    let begun = system.energies(&state, &mut work);
    let mut rows = vec![history_row(&system, &state, &begun, begun.total())];
    let (mut contact, mut forces) = (Follower::since(begin), StepForces::new(march.step.value));
    let mut printed = Vec::with_capacity(prints);
    for step in 1..=march.steps {
        integrator.step(&mut system, &mut state, march.step.value)?;
        let touch = system.touch(0, &state);
        contact.take(state.t, touch);
        forces.take(step as u64, touch.force);
        if step % march.every == 0 {
            printed.push(print(step, side, &system, model, &state));
            let energies = system.energies(&state, &mut work);
            rows.push(history_row(&system, &state, &energies, begun.total()));
        }
    }
    let (factorisations, solves) = system.structure().work();
    let counters = Counters {
        factorisations,
        solves,
        steps: march.steps as u64,
        contact_calls: system.contact_calls(),
        ..Counters::default()
    };
    Ok(Marched { prints: printed, rows, contact: contact.finish(), forces, begin, counters, state })
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
