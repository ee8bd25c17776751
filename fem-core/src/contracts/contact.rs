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
/// any number of states within a step; only [`ContactLaw::commit`], called once per accepted step, changes the history. Under a spherical tip
/// there are more histories of one law, of which those that are apart are left alone until the whole contact has ended.
pub trait ContactLaw: DynClone + Debug + Send + Sync {
    /// Force and tangent at indentation `alpha` (m). The force is continuous and never falls as `alpha` grows: an implicit
    /// step seeks the one indentation at which it fits.
    fn force(&self, history: &ContactHistory, alpha: f64) -> ContactForce;

    /// Takes `alpha` into the history.
    fn commit(&self, history: &mut ContactHistory, alpha: f64);

    /// Work done on the contact up to `alpha`, J.
    fn energy(&self, history: &ContactHistory, alpha: f64) -> Energy;

    /// Mean F̄ of the force on the way from `from` to `to` with `history` throughout, and dF̄/d`to`: the discrete gradient
    /// F̄ = [W(to) − W(from)]/(to − from) of the work W = stored + dissipated.
    ///
    /// Of a short way W has too few digits; there F is integrated by Gauss' rule of three points, on either side of the
    /// peak. F̄ lies between the forces at the ends, so that it never pulls.
    fn mean_force(&self, history: &ContactHistory, from: f64, to: f64) -> ContactForce {
        let [start, end] = [from, to].map(|alpha| self.force(history, alpha));
        if !end.force.is_finite() {
            return end;
        }
        let Branches { touch, peak } = self.branches(history);
        let (low, high) = (from.min(to), from.max(to));
        let [way, depth] = [high - low, low - touch];
        let mean = if way <= SHORT * depth {
            let part = |a: f64, b: f64| (b - a) / way * gauss(|alpha| self.force(history, alpha).force, a, b);
            match peak {
                Some(peak) if low < peak && peak < high => part(low, peak) + part(peak, high),
                _ => part(low, high),
            }
        } else {
            let [before, after] = [from, to].map(|alpha| self.energy(history, alpha));
            ((after.stored - before.stored) + (after.dissipated - before.dissipated)) / (to - from)
        };
        // Where there is no way, the mean is not a number, and the force at its end is taken.
        let force = mean.max(start.force.min(end.force)).min(start.force.max(end.force));
        let tangent = if way <= TINY * depth { 0.5 * end.tangent } else { (end.force - force) / (to - from) };
        ContactForce { force, tangent }
    }

    /// Where the force is not smooth, given the committed history; a march of high order ends a step there.
    fn branches(&self, _history: &ContactHistory) -> Branches {
        Branches::default()
    }
}
dyn_clone::clone_trait_object!(ContactLaw);

/// Ways, over the least depth on them, up to which Gauss' rule is exact but for rounding, and up to which the difference of two
/// forces has too few digits for a tangent.
const SHORT: f64 = 0.02;
const TINY: f64 = 1e-8;

/// Mean of `f` from `a` to `b`.
fn gauss(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (middle, reach) = (0.5 * (a + b), 0.5 * (b - a) * 0.6_f64.sqrt());
    (5.0 * (f(middle - reach) + f(middle + reach)) + 8.0 * f(middle)) / 18.0
}
