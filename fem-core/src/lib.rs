//! The words of the framework and the contracts of its plug-ins.
//!
//! Everything here speaks SI units, `f64` and slices, opens no file and depends on no concrete plug-in.
//!
//! | what | where |
//! | --- | --- |
//! | contracts | [`element`], [`failure`], [`contact`], [`time`], [`reduction`]; [`plugin`] introduces an implementation |
//! | formulas that people write | [`formula`] |
//! | materials and laminates | [`tensor`], [`material`], [`in_situ`], [`layup`], [`laminate`] |
//! | the plate and its unknowns | [`domain`], [`mesh`], [`dof`], [`plate`], [`support`], [`springs`], [`axes`], [`symmetry`], [`constraint`], [`pieces`], [`patch`], [`load`] |
//! | matrices and stresses | [`quadrature`], [`structure`], [`damping`], [`recovery`], [`profile`], [`window`], [`counters`] |
//! | checks of the contracts, for the tests of plug-in crates | [`testkit`] |
#![cfg_attr(feature = "assembly", doc = "| sparse matrices (feature `assembly`) | [`assembly`] |")]
//!
//! A plug-in crate depends on this crate alone; the sparse solver comes with the feature `assembly`.
//!
//! ```
//! use fem_core::laminate::{LaminaPly, Laminate};
//! use fem_core::layup;
//! use fem_core::material::{Elastic, Material, Strengths, Toughnesses};
//!
//! let tape = Material {
//!     name: "AS4/3502".into(),
//!     elastic: Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9),
//!     density: Some(1575.0),
//!     strengths: Strengths::default(),
//!     toughness: Toughnesses::default(), eta: None,
//!     expansion: None,
//! };
//! tape.check()?;
//! let ply = |angle_deg: f64| LaminaPly { angle_deg, angle: angle_deg.to_radians(), thickness: 1.3208e-4, material: 0 };
//! let plies = layup::parse("[0/45/-45/90]2s")?.iter().map(|p| ply(p.angle_deg)).collect();
//!
//! // Two layers of cells, eight plies each, meet at the mid-plane.
//! let laminate = Laminate { plies, layers: vec![8, 8], middle: 0.0 };
//! assert_eq!(laminate.levels()[1], 0.0);
//! assert!((laminate.areal_mass(&[tape])? - 3.328416).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Rooms, lowest first: each imports from those above it here.
mod words;

mod contracts;

mod plates;

#[cfg(feature = "assembly")]
pub mod assembly;
mod stresses;
pub mod testkit;

pub use contracts::{
    contact, cubic_strains, element, failure, interface_law, large, plugin, ply_law, reduction, stack, structure, time,
    transverse,
};
pub use plates::{
    axes, between, classical, constraint, hold, interfaces, laminate, laws, load, mesh, patch, pieces, plate, springs,
    support, symmetry, warping, window,
};
pub use stresses::{estimate, field, profile, recovery, residual, waves};
pub use words::{
    counters, damping, dof, domain, energy, formula, functional, in_situ, interval, layup, material, prolongation,
    quadrature, tensor, vectorised,
};
