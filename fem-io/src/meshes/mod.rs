//! Reads plate meshes: MSH of gmsh, INP of Abaqus and BDF of Nastran, told apart by what they begin with.
//!
//! Cells are quadrilaterals and triangles in a plane z = const. Physical groups and sets become groups. Node and cell numbers of the
//! result follow the numbers in the file, not the order in it. Everything that would make the mesh another one than it seems (cells
//! that overlap or are not joined, edges that belong to no cell, numbers given twice) is refused with place and remedy.
//!
//! ```
//! let square = "$MeshFormat\n4.1 0 8\n$EndMeshFormat
//! $PhysicalNames\n1\n2 1 \"plate\"\n$EndPhysicalNames
//! $Entities\n0 0 1 0\n1 0 0 0 10 10 0 1 1 0\n$EndEntities
//! $Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n10 0 0\n10 10 0\n0 10 0\n$EndNodes
//! $Elements\n1 1 1 1\n2 1 3 1\n1 1 2 3 4\n$EndElements\n";
//! let plate = fem_io::meshes::parse(square.as_bytes(), "square.msh", 1e-3)?;
//! assert_eq!(plate.mesh.groups["plate"].quads, [0]);
//! assert!((plate.mesh.area() - 1e-4).abs() < 1e-12);
//!
//! let same = "*NODE\n1, 0, 0\n2, 10, 0\n3, 10, 10\n4, 0, 10\n*ELEMENT, TYPE=S4R, ELSET=plate\n1, 1, 2, 3, 4\n";
//! assert_eq!(fem_io::meshes::parse(same.as_bytes(), "square.inp", 1e-3)?, plate);
//! # Ok::<(), fem_io::meshes::MeshError>(())
//! ```

#[cfg(test)]
mod tests;

use std::path::Path;

use crate::raw::{self, Includes};
use crate::{abaqus, gmsh, nastran};

pub use crate::raw::{Examined, FileMesh, FilePlace, FlawPlace, MeshError, MeshFault};

/// Reads a mesh file; `unit_metres` is the length of the file's unit (0.001 for mm).
///
/// # Errors
/// When the file cannot be read, is of no known format or is not a sound flat mesh of convex cells that tile a plate.
pub fn read(path: &Path, unit_metres: f64) -> Result<FileMesh, MeshError> {
    examine(path, unit_metres, &[])?.sound()
}

/// Reads a mesh from the bytes of a file; `name` stands for the file in messages. Bytes include no other files.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], name: &str, unit_metres: f64) -> Result<FileMesh, MeshError> {
    examine_bytes(bytes, name, Includes::of(None), unit_metres, &[])?.sound()
}

/// Reads a mesh file whose cells need not tile a plate; where they do not on purpose, along the groups `cuts`, is no flaw.
///
/// # Errors
/// As [`read`], but for flaws of the tiling, which are part of the result.
pub fn examine(path: &Path, unit_metres: f64, cuts: &[String]) -> Result<Examined, MeshError> {
    let bytes = raw::read_file(path)?;
    examine_bytes(&bytes, &path.display().to_string(), Includes::of(Some(path)), unit_metres, cuts)
}

fn examine_bytes(
    bytes: &[u8],
    name: &str,
    includes: Includes,
    unit_metres: f64,
    cuts: &[String],
) -> Result<Examined, MeshError> {
    let error = |fault| MeshError { file: name.to_owned(), place: FilePlace::File, fault };
    if !(unit_metres > 0.0 && unit_metres.is_finite()) {
        return Err(error(MeshFault::Unit(unit_metres)));
    }
    let mut gathered = match Format::of(bytes, name).ok_or_else(|| error(MeshFault::NotAMesh))? {
        Format::Msh => return gmsh::examine(name, bytes, unit_metres, cuts),
        Format::Inp => abaqus::read(name, bytes, includes)?,
        Format::Bdf => nastran::read(name, bytes, includes)?,
    };
    let raw = gathered.raw()?;
    raw.examined(&gathered, unit_metres, cuts)
}

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Msh,
    Inp,
    Bdf,
}

impl Format {
    /// By what the file begins with, and by its name where that says nothing.
    fn of(bytes: &[u8], name: &str) -> Option<Self> {
        if bytes.starts_with(b"$MeshFormat") {
            return Some(Self::Msh);
        }
        let word =
            |line: &[u8]| line.split(|b| !b.is_ascii_alphanumeric()).next().unwrap_or_default().to_ascii_uppercase();
        let mut lines = bytes.split(|b| *b == b'\n' || *b == b'\r').map(<[u8]>::trim_ascii);
        // A title says nothing: scenes have one as well.
        let tells = |line: &&[u8]| {
            !line.is_empty() && !line.starts_with(b"$") && !line.starts_with(b"**") && word(line) != b"TITLE"
        };
        let told = lines.find(|line| tells(line)).and_then(|line| match line {
            [b'*', letter, ..] if letter.is_ascii_alphabetic() => Some(Self::Inp),
            _ => nastran::OPENINGS.contains(&&word(line)[..]).then_some(Self::Bdf),
        });
        let ending = || match name.rsplit_once('.')?.1.to_ascii_lowercase().as_str() {
            "inp" => Some(Self::Inp),
            "bdf" | "nas" | "fem" | "dat" | "blk" => Some(Self::Bdf),
            _ => None,
        };
        told.or_else(ending)
    }
}
