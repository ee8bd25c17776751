//! Laws of plies and of interfaces: contracts, closed forms, reference tables (`tests/data/damage`).
#![allow(clippy::unwrap_used, clippy::panic)]

mod bilinear;
mod crack_band;
mod hahn_tsai;
mod tables;
