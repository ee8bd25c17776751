//! x
pub mod materials;
pub mod scene;
pub mod units;

pub mod gmsh;
pub mod files;
pub mod plot;
pub mod tables;
