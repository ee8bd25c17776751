//! The history as it grows, with its energies.

use super::ContactRecord;
use fem_core::time::{State, StepError};
use fem_dynamics::impact::ImpactSystem;
use fem_io::tables::{HistoryRow, ImpactorRow};
use serde::{Deserialize, Serialize};

/// The history as it grows, with the energy ledger.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Ledger {
    pub(super) rows: Vec<HistoryRow>,
    initial: f64,
    pub(super) error: f64,
    contacts: Vec<Contact>,
    #[serde(skip)]
    work: Vec<f64>,
}

impl Ledger {
    /// `threshold`: a force whose first reaching is noted, N.
    pub(super) fn new(system: &ImpactSystem, state: &State, threshold: Option<f64>) -> Result<Self, StepError> {
        let mut work = Vec::new();
        let initial = system.energies(state, &mut work).total();
        let contacts = vec![Contact { threshold, ..Contact::default() }; state.contacts.len()];
        let mut ledger = Self { rows: Vec::new(), initial, error: 0.0, contacts, work };
        ledger.row(system, state)?;
        Ok(ledger)
    }

    /// Takes the contact forces of a step.
    pub(super) fn contacts(&mut self, system: &ImpactSystem, state: &State) {
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            contact.sample(state.t, system.contact_force(i, state));
        }
    }

    pub(super) fn records(&self) -> impl Iterator<Item = ContactRecord> {
        self.contacts.iter().map(|contact| contact.record)
    }

    /// Writes a row of numbers that are all finite.
    pub(super) fn row(&mut self, system: &ImpactSystem, state: &State) -> Result<(), StepError> {
        let e = system.energies(state, &mut self.work);
        let n = system.structure().ndof();
        let balance = e.total() - self.initial;
        let error = (balance / self.initial).abs();
        let impactor = |i: usize| ImpactorRow {
            contact_force_n: system.contact_force(i, state),
            impactor_displacement_m: system.position(i, &state.u),
            impactor_velocity_m_s: state.v[n + i],
            plate_displacement_m: system.deflection(i, &state.u),
        };
        let row = HistoryRow {
            time_s: state.t,
            impactors: (0..self.contacts.len()).map(impactor).collect(),
            impactor_kinetic_j: e.impactor,
            plate_kinetic_j: e.kinetic,
            plate_strain_j: e.strain,
            contact_stored_j: e.stored,
            contact_dissipated_j: e.dissipated,
            energy_balance_j: balance,
        };
        // None of the energies is negative, so that a finite sum is one of finite terms.
        let of_each = |r: &ImpactorRow| [r.contact_force_n, r.impactor_displacement_m, r.plate_displacement_m];
        if !row.impactors.iter().flat_map(of_each).chain([error]).all(f64::is_finite) {
            return Err(StepError::NotFinite { t: state.t });
        }
        self.error = self.error.max(error);
        self.rows.push(row);
        Ok(())
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
    fn sample(&mut self, t: f64, force: f64) {
        let (before, low) = self.last;
        self.record.count += u32::from(force > 0.0 && low <= 0.0);
        if let (None, Some(level)) = (self.record.threshold_time, self.threshold)
            && force >= level
        {
            self.record.threshold_time = Some(before + (t - before) * ((level - low) / (force - low)));
        }
        self.last = (t, force);
    }
}
