//! The contract of a contact law.

use crate::words::energy::Energy;
use dyn_clone::DynClone;
use std::fmt::Debug;

/// What a contact law remembers between accepted steps: plain numbers, all zero before the first contact.
pub type ContactHistory = [f64; 8];

/// Contact force and its derivative at one indentation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactForce {
    /// Force, N; never negative.
    pub force: f64,
    /// dF/dα, N/m.
    pub tangent: f64,
}

/// Where a contact law passes from one smooth branch to another.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Branches {
    /// Indentation at which the force begins, m: 0, or the dent.
    pub touch: f64,
    /// Largest indentation so far, m, of a law that follows another curve below it.
    pub peak: Option<f64>,
}

/// How deep a contact is, and whether it deepens.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Indentation {
    /// α, m.
    pub alpha: f64,
    /// dα/dt, m/s.
    pub rate: f64,
}

/// A contact law F(α): α is the indentation, positive when the bodies overlap.
///
/// The force is a pure function of the committed history and the present indentation, so that an integrator may try
/// any number of states within a step; only [`ContactLaw::commit`], called once per accepted step, changes the history.
pub trait ContactLaw: DynClone + Debug + Send + Sync {
    /// Force and tangent at indentation `alpha` (m). The force is continuous and never falls as `alpha` grows: an implicit
    /// step seeks the one indentation at which it fits.
    fn force(&self, history: &ContactHistory, alpha: f64) -> ContactForce;

    /// Takes `alpha` into the history.
    fn commit(&self, history: &mut ContactHistory, alpha: f64);

    /// Work done on the contact up to `alpha`, J.
    fn energy(&self, history: &ContactHistory, alpha: f64) -> Energy;

    /// Where the force is not smooth, given the committed history; a march of high order ends a step there.
    fn branches(&self, _history: &ContactHistory) -> Branches {
        Branches::default()
    }
}
dyn_clone::clone_trait_object!(ContactLaw);
