//! Modes and stresses of plates that are kept for later runs.
//!
//! They take nearly all of the time before a march. K and M are made anew, and the modes are held against them, and the stresses against those
//! of a displacement in some cells. The key of a file is a digest of all that it depends on.

use super::stress::looks_between;
use crate::error::WRITER;
use crate::model::{Impact, Model, leaves_plate};
use fem_core::structure::Structure;
use fem_dynamics::reduce::Reduced;
use fem_io::cache::Cache;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Keys, or beginnings of them, that come after a plate is reduced; and those that come after its stresses.
const AFTER_MODES: [&str; 6] = ["march.", "failure.", "output.", "study.", "sweep.", "accuracy"];
const AFTER_STRESSES: [&str; 8] =
    ["march.", "failure.criteria", "failure.every", "failure.watch", "output.", "study.", "sweep.", "accuracy"];

/// A part of a plate in the cache, there or not.
#[derive(Debug)]
pub(super) struct KeptPart<'a> {
    cache: &'a Cache,
    key: String,
}

/// A reduction, with the factorisations and solves that it took.
#[derive(Debug, Serialize, Deserialize)]
struct Saved {
    stiffness: Vec<f64>,
    mass: Vec<f64>,
    basis: Vec<f64>,
    work: (u64, u64),
}

impl<'a> KeptPart<'a> {
    /// The modes of `model`; `None` where there is no cache, or nothing that is worth to be kept.
    pub(super) fn of_modes(model: &'a Model, impact: &Impact) -> Option<Self> {
        impact.reduction.as_ref()?;
        Self::of(model, "modes", &AFTER_MODES)
    }

    /// Its stresses per mode.
    pub(super) fn of_stresses(model: &'a Model) -> Option<Self> {
        Self::of(model, if looks_between(model) { "stresses" } else { "stresses of plies" }, &AFTER_STRESSES)
    }

    fn of(model: &'a Model, what: &str, after: &[&str]) -> Option<Self> {
        let cache = model.cache.as_ref()?;
        Some(Self { cache, key: key(model, what, after)? })
    }

    /// What is kept.
    pub(super) fn read<T: DeserializeOwned>(&self) -> Option<T> {
        let payload = self.cache.get(&self.key)?;
        let read = postcard::from_bytes(&payload).ok();
        if read.is_none() {
            self.refuse("it is not what this program writes");
        }
        read
    }

    /// Removes what was kept, for a reason.
    pub(super) fn refuse(&self, why: &str) {
        self.cache.refuse(&self.key, why);
    }

    /// Keeps `what` is to be read.
    pub(super) fn write(&self, what: &impl Serialize) {
        if let Ok(payload) = postcard::to_stdvec(what) {
            self.cache.put(&self.key, &payload);
        }
    }

    /// The reduction of `structure`, and the factorisations and solves that it took.
    pub(super) fn read_modes(&self, structure: &dyn Structure) -> Option<(Reduced, (u64, u64))> {
        let Saved { stiffness, mass, basis, work } = self.read()?;
        let reduced = Reduced::restored(structure, stiffness, mass, basis);
        if reduced.is_none() {
            self.refuse("its modes are not those of the plate");
        }
        Some((reduced?, work))
    }

    /// Keeps `reduced`, which took so many factorisations and solves.
    pub(super) fn write_modes(&self, reduced: &Reduced, work: (u64, u64)) {
        self.write(&(reduced.modal.stiffnesses(), reduced.modal.masses(), &reduced.basis, work));
    }
}

/// Digest of the program, of the mesh, and of the values of all keys that shape `what`, but for those `after` it.
fn key(model: &Model, what: &str, after: &[&str]) -> Option<String> {
    let shapes = |key: &str| {
        !leaves_plate(key) && !after.iter().any(|after| key.starts_with(after)) && !key.starts_with("materials.")
    };
    let mut keys: BTreeMap<&str, String> =
        model.origin.keys.iter().filter(|(key, _)| shapes(key)).map(|(key, v)| (key.as_str(), v.clone())).collect();
    for material in &model.materials {
        let constants = format!("{:?} {:?} {:?}", material.elastic, material.density, material.expansion);
        keys.insert(&material.name, constants);
    }
    // An effect that is left to the advisor acts or not.
    keys.insert("decisions", format!("{:?}", model.decisions));
    if model.origin.mesh.is_some() {
        // What was read: the file may include others.
        keys.insert("mesh.file", hex(&Sha256::digest(format!("{:?}", model.plate.plane))));
    }
    let bytes = postcard::to_stdvec(&(WRITER, program(), what, &keys)).ok()?;
    Some(hex(&Sha256::digest(bytes)))
}

/// What tells builds of a program apart: plug-ins of its own, and changes between versions, have no name.
fn program() -> Option<(u64, u128)> {
    let is = std::env::current_exe().ok()?.metadata().ok()?;
    let built = is.modified().ok()?.duration_since(std::time::UNIX_EPOCH).ok()?;
    Some((is.len(), built.as_nanos()))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
