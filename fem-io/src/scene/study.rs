//! What a study of the scene varies and looks at, and the settings that it puts over those of the scene.

use super::Scene;
use crate::document::keys::{Form, Keys, key};
use crate::document::reader::SceneValue;
use crate::document::source::{Located, SceneError, SceneSource};
use crate::materials::LIBRARY;
use fem_core::plugin::Dimension;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use toml_edit::{DocumentMut, InlineTable, Item, Key, Table, TableLike, Value};

/// Keys that replace those of a scene: values by the paths of their keys, both as TOML writes them.
pub type Setting = BTreeMap<String, String>;

/// What a scene says of studies of it.
#[derive(Debug, Clone, Default)]
pub struct Study {
    /// Axes by the names that the study gives them; those that fit the scene if `None`.
    pub axes: Option<Vec<Located<String>>>,
    /// Axes of the scene's own.
    pub own: Vec<OwnAxis>,
    /// What accuracy is asked of; what fits the analysis if empty.
    pub quantities: Vec<Located<Quantity>>,
    /// Relative error to which the reference must have converged.
    pub tolerance: Option<f64>,
}

/// An axis that a scene names.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnAxis {
    /// What results call it.
    pub name: Located<String>,
    /// Whether its levels grow finer, so that errors count from the last one; otherwise they are alternatives to the scene.
    pub ladder: bool,
    /// What each level sets in the scene.
    pub levels: Vec<Setting>,
}

/// Something that has an error.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// One that the study knows by this name, or all whose names begin so.
    Named(String),
    /// A stress at a place.
    Stress {
        /// What results call it.
        name: String,
        /// Name of the `[[profile]]` that it lies on.
        profile: String,
        /// Column of the profile's table without its unit: `sxx`, `s12`.
        component: String,
        /// Height, m.
        height: f64,
    },
}

