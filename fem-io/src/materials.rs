//! The materials library: constants as data, each with its source and its status.

use crate::scene::SceneError;
use crate::scene::material;
use crate::scene::reader::{Field, Keys, Reader};
use crate::scene::source::{Origin, SceneSource};
use crate::scene::tree::{Entry, Node, Table};
use fem_core::material::Material;
use std::fmt;
use std::sync::{Arc, LazyLock};

pub(crate) const LIBRARY: &str = include_str!("materials/library.toml");

/// A material of the library.
#[derive(Debug, Clone)]
pub struct LibraryMaterial {
    /// One line for people.
    pub summary: String,
    /// Its constants as they are written.
    pub constants: Vec<Constant>,
    /// The same for computing.
    pub material: Material,
    /// The constants as a scene would write them.
    pub(crate) table: Table,
}

/// A constant of the library.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// Its key in scenes.
    pub key: String,
    /// Its value with unit.
    pub value: String,
    /// How far it can be trusted.
    pub status: Status,
    /// Where it comes from.
    pub source: String,
}

/// How far a constant can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The source gives it for this very material.
    Measured,
    /// Usual for materials of this class.
    Typical,
    /// Chosen for want of data.
    Assumed,
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Measured => "measured",
            Self::Typical => "typical",
            Self::Assumed => "assumed",
        })
    }
}

/// The material `name` of the library.
///
/// ```
/// let resin = fem_io::materials::library("3502 resin").ok_or("not there")?;
/// assert_eq!(resin.material.density, 1260.0);
/// # Ok::<(), &str>(())
/// ```
pub fn library(name: &str) -> Option<&'static LibraryMaterial> {
    all().iter().find(|m| m.material.name == name)
}

/// Names of all materials of the library.
pub fn names() -> impl Iterator<Item = &'static str> + Clone {
    all().iter().map(|m| m.material.name.as_str())
}

pub(crate) fn all() -> &'static [LibraryMaterial] {
    #[expect(clippy::expect_used, reason = "the library is part of the program and a test reads it")]
    static ALL: LazyLock<Vec<LibraryMaterial>> = LazyLock::new(|| parse(LIBRARY).expect("the materials library"));
    &ALL
}

const MATERIAL: Keys = &[("summary", r#""carbon/epoxy tape""#), ("constants", "{ }")];
const CONSTANT: Keys = &[("value", r#""130.3 GPa""#), ("status", r#""measured""#), ("source", r#""a data sheet""#)];

fn parse(text: &str) -> Result<Vec<LibraryMaterial>, SceneError> {
    let source = Arc::new(SceneSource::default().with(Origin::Library, "materials library", text));
    let document = Table::parse(text, Origin::Library, &source)?;
    let root = Reader::root(&document, &[("materials", "{ }")], &source)?;
    root.required("materials")?.entries()?.iter().map(|(name, field)| read(name, field)).collect()
}

fn read(name: &str, field: &Field<'_>) -> Result<LibraryMaterial, SceneError> {
    const STATUS: [(&str, Status); 3] =
        [("measured", Status::Measured), ("typical", Status::Typical), ("assumed", Status::Assumed)];
    let own = field.table(MATERIAL)?;
    let mut constants = Vec::new();
    let mut table = Table::default();
    for (key, field) in own.required("constants")?.entries()? {
        let constant = field.table(CONSTANT)?;
        let value = constant.required("value")?;
        constants.push(Constant {
            key: key.to_owned(),
            value: match value.node() {
                Node::Number(number) => number.to_string(),
                _ => value.text()?.to_owned(),
            },
            status: constant.required("status")?.choice(&STATUS)?,
            source: constant.required("source")?.text()?.to_owned(),
        });
        table.0.push(Entry { key: key.to_owned(), place: field.entry_place(), item: value.item().clone() });
    }
    Ok(LibraryMaterial {
        summary: own.required("summary")?.text()?.to_owned(),
        constants,
        material: material::from_constants(name, &own.of(&table, material::KEYS)?)?,
        table,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fem_core::material::Strength;

    #[test]
    fn the_library_is_read_and_every_constant_has_a_source() {
        assert_eq!(names().collect::<Vec<_>>(), ["AS4/3502", "3502 resin", "IM6/934"]);
        for material in all() {
            assert!(material.constants.iter().all(|c| !c.source.is_empty() && !c.value.is_empty()));
            assert_eq!(material.material.check(), Ok(()));
        }
        assert!(library("AS4").is_none());
    }

    #[test]
    fn the_constants_of_the_report() {
        let fibre = &library("AS4/3502").unwrap().material;
        assert_eq!(fibre.density, 1575.0);
        let s = &fibre.strengths;
        let mpa = [s.xt(), s.xc(), s.yt(), s.yc(), s.s12(), s.s23()].map(|v| v / 1e6);
        assert_eq!(mpa, [1793.0, 1724.0, 64.0, 138.0, 109.0, 69.0]);
        let g23 = fibre.elastic.g23 / 1e9;
        assert!((g23 - 3.446).abs() < 5e-4, "G23 = E2 / (2 (1 + nu23)), got {g23} GPa");
        let resin = library("3502 resin").unwrap();
        assert_eq!(resin.material.strengths.get(Strength::S12), Some(62e6));
        assert_eq!(resin.constants[0].value, "3.79 GPa");
        assert!(library("IM6/934").unwrap().constants.iter().all(|c| c.status == Status::Assumed));
    }

    #[test]
    fn a_slip_in_the_library_shows_its_line() {
        let error = parse("[materials.x]\nsummary = \"x\"\nconstants.e = { value = \"1 GPa\", status = \"sure\" }")
            .unwrap_err();
        assert_eq!(error.location(), Some(("materials library", 3)));
        assert!(error.remedy().contains("measured"), "{}", error.remedy());
    }
}
