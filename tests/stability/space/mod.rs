//! Shapes, thicknesses, stiffnesses and frames.

mod exact;
mod strips;

use crate::case::Case;

pub(crate) fn cases() -> Vec<Case> {
    [strips::cases()].concat()
}
