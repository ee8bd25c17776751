//! What an analysis found, for people and machines: summaries, tables, fields, pictures, the page of a folder of results.

pub mod buckling;
pub mod damage;
mod delamination;
pub(crate) mod fields;
mod files;
mod indices;
pub mod mesh;
mod modal;
pub mod modes;
pub mod outlines;
pub mod pictures;
pub mod preload;
pub mod report;
mod shapes;
mod slopes;
pub mod statics;
pub mod summary;

pub use files::{events, history_columns, write_plots, write_tables};
