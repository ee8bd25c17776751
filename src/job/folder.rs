//! The folder of results, and the scene in it.

use crate::analyses::impact;
use crate::error::{CheckpointError, Error};
use crate::output::{damage, report};
use fem_io::files::{self, FileError, OutputDir};
use fem_io::scene::SceneSource;
use std::path::Path;

/// What every run writes, but for the scene.
const RESULTS: [&str; 6] = [impact::CHECKPOINT, "summary.json", "cost.json", "history.csv", "events.csv", damage::FILE];

/// The folder for results of `scene`: new, empty, one in which runs have left theirs, or that of the scene itself.
///
/// # Errors
/// A folder that takes no results; one with files of somebody else's.
pub(crate) fn results(folder: &Path, scene: &SceneSource) -> Result<OutputDir, FileError> {
    let home =
        Path::new(scene.name()).parent().map(|home| if home.as_os_str().is_empty() { Path::new(".") } else { home });
    if home.is_some_and(|home| same(home, folder)) { OutputDir::open(folder) } else { OutputDir::create(folder) }
}

/// As [`results`], for a run that begins in it; `checkpoint` is a file in it that the run goes on from.
///
/// # Errors
/// As [`results`], and a file that the run would overwrite and that none has left there, so that no run is in vain.
pub(super) fn begin_run(folder: &Path, scene: &SceneSource, checkpoint: Option<&str>) -> Result<OutputDir, Error> {
    let dir = match checkpoint {
        // It says itself what it is, also in a copy of the folder without the list of files.
        Some(_) => OutputDir::open(folder)?,
        None => results(folder, scene)?,
    };
    dir.begin_run();
    checkpoint.map_or(Ok(()), |file| dir.adopt(file))?;
    dir.claim(&RESULTS)?;
    if !owns_scene(&dir, scene) {
        dir.claim(&[report::SCENE])?;
    }
    Ok(dir)
}

/// What was saved in `folder`, or `None` where a run has begun there that was killed before it could save anything.
///
/// # Errors
/// What else is wrong with it.
pub(crate) fn saved<T>(folder: &Path, read: Result<T, CheckpointError>) -> Result<Option<T>, CheckpointError> {
    match read {
        Err(CheckpointError::Missing { .. }) if files::is_own(folder) => {
            tracing::info!(folder = %folder.display(), "nothing was saved yet: from the beginning");
            Ok(None)
        }
        read => read.map(Some),
    }
}

/// Leaves a copy of the scene with its results, from which a report shows it.
pub(super) fn keep_scene(dir: &OutputDir, scene: &SceneSource) -> Result<(), Error> {
    if owns_scene(dir, scene) {
        return Ok(());
    }
    Ok(dir.write(report::SCENE, |out| out.write_all(scene.text().as_bytes()))?)
}

/// Whether the folder of the results is that of the scene, which then needs no copy.
fn owns_scene(dir: &OutputDir, scene: &SceneSource) -> bool {
    same(&dir.path().join(report::SCENE), Path::new(scene.name()))
}

fn same(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}
