//! What the displacements of a plate mean: stresses at places and along lines, of large deflections and of cure, and the error
//! of a mesh.

mod around;
mod band;
mod equilibrium;
pub mod estimate;
pub mod field;
pub mod profile;
pub mod recovery;
pub mod residual;
pub mod waves;
