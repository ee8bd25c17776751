//! What every step of a march adds to: extremes of the contacts, the force, rows of the history, the balance of energy.

use super::contact::{ContactRecord, Follower, StepForces};
use super::modal::ModalView;
use crate::effect::Effect;
use fem_core::time::State;
use fem_dynamics::guard::{Alarm, Guard};
use fem_dynamics::impact::{Energies, ImpactSystem, Noted, Touch};
use fem_io::tables::{HistoryRow, ImpactorRow};
use serde::{Deserialize, Serialize};

/// Steps between two looks at the energies, at most: a look costs two products with matrices.
pub const BALANCE_EVERY: u64 = 128;

/// Of the first 2048 steps each is looked at, of as many after them every second, and so on: the looks are those of their
/// steps, whatever the end of the march and the rows of its history.
const DENSE: u32 = 10;

/// Time without a force after which an impactor that moves away has left, over the time from the first to the last force: a plate
/// that swings back within it touches again.
const QUIET: f64 = 0.05;

/// Share of a step before its end within which a part ends with it: times of parts are sums, those of steps products.
const AT_END: f64 = 1e-6;

/// What every step adds to.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Ledger {
    pub(super) rows: Vec<HistoryRow>,
    /// Largest change of the total energy, relative.
    pub(super) error: f64,
    pub(super) forces: StepForces,
    contacts: Vec<Follower>,
    #[serde(skip)]
    work: Vec<f64>,
}

/// What is done with the energies at the end of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    /// Steps that the look stands for; none of a row beside.
    steps: u64,
    /// Whether they are a row of the history.
    row: bool,
}

impl Look {
    /// After `step` steps, which may be a `row` of the history; `None` where nothing is due.
    pub(super) fn due(step: u64, row: bool) -> Option<Self> {
        let every = (1 << step.max(1).ilog2().saturating_sub(DENSE)).min(BALANCE_EVERY);
        let steps = if step.is_multiple_of(every) { every } else { 0 };
        (row || steps > 0).then_some(Self { steps, row })
    }

    /// A row beside the steps.
    pub(super) const ROW: Self = Self { steps: 0, row: true };
}

impl Ledger {
    /// Of a march with steps of `dt`, of so many `contacts`; `thresholds`: forces whose first reaching is noted, N.
    pub(super) fn new(dt: f64, contacts: usize, thresholds: Option<[f64; 2]>) -> Self {
        let contacts = (0..contacts).map(|_| Follower::new(thresholds)).collect();
        Self { rows: Vec::new(), error: 0.0, forces: StepForces::new(dt), contacts, work: Vec::new() }
    }

    /// Whether it can be that of a march after `step` steps of `dt`, in so many `parts` where they are divided, with so many contacts and
    /// columns of effects.
    pub(super) fn is_sound(&self, step: u64, parts: u64, dt: f64, contacts: usize, columns: usize) -> bool {
        let rows = self.rows.iter().all(|row| row.impactors.len() == contacts && row.effects.len() == columns);
        let in_time = self.rows.len() as u64 <= step + 1 && self.rows.is_sorted_by(|a, b| a.time_s < b.time_s);
        let forces = self.forces.step() == dt && self.forces.last() as u64 <= step;
        rows && in_time
            && forces
            && self.contacts.len() == contacts
            && self.contacts.iter().all(|c| c.is_sound(step + parts))
    }

    /// Shows effects the end of a step.
    pub(super) fn step(&mut self, effects: &mut [Box<dyn Effect>], system: &ImpactSystem, state: &State) {
        effects.iter_mut().for_each(|effect| effect.on_step(system, state, &mut self.work));
    }

