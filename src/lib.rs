//! Low-velocity impact on laminated composites: a gmsh plate and a scene go in; force history, ply and interface stresses
//! and the time, place and mode of first damage come out.
//!
//! This crate is the program as a library: [`Registry`] gathers the plug-ins, [`job::run`] takes a scene to its results,
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
//!
//! A program of one's own calls a job. The lowest frequency of a clamped square of aluminium, against theory of thin plates:
//!
//! ```
//! use fem::job::{self, Found, Options};
//! use fem::{Registry, io::scene};
//!
//! let edges = ["x-min", "x-max", "y-min", "y-max"];
//! let clamped = edges.map(|edge| format!("[[support]]\ngroup = '{edge}'\nat = 'all'\nfix = ['U10', 'U20', 'U30', 'U13', 'U23']\n"));
//! let text = format!(
//!     "title = 'clamped square'\nanalysis = 'modes'\nmesh = {{ rectangle = ['100 mm', '100 mm'], cells = [16, 16] }}\n\
//!      laminate = {{ plies = '[0]', material = 'sheet', ply_thickness = '1 mm', layers = [1] }}\nelement = {{ kind = 'mitc4' }}\n\
//!      materials.sheet = {{ e = '70 GPa', nu = 0.3, density = '2700 kg/m^3' }}\n{}",
//!     clamped.concat()
//! );
//! let scene = scene::parse(&text, "scene.toml".as_ref())?;
//! let done = job::run(&scene, &Registry::standard(), &Options::default(), &mut ())?;
//! let Found::Modes(found) = done.found else { unreachable!("the scene asks for modes") };
//! // ω = 35.985 √(D/(ρ h))/a²
//! let (d, areal_mass) = (70e9 * 1e-9 / 12.0 / 0.91, 2.7_f64);
//! let theory = 35.985 * (d / areal_mass).sqrt() / 0.01;
//! assert!((found.solution.modes.omega[0] / theory - 1.0_f64).abs() < 2e-2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`job::Options`] name a folder for the files that `fem run` writes, and whoever implements [`job::Follow`] hears of progress
//! and may break a march off.

pub mod advise;
pub mod analyses;
pub mod cli;
pub mod cost;
pub mod decks;
pub mod effect;
pub mod effects;
pub mod envelope;
mod error;
pub mod forecast;
pub mod job;
pub mod map;
mod model;
pub mod output;
mod registry;
pub mod study;
pub mod sweep;
mod words;

pub use effect::{Decision, Effects};
pub use error::{CheckpointError, Error};
pub use fem_core as core;
pub use fem_dynamics as dynamics;
pub use fem_elements as elements;
pub use fem_failure as failure;
pub use fem_io as io;
pub use model::{
    FieldPlan, Gauge, Impact, Model, NamedCriterion, NamedProfile, Origin, PathPlan, Plan, Strike, mesh as scene_mesh,
};
pub use registry::{NO_REDUCTION, Registry, RegistryError};
