//! What a march is saved as, and what must agree for a checkpoint to be continued.

use super::march::Saved;
use crate::analyses::saved::{self, Keys};
use crate::error::{CheckpointError, Error};
use crate::model::Model;
use fem_io::files::{FileError, OutputDir};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Name of the file in the folder of the results.
pub(crate) const FILE: &str = "checkpoint.bin";

/// The key of the time at which a march ends.
const END: &str = "march.end";

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
        Ok(Self { folder: folder.to_owned(), saved: saved::read(folder, FILE, &keys(model)?)? })
    }
}

/// Writes what a march of `model` has found, a [`Saved`] or references to its parts, into `dir`.
pub(super) fn write(dir: &OutputDir, model: &Model, found: &impl Serialize) -> Result<(), Error> {
    Ok(saved::write(dir, FILE, &keys(model)?, found)?)
}

fn keys(model: &Model) -> Result<Keys, FileError> {
    let mut keys = saved::identity(model)?;
    keys.remove(END);
    Ok(keys)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use fem_core::time::{Histories, State};

    #[test]
    fn every_bit_of_a_state_comes_back() {
        let odd = [f64::NAN, -f64::NAN, f64::from_bits(0x7ff0_0000_dead_beef), f64::INFINITY, -0.0, 5e-324, 0.1];
        let state = State {
            t: f64::NAN,
            u: odd.to_vec(),
            v: Vec::new(),
            a: vec![1.0],
            histories: Histories { contacts: vec![[-0.0; 8]], beds: vec![[[0.1; 8], [-0.0; 8]]], points: vec![5e-324] },
        };
        let back: State = postcard::from_bytes(&postcard::to_stdvec(&state).unwrap()).unwrap();
        let bits = |s: &State| {
            let numbers = [&s.u, &s.v, &s.a]
                .into_iter()
                .flatten()
                .chain(s.histories.contacts.as_flattened())
                .chain(s.histories.beds.as_flattened().as_flattened())
                .chain(&s.histories.points)
                .chain([&s.t]);
            numbers.map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(bits(&back), bits(&state));
        assert_eq!((back.u.len(), back.v.len()), (7, 0));
    }
}
