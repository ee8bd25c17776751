//! A plate of cells: mesh, plies, unknowns, and what holds, loads and strikes it.

pub mod axes;
pub mod between;
pub mod classical;
pub mod constraint;
mod error;
pub mod hold;
pub mod interfaces;
pub mod laminate;
pub mod laws;
pub mod load;
pub mod mesh;
pub mod patch;
pub mod pieces;
pub mod plate;
mod prolongation;
pub(crate) mod slopes;
pub mod springs;
pub mod support;
pub mod symmetry;
pub mod warping;
pub mod window;
