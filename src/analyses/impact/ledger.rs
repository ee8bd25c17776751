//! The history as it grows, with its energies.

use super::ContactRecord;
use crate::effect::Effect;
use fem_core::time::State;
use fem_dynamics::guard::{Alarm, Guard};
use fem_dynamics::impact::{Energies, ImpactSystem, Touch};
use fem_io::tables::{HistoryRow, ImpactorRow};
use serde::{Deserialize, Serialize};

/// The history as it grows, with the energy ledger.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Ledger {
    pub(super) rows: Vec<HistoryRow>,
    /// Largest change of the total energy, relative.
    pub(super) error: f64,
    contacts: Vec<Contact>,
    #[serde(skip)]
    work: Vec<f64>,
}

impl Ledger {
    /// `threshold`: a force whose first reaching is noted, N.
    pub(super) fn new(contacts: usize, threshold: Option<f64>) -> Self {
        let contacts = vec![Contact { threshold, ..Contact::default() }; contacts];
        Self { rows: Vec::new(), error: 0.0, contacts, work: Vec::new() }
    }

    /// Shows effects the end of a step.
    pub(super) fn step(&mut self, effects: &mut [Box<dyn Effect>], system: &ImpactSystem, state: &State) {
        effects.iter_mut().for_each(|effect| effect.on_step(system, state, &mut self.work));
    }

    /// Takes the contact forces of a step.
    pub(super) fn contacts(&mut self, system: &ImpactSystem, guard: &Guard, state: &State) -> Result<(), Alarm> {
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            let touch = system.touch(i, state);
            guard.touch(i, touch)?;
            contact.sample(state.t, touch);
        }
        Ok(())
    }

    /// Adds up the energies; they are returned as well where an alarm is.
    pub(super) fn balance(
        &mut self,
        effects: &[Box<dyn Effect>],
        system: &mut ImpactSystem,
        guard: &Guard,
        state: &State,
    ) -> (Energies, Result<(), Alarm>) {
        let mut energies = system.energies(state, &mut self.work);
        energies.damped = effects.iter().fold(0.0, |sum, effect| sum + effect.lost());
        let balanced = guard.balance(&energies);
        if let Ok(change) | Err(Alarm::Energy(change)) = balanced {
            self.error = self.error.max(change.abs());
        }
        (energies, balanced.map(|_| ()))
    }

    pub(super) fn records(&self) -> impl Iterator<Item = ContactRecord> {
        self.contacts.iter().map(|contact| contact.record)
    }

    /// Writes a row, also the last one of a march that leaks; none of numbers that are not finite.
    pub(super) fn row(
        &mut self,
        effects: &[Box<dyn Effect>],
        system: &mut ImpactSystem,
        guard: &Guard,
        state: &State,
    ) -> Result<(), Alarm> {
        let (e, balanced) = self.balance(effects, system, guard, state);
        if let Err(Alarm::NotFinite(_)) = balanced {
            return balanced;
        }
        let impactor = |i: usize| {
            let Touch { force, velocity, .. } = system.touch(i, state);
            ImpactorRow {
                contact_force_n: force,
                impactor_displacement_m: system.position(i, &state.u),
                impactor_velocity_m_s: velocity,
                plate_displacement_m: system.deflection(i, &state.u),
            }
        };
        self.rows.push(HistoryRow {
            time_s: state.t,
            impactors: (0..self.contacts.len()).map(impactor).collect(),
            impactor_kinetic_j: e.impactor,
            plate_kinetic_j: e.kinetic,
            plate_strain_j: e.strain,
            contact_stored_j: e.stored,
            contact_dissipated_j: e.dissipated,
            effects: effects.iter().flat_map(|effect| effect.values(system, state, &e)).collect(),
            energy_balance_j: e.total() - guard.energy(),
        });
        balanced
    }
}

/// A contact as seen at every step.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
struct Contact {
    threshold: Option<f64>,
    /// Time and force before; the force is 0 at the time 0.
    last: (f64, f64),
    record: ContactRecord,
}

impl Contact {
    /// The threshold's time comes by linear interpolation between samples.
    fn sample(&mut self, t: f64, Touch { indentation, force, .. }: Touch) {
        let (before, low) = self.last;
        self.record.deepest = self.record.deepest.max(indentation);
        self.record.count += u32::from(force > 0.0 && low <= 0.0);
        if let (None, Some(level)) = (self.record.threshold_time, self.threshold)
            && force >= level
        {
            self.record.threshold_time = Some(before + (t - before) * ((level - low) / (force - low)));
        }
        self.last = (t, force);
    }
}
