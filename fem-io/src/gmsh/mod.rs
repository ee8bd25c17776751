//! Meshes of gmsh: MSH 2.2, 4.0 and 4.1 are read, ASCII and binary, and 4.1 is written.
//!
//! Cells are the quadrilaterals and triangles of all physical surfaces; physical curves become groups of edges, physical points
//! groups of nodes.

mod cursor;
mod elements;
mod entities;
mod groups;
mod nodes;
mod source;
mod write;

use crate::raw::{Examined, MeshError, Raw};

pub use write::{Encoding, write};

use groups::Groups;
use source::Source;

/// Nodes, elements and physical groups of a file whose bytes begin with `$MeshFormat`.
pub(crate) fn examine(name: &str, bytes: &[u8], unit_metres: f64, cuts: &[String]) -> Result<Examined, MeshError> {
    let source = Source::open(name, bytes)?;
    let mut groups = Groups::new(&source, entities::read(&source)?)?;
    let mut raw = Raw::new(nodes::read(&source)?);
    elements::read(&source, &mut groups, &mut raw)?;
    raw.examined(&source, unit_metres, cuts)
}
