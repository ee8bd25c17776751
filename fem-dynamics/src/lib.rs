//! The response: reductions, contact laws, the coupled system of structure and impactors, time integration.
//!
//! | what | where |
//! | --- | --- |
//! | few unknowns instead of many | [`reduce`] |
//! | force of an indentation | [`contact`] |
//! | structure and impactors as one system, with its energies | [`impact`] |
//! | springs under a structure that only push | [`lifting`] |
//! | natural frequencies | [`modes`] |
//! | steps in time | [`integrate`], [`limit`] |
//! | what no impact can do | [`guard`] |
//!
//! A mass strikes one that hangs on a spring:
//!
//! ```
//! use fem_core::plugin::{Built, Dimension, Params, Plugin, Value};
//! use fem_core::structure::{SolveError, Structure};
//! use fem_dynamics::contact::Hertz;
//! use fem_dynamics::impact::{ImpactSystem, Impactor};
//! use fem_dynamics::integrate::Newmark;
//!
//! #[derive(Debug)]
//! struct OnSpring {
//!     k: f64,
//!     m: f64,
//! }
//!
//! impl Structure for OnSpring {
//!     fn ndof(&self) -> usize {
//!         1
//!     }
//!     fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
//!         y[0] += scale * self.k * x[0];
//!     }
//!     fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
//!         y[0] += scale * self.m * x[0];
//!     }
//!     fn solve_shifted(&mut self, shift: f64, x: &mut [f64], _: usize) -> Result<(), SolveError> {
//!         x[0] /= self.k + shift * self.m;
//!         Ok(())
//!     }
//!     fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
//!         x[0] /= self.m;
//!         Ok(())
//!     }
//! }
//!
//! // Plug-ins are built from the parameters that a scene would give them.
//! let k = Value::Quantity(1e9, Dimension::contact_stiffness(1.5));
//! let Built::Contact(law) = Hertz::build(&Params::default().with("k", k))? else { unreachable!() };
//! let Built::Integrator(mut newmark) = Newmark::build(&Params::default())? else { unreachable!() };
//!
//! let impactor = Impactor { mass: 0.1, velocity: 2.0, start: 0.0, load: vec![(0, 1.0)], law };
//! let mut system = ImpactSystem::new(Box::new(OnSpring { k: 1e6, m: 0.2 }), vec![impactor]);
//! let mut state = system.initial();
//! newmark.start(&mut system, &mut state)?;
//! for _ in 0..5000 {
//!     newmark.step(&mut system, &mut state, 1e-6)?;
//! }
//! assert!(state.v[1] < 0.0, "it rebounds");
//! let energy = system.energies(&state, &mut Vec::new()).total();
//! assert!((energy / 0.2 - 1.0).abs() < 1e-5, "and nothing is lost");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod buckling;
pub mod contact;
pub mod guard;
pub mod impact;
pub mod integrate;
mod lanczos;
pub mod lifting;
pub mod limit;
pub mod modes;
pub mod reduce;
mod vector;
