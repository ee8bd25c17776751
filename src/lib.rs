//! Low-velocity impact on laminated composites: a gmsh plate and a scene go in; force history, ply and interface stresses
//! and the time, place and mode of first damage come out.
//!
//! This crate is the facade: [`Registry`] gathers the plug-ins, [`Model`] makes a scene concrete, [`run`] does the main job,
//! [`cli`] is the command line as a function, so that a crate with plug-ins of its own needs a main of five lines:
//!
//! ```no_run
//! # struct Mine;
//! # impl fem::core::plugin::Plugin for Mine {
//! #     const INFO: fem::core::plugin::PluginInfo = fem::core::plugin::PluginInfo {
//! #         kind: fem::core::plugin::Kind::Criterion, name: "mine", summary: "", source: "", params: &[] };
//! #     fn build(_: &fem::core::plugin::Params) -> Result<fem::core::plugin::Built, fem::core::plugin::ParamError> {
//! #         Err(fem::core::plugin::ParamError::new("", "")) }
//! # }
//! fn main() -> std::process::ExitCode {
//!     fem::cli::main(fem::Registry::standard().with::<Mine>())
//! }
//! ```

pub mod advise;
pub mod cli;
pub mod cost;
pub mod damage;
mod error;
mod indices;
pub mod matrices;
pub mod memory;
mod modal;
mod model;
pub mod modes;
pub mod pictures;
mod registry;
pub mod report;
pub mod run;
pub mod statics;
mod stress;
pub mod study;
pub mod summary;

pub use error::Error;
pub use fem_core as core;
pub use fem_dynamics as dynamics;
pub use fem_elements as elements;
pub use fem_failure as failure;
pub use fem_io as io;
pub use model::{Decision, Effects, Gauge, Impact, Model, NamedCriterion, NamedProfile, Plan, Strike};
pub use registry::{NO_REDUCTION, Registry, RegistryError};
