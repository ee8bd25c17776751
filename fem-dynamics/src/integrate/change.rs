//! How much two results of a part of a step differ.

use crate::vector::dot;
use fem_core::contact::Indentation;
use fem_core::time::{SecondOrderSystem, State};

/// Changes below this share of what changes are not resolved for their own sake.
const SMALL: f64 = 1e-3;

/// Compares results of a part with what the part changes.
#[derive(Debug, Clone, Default)]
pub(super) struct Change {
    work: [Vec<f64>; 2],
}

impl Change {
    /// The largest of
    ///
    /// ```text
    /// |v₂ − v₁|_M / (|v₂ − v₀|_M + 10⁻³ |v₂|_M)                |v|²_M = vᵀ M v
    /// |α₂ − α₁| / (h (|α̇₀| + |α̇₂|)/2 + 10⁻³ |α₂ − α_t|)        of each contact that touches
    /// ```
    ///
    /// v₀ the velocities at the `start` of a part, v₁ and v₂ those of two results at its end, the `worse` and the `better`, α an
    /// indentation and α_t where the contact begins. It knows no units and no scale of the motion;
    /// what has no mass and lies under no contact is not measured.
    pub(super) fn error(&mut self, sys: &dyn SecondOrderSystem, start: &State, worse: &State, better: &State) -> f64 {
        let work = &mut self.work;
        let mut from = |v: &[f64]| norm(sys, better.v.iter().zip(v).map(|(a, b)| a - b), work);
        let [off, change] = [&worse.v, &start.v].map(|v| from(v));
        let velocity = norm(sys, better.v.iter().copied(), work);
        let of_contacts = (0..better.histories.contacts.len()).map(|i| {
            let [from, other, to] = [start, worse, better].map(|s| sys.indentation(i, s));
            let depth = |at: Indentation| at.alpha - sys.branches(i, &start.histories.contacts[i]).touch;
            if [from, other, to].into_iter().all(|at| depth(at) <= 0.0) {
                return 0.0;
            }
            let way = 0.5 * (better.t - start.t) * (from.rate.abs() + to.rate.abs());
            over((to.alpha - other.alpha).abs(), way + SMALL * depth(to).abs())
        });
        let largest = |most: f64, one: f64| if one <= most || most.is_nan() { most } else { one };
        of_contacts.fold(over(off, change + SMALL * velocity), largest)
    }
}

/// No error of nothing is none.
fn over(error: f64, of: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / of }
}

/// Root of vᵀ M v.
fn norm(sys: &dyn SecondOrderSystem, v: impl Iterator<Item = f64>, [x, product]: &mut [Vec<f64>; 2]) -> f64 {
    x.clear();
    x.extend(v);
    product.clear();
    product.resize(x.len(), 0.0);
    sys.add_mass(1.0, x, product);
    let square = dot(x, product);
    // Of a mass that is hardly there rounding may leave less than nothing; what is no number stays none.
    if square < 0.0 { 0.0 } else { square.sqrt() }
}
