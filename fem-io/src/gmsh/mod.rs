//! Reads plate meshes that gmsh wrote (format MSH 4.1, ASCII or binary), and writes such files.
//!
//! Cells are the quadrilaterals of all physical surfaces; physical curves become groups of edges, physical points
//! groups of nodes. Node and cell numbers of the result follow the numbers in the file, not the order in it. Everything
//! that would make the mesh another one than it seems (cells that overlap or are not joined, edges that belong to no cell,
//! numbers given twice) is refused with place and remedy.
//!
//! ```
//! let square = "$MeshFormat\n4.1 0 8\n$EndMeshFormat
//! $PhysicalNames\n1\n2 1 \"plate\"\n$EndPhysicalNames
//! $Entities\n0 0 1 0\n1 0 0 0 10 10 0 1 1 0\n$EndEntities
//! $Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n10 0 0\n10 10 0\n0 10 0\n$EndNodes
//! $Elements\n1 1 1 1\n2 1 3 1\n1 1 2 3 4\n$EndElements\n";
//! let plate = fem_io::gmsh::parse(square.as_bytes(), "square.msh", 1e-3)?;
//! assert_eq!(plate.mesh.groups["plate"].quads, [0]);
//! assert!((plate.mesh.area() - 1e-4).abs() < 1e-12);
//! # Ok::<(), fem_io::gmsh::MeshError>(())
//! ```

mod assemble;
mod checks;
mod cursor;
mod elements;
mod entities;
mod error;
mod groups;
mod nodes;
mod source;
#[cfg(test)]
mod tests;
mod tiling;
mod write;

use std::path::Path;

use crate::bytes::{self, Links};
use fem_core::mesh::PlaneMesh;

pub use error::{FilePlace, FlawPlace, MeshError, MeshFault};
pub use tiling::Examined;
pub use write::{Encoding, write};

use elements::Grouped;
use groups::Groups;
use nodes::NodeTable;
use source::Source;

/// Longest file that is read: far more than the memory of a plate's matrices allows for.
const MAX_BYTES: u64 = 1 << 32;

/// A mesh and what its reader thinks the user should know.
#[derive(Debug, Clone, PartialEq)]
pub struct GmshMesh {
    /// The mesh, metres.
    pub mesh: PlaneMesh,
    /// One sentence each.
    pub warnings: Vec<String>,
}

/// Reads a mesh file; `unit_metres` is the length of the file's unit (0.001 for mm).
///
/// Cells are quadrilaterals and triangles; those of second order are read by their corners, with a warning.
///
/// # Errors
/// When the file cannot be read, is not MSH 4.1 or is not a sound flat mesh of convex cells that tile a plate.
pub fn read(path: &Path, unit_metres: f64) -> Result<GmshMesh, MeshError> {
    examine(path, unit_metres, &[])?.sound()
}

/// Reads a mesh from the bytes of a file; `name` stands for the file in messages.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], name: &str, unit_metres: f64) -> Result<GmshMesh, MeshError> {
    examine_bytes(bytes, name, unit_metres, &[])?.sound()
}

/// Reads a mesh file whose cells need not tile a plate; where they do not on purpose, along the groups `cuts`, is no flaw.
///
/// # Errors
/// As [`read`], but for flaws of the tiling, which are part of the result.
pub fn examine(path: &Path, unit_metres: f64, cuts: &[String]) -> Result<Examined, MeshError> {
    let name = path.display().to_string();
    let bytes = bytes::read(path, MAX_BYTES, Links::Follow).map_err(|e| MeshError {
        file: name.clone(),
        place: FilePlace::File,
        fault: MeshFault::Unreadable(e.to_string()),
    })?;
    examine_bytes(&bytes, &name, unit_metres, cuts)
}

fn examine_bytes(bytes: &[u8], name: &str, unit_metres: f64, cuts: &[String]) -> Result<Examined, MeshError> {
    let source = Source::open(name, bytes)?;
    if !(unit_metres > 0.0 && unit_metres.is_finite()) {
        return Err(source.error(FilePlace::File, MeshFault::Unit(unit_metres)));
    }
    let groups = Groups::new(&source, entities::read(&source)?)?;
    let nodes = NodeTable::read(&source)?;
    let mut grouped = Grouped::read(&source, &nodes, &groups)?;
    if grouped.cells.is_empty() {
        return Err(source.error(FilePlace::File, MeshFault::NoCells));
    }
    let turned = checks::orient(&source, &nodes, &mut grouped.cells)?;
    let mesh = assemble::mesh(&source, &nodes, &grouped, unit_metres)?;
    let warnings = warnings(&mesh, &groups, &grouped, &turned);
    let examined = Examined::new(&source, GmshMesh { mesh, warnings }, cuts);
    if examined.flaws.is_empty() {
        checks::check_edges(&source, &nodes, &grouped.edges, &examined.read.mesh)?;
    }
    Ok(examined)
}

/// What the user should know of a mesh that was accepted.
fn warnings(mesh: &PlaneMesh, groups: &Groups, grouped: &Grouped<'_>, turned: &[u64]) -> Vec<String> {
    let mut warnings = Vec::new();
    let cells = mesh.quads.len();
    if let Some(first) = turned.first() {
        let (n, verb) = (turned.len(), if turned.len() == 1 { "was" } else { "were" });
        warnings.push(format!("{n} of {cells} cells {verb} clockwise (the first is {first}) and turned round"));
    }
    let (second_order, bulge) = grouped.second_order;
    if second_order > 0 {
        warnings.push(format!(
            "{second_order} of {cells} cells are of second order and read by their corners; their mid-side nodes, up to \
             {:.2} % of an edge off its middle, are dropped: curved edges become straight. Set Mesh.ElementOrder = 1",
            100.0 * bulge
        ));
    }
    if grouped.left_out > 0 {
        warnings.push(format!(
            "{} surface elements belong to no physical group and are left out; unset Mesh.SaveAll or name their surface",
            grouped.left_out
        ));
    }
    for name in groups.names().filter(|name| !mesh.groups.contains_key(*name)) {
        warnings.push(format!("the physical group {name:?} holds no elements and is left out"));
    }
    warnings
}
