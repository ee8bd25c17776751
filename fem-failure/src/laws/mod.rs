//! Laws of plies and of interfaces: how they answer beyond linear elasticity.

mod bilinear;
mod hahn_tsai;
mod mixed_mode;
mod process_zone;

pub use bilinear::Bilinear;
pub use hahn_tsai::{HahnTsai, Unloading};
pub use mixed_mode::MixedMode;
pub use process_zone::process_zone;
