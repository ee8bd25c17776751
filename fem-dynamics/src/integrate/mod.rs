//! Time integrators.
//!
//! | name | order | kind | step limit ω Δt |
//! | --- | --- | --- | --- |
//! | `rk1` `rk2` `rk3` `rk4` | 1 to 4 | explicit Runge-Kutta (report INTALG 1 to 4) | 0.0014, 0.053, 1.5, 1.5 |
//! | `dormand-prince` | 5 | explicit Runge-Kutta with error control | none: it divides its steps |
//! | `central-difference` | 2 | explicit | 1.8 |
//! | `newmark` | 2 | implicit | none for 2β ≥ γ |
//! | `hht-alpha`, `generalized-alpha` | 2 | implicit, damps high modes | none |
//! | `energy-conserving` | 2 | implicit, keeps the energy in contact too | none |
//!
//! The histories of the contacts stay as committed during a step; a step ends with one commit. `a` in the state is the
//! acceleration that the next step starts from, so that a state holds all that a restart needs. Schemes of order above 2
//! are marched [`located`]: their steps are divided where a contact law changes its branch. Any scheme may be [`divided`]: its steps
//! are halved until an estimate of their error is within a tolerance.

mod central_difference;
mod change;
mod divided;
mod dormand_prince;
mod energy_conserving;
mod generalized_alpha;
mod hht_alpha;
mod located;
mod newmark;
mod runge_kutta;
mod stages;

pub use central_difference::CentralDifference;
pub use divided::divided;
pub use dormand_prince::DormandPrince;
pub use energy_conserving::EnergyConserving;
pub use generalized_alpha::GeneralizedAlpha;
pub use hht_alpha::HhtAlpha;
pub use located::located;
pub use newmark::Newmark;
pub use runge_kutta::{Rk1, Rk2, Rk3, Rk4, RungeKutta};

use fem_core::time::{Histories, SecondOrderSystem, State, StepError};

/// Part of the linear limit that a conditionally stable scheme may use: a contact stiffens within the step.
const MARGIN: f64 = 0.9;

/// Acceleration of equilibrium. No force asks nothing of M, so that a structure at rest may have massless dofs.
fn accelerate(sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
    sys.force(s.t, &s.u, &s.v, &s.histories, &mut s.a);
    if s.a.iter().any(|a| *a != 0.0) { sys.solve_mass(0.0, &mut s.a) } else { Ok(()) }
}

/// Ends a step: the contacts take the new state, unless it is not finite.
fn accept(sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
    if !s.t.is_finite() || [&s.u, &s.v, &s.a].into_iter().flatten().any(|x| !x.is_finite()) {
        return Err(StepError::NotFinite { t: s.t });
    }
    sys.commit(s)
}

/// Copies without allocating, once the lengths agree.
fn copy(from: &State, to: &mut State) {
    let State { t, u, v, a, histories: Histories { contacts, beds, points } } = to;
    *t = from.t;
    u.clone_from(&from.u);
    v.clone_from(&from.v);
    a.clone_from(&from.a);
    contacts.clone_from(&from.histories.contacts);
    beds.clone_from(&from.histories.beds);
    points.clone_from(&from.histories.points);
}
