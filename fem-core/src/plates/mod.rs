//! A plate of cells: mesh, plies, unknowns, and what holds, loads and strikes it.

pub mod constraint;
mod error;
pub mod laminate;
pub mod laws;
pub mod load;
pub mod mesh;
pub mod patch;
pub mod plate;
mod prolongation;
pub mod support;
pub mod symmetry;
pub mod window;
