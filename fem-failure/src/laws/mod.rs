//! Laws of plies and of interfaces: how they answer beyond linear elasticity.

mod bilinear;
mod crack_band;
mod hahn_tsai;
mod mixed_mode;
mod process_zone;
mod shear;

pub use bilinear::Bilinear;
pub use crack_band::{Breaks, CrackBand};
pub use hahn_tsai::{HahnTsai, Unloading};
pub use mixed_mode::MixedMode;
pub use process_zone::process_zone;
