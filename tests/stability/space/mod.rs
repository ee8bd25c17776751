//! Shapes, thicknesses, stiffnesses and frames.

mod exact;
mod frames;
mod shapes;
mod strips;

use crate::case::Case;

pub(crate) fn cases() -> Vec<Case> {
    [strips::cases(), shapes::cases(), frames::cases()].concat()
}
