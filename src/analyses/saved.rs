//! Files that a later process continues from, and what must agree with them for that.

use crate::error::{CheckpointError, WRITER};
use crate::model::Model;
use fem_io::checkpoint;
use fem_io::files::{FileError, OutputDir};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::{BTreeMap, BTreeSet};
use std::io::ErrorKind;
use std::path::Path;

/// Keys, or beginnings of them, on which no number depends.
const FREE: &[&str] = &["title", "study.", "sweep.", "output.plots", "output.maps", "output.checkpoint_every"];

const MATERIALS: &str = "materials.";
const LAW: &str = ".law";
const MESH: &str = "mesh.file";

/// Differences that a message names.
const NAMED: usize = 4;

/// What was saved as `file` in `folder` by a computation that depends on `now`.
///
/// # Errors
/// No such file, a damaged one, one of another version, scene or mesh.
pub(crate) fn read<T: DeserializeOwned>(folder: &Path, file: &str, now: &Keys) -> Result<T, CheckpointError> {
    let folder = folder.to_owned();
    let path = folder.join(file);
    let payload = match checkpoint::read(&path) {
        Err(FileError::Io { cause, .. }) if cause.kind() == ErrorKind::NotFound => {
            return Err(CheckpointError::Missing { folder });
        }
        payload => payload?,
    };
    let damaged = |e: postcard::Error| FileError::Damaged { path: path.clone(), why: e.to_string() };
    // The version comes first: another one may have kept anything behind it.
    let (version, rest) = postcard::take_from_bytes::<String>(&payload).map_err(damaged)?;
    if version != WRITER {
        return Err(CheckpointError::Version { folder, theirs: version });
    }
    let (then, rest) = postcard::take_from_bytes::<Keys>(rest).map_err(damaged)?;
    let differences = differences(&then, now);
    if !differences.is_empty() {
        return Err(CheckpointError::Differs { folder, differences });
    }
    Ok(postcard::from_bytes(rest).map_err(damaged)?)
}

/// Writes `found`, which depends on `keys`, as `file` into `dir`.
///
/// # Errors
/// A folder that cannot be written.
pub(crate) fn write(dir: &OutputDir, file: &str, keys: &Keys, found: &impl Serialize) -> Result<(), FileError> {
    let payload = postcard::to_stdvec(&(WRITER, keys, found));
    let payload = payload.map_err(|e| FileError::Damaged { path: dir.path().join(file), why: e.to_string() })?;
    checkpoint::write(dir, file, &payload)
}

/// Values by the paths of their keys.
pub(crate) type Keys = BTreeMap<String, String>;

/// All that results of `model` depend on: keys of the scene and its preset, materials and the mesh by what they hold.
///
/// # Errors
/// A mesh that cannot be read any more.
pub(crate) fn identity(model: &Model) -> Result<Keys, FileError> {
    let mut keys = model.origin.keys.clone();
    let depends = |key: &str| {
        !FREE.iter().any(|free| key.starts_with(free))
            && (!key.starts_with(MATERIALS) || key.contains(LAW))
            && key != MESH
    };
    keys.retain(|key, _| depends(key));
    keys.extend(model.materials.iter().map(|m| (format!("{MATERIALS}{}", m.name), format!("{m:?}"))));
    if let Some(file) = &model.origin.mesh {
        keys.insert(MESH.to_owned(), checkpoint::digest(file)?);
    }
    Ok(keys)
}

/// What differs, in words.
fn differences(then: &Keys, now: &Keys) -> Vec<String> {
    let all: BTreeSet<_> = then.keys().chain(now.keys()).collect();
    let words = |key: &String| match (then.get(key), now.get(key)) {
        (then, now) if then == now => None,
        (Some(_), Some(_)) if key.starts_with(MATERIALS) => Some(format!("`{key}` had different constants")),
        (Some(then), Some(now)) => Some(format!("`{key}` was {then} and is {now}")),
        (Some(then), None) => Some(format!("`{key}` was {then} and is left out")),
        (None, _) => Some(format!("`{key}` was left out")),
    };
    let mut words: Vec<String> = all.into_iter().filter_map(words).collect();
    if words.len() > NAMED {
        let more = words.len() - NAMED;
        words.truncate(NAMED);
        words.push(format!("and {more} more"));
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_named_and_counted() {
        let keys = |pairs: &[(&str, &str)]| -> Keys {
            pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
        };
        let then = keys(&[("a", "1"), ("b", "2"), ("materials.m", "x")]);
        assert!(differences(&then, &then).is_empty());
        let now = keys(&[("a", "3"), ("c", "4"), ("materials.m", "y")]);
        let want = [
            "`a` was 1 and is 3",
            "`b` was 2 and is left out",
            "`c` was left out",
            "`materials.m` had different constants",
        ];
        assert_eq!(differences(&then, &now), want);
        let more = keys(&[("d", "1"), ("e", "1"), ("f", "1"), ("g", "1"), ("h", "1"), ("i", "1")]);
        assert_eq!(differences(&keys(&[]), &more).last().map(String::as_str), Some("and 2 more"));
    }
}
