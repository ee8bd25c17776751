//! Files that a file includes.

use super::error::{FilePlace, MeshError, MeshFault};
use crate::bytes::{self, Links};
use std::path::{Path, PathBuf};

/// Longest file that is read, and all files that it includes: far more than the memory of a plate's matrices allows for.
pub(crate) const MAX_BYTES: u64 = 1 << 32;

/// Files within files.
const MAX_DEPTH: usize = 16;

/// Most files of a mesh.
const MAX_FILES: usize = 1000;

/// Reads what a file includes, from its own folder.
#[derive(Debug)]
pub(crate) struct Includes {
    /// None for bytes that come from no file.
    folder: Option<PathBuf>,
    depth: usize,
    left: u64,
    files: usize,
}

impl Includes {
    pub(crate) fn of(file: Option<&Path>) -> Self {
        let folder = file.map(|file| file.parent().unwrap_or(Path::new("")).to_owned());
        Self { folder, depth: 0, left: MAX_BYTES, files: 0 }
    }

    /// Name and bytes of the file that stands as `named`; to be [left](Self::leave) again.
    ///
    /// # Errors
    /// What stands in the way.
    pub(crate) fn enter(&mut self, named: &str) -> Result<(String, Vec<u8>), MeshFault> {
        let refused = |why: &str| MeshFault::NotUnderstood(format!("the file {named:?} cannot be included: {why}"));
        let folder = self.folder.as_ref().ok_or_else(|| refused("the mesh comes from no folder"))?;
        if named.is_empty() {
            return Err(refused("its name is missing"));
        }
        if self.depth >= MAX_DEPTH || self.files >= MAX_FILES {
            return Err(refused("files include each other without end"));
        }
        let path = folder.join(named);
        let bytes = bytes::read(&path, self.left, Links::Follow)
            .map_err(|why| refused(&format!("{why}; names count from the folder of the mesh file")))?;
        self.left -= bytes.len() as u64;
        self.files += 1;
        self.depth += 1;
        Ok((path.display().to_string(), bytes))
    }

    pub(crate) fn leave(&mut self) {
        self.depth -= 1;
    }
}

/// The bytes of a mesh file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, MeshError> {
    bytes::read(path, MAX_BYTES, Links::Follow).map_err(|why| MeshError {
        file: path.display().to_string(),
        place: FilePlace::File,
        fault: MeshFault::Unreadable(why.to_string()),
    })
}
