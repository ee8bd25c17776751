//! Supports, constraints, singular and ill-conditioned matrices.

mod condition;
mod masses;
mod supports;

use crate::case::Case;

pub(crate) fn cases() -> Vec<Case> {
    [supports::cases(), masses::cases(), condition::cases()].concat()
}
