//! Files in and out: scenes, meshes and materials are read, tables and plots are written.
//!
//! | what | where |
//! | --- | --- |
//! | the scene, a TOML file over presets | [`scene`], with [`units`] and the library of [`materials`] |
//! | meshes of gmsh, Abaqus and Nastran | [`meshes`]; [`gmsh`] writes them |
//! | decks of LAMCEL, LAMSUB and TRADYR | [`deck`] |
//! | the folder of results: files that appear whole or not at all | [`files`] |
//! | what a later run goes on from, or need not compute again | [`checkpoint`], [`cache`] |
//! | arrays for NumPy | [`npy`] |
//! | CSV and JSON, line plots as SVG and PNG | [`tables`], [`plot`] |
//! | fields for ParaView and PyVista | [`vtu`] |
//!
//! Beyond this crate there are only SI units; whatever is refused is refused here, with its file, its line and a remedy:
//!
//! ```
//! use fem_core::plugin::Dimension;
//! use fem_io::units::parse_as;
//!
//! assert_eq!(parse_as("0.5 us", Dimension::TIME)?, 5e-7);
//! assert_eq!(parse_as("2 GPa", Dimension::PRESSURE)?, 2e9);
//! assert!(parse_as("2", Dimension::PRESSURE).is_err(), "a bare number has no meaning");
//! # Ok::<(), fem_io::units::UnitError>(())
//! ```

mod abaqus;
mod bytes;
pub mod cache;
pub mod checkpoint;
pub mod deck;
mod document;
pub mod files;
pub mod gmsh;
pub mod materials;
pub mod meshes;
mod nastran;
pub mod npy;
pub mod plot;
mod raw;
pub mod results;
pub mod scene;
pub mod tables;
pub mod units;
pub mod vtu;
