//! A contact law without what the plate gives by itself.

use fem_core::contact::{Branches, ContactForce, ContactHistory, ContactLaw};
use fem_core::energy::Energy;

/// Largest share of a law's own compliance dα/dF that the plate may take of it; and on the way back from deeper than where it may take no more.
const MOST: f64 = 0.5;
const BACK: f64 = 0.9;

/// Indentations between which it is looked for, m.
const SHALLOWEST: f64 = 1e-9;
const DEEPEST: f64 = 1.0;
/// Places on each way back.
const LOOKS: u32 = 200;

/// A law whose indentation counts from a surface of the plate that the force squeezes towards its face: α = a + c F(α), a the indentation
/// of the face and c the static compliance of what lies between.
///
/// A law that was measured holds the squeeze of the specimen; in a plate that is squeezed by itself it would count twice. What
/// is left is stiffer, dF/da = F′/(1 − c F′). The work c F²/2 is the plate's, and taken from what the law stores.
///
/// Where c is half of the law's own compliance, on loading or on the way back, at [`force_limit`](Self::force_limit), the squeeze is no part
/// of such a law; beyond it no more is taken away, α = a + c F_limit. The squeeze follows the force at once: waves through the thickness are
/// left out of it, as they are of the law.
#[derive(Debug, Clone)]
pub struct WithoutSqueeze {
    law: Box<dyn ContactLaw>,
    compliance: f64,
    limit: f64,
}

impl WithoutSqueeze {
    /// `law` without the squeeze of `compliance` (m/N), positive; `None` where the squeeze is more than half of what the law gives from
    /// the first touch on, or all of it on the way back from deeper down.
    pub fn new(law: Box<dyn ContactLaw>, compliance: f64) -> Option<Self> {
        let fits = |alpha: f64| {
            let mut history = ContactHistory::default();
            let loading = law.force(&history, alpha).tangent;
            law.commit(&mut history, alpha);
            // Next to the peak, on the way back.
            compliance * loading.max(law.force(&history, alpha * (1.0 - 1e-6)).tangent) <= MOST
        };
        let mut depths =
            std::iter::successors(Some(SHALLOWEST), |depth| Some(2.0 * depth)).take_while(|depth| *depth < DEEPEST);
        let limit = match depths.find(|depth| !fits(*depth)) {
            None => f64::INFINITY,
            Some(SHALLOWEST) => return None,
            Some(stiff) => {
                let (mut low, mut high) = (0.5 * stiff, stiff);
                for _ in 0..50 {
                    let middle = 0.5 * (low + high);
                    if fits(middle) { low = middle } else { high = middle }
                }
                law.force(&ContactHistory::default(), low).force
            }
        };
        let found = Self { law, compliance, limit };
        found.gives_way().then_some(found)
    }

    /// Whether the law gives way, however deep it has been, where the squeeze is taken from it: on ways back, up to the force of the limit.
    fn gives_way(&self) -> bool {
        let depths = std::iter::successors(Some(SHALLOWEST), |depth| Some(2.0 * depth));
        depths.take_while(|depth| *depth < DEEPEST).all(|deepest| {
            let mut history = ContactHistory::default();
            self.law.commit(&mut history, deepest);
            let touch = self.law.branches(&history).touch;
            (1..LOOKS).all(|k| {
                let alpha = touch + (deepest - touch) * f64::from(k) / f64::from(LOOKS);
                let ContactForce { force, tangent } = self.law.force(&history, alpha);
                !(force > 0.0 && force < self.limit) || self.compliance * tangent <= BACK
            })
        })
    }

    /// Force up to which the squeeze is taken from the law, N; infinite where it always is.
    pub fn force_limit(&self) -> f64 {
        self.limit
    }

    /// Indentation of the law less that of the face at a force, m.
    fn squeeze(&self, force: f64) -> f64 {
        self.compliance * force.min(self.limit)
    }

    /// The indentation α of the law at that of the face `a`: Newton's iteration between bounds for α − squeeze(F(α)) = a.
    fn of_law(&self, history: &ContactHistory, a: f64) -> f64 {
        // Without an overlap, and where `a` is not a number, there is no force.
        if self.law.force(history, a).force == 0.0 || !a.is_finite() {
            return a;
        }
        // What is taken is at most half of the way, or that at the limit.
        let (mut low, mut high) = (a, if self.limit.is_finite() { a + self.squeeze(self.limit) } else { 2.0 * a });
        let mut alpha = a;
        for _ in 0..100 {
            let ContactForce { force, tangent } = self.law.force(history, alpha);
            let left = alpha - self.squeeze(force) - a;
            if left < 0.0 {
                low = alpha
            } else {
                high = alpha
            }
            let slope = 1.0 - if force < self.limit { self.compliance * tangent } else { 0.0 };
            let next = alpha - left / slope;
            let next = if low <= next && next <= high { next } else { 0.5 * (low + high) };
            if (next - alpha).abs() <= f64::EPSILON * alpha.abs() || high - low <= f64::EPSILON * high.abs() {
                return next;
            }
            alpha = next;
        }
        alpha
    }
}

impl ContactLaw for WithoutSqueeze {
    fn force(&self, history: &ContactHistory, alpha: f64) -> ContactForce {
        let ContactForce { force, tangent } = self.law.force(history, self.of_law(history, alpha));
        let share = if force < self.limit { self.compliance * tangent } else { 0.0 };
        ContactForce { force, tangent: tangent / (1.0 - share) }
    }

    fn commit(&self, history: &mut ContactHistory, alpha: f64) {
        self.law.commit(history, self.of_law(history, alpha));
    }

    fn energy(&self, history: &ContactHistory, alpha: f64) -> Energy {
        let of_law = self.of_law(history, alpha);
        let Energy { stored, dissipated } = self.law.energy(history, of_law);
        let taken = self.law.force(history, of_law).force.min(self.limit);
        Energy { stored: stored - 0.5 * self.compliance * taken * taken, dissipated }
    }

    fn branches(&self, history: &ContactHistory) -> Branches {
        let Branches { touch, peak } = self.law.branches(history);
        // Rounded downwards, because a contact that is loaded is there, and not below.
        let of_face = |peak: f64| (peak - self.squeeze(self.law.force(history, peak).force)) * (1.0 - 1e-14);
        Branches { touch, peak: peak.map(of_face) }
    }
}
