//! A folder of results, read.

use super::SCENE;
use crate::error::Error;
use crate::output::damage::{self, DamageMap};
use fem_io::files::FileError;
use fem_io::results::{Table, damaged, read_json, read_table, read_text};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Pictures of a run and what they show, in the order of the page; those of profiles come after them.
const PICTURES: [(&str, &str); 7] = [
    ("contact_force", "Contact force over time"),
    ("displacement", "Displacements over time"),
    ("energy", "Energies over time"),
    ("force_displacement", "Contact force over displacements"),
    ("index_history", "Failure indices at the watched places"),
    ("modal_coordinates", "Modes in the deflection"),
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

impl Folder {
    /// # Errors
    /// No `summary.json` and no checkpoint; a file that is not as a run writes it.
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let file = |name: &str| path.join(name);
        let summary: Option<Value> = read_json(&file("summary.json"))?;
        if summary.is_none() && !file("checkpoint.bin").exists() {
            return Err(Error::NoResults { folder: path.to_owned() });
        }
        if summary.as_ref().is_some_and(|summary| summary.get("title").and_then(Value::as_str).is_none()) {
            return Err(damaged(&file("summary.json"), "it has no title".into()).into());
        }
        let damage: Option<DamageMap> = read_json(&file(damage::FILE))?;
        if let Some(why) = damage.as_ref().and_then(|damage| damage.check().err()) {
            return Err(damaged(&file(damage::FILE), why).into());
        }
        Ok(Self {
            path: path.to_owned(),
            cost: read_json(&file("cost.json"))?,
            scene: read_text(&file(SCENE))?,
            history: read_table(&file("history.csv"))?,
            events: read_table(&file("events.csv"))?,
            modes: read_table(&file("modes.csv"))?,
            pictures: pictures(path)?,
            summary,
            damage,
        })
    }
}

fn pictures(path: &Path) -> Result<Vec<Picture>, Error> {
    let known = PICTURES.iter().chain([&SECTION]).map(|(name, caption)| ((*name).to_owned(), (*caption).to_owned()));
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
        let svg_path = path.join(format!("{name}.svg"));
        let Some(svg) = read_text(&svg_path)? else { continue };
        if !is_drawing(&svg) {
            return Err(damaged(&svg_path, "it was not drawn by `fem run`".into()).into());
        }
        let png = std::fs::read(path.join(format!("{name}.png"))).ok();
        pictures.push(Picture { name, caption, svg, png });
    }
    Ok(pictures)
}

fn read_error(path: &Path, cause: std::io::Error) -> Error {
    FileError::Io { action: "read the folder", path: path.to_owned(), cause }.into()
}

/// Whether a text has nothing but the elements of our own drawings, all of it, and no attribute that would run or load.
///
/// The page takes pictures as they are, so what is in them must be known.
fn is_drawing(svg: &str) -> bool {
    const ELEMENTS: [&str; 7] = ["svg", "title", "rect", "polyline", "circle", "path", "text"];
    let whole = svg.starts_with("<svg xmlns=") && svg.trim_end().ends_with("</svg>");
    whole
        && svg.split('<').skip(1).all(|part| {
            let Some((tag, _)) = part.split_once('>') else { return false };
            let name = tag.trim_start_matches('/').split([' ', '/']).next().unwrap_or("");
            let separates = |c: char| c.is_whitespace() || c == '/';
            let attributes = tag.split('"').step_by(2).flat_map(|part| part.split(separates)).skip(1);
            let harmless =
                |word: &str| !word.to_ascii_lowercase().starts_with("on") && !word.contains("href") && word != "style=";
            ELEMENTS.contains(&name) && attributes.into_iter().all(harmless)
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_our_own_drawings_are_taken() {
        let drawing =
            |inside: &str| format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1\">\n{inside}\n</svg>\n");
        for good in
            ["<title>on a &lt;b</title>", "<text x=\"1\">onload= href</text>", "<path d=\"M0,0Z\"/><circle r=\"1\"/>"]
        {
            assert!(is_drawing(&drawing(good)), "{good}");
        }
        let bad = [
            "<script>1</script>",
            "<rect/onload=x>",
            "<rect onload=\"x\"/>",
            "<rect\nONLOAD=\"x\"/>",
            "<a href=\"x\"/>",
            "<text xlink:href=\"x\"/>",
            "<text",
        ];
        for bad in bad {
            assert!(!is_drawing(&drawing(bad)), "{bad}");
        }
        assert!(!is_drawing("<svg xmlns=\"\"><text>cut"));
    }
}
