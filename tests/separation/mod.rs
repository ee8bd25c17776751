//! Layers that separate: delamination specimens against beams on cohesive interfaces.

mod circle;
mod closed;
mod dynamics;
mod specimens;
