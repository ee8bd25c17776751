//! The words of the framework and the contracts of its plug-ins.
//!
//! Everything here speaks SI units, `f64` and slices. A plug-in crate depends on this crate alone, without its default
//! feature `assembly`, which brings the sparse solver.

#[cfg(feature = "assembly")]
pub mod assembly;
pub mod constraint;
pub mod contact;
pub mod counters;
pub mod dof;
pub mod element;
pub mod failure;
pub mod laminate;
pub mod layup;
pub mod material;
pub mod mesh;
pub mod plate;
pub mod plugin;
pub mod patch;
pub mod quadrature;
pub mod recovery;
pub mod reduction;
pub mod structure;
pub mod support;
pub mod tensor;
#[cfg(feature = "testkit")]
pub mod testkit;
pub mod time;
pub mod window;
