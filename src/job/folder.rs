//! The scene beside its results.

use crate::error::Error;
use crate::output::report;
use fem_io::files::{FileError, OutputDir};
use fem_io::scene::SceneSource;
use std::path::Path;

/// Leaves a copy of the scene with its results, from which a report shows it.
pub(super) fn keep_scene(dir: &OutputDir, scene: &SceneSource) -> Result<(), Error> {
    if owns_scene(dir, scene)? {
        return Ok(());
    }
    Ok(dir.write(report::SCENE, |out| out.write_all(scene.text().as_bytes()))?)
}

/// Whether the folder of the results is that of the scene, which then needs no copy.
///
/// # Errors
/// Another `scene.toml`, which no run has left there.
pub(super) fn owns_scene(dir: &OutputDir, scene: &SceneSource) -> Result<bool, Error> {
    let copy = dir.path().join(report::SCENE);
    let same = |a: &Path, b: &Path| matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
    if same(&copy, Path::new(scene.name())) {
        return Ok(true);
    }
    if copy.exists() && !dir.path().join("cost.json").exists() {
        return Err(FileError::Taken { path: copy }.into());
    }
    Ok(false)
}
