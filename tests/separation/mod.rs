//! Layers that separate: delamination specimens against beams on cohesive interfaces, and impacts.

mod bars;
mod circle;
mod clamps;
mod closed;
mod dynamics;
mod left;
mod paths;
mod pictures;
mod resting;
mod scenes;
mod specimens;
mod stretched;
mod tips;
