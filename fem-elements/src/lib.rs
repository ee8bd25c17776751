//! Elements: one file each, all implementing [`fem_core::element::Element`].

pub mod hermite;
mod hermite_prism;

pub use hermite_prism::{HermitePrism, Mass};