pub(super) const KEYS: Keys = &[
    key(
        "axes",
        Form::List(&Form::Text),
        r#"["mesh", "layers", "reduction", "step"]"#,
        "what is varied, see `fem study --help`; all that fits the scene if left out",
    ),
    key(
        "axis",
        Form::List(&Form::Table(AXIS)),
        r#"[{ name = "patch", levels = [{ impactor.patch_radius = "2 mm" }] }]"#,
        "axes of your own",
    ),
    key(
        "quantities",
        Form::List(&Form::OneOf(&[Form::Text, Form::Table(STRESS)])),
        r#"["peak-force", "first-damage"]"#,
        "what accuracy is asked of; what fits the analysis if left out",
    ),
    key("tolerance", Form::Number, "1e-3", "relative error to which the reference must have converged"),
];
const AXIS: Keys = &[
    key("name", Form::Text, r#""patch""#, "what results call it").required(),
    key("ladder", Form::Flag, "true", "whether its levels grow finer; otherwise they are alternatives").default("true"),
    key(
        "levels",
        Form::List(&Form::Setting),
        r#"[{ impactor.patch_radius = "2 mm" }, { impactor.patch_radius = "1 mm" }]"#,
        "keys of the scene with their values, a table per level",
    )
    .required(),
];
const STRESS: Keys = &[
    key("name", Form::Text, r#""sxx-top""#, "what results call it").required(),
    key("profile", Form::Text, r#""centre""#, "name of the profile that it lies on").required(),
    key("component", Form::Text, r#""sxx""#, "column of the profile's table, without its unit").required(),
    key("height", Form::Quantity(Dimension::LENGTH), r#""0.5 mm""#, "height above the mid-plane").required(),
];

pub(super) fn read(field: &SceneValue<'_>) -> Result<Study, SceneError> {
    let table = field.table(KEYS)?;
    let names = |field: SceneValue<'_>| field.list()?.iter().map(name).collect::<Result<Vec<_>, _>>();
    let quantities = |field: SceneValue<'_>| field.list()?.iter().map(quantity).collect::<Result<Vec<_>, _>>();
    let own = |field: SceneValue<'_>| field.list()?.iter().map(axis).collect::<Result<Vec<_>, _>>();
    let tolerance = |field: SceneValue<'_>| match field.number()? {
        tolerance if tolerance > 0.0 && tolerance < 1.0 => Ok(tolerance),
        tolerance => {
            Err(field.error(format!("{tolerance} is not a relative error"), "give a number between 0 and 1: 1e-3"))
        }
    };
    Ok(Study {
        axes: table.optional("axes").map(names).transpose()?,
        own: table.optional("axis").map(own).transpose()?.unwrap_or_default(),
        quantities: table.optional("quantities").map(quantities).transpose()?.unwrap_or_default(),
        tolerance: table.optional("tolerance").map(tolerance).transpose()?,
    })
}

fn name(field: &SceneValue<'_>) -> Result<Located<String>, SceneError> {
    Ok(field.at(field.text()?.to_owned()))
}

fn axis(field: &SceneValue<'_>) -> Result<OwnAxis, SceneError> {
    let table = field.table(AXIS)?;
    let level = |field: &SceneValue<'_>| {
        let help = "write keys of the scene with their values: { impactor.patch_radius = \"2 mm\" }";
        field.any_table()?.setting().filter(|keys| !keys.is_empty()).ok_or_else(|| field.error("sets nothing", help))
    };
    Ok(OwnAxis {
        name: name(&table.required("name")?)?,
        ladder: table.optional("ladder").map_or(Ok(true), |field| field.flag())?,
        levels: table.required("levels")?.list()?.iter().map(level).collect::<Result<_, _>>()?,
    })
}

fn quantity(field: &SceneValue<'_>) -> Result<Located<Quantity>, SceneError> {
    if let crate::document::tree::Node::Text(_) = field.node() {
        return Ok(field.at(Quantity::Named(field.text()?.to_owned())));
    }
    let table = field.table(STRESS)?;
    let text = |key| Ok(table.required(key)?.text()?.to_owned());
    Ok(field.at(Quantity::Stress {
        name: text("name")?,
        profile: text("profile")?,
        component: text("component")?,
        height: table.required("height")?.quantity(Dimension::LENGTH)?,
    }))
}

/// A setting as the text of a TOML document.
pub(super) fn text(setting: &Setting) -> String {
    setting.iter().map(|(path, value)| format!("{path} = {value}\n")).collect()
}

/// A relative error, 0.01 or "1 %".
pub(super) fn read_accuracy(field: &SceneValue<'_>) -> Result<Located<f64>, SceneError> {
    let share = field.text().map_or_else(|_| field.number().ok(), |text| parse_share(text).ok());
    let wrong =
        || field.error("is no error that can be asked for", "give a part between 0 and 1, or per cent: 0.01, \"1 %\"");
    share.filter(|share| is_share(*share)).map(|share| field.at(share)).ok_or_else(wrong)
}

fn is_share(share: f64) -> bool {
    share > 0.0 && share < 1.0
}

/// A relative error between 0 and 1 from its text: `0.01`, `1%` or `1 %`.
///
/// # Errors
/// What is wrong with it.
pub fn parse_share(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let share = number.trim().parse::<f64>().ok().map(|share| share * unit);
    share
        .filter(|share| is_share(*share))
        .ok_or_else(|| "must be an error between 0 and 1, or in percent: 0.01 or 1%".into())
}

/// The text of the scene `path` with `setting` written into it, and without the accuracy that it asks for, which a setting is to meet.
/// Comments stay; relative names of files are made absolute, so that the scene can lie anywhere.
///
/// # Errors
/// A scene that cannot be read, or a setting that does not fit its keys.
pub fn rewrite(path: &Path, setting: &Setting) -> Result<String, SceneError> {
    let mut document = written(&super::read_text(path)?, path, setting)?;
    document.remove("accuracy");
    let folder = std::path::absolute(path).ok().and_then(|path| path.parent().map(Path::to_owned)).unwrap_or_default();
    let rooted = |item: Option<&mut Item>| {
        if let Some(item) = item
            && let Some(file) = item.as_str()
        {
            *item = toml_edit::value(folder.join(file).display().to_string());
        }
    };
    rooted(document.get_mut("mesh").and_then(|mesh| mesh.get_mut("file")));
    let materials = document.get_mut("materials").and_then(Item::as_table_like_mut);
    for (_, material) in materials.into_iter().flat_map(|materials| materials.iter_mut()) {
        rooted(material.as_table_like_mut().and_then(|material| material.get_mut("file")));
    }
    Ok(document.to_string())
}

/// Reads the scene `text`, that of `path`, with `keys` and their values, both as TOML writes them, in the place of its own; the text of
/// what is read has them in it.
///
/// # Errors
/// As [`parse`](super::parse), and keys that do not fit the text.
pub fn parse_set(text: &str, path: &Path, keys: &[(String, String)]) -> Result<Scene, SceneError> {
    let setting = keys.iter().cloned().collect();
    super::parse(&written(text, path, &setting)?.to_string(), path)
}

fn written(text: &str, path: &Path, setting: &Setting) -> Result<DocumentMut, SceneError> {
    let source = Arc::new(SceneSource::new(path, text, LIBRARY));
    let wrong = |why: String| source.error(why, "");
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| wrong(e.to_string()))?;
    for (path, value) in setting {
        let keys = Key::parse(path).map_err(|e| wrong(format!("`{path}` is no path of keys: {e}")))?;
        let value: Value = value.parse().map_err(|e: toml_edit::TomlError| wrong(format!("`{path}`: {e}")))?;
        if !set_path(document.as_table_mut(), &keys, &value) {
            let help = "set the whole of it, a table or a list, at once";
            return Err(source.error(
                format!("nothing can be set at `{path}`: it leads through a value or a list in one line"),
                help,
            ));
        }
    }
    Ok(document)
}

/// Names of plug-ins: a table that names another one is made anew.
const NAMES: [&str; 4] = ["kind", "law", "method", "name"];

/// Sets `value` where `keys` lead; whether they lead anywhere.
fn set_path(table: &mut dyn TableLike, keys: &[Key], value: &Value) -> bool {
    match keys {
        [] => false,
        [key] => {
            table.insert(key, Item::Value(value.clone()));
            true
        }
        [key, rest @ ..] => {
            if let ([last], Some(old)) = (rest, table.get_mut(key))
                && NAMES.contains(&last.get())
                && old.get(last.get()).is_some_and(|name| name.as_str() != value.as_str())
            {
                *old = if old.is_table() { Item::Table(Table::new()) } else { Item::Value(InlineTable::new().into()) };
            }
            match table.entry(key).or_insert_with(|| Item::Table(Table::new())) {
                Item::ArrayOfTables(tables) => tables.iter_mut().all(|table| set_path(table, rest, value)),
                item => item.as_table_like_mut().is_some_and(|table| set_path(table, rest, value)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_setting_goes_into_the_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let scene = "# What it is.\nmesh = { file = \"plate.msh\", unit = \"mm\" }\n\n[[impactor]]\nmass = \"1 kg\" # heavy\n\n\
                     [reduction]\nmethod = \"guyan\"\ngovernors = 3\n\n[materials.m]\nfile = \"m.toml\"\n";
        std::fs::write(&path, scene).unwrap();
        let setting = [
            ("mesh.refine", "1"),
            ("impactor.patch_radius", "\"2 mm\""),
            ("reduction.method", "\"ritz\""),
            ("reduction.vectors", "20"),
            ("march.step", "\"0.1 us\""),
        ];
        let setting = setting.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
        let text = rewrite(&path, &setting).unwrap();
        let root = folder.path().display();
        assert_eq!(
            text,
            format!(
                "# What it is.\nmesh = {{ file = \"{root}/plate.msh\", unit = \"mm\" , refine = 1 }}\n\n[[impactor]]\n\
                 mass = \"1 kg\" # heavy\npatch_radius = \"2 mm\"\n\n[reduction]\nmethod = \"ritz\"\nvectors = 20\n\n\
                 [materials.m]\nfile = \"{root}/m.toml\"\n\n[march]\nstep = \"0.1 us\"\n"
            )
        );
    }

    #[test]
    fn a_setting_that_leads_nowhere_is_refused() {
        let text = "title = \"t\"\naccuracy = 0.01\nimpactor = [{ mass = \"1 kg\" }]\n";
        let set = |key: &str, value: &str| {
            let setting = [(key.to_owned(), value.to_owned())].into();
            written(text, Path::new("scene.toml"), &setting).map(|document| document.to_string())
        };
        assert!(set("title", "\"other\"").unwrap().starts_with("title = \"other\"\naccuracy = 0.01\n"));
        for (key, value) in [("title.short", "1"), ("impactor.mass", "\"2 kg\""), ("a..b", "1"), ("title", "1 kg")] {
            let why = set(key, value).unwrap_err().to_string();
            assert!(why.contains(&format!("`{key}`")), "{why}");
        }
    }
}
