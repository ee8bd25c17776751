//! How deep a contact goes.

use fem_core::contact::{ContactHistory, ContactLaw};
use fem_core::energy::Energy;

/// Indentation (m) at which `law` has taken `energy` (J) on first loading; `None` where it never does.
pub(crate) fn indentation_of(law: &dyn ContactLaw, energy: f64) -> Option<f64> {
    let work = |alpha: f64| {
        let Energy { stored, dissipated } = law.energy(&ContactHistory::default(), alpha);
        stored + dissipated
    };
    let mut high = 1.0;
    while !(work(high) >= energy) {
        high *= 2.0;
        if high > f64::MAX {
            return None;
        }
    }
    while work(0.5 * high) >= energy && high > f64::MIN_POSITIVE {
        high *= 0.5;
    }
    let mut low = 0.5 * high;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if work(middle) < energy { low = middle } else { high = middle }
    }
    Some(high)
}