    /// Takes the contacts at the end of step number `step`.
    pub(super) fn contacts(
        &mut self,
        step: u64,
        system: &ImpactSystem,
        guard: &Guard,
        state: &State,
    ) -> Result<(), Alarm> {
        let mut all = 0.0;
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            let touch = system.touch(i, state);
            guard.touch(i, touch)?;
            contact.take(state.t, touch);
            all += touch.force;
        }
        self.forces.take(step, all);
        Ok(())
    }

    /// Takes the contacts at the ends of parts of a step that ends at `end`: those that are shorter than a step are seen so.
    pub(super) fn parts(&mut self, noted: Vec<Noted>, end: f64) {
        let until = end - AT_END * self.forces.step();
        for Noted { t, touches } in noted.into_iter().take_while(|noted| noted.t < until) {
            self.contacts.iter_mut().zip(touches).for_each(|(contact, touch)| contact.take(t, touch));
        }
    }

    /// Whether all impactors have struck and left for good after `step` steps: they move away from the plate, and none has touched it
    /// for a while ([`QUIET`]).
    pub(super) fn separated(&self, step: u64, system: &ImpactSystem, state: &State) -> bool {
        let touched = self.contacts.iter().filter_map(Follower::touched);
        let Some([first, last]) = touched.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]) else { return false };
        // The step at whose end, or in whose parts, that was.
        let [first, last] = [first, last].map(|t| (t / self.forces.step() - AT_END).ceil());
        let step = step as f64;
        let gone =
            |(i, contact): (usize, &Follower)| contact.touched().is_some() && system.touch(i, state).velocity < 0.0;
        step > last && step - last > QUIET * (last - first) && self.contacts.iter().enumerate().all(gone)
    }

    /// What the contacts were.
    pub(super) fn records(self) -> (Vec<ContactRecord>, StepForces, Vec<HistoryRow>) {
        (self.contacts.into_iter().map(Follower::finish).collect(), self.forces, self.rows)
    }

    /// Adds up the energies. A row is written also where a march leaks, none of numbers that are not finite.
    pub(super) fn look(
        &mut self,
        look: Look,
        effects: &[Box<dyn Effect>],
        system: &mut ImpactSystem,
        guard: &Guard,
        state: &State,
        modal: Option<&mut ModalView>,
    ) -> Result<(), Alarm> {
        let mut e = system.energies(state, &mut self.work);
        e.damped = effects.iter().fold(0.0, |sum, effect| sum + effect.lost());
        let balanced = guard.balance(&e);
        match balanced {
            Ok(change) if look.steps > 0 => self.error = self.error.max(change.abs()),
            Err(Alarm::Energy(change)) => self.error = self.error.max(change.abs()),
            Err(Alarm::NotFinite(_)) => return balanced.map(|_| ()),
            _ => {}
        }
        if look.row {
            let effects = effects.iter().flat_map(|effect| effect.values(system, state, &e)).collect();
            self.rows.push(HistoryRow { effects, ..history_row(system, state, &e, guard.energy()) });
        }
        balanced?;
        if let Some(modal) = modal {
            if look.row {
                modal.row(state);
            }
            modal.weigh(state, look.steps as f64, [e.strain, e.kinetic]);
        }
        Ok(())
    }
}

/// What an instant is to a history, effects apart; `begun` is the energy at the beginning.
pub(crate) fn history_row(system: &ImpactSystem, state: &State, e: &Energies, begun: f64) -> HistoryRow {
    let impactor = |i: usize| {
        let Touch { force, velocity, deflection, .. } = system.touch(i, state);
        ImpactorRow {
            contact_force_n: force,
            impactor_displacement_m: system.position(i, &state.u),
            impactor_velocity_m_s: velocity,
            plate_displacement_m: deflection,
        }
    };
    HistoryRow {
        time_s: state.t,
        impactors: (0..state.histories.contacts.len()).map(impactor).collect(),
        impactor_kinetic_j: e.impactor,
        plate_kinetic_j: e.kinetic,
        plate_strain_j: e.strain,
        contact_stored_j: e.stored,
        contact_dissipated_j: e.dissipated,
        effects: Vec::new(),
        energy_balance_j: e.total() - begun,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_stand_for_all_steps_and_grow_rare() {
        let looks = |end: u64| (1..=end).filter_map(|step| Some(Look::due(step, false)?.steps));
        assert_eq!(looks(2047).collect::<Vec<_>>(), [1; 2047]);
        for end in [4096, 65_536, 1 << 20] {
            assert_eq!(looks(end).sum::<u64>() / 1000, end / 1000, "{end}");
            assert!(looks(end).count() as u64 <= 2048 + 1024 * 7 + end / BALANCE_EVERY, "{end}");
        }
        assert_eq!(looks(1 << 18).max(), Some(BALANCE_EVERY));
        assert!(Look::due(4097, true).is_some_and(|look| look.steps == 0 && look.row));
    }
}
