//! A series of files in order of time.

use super::escape;
use crate::files::{FileError, OutputDir};

/// A file of a series.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Its time, or whatever numbers the series.
    pub time: f64,
    /// What it shows, where files show several things at a time.
    pub part: usize,
    /// Its name, in the folder of the series.
    pub file: String,
}

/// Writes the series `members` as the file `name`, which ends in `.pvd`.
///
/// # Errors
/// As [`OutputDir::write_unsynced`].
pub fn write_collection(dir: &OutputDir, name: &str, members: &[Member]) -> Result<(), FileError> {
    dir.write_unsynced(name, |out| {
        writeln!(out, r#"<?xml version="1.0"?>"#)?;
        writeln!(out, r#"<VTKFile type="Collection" version="1.0" byte_order="LittleEndian">"#)?;
        writeln!(out, "<Collection>")?;
        for Member { time, part, file } in members {
            writeln!(out, r#"<DataSet timestep="{time}" part="{part}" file="{}"/>"#, escape(file))?;
        }
        writeln!(out, "</Collection>\n</VTKFile>")
    })
}
