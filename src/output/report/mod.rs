//! A page of results: one HTML file that opens from disk.
//!
//! It is made of the files of a folder of results alone, so any run can have one at any time later. What a run did not
//! write is not on it. The page loads nothing, and forbids itself to: its scripts are part of it, its pictures as well.

mod compare;
mod curves;
mod drawing;
mod facts;
mod folder;
mod headline;
mod measured;
mod page;
mod what_if;

pub use what_if::{WhatIf, WhatIfCriterion, WhatIfImpact, WhatIfLaw, WhatIfPlate, WhatIfUnloading};

pub(crate) use page::standalone;

use crate::effect::LedgerColumn;
use crate::error::Error;
use fem_io::files::OutputDir;
use folder::Folder;
use measured::Measured;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Copy of the scene in a folder of results.
pub const SCENE: &str = "scene.toml";

/// Copy of the deck in a folder of results of one.
pub const DECK: &str = "deck.dat";

/// The page.
pub const PAGE: &str = "report.html";

/// The page of several runs, in the folder of the first.
pub const COMPARISON: &str = "comparison.html";

/// Reads the folders of results `paths`, writes [`PAGE`] into an only one, or [`COMPARISON`] into the first of several, and says
/// where that is. `measured` is a table of a force over time, laid over the computed one; `columns` are those of effects. The page of an only
/// folder marches impacts of its own on what is given as `what_if`.
///
/// A march that was stopped by a signal has left a checkpoint alone: the page says so.
///
/// # Errors
/// No folder, or one that no run wrote into, a file in it that is cut off or changed, a run that is still writing there; a table
/// that says no force over time.
pub fn write(
    paths: &[PathBuf],
    measured: Option<&Path>,
    columns: &[&LedgerColumn],
    what_if: Option<&WhatIf>,
) -> Result<PathBuf, Error> {
    let Some(first) = paths.first() else { return Err(Error::NoResults { folder: PathBuf::new() }) };
    paths.iter().try_for_each(|path| Folder::check(path))?;
    let mut named = BTreeSet::new();
    let again = |path: &&PathBuf| fs::canonicalize(path).is_ok_and(|folder| !named.insert(folder));
    if let Some(folder) = paths.iter().find(again) {
        return Err(Error::SameFolder { folder: folder.clone() });
    }
    let measured = measured.map(Measured::read).transpose()?;
    // Before the files are read, so that no run changes them meanwhile.
    let dirs = paths.iter().map(OutputDir::open).collect::<Result<Vec<_>, _>>()?;
    let folders = paths.iter().map(|path| Folder::read(path)).collect::<Result<Vec<_>, _>>()?;
    let (name, page) = match &folders[..] {
        [folder] => (PAGE, page::render(folder, measured.as_ref(), columns, what_if)?),
        several => (COMPARISON, compare::render(several, measured.as_ref())?),
    };
    dirs[0].write(name, |out| out.write_all(page.as_bytes()))?;
    Ok(first.join(name))
}
