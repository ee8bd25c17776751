//! A folder of results, read.

use super::drawing::redraw;
use super::{DECK, SCENE};
use crate::analyses::impact::CHECKPOINT;
use crate::error::Error;
use crate::output::damage::{self, DamageMap};
use fem_io::files::{self, FileError};
use fem_io::results::{FORMAT, Table, damaged, read_bytes, read_document, read_json, read_table, read_text};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Pictures of a run and what they show, in the order of the page; those of profiles come after them.
const PICTURES: [(&str, &str); 13] = [
    ("contact_force", "Contact force over time"),
    ("displacement", "Displacements over time"),
    ("energy", "Energies over time"),
    ("force_displacement", "Force over displacements"),
    ("index_history", "Failure indices at the watched places"),
    ("modal_coordinates", "Modes in the deflection"),
    ("deflection", "Deflection in plan"),
    ("ply_stresses", "Stresses of the outer plies in plan"),
    ("mode_shapes", "Shapes of the lowest modes"),
    ("buckling_shapes", "Shapes of buckling"),
    ("c_scan", "Delaminations in plan"),
    ("c_scan_times", "When it delaminated"),
    ("damage_map", "Damage in plan"),
];
const SECTION: (&str, &str) = ("damage_section", "Damage in a section");

/// What a run left; absent files are `None`.
#[derive(Debug)]
pub(super) struct Folder {
    pub(super) path: PathBuf,
    pub(super) summary: Option<Value>,
    pub(super) cost: Option<Value>,
    pub(super) scene: Option<String>,
    pub(super) deck: Option<String>,
    pub(super) history: Option<Table>,
    pub(super) events: Option<Table>,
    pub(super) modes: Option<Table>,
    pub(super) damage: Option<DamageMap>,
    pub(super) pictures: Vec<Picture>,
}

/// A picture of the folder.
#[derive(Debug)]
pub(super) struct Picture {
    /// Name of its files without the ending.
    pub(super) name: String,
    pub(super) caption: String,
    pub(super) svg: String,
    /// Absent where it was removed.
    pub(super) png: Option<Vec<u8>>,
}

/// The files in a folder that are of one run.
struct Files<'a> {
    folder: &'a Path,
    /// Names of those that are of an earlier one.
    superseded: BTreeSet<String>,
}

impl Files<'_> {
    /// The file `name` by `read`; `None` where it is of an earlier run.
    fn read<T>(
        &self,
        name: &str,
        read: impl FnOnce(&Path) -> Result<Option<T>, FileError>,
    ) -> Result<Option<T>, FileError> {
        if self.superseded.contains(name) { Ok(None) } else { read(&self.folder.join(name)) }
    }
}

impl Folder {
    /// # Errors
    /// No `summary.json` and no checkpoint; a file that is not as a run writes it.
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let file = |name: &str| path.join(name);
        let files = Files { folder: path, superseded: files::superseded(path)? };
        let summary: Option<Value> = files.read("summary.json", read_document)?;
        if summary.as_ref().is_some_and(|summary| summary.get("title").and_then(Value::as_str).is_none()) {
            return Err(damaged(&file("summary.json"), "it has no title".into()).into());
        }
        if let Some(newer) = summary.as_ref().and_then(|s| s.get("format")?.as_u64()).filter(|f| *f > u64::from(FORMAT))
        {
            let why =
                format!("its format is {newer}, and this program reads formats up to {FORMAT}: use a newer `fem`");
            return Err(damaged(&file("summary.json"), why).into());
        }
        let damage: Option<DamageMap> = files.read(damage::FILE, read_json)?;
        if let Some(why) = damage.as_ref().and_then(|damage| damage.check().err()) {
            return Err(damaged(&file(damage::FILE), why).into());
        }
        Ok(Self {
            path: path.to_owned(),
            cost: files.read("cost.json", read_document)?,
            scene: files.read(SCENE, read_text)?,
            deck: files.read(DECK, read_text)?,
            history: files.read("history.csv", read_table)?,
            events: files.read("events.csv", read_table)?,
            modes: files.read("modes.csv", read_table)?,
            pictures: pictures(&files)?,
            summary,
            damage,
        })
    }

    /// # Errors
    /// A folder without `summary.json` and checkpoint.
    pub(super) fn check(path: &Path) -> Result<(), Error> {
        let there = ["summary.json", CHECKPOINT].iter().any(|name| path.join(name).symlink_metadata().is_ok());
        if there { Ok(()) } else { Err(Error::NoResults { folder: path.to_owned() }) }
    }
}

fn pictures(files: &Files<'_>) -> Result<Vec<Picture>, Error> {
    let known = PICTURES.iter().chain([&SECTION]).map(|(name, caption)| ((*name).to_owned(), (*caption).to_owned()));
    let path = files.folder;
    let names = std::fs::read_dir(path).map_err(|cause| read_error(path, cause))?;
    let names: Result<Vec<_>, _> = names.map(|entry| entry.map(|entry| entry.file_name())).collect();
    let names = names.map_err(|cause| read_error(path, cause))?;
    let profile = |name: &std::ffi::OsString| {
        let name = name.to_str()?.strip_suffix(".svg")?;
        Some((name.to_owned(), format!("Through the thickness: {}", name.strip_prefix("profile-")?)))
    };
    let mut profiles: Vec<_> = names.iter().filter_map(profile).collect();
    profiles.sort();
    let mut pictures = Vec::new();
    for (name, caption) in known.chain(profiles) {
        let svg_name = format!("{name}.svg");
        let Some(svg) = files.read(&svg_name, read_text)? else { continue };
        let svg = redraw(&svg)
            .map_err(|why| damaged(&path.join(svg_name), format!("it was not drawn by `fem run`: {why}")))?;
        let png = files.read(&format!("{name}.png"), read_bytes)?;
        pictures.push(Picture { name, caption, svg, png });
    }
    Ok(pictures)
}

fn read_error(path: &Path, cause: std::io::Error) -> Error {
    FileError::Io { action: "read the folder", path: path.to_owned(), cause }.into()
}
