//! Long marches, and what must not change them.

use crate::case::Case;

pub(super) fn cases() -> Vec<Case> {
    vec![]
}
