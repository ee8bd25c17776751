//! A mass much larger than the plate's: the peak of an impact without inertia of the plate.

use fem_core::contact::{ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use std::f64::consts::PI;

/// Force at a deflection w under the impactor: F = Kb w + Km w³.
///
/// Km is that of membrane stiffening, zero of a plate that stays linear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Kb, N/m.
    pub bending: f64,
    /// Km, N/m³.
    pub membrane: f64,
}

impl Spring {
    /// F, N.
    pub fn force(self, w: f64) -> f64 {
        w * (self.bending + self.membrane * w * w)
    }

    /// ∫ F dw, J.
    pub fn energy(self, w: f64) -> f64 {
        w * w * (0.5 * self.bending + 0.25 * self.membrane * w * w)
    }
}

/// The moment at which an impactor stands still on a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactPeak {
    /// Contact force, N.
    pub force: f64,
    /// Deflection of the plate under the impactor, m.
    pub deflection: f64,
    /// Indentation, m.
    pub indentation: f64,
    /// Work done on the contact, J.
    pub contact_energy: f64,
}

/// Halvings of an interval until nothing of it is left.
const HALVINGS: usize = 100;

/// An indentation beyond all that can be meant, m.
const DEEPEST: f64 = 1e3;

/// The peak of the energy balance of Shivakumar, Elber and Illg (J. Appl. Mech. 52 (1985) 674):
///
/// ½ M V² = ½ Kb w² + ¼ Km w⁴ + ∫₀^α F dα,  F(α) = Kb w + Km w³,
///
/// the last term (2/5) F^(5/3)/k^(2/3) for Hertz's law. Exact where the plate has no inertia; any contact law will do.
pub fn energy_balance(energy: f64, spring: Spring, law: &dyn ContactLaw) -> ImpactPeak {
    let at = |w: f64| {
        let force = spring.force(w);
        let indentation = indentation(law, force);
        ImpactPeak { force, deflection: w, indentation, contact_energy: work(law, indentation) }
    };
    // All of the energy in bending is more than the plate will get.
    let most = (2.0 * energy / spring.bending).sqrt();
    at(halve(most, |w| spring.energy(w) + at(w).contact_energy < energy))
}

/// The peak of an impact that leaves the plate at rest, all of `energy` in the contact: for Hertz's law
/// F = k^(2/5) (5 M V²/4)^(3/5).
pub fn rigid_target(energy: f64, law: &dyn ContactLaw) -> ImpactPeak {
    let indentation = halve(deep(|alpha| work(law, alpha) >= energy), |alpha| work(law, alpha) < energy);
    let force = law.force(&ContactHistory::default(), indentation).force;
    ImpactPeak { force, deflection: 0.0, indentation, contact_energy: work(law, indentation) }
}

/// Time from first touch to the peak, a quarter of a period of the mass on a linear spring that takes the energy at the same
/// travel: (π/2) √(M/K), K = M V²/(w + α)². Without contact and membrane this is exact.
pub fn time_of_peak(velocity: f64, peak: &ImpactPeak) -> f64 {
    0.5 * PI * (peak.deflection + peak.indentation) / velocity
}

/// Indentation of first loading at which the contact force is `force`, m.
pub(super) fn indentation(law: &dyn ContactLaw, force: f64) -> f64 {
    let force_at = |alpha: f64| law.force(&ContactHistory::default(), alpha).force;
    halve(deep(|alpha| force_at(alpha) >= force), |alpha| force_at(alpha) < force)
}

/// Work of first loading up to `alpha`, J.
pub(super) fn work(law: &dyn ContactLaw, alpha: f64) -> f64 {
    let Energy { stored, dissipated } = law.energy(&ContactHistory::default(), alpha);
    stored + dissipated
}

/// An indentation that is `enough`, within a factor of two; [`DEEPEST`] where none up to that is.
fn deep(enough: impl Fn(f64) -> bool) -> f64 {
    let mut alpha = DEEPEST;
    while enough(0.5 * alpha) && alpha > f64::MIN_POSITIVE {
        alpha *= 0.5;
    }
    alpha
}

/// Where `short` ends between 0 and `high`.
fn halve(mut high: f64, short: impl Fn(f64) -> bool) -> f64 {
    let mut low = 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if short(middle) { low = middle } else { high = middle }
    }
    high
}
