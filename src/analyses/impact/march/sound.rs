//! Whether what a checkpoint holds can have come from a march of the same model: a file with a valid checksum may still be made by
//! anyone, and numbers that do not fit together would stop the program where they are used.

use super::{Progress, SystemCounts};
use crate::model::Model;
use fem_core::structure::Tangent;
use fem_core::time::{Histories, State};
use fem_dynamics::impact::ImpactSystem;

/// Counts beyond this are of no march, and sums of them would overflow.
pub(super) const MOST: u64 = 1 << 53;

impl Progress {
    /// Whether it fits itself and a march of `model`, whose system begins with `fresh`.
    pub(super) fn is_sound(&self, model: &Model, system: &ImpactSystem, fresh: &State) -> bool {
        let Self { step, dt, row_every, state, ledger, work, parts, onsets, tangent, .. } = self;
        let sizes = |State { u, v, a, histories: Histories { contacts, beds, points }, .. }: &State| {
            [u.len(), v.len(), a.len(), contacts.len(), beds.len(), points.len()]
        };
        let SystemCounts { factorisations, solves, contact_calls, iterations } = *work;
        let n = system.structure().ndof();
        let fits = |Tangent { u, points, .. }: &Tangent| u.len() == n && points.len() == system.structure().states();
        let on_time = state.t == *step as f64 * dt;
        *row_every > 0
            && [factorisations, solves, contact_calls, iterations].iter().all(|count| *count < MOST)
            && parts.is_none_or(|parts| parts.count < MOST)
            && sizes(state) == sizes(fresh)
            && onsets.is_sound(model.separation.as_ref().map_or(0, |of| of.interfaces.cells().len()))
            && on_time
            && ledger.is_sound(
                *step,
                parts.map_or(0, |parts| parts.count),
                *dt,
                model.impactors().len(),
                model.effects.columns().count(),
            )
            && tangent.as_ref().is_none_or(fits)
    }

    /// Rows of the history so far.
    pub(super) fn rows(&self) -> usize {
        self.ledger.rows.len()
    }
}
