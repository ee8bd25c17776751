//! A page of results: one HTML file that opens from disk.
//!
//! It is made of the files of a folder of results alone, so any run can have one at any time later. What a run did not
//! write is not on it. The page loads nothing, and forbids itself to: its scripts are part of it, its pictures as well.

mod curves;
mod drawing;
mod facts;
mod folder;
mod headline;
mod page;

use crate::effect::LedgerColumn;
use crate::error::Error;
use fem_io::files::OutputDir;
use folder::Folder;
use std::path::{Path, PathBuf};

/// Copy of the scene in a folder of results.
pub const SCENE: &str = "scene.toml";

/// Copy of the deck in a folder of results of one.
pub const DECK: &str = "deck.dat";

/// The page.
pub const PAGE: &str = "report.html";

/// Reads the folder of results `path`, writes [`PAGE`] into it, and says where that is. `columns` are those of effects.
///
/// A march that was stopped by a signal has left a checkpoint alone: the page says so.
///
/// # Errors
/// A folder that no run wrote into, a file in it that is cut off or changed, a run that is still writing there.
pub fn write(path: &Path, columns: &[&LedgerColumn]) -> Result<PathBuf, Error> {
    Folder::check(path)?;
    // Before the files are read, so that no run changes them meanwhile.
    let dir = OutputDir::open(path)?;
    let page = page::render(&Folder::read(path)?, columns)?;
    dir.write(PAGE, |out| out.write_all(page.as_bytes()))?;
    Ok(path.join(PAGE))
}
