//! The history as it grows, with its energies.

use fem_core::time::{State, StepError};
use fem_dynamics::impact::ImpactSystem;
use fem_io::tables::HistoryRow;
use serde::{Deserialize, Serialize};

/// The history as it grows, with the energy ledger.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Ledger {
    pub(super) rows: Vec<HistoryRow>,
    initial: f64,
    pub(super) error: f64,
    pub(super) contacts: u32,
    touching: bool,
    #[serde(skip)]
    work: Vec<f64>,
}

impl Ledger {
    pub(super) fn new(system: &ImpactSystem, state: &State) -> Result<Self, StepError> {
        let mut work = Vec::new();
        let initial = system.energies(state, &mut work).total();
        let mut ledger = Self { rows: Vec::new(), initial, error: 0.0, contacts: 0, touching: false, work };
        ledger.row(system, state)?;
        Ok(ledger)
    }

    pub(super) fn contact(&mut self, touching: bool) {
        self.contacts += u32::from(touching && !self.touching);
        self.touching = touching;
    }

    /// Writes a row of numbers that are all finite.
    pub(super) fn row(&mut self, system: &ImpactSystem, state: &State) -> Result<(), StepError> {
        let e = system.energies(state, &mut self.work);
        let n = system.structure().ndof();
        let balance = e.total() - self.initial;
        let error = (balance / self.initial).abs();
        let row = HistoryRow {
            time_s: state.t,
            contact_force_n: system.contact_force(0, state),
            impactor_displacement_m: system.position(0, &state.u),
            impactor_velocity_m_s: state.v[n],
            plate_displacement_m: system.deflection(0, &state.u),
            impactor_kinetic_j: e.impactor,
            plate_kinetic_j: e.kinetic,
            plate_strain_j: e.strain,
            contact_stored_j: e.stored,
            contact_dissipated_j: e.dissipated,
            energy_balance_j: balance,
        };
        // None of the energies is negative, so that a finite sum is one of finite terms.
        let numbers = [error, row.contact_force_n, row.impactor_displacement_m, row.plate_displacement_m];
        if !numbers.iter().all(|v| v.is_finite()) {
            return Err(StepError::NotFinite { t: state.t });
        }
        self.error = self.error.max(error);
        self.rows.push(row);
        Ok(())
    }
}

/// When a force first reaches a level, by linear interpolation between its samples.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Crossing {
    level: f64,
    last: (f64, f64),
    pub(super) time: Option<f64>,
}

impl Crossing {
    /// The force is 0 at the time 0.
    pub(super) fn new(level: f64) -> Self {
        Self { level, last: (0.0, 0.0), time: None }
    }

    pub(super) fn sample(&mut self, t: f64, force: f64) {
        let (before, low) = self.last;
        if self.time.is_none() && force >= self.level {
            self.time = Some(before + (t - before) * ((self.level - low) / (force - low)));
        }
        self.last = (t, force);
    }
}
