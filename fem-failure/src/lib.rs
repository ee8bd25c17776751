//! Failure criteria of laminated composites and the scan for first damage.
//!
//! One file per criterion; each is a pure function of the stress in a ply's own axes, returns one index per failure
//! mode (1 at failure, 0 where the mode does not apply) and introduces itself through
//! [`Plugin::INFO`](fem_core::plugin::Plugin::INFO). [`scan::Scan`] follows any number of them through a run.

pub mod scan;

mod hashin_report;
mod octahedral;

pub use hashin_report::{HashinReport, Product};
pub use octahedral::Octahedral;
