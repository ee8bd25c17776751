//! Laws of plies: how a ply answers to strains beyond linear elasticity.

mod hahn_tsai;

pub use hahn_tsai::{HahnTsai, Unloading};
