//! The materials library: constants as data, each with its source and its status.

pub(crate) mod constants;

use crate::document::keys::{Form, Keys, key, words};
use crate::document::reader::{Reader, SceneValue};
use crate::document::source::{Origin, Place, SceneError, SceneSource};
use crate::document::tree::{Entry, Node, Table};
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
    /// The lowest and the highest of the values that sources give, where they disagree.
    pub range: Option<[String; 2]>,
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
/// assert_eq!(resin.material.density, Some(1260.0));
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
    static ALL: LazyLock<Vec<LibraryMaterial>> = LazyLock::new(|| {
        let source = SceneSource::default().with(Origin::Library, "materials library", LIBRARY);
        parse(LIBRARY, &Arc::new(source)).expect("the materials library")
    });
    &ALL
}

const STATUS: [(&str, Status); 3] =
    [("measured", Status::Measured), ("typical", Status::Typical), ("assumed", Status::Assumed)];
const LIBRARY_KEYS: Keys =
    &[key("materials", Form::Named(&Form::Table(MATERIAL)), "{ }", "materials by name").required()];
const MATERIAL: Keys = &[
    key("summary", Form::Text, r#""carbon/epoxy tape""#, "what it is, in a line").required(),
    key("constants", Form::Named(&Form::Table(CONSTANT)), "{ }", "its constants by the keys of a scene").required(),
];
const CONSTANT: Keys = &[
    key("value", VALUE, r#""130.3 GPa""#, "its value, with its unit").required(),
    key("status", Form::Words(&words(&STATUS)), r#""measured""#, "how far it can be trusted").required(),
    key("source", Form::Text, r#""a data sheet""#, "where it comes from").required(),
    key(
        "range",
        Form::Several(2, &VALUE),
        r#"["128 GPa", "141 GPa"]"#,
        "the lowest and the highest of the values that sources give",
    ),
];
const VALUE: Form = Form::OneOf(&[Form::Number, Form::Text]);

/// The materials of a text in the format of the library, which `source` holds as such.
pub(crate) fn parse(text: &str, source: &Arc<SceneSource>) -> Result<Vec<LibraryMaterial>, SceneError> {
    let document = Table::parse(text, Origin::Library, source)?;
    let root = Reader::root(&document, LIBRARY_KEYS, source)?;
    let missing = || {
        let top = Place { origin: Origin::Library, span: 0..0 };
        source.error_at(&top, "`materials` is missing", "describe each material in a table [materials.\"its name\"]")
    };
    root.optional("materials").ok_or_else(missing)?.entries()?.iter().map(|(name, field)| read(name, field)).collect()
}

fn read(name: &str, field: &SceneValue<'_>) -> Result<LibraryMaterial, SceneError> {
    let own = field.table(MATERIAL)?;
    let mut constants = Vec::new();
    let mut table = Table::default();
    for (key, field) in own.required("constants")?.entries()? {
        let constant = field.table(CONSTANT)?;
        let value = constant.required("value")?;
        constants.push(Constant {
            key: key.to_owned(),
            value: written(&value)?,
            range: constant.optional("range").map(|range| range_around(&value, &range)).transpose()?,
            status: constant.required("status")?.choice(&STATUS)?,
            source: constant.required("source")?.text()?.to_owned(),
        });
        table.0.push(Entry { key: key.to_owned(), place: field.entry_place(), item: value.item().clone() });
    }
    Ok(LibraryMaterial {
        summary: own.required("summary")?.text()?.to_owned(),
        constants,
        material: constants::from_constants(name, &own.of(&table, constants::CONSTANTS, field.source())?)?,
        table,
    })
}

/// A value as it is written.
fn written(value: &SceneValue<'_>) -> Result<String, SceneError> {
    Ok(match value.node() {
        Node::Number(number) => number.to_string(),
        _ => value.text()?.to_owned(),
    })
}

/// The ends of the range of a value, which lies between them.
fn range_around(value: &SceneValue<'_>, range: &SceneValue<'_>) -> Result<[String; 2], SceneError> {
    let size = |value: &SceneValue<'_>| match value.node() {
        Node::Text(text) => value.any_quantity(text).map(|(size, dimension)| (size, Some(dimension))),
        _ => Ok((value.number()?, None)),
    };
    let ends = range.list()?;
    let [low, high] = &ends[..] else {
        return Err(range.error("is not two values", "give the lowest and the highest value"));
    };
    let ((below, low_unit), (at, unit), (above, high_unit)) = (size(low)?, size(value)?, size(high)?);
    if !(below <= at && at <= above && low_unit == unit && high_unit == unit) {
        return Err(
            range.error("does not hold the value", "give the lowest and the highest value, with units like its own")
        );
    }
    Ok([written(low)?, written(high)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use fem_core::material::Strength;

    #[test]
    fn the_library_is_read_and_every_constant_has_a_source() {
        let known = ["AS4/3502", "3502 resin", "IM6/934"];
        assert_eq!(names().take(3).collect::<Vec<_>>(), known);
        for material in all() {
            assert!(material.constants.iter().all(|c| !c.source.is_empty() && !c.value.is_empty()));
            assert_eq!(material.material.check(), Ok(()));
            let Material { density, strengths, .. } = &material.material;
            assert!(density.is_some(), "{}", material.material.name);
            // 1 is along the fibres, the ribbon or the warp; cores are stiffest through their thickness.
            let e = &material.material.elastic;
            let (along, through) = (e.e1.max(e.e2), e.e3);
            let is_core = strengths.get(Strength::Zc).is_some() && strengths.get(Strength::Yt).is_none();
            assert_eq!(through > along, is_core, "{}", material.material.name);
            // A slip of a unit or a digit.
            assert!((40.0..9000.0).contains(&density.unwrap()) && (1e6..3e11).contains(&along));
        }
        assert!(all().len() >= 25);
        assert!(library("AS4").is_none());
    }

    #[test]
    fn the_constants_of_the_report() {
        let fibre = &library("AS4/3502").unwrap().material;
        assert_eq!(fibre.density, Some(1575.0));
        let s = &fibre.strengths;
        let mpa = [s.xt(), s.xc(), s.yt(), s.yc(), s.s12(), s.s23()].map(|v| v / 1e6);
        assert_eq!(mpa, [1793.0, 1724.0, 64.0, 138.0, 109.0, 69.0]);
        let g23 = fibre.elastic.g23 / 1e9;
        assert!((g23 - 3.446).abs() < 5e-4, "G23 = E2 / (2 (1 + nu23)), got {g23} GPa");
        let range = library("IM6/934").unwrap().constants[0].range.clone();
        assert_eq!(range, Some(["160 GPa", "172 GPa"].map(str::to_owned)));
        let resin = library("3502 resin").unwrap();
        assert_eq!(resin.material.strengths.get(Strength::S12), Some(62e6));
        assert_eq!(resin.constants[0].value, "3.79 GPa");
        assert!(library("IM6/934").unwrap().constants.iter().all(|c| c.status == Status::Assumed));
    }

    /// The sets of the reference tables, name and S23 apart, are as their source gives them.
    #[test]
    fn the_sets_of_the_reference_tables() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/criteria/materials.csv");
        let mut rows = csv::Reader::from_path(file).unwrap();
        let mut compared = 0;
        for row in rows.deserialize::<std::collections::BTreeMap<String, String>>().map(Result::unwrap) {
            let plain = |name: &str| name.replace(['/', '-'], "_");
            let name =
                names().find(|n| plain(n) == row["material"] || plain(n).replace("E_g", "Eg") == row["material"]);
            let set = library(name.unwrap_or_else(|| panic!("{row:?}"))).unwrap();
            let (e, s) = (&set.material.elastic, &set.material.strengths);
            for (column, got) in [
                ("E1", e.e1 / 1e6),
                ("E2", e.e2 / 1e6),
                ("nu12", e.nu12),
                ("nu23", e.nu23),
                ("G12", e.g12 / 1e6),
                ("Xt", s.xt() / 1e6),
                ("Xc", s.xc() / 1e6),
                ("Yt", s.yt() / 1e6),
                ("Yc", s.yc() / 1e6),
                ("S12", s.s12() / 1e6),
                ("S23", s.s23() / 1e6),
            ] {
                let want: f64 = row[column].parse().unwrap();
                assert!((got / want - 1.0).abs() < 1e-14, "{}, {column}: {got}, not {want}", row["material"]);
            }
            let guessed = |c: &Constant| c.status != Status::Measured && !["S23", "density"].contains(&c.key.as_str());
            assert!(!set.constants.iter().any(guessed), "{:?}", set.constants);
            compared += 1;
        }
        assert_eq!(compared, 6);
    }

    #[test]
    fn a_slip_in_the_library_shows_its_line() {
        for (text, line, remedy) in [
            ("[materials.x]\nsummary = \"x\"\nconstants.e = { value = \"1 GPa\", status = \"sure\" }", 3, "measured"),
            (
                "[materials.x]\nsummary = \"x\"\n[materials.x.constants]\n\
                 library = { value = 1, status = \"typical\", source = \"y\" }",
                4,
                "known: e, nu",
            ),
            (
                "[materials.x]\nsummary = \"x\"\nconstants.e = { value = \"9 GPa\", status = \"typical\", source = \"y\", \
                 range = [\"1 GPa\", \"8 GPa\"] }",
                3,
                "lowest and the highest",
            ),
            ("[material.x]\n", 1, "did you mean `materials`"),
            ("\n# nothing", 1, "[materials.\"its name\"]"),
        ] {
            let source = SceneSource::default().with(Origin::Library, "mine.toml", text);
            let error = parse(text, &Arc::new(source)).unwrap_err();
            assert_eq!(error.location(), Some(("mine.toml", line)), "{error}");
            assert!(error.remedy().contains(remedy), "{error}: {}", error.remedy());
        }
    }
}
