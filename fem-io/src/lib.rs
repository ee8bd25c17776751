//! x
pub mod units;

pub mod gmsh;
