//! x
pub mod units;

pub mod gmsh;
pub mod files;
pub mod tables;
