//! What a march is saved as, and what a checkpoint must agree with to be gone on from.

use super::march::Saved;
use crate::error::Error;
use crate::model::Model;
use fem_io::checkpoint;
use fem_io::files::{FileError, OutputDir};
use fem_io::scene::MeshSource;
use miette::Diagnostic;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Name of the file in the folder of the results.
const FILE: &str = "checkpoint.bin";

/// Keys on which no number of the march depends, and its end, up to which it goes on.
const FREE: &[&str] = &["title", "march.end", "output.plots", "output.maps", "output.checkpoint_every"];

const MATERIALS: &str = "materials.";
const MESH: &str = "mesh.file";
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Differences that a message names.
const NAMED: usize = 4;

/// Why a march cannot go on from a checkpoint.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[non_exhaustive]
pub enum CheckpointError {
    /// There is none.
    #[error("there is no checkpoint in `{}`", folder.display())]
    #[diagnostic(help("run without `--resume` first, or name the folder of the run with `--out`"))]
    Missing {
        /// The folder.
        folder: PathBuf,
    },
    /// It cannot be read, or is not as it was written.
    #[error(transparent)]
    #[diagnostic(help("run without `--resume`: that starts anew and replaces the checkpoint"))]
    File(#[from] FileError),
    /// Another version wrote it.
    #[error("the checkpoint in `{}` was written by version {theirs}, this is version {}", folder.display(), VERSION)]
    #[diagnostic(help("go on with version {theirs}, or run without `--resume` to start anew"))]
    Version {
        /// The folder.
        folder: PathBuf,
        /// The version.
        theirs: String,
    },
    /// It belongs to another run.
    #[error("the checkpoint in `{}` belongs to another run: {}", folder.display(), differences.join("; "))]
    #[diagnostic(help(
        "restore what differs, or run without `--resume` to start anew; `title`, `march.end` and the plots may differ"
    ))]
    Differs {
        /// The folder.
        folder: PathBuf,
        /// What differs, in words.
        differences: Vec<String>,
    },
    /// It lies beyond the end.
    #[error("the checkpoint in `{}` is at {at:e} s, beyond `march.end`", folder.display())]
    #[diagnostic(help("set `march.end` to that time or a later one, or run without `--resume` to start anew"))]
    Beyond {
        /// The folder.
        folder: PathBuf,
        /// Its time, s.
        at: f64,
    },
}

/// A checkpoint that belongs to the scene of a model.
#[derive(Debug)]
pub struct Checkpoint {
    pub(super) folder: PathBuf,
    pub(super) saved: Saved,
}

impl Checkpoint {
    /// Reads the checkpoint in `folder` and compares what it depends on with `model`.
    ///
    /// # Errors
    /// No checkpoint, a damaged one, one of another version, scene or mesh.
    pub fn read(folder: &Path, model: &Model) -> Result<Self, CheckpointError> {
        let folder = folder.to_owned();
        let path = folder.join(FILE);
        let payload = match checkpoint::read(&path) {
            Err(FileError::Io { cause, .. }) if cause.kind() == ErrorKind::NotFound => {
                return Err(CheckpointError::Missing { folder });
            }
            payload => payload?,
        };
        let damaged = |e: postcard::Error| FileError::Damaged { path: path.clone(), why: e.to_string() };
        // The version comes first: another one may have kept anything behind it.
        let (version, rest) = postcard::take_from_bytes::<String>(&payload).map_err(damaged)?;
        if version != VERSION {
            return Err(CheckpointError::Version { folder, theirs: version });
        }
        let (then, rest) = postcard::take_from_bytes::<Keys>(rest).map_err(damaged)?;
        let differences = differences(&then, &keys(model)?);
        if !differences.is_empty() {
            return Err(CheckpointError::Differs { folder, differences });
        }
        Ok(Self { folder, saved: postcard::from_bytes(rest).map_err(damaged)? })
    }
}

/// Writes what a march of `model` has found, a [`Saved`] or references to its parts, into `dir`.
pub(super) fn write(dir: &OutputDir, model: &Model, found: &impl Serialize) -> Result<(), Error> {
    let payload = postcard::to_stdvec(&(VERSION, keys(model)?, found));
    let payload = payload.map_err(|e| FileError::Damaged { path: dir.path().join(FILE), why: e.to_string() })?;
    Ok(checkpoint::write(dir, FILE, &payload)?)
}

/// Values by the paths of their keys.
type Keys = BTreeMap<String, String>;

/// All that a march of `model` depends on: keys of the scene and its preset, materials and the mesh by what they hold.
fn keys(model: &Model) -> Result<Keys, FileError> {
    let scene = &model.scene;
    let depends = |key: &str| !FREE.contains(&key) && !key.starts_with(MATERIALS) && key != MESH;
    let mut keys = scene.keys.clone();
    keys.retain(|key, _| depends(key));
    keys.extend(model.materials.iter().map(|m| (format!("{MATERIALS}{}", m.name), format!("{m:?}"))));
    if let MeshSource::File { file, .. } = &scene.mesh {
        keys.insert(MESH.to_owned(), checkpoint::digest(&file.value)?);
    }
    Ok(keys)
}

/// What differs, in words.
fn differences(then: &Keys, now: &Keys) -> Vec<String> {
    let all: BTreeSet<_> = then.keys().chain(now.keys()).collect();
    let words = |key: &String| match (then.get(key), now.get(key)) {
        (then, now) if then == now => None,
        (Some(_), Some(_)) if key.starts_with(MATERIALS) => Some(format!("`{key}` had other constants")),
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
    #![allow(clippy::unwrap_used)]

    use super::*;
    use fem_core::time::State;

    #[test]
    fn every_bit_of_a_state_comes_back() {
        let odd = [f64::NAN, -f64::NAN, f64::from_bits(0x7ff0_0000_dead_beef), f64::INFINITY, -0.0, 5e-324, 0.1];
        let state = State { t: f64::NAN, u: odd.to_vec(), v: Vec::new(), a: vec![1.0], contacts: vec![[-0.0; 8]] };
        let back: State = postcard::from_bytes(&postcard::to_stdvec(&state).unwrap()).unwrap();
        let bits = |s: &State| {
            let numbers = [&s.u, &s.v, &s.a].into_iter().flatten().chain(s.contacts.as_flattened()).chain([&s.t]);
            numbers.map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(bits(&back), bits(&state));
        assert_eq!((back.u.len(), back.v.len()), (7, 0));
    }

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
            "`materials.m` had other constants",
        ];
        assert_eq!(differences(&then, &now), want);
        let more = keys(&[("d", "1"), ("e", "1"), ("f", "1"), ("g", "1"), ("h", "1"), ("i", "1")]);
        assert_eq!(differences(&keys(&[]), &more).last().map(String::as_str), Some("and 2 more"));
    }
}
