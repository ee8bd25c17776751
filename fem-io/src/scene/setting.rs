//! Keys laid over those of a scene: by the command line, a study or a sweep.

use super::run::SEPARATION;
use super::{AS_WRITTEN, Merged, Scene, parse, parse_with};
use crate::document::source::{SceneError, SceneSource};
use crate::document::tree::{chosen, plugin_key};
use crate::materials::LIBRARY;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;
use toml_edit::{DocumentMut, InlineTable, Item, Key, Table, TableLike, Value};

/// Keys that replace those of a scene: values by the paths of their keys, both as TOML writes them.
pub type Setting = BTreeMap<String, String>;

/// A setting as the text of a TOML document.
pub(super) fn text(setting: &Setting) -> String {
    setting.iter().map(|(path, value)| format!("{path} = {value}\n")).collect()
}

/// The values of a scene as they are written, by the paths of their keys, by which a value without quotes or unit is read as
/// what it stands for.
#[derive(Debug, Clone)]
pub struct Written(BTreeMap<String, String>);

impl Written {
    /// Those of the scene `text` and of the preset beneath it; `path` names it in errors.
    ///
    /// # Errors
    /// A text that is not TOML, or a key that no scene has.
    pub fn of(text: &str, path: &Path) -> Result<Self, SceneError> {
        let mut keys = BTreeMap::new();
        Merged::new(text, path, "", AS_WRITTEN)?.table.flatten("", &mut keys);
        Ok(Self(keys))
    }

    /// Those of a scene that is read.
    pub fn in_scene(scene: &Scene) -> Self {
        Self(scene.keys.clone())
    }

    /// The text that stands at `key`, in the first table of a list or that which the key chooses; nothing where there is none, or no text.
    pub fn text(&self, key: &str) -> Option<&str> {
        let value = self.places(key).iter().find_map(|place| self.0.get(place))?;
        value.strip_prefix('"')?.strip_suffix('"')
    }

    /// One of these keys that sets nothing, because others set all of its places: the same by another name, or each table of its list.
    pub fn hidden<'k>(&self, keys: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
        let places: Vec<(&str, Vec<String>)> = keys.into_iter().map(|key| (key, self.places(key))).collect();
        let over = |i: usize, own: &[String]| {
            let others = places.iter().enumerate();
            let others = others.filter(move |(j, (_, of))| of.len() < own.len() || (of.len() == own.len() && *j > i));
            others.flat_map(|(_, (_, of))| of).collect::<BTreeSet<_>>()
        };
        let hidden = |(i, (_, own)): &(usize, &(&str, Vec<String>))| {
            let over = over(*i, own);
            !own.is_empty() && own.iter().all(|place| over.contains(place))
        };
        places.iter().enumerate().find(hidden).map(|(_, (key, _))| *key)
    }

    /// Where `key` leads: paths in which each table of a list has its number.
    fn places(&self, key: &str) -> Vec<String> {
        let mut found = Vec::new();
        if let Ok(keys) = Key::parse(key) {
            let keys: Vec<&str> = keys.iter().map(Key::get).collect();
            self.follow(String::new(), &keys, &mut found);
        }
        found
    }

    fn follow(&self, path: String, keys: &[&str], found: &mut Vec<String>) {
        let tables = self.tables(&path);
        if !tables.is_empty() {
            let names: Vec<_> = tables.iter().map(|table| table.get("name").copied()).collect();
            let choice = keys.split_first().filter(|(_, rest)| !rest.is_empty()).and_then(|(key, rest)| {
                let is_key = tables.iter().any(|table| table.contains_key(key));
                Some((chosen(key, &names, is_key)?, rest))
            });
            let (of, keys) = match choice {
                Some((i, rest)) => (i..i + 1, rest),
                None => (0..tables.len(), keys),
            };
            return of.for_each(|i| self.follow(format!("{path}[{i}]"), keys, found));
        }
        match keys {
            [] => found.push(path),
            [key, rest @ ..] if path.is_empty() => self.follow((*key).to_owned(), rest, found),
            [key, rest @ ..] => self.follow(format!("{path}.{key}"), rest, found),
        }
    }

    /// The tables of the list at `path`, the first words of their keys with what stands there.
    fn tables(&self, path: &str) -> Vec<BTreeMap<&str, &str>> {
        let mut tables: Vec<BTreeMap<&str, &str>> = Vec::new();
        for (place, value) in &self.0 {
            let item = place.strip_prefix(path).and_then(|rest| rest.strip_prefix('[')?.split_once("]."));
            let Some((i, key)) = item.and_then(|(i, key)| Some((i.parse::<usize>().ok()?, key))) else { continue };
            tables.resize_with(tables.len().max(i + 1), BTreeMap::new);
            tables[i].insert(key.split(['.', '[']).next().unwrap_or(key), value.trim_matches('"'));
        }
        tables
    }

    /// `value` as TOML writes it at `key`: a text where the scene has one there, and with its unit where it is a number that
    /// has none; else as it is, or as a text where TOML has no such value; a table is one.
    pub fn toml(&self, key: &str, value: &str) -> String {
        let value = value.trim();
        let quoted = |text: &str| Value::from(text).to_string();
        let as_toml = value.parse::<Value>().ok();
        match (self.text(key), &as_toml) {
            (_, Some(Value::String(_) | Value::InlineTable(_))) => value.to_owned(),
            (Some(text), _) => match unit(text).filter(|_| value.parse::<f64>().is_ok()) {
                Some(unit) => quoted(&format!("{value} {unit}")),
                None => quoted(value),
            },
            (None, Some(_)) => value.to_owned(),
            (None, None) => quoted(value),
        }
    }
}

/// The unit of a quantity, `m/s` of `1.56 m/s`.
pub fn unit(quantity: &str) -> Option<&str> {
    let (number, unit) = quantity.trim().split_once(char::is_whitespace)?;
    number.parse::<f64>().ok().map(|_| unit.trim())
}

/// Reads the scene `text`, that of `path`, with `keys` and their values, both as TOML writes them, in the place of its own; the text of
/// what is read has them in it.
///
/// # Errors
/// As [`parse`], and keys that do not fit the text, or that are given twice.
pub fn parse_set(text: &str, path: &Path, keys: &[(String, String)]) -> Result<Scene, SceneError> {
    if keys.is_empty() {
        return parse(text, path);
    }
    let source = Arc::new(SceneSource::new(path, text, LIBRARY));
    let mut setting = Setting::new();
    for (key, value) in keys {
        Key::parse(key).map_err(|_| {
            source.error(format!("`{key}` is no key"), "write it as in `impactor.velocity = ...`: words and points")
        })?;
        if setting.insert(key.clone(), value.clone()).is_some() {
            return Err(source.error(format!("`{key}` is set twice"), "set it once"));
        }
    }
    if let Some(hidden) = Written::of(text, path)?.hidden(setting.keys().map(String::as_str)) {
        return Err(source.error(format!("`{hidden}` sets nothing: other keys set all of its places"), "leave it out"));
    }
    let written = write(text, path, &setting)?.to_string();
    // What is wrong is shown in what is set, and not in a text that nobody wrote.
    parse_with(text, path, &self::text(&setting))?;
    parse(&written, path)
}

/// As [`parse_set`], of values in words: they need neither quotes nor, where the scene has one, a unit.
///
/// # Errors
/// As [`parse_set`].
pub fn parse_words(text: &str, path: &Path, keys: &[(String, String)]) -> Result<Scene, SceneError> {
    if keys.is_empty() {
        return parse(text, path);
    }
    let written = Written::of(text, path)?;
    let keys: Vec<_> = keys.iter().map(|(key, words)| (key.clone(), written.toml(key, words))).collect();
    parse_set(text, path, &keys)
}

/// The text of the scene of `source` with `setting` written into it, and without the accuracy that it asks for, which a setting is to meet.
/// Comments stay; relative names of files are made absolute, so that the scene can lie anywhere.
///
/// # Errors
/// A setting that does not fit its keys.
pub fn rewrite(source: &SceneSource, setting: &Setting) -> Result<String, SceneError> {
    let mut document = write(source.text(), source.path(), setting)?;
    document.remove("accuracy");
    let folder =
        std::path::absolute(source.path()).ok().and_then(|path| path.parent().map(Path::to_owned)).unwrap_or_default();
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

/// The scene `text` with `setting` written into it.
fn write(text: &str, path: &Path, setting: &Setting) -> Result<DocumentMut, SceneError> {
    let source = Arc::new(SceneSource::new(path, text, LIBRARY));
    let wrong = |why: String| source.error(why, "");
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| wrong(e.to_string()))?;
    let mut each = Vec::new();
    for (path, value) in setting {
        each.push((Key::parse(path).map_err(|e| wrong(format!("`{path}` is no path of keys: {e}")))?, path, value));
    }
    // What names a plug-in makes its table anew, what is set of one table of a list goes over what is set of all, and other names
    // change when nothing is called by them any more.
    let renames = |keys: &[Key]| keys.last().is_some_and(|key| key.get() == "name");
    each.sort_by_key(|(keys, ..)| (!names_plugin(keys), renames(keys), keys.len()));
    for (keys, path, value) in each {
        let value: Value = value.parse().map_err(|e: toml_edit::TomlError| wrong(format!("`{path}`: {e}")))?;
        if !set_path(document.as_table_mut(), &keys, &value) {
            let help = "set the whole of it, a table or a list, at once";
            let message = format!(
                "nothing can be set at `{path}`: it leads through a value, or a list of other things than tables"
            );
            return Err(source.error(message, help));
        }
    }
    Ok(document)
}

/// Keys of which a table has one: to set it takes the other away.
const EITHER: [&[&str]; 2] = [&["velocity", "energy", "drop_height"], &["patch_radius", "patch_side", "tip_radius"]];

/// Keys of a place, and those that each of them takes away.
const PLACE: [[&[&str]; 2]; 2] = [[&["x", "y"], &["group"]], [&["group"], &["x", "y"]]];

/// Whether `keys` lead to what names the plug-in of a table, or of one of a list.
fn names_plugin(keys: &[Key]) -> bool {
    let names = |table: &Key, last: &Key| plugin_key(table.get()) == Some(last.get());
    match keys {
        [.., table, choice, last] => names(choice, last) || names(table, last),
        [table, last] => names(table, last),
        _ => false,
    }
}

/// Sets `value` where `keys` lead; whether they lead anywhere.
fn set_path(table: &mut dyn TableLike, keys: &[Key], value: &Value) -> bool {
    match keys {
        [] => false,
        [key] => {
            for others in EITHER.iter().filter(|keys| keys.contains(&key.get())) {
                others.iter().filter(|other| **other != key.get()).for_each(|other| {
                    table.remove(other);
                });
            }
            for other in PLACE.iter().filter(|keys| keys[0].contains(&key.get())).flat_map(|keys| keys[1]) {
                table.remove(other);
            }
            // The latest time is that of a march to the separation.
            if key.get() == "end" && value.as_str() != Some(SEPARATION) {
                table.remove("latest");
            }
            table.insert(key, Item::Value(value.clone()));
            true
        }
        [key, rest @ ..] => {
            // A table that names another plug-in is made anew.
            if let ([last], Some(old)) = (rest, table.get_mut(key))
                && names_plugin(keys)
                && old.get(last.get()).is_some_and(|name| name.as_str() != value.as_str())
            {
                *old = if old.is_table() { Item::Table(Table::new()) } else { Item::Value(InlineTable::new().into()) };
            }
            match table.entry(key).or_insert_with(|| Item::Table(Table::new())) {
                Item::ArrayOfTables(tables) => {
                    set_items(key, tables.iter_mut().map(|table| table as _).collect(), rest, value)
                }
                Item::Value(Value::Array(items)) => {
                    let tables = items.iter_mut().map(|item| item.as_inline_table_mut().map(|table| table as _));
                    tables.collect::<Option<_>>().is_some_and(|tables| set_items(key, tables, rest, value))
                }
                item => item.as_table_like_mut().is_some_and(|table| set_path(table, rest, value)),
            }
        }
    }
}

/// Sets `value` where `keys` lead in the one of these tables of the key `list` that they choose, or else in each; whether they lead anywhere.
fn set_items(list: &Key, mut tables: Vec<&mut dyn TableLike>, keys: &[Key], value: &Value) -> bool {
    // A name chooses where something follows, or a table that is laid over the one of it; a number always.
    let whole = value.as_inline_table();
    let chooses =
        |(key, rest): &(&Key, &[Key])| !rest.is_empty() || whole.is_some() || key.get().parse::<usize>().is_ok();
    let choice = keys.split_first().filter(chooses).and_then(|(key, rest)| {
        let names: Vec<_> = tables.iter().map(|table| table.get("name").and_then(Item::as_str)).collect();
        let is_key = tables.iter().any(|table| table.contains_key(key.get()));
        Some((chosen(key.get(), &names, is_key)?, rest))
    });
    if let Some((i, [])) = choice {
        return whole
            .is_some_and(|whole| whole.iter().all(|(key, value)| set_path(tables[i], &[Key::new(key)], value)));
    }
    let (of, keys) = match choice {
        Some((i, rest)) => (i..i + 1, rest),
        None => (0..tables.len(), keys),
    };
    let set = |table: &mut dyn TableLike| {
        // One that names another plug-in is made anew.
        if let [last] = keys
            && names_plugin(&[list.clone(), last.clone()])
            && table.get(last.get()).is_some_and(|name| name.as_str() != value.as_str())
        {
            table.clear();
        }
        set_path(table, keys, value)
    };
    !of.is_empty() && tables[of].iter_mut().all(|table| set(*table))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::document::source::Origin;

    #[test]
    fn tables_that_are_no_plugins_keep_the_rest() {
        let text = "[[support]]\ngroup = \"a\"\nkind = \"clamped\"\n\n[element]\nkind = \"hex20\"\nmass = \"linear\"\n";
        let mut document: DocumentMut = text.parse().unwrap();
        for (keys, kind) in [("support.kind", "hinged"), ("element.kind", "mitc4")] {
            assert!(set_path(document.as_table_mut(), &Key::parse(keys).unwrap(), &Value::from(kind)));
        }
        let expected = "[[support]]\ngroup = \"a\"\nkind = \"hinged\"\n\n[element]\nkind = \"mitc4\"\n";
        assert_eq!(document.to_string(), expected);
        let source = Arc::new(SceneSource::new(Path::new("scene"), text, LIBRARY));
        let tree = |text: &str| crate::document::tree::Table::parse(text, Origin::Scene, &source).unwrap();
        let mut keys = BTreeMap::new();
        tree("support.kind = \"hinged\"\nelement.kind = \"mitc4\"\n").over(tree(text)).flatten("", &mut keys);
        let found: Vec<_> = keys.keys().map(String::as_str).collect();
        assert_eq!(found, ["element.kind", "support[0].group", "support[0].kind"]);
    }

    #[test]
    fn a_material_keeps_its_constants_under_another_law() {
        let text = "[materials.m]\nlibrary = \"AS4/3502\"\nlaw = \"crack-band\"\n\n[contact]\nlaw = \"hertz\"\nk = 3\n";
        let mut document: DocumentMut = text.parse().unwrap();
        for (keys, law) in [("materials.m.law", "hahn-tsai"), ("contact.law", "linear")] {
            assert!(set_path(document.as_table_mut(), &Key::parse(keys).unwrap(), &Value::from(law)));
        }
        let expected = "[materials.m]\nlibrary = \"AS4/3502\"\nlaw = \"hahn-tsai\"\n\n[contact]\nlaw = \"linear\"\n";
        assert_eq!(document.to_string(), expected);
    }

    /// Its parameters are those that are set beside it, whichever come first.
    #[test]
    fn a_plugin_is_named_before_its_parameters() {
        let text = "[reduction]\nmethod = \"ritz\"\nvectors = 20\n";
        let setting = [("reduction.governors", "3"), ("reduction.method", "\"guyan\"")];
        let setting = setting.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
        let written = write(text, Path::new("scene"), &setting).unwrap().to_string();
        assert_eq!(written, "[reduction]\nmethod = \"guyan\"\ngovernors = 3\n");
    }

    #[test]
    fn another_end_has_no_latest_time() {
        let text = "[march]\nend = \"separation\"\nlatest = \"8 ms\"\n";
        let march = |end: &str| {
            let setting = [("march.end".to_owned(), format!("\"{end}\""))].into();
            write(text, Path::new("scene"), &setting).unwrap().to_string()
        };
        assert_eq!(march("1 ms"), "[march]\nend = \"1 ms\"\n");
        assert_eq!(march("separation"), text);
    }

    #[test]
    fn words_become_what_the_scene_has_there() {
        let keys = [
            ("laminate.plies", "\"[0/90]s\""),
            ("impactor[0].mass", "\"1 kg\""),
            ("impactor[1].mass", "\"1 g\""),
            ("impactor[1].name", "\"splinter\""),
            ("failure.criteria[0]", "\"tsai-wu\""),
            ("mesh.cells[0]", "4"),
        ];
        let written = Written(keys.map(|(key, value)| (key.to_owned(), value.to_owned())).into());
        for (key, words, value) in [
            ("laminate.plies", "[0]", "\"[0]\""),
            ("impactor.mass", "2", "\"2 kg\""),
            ("failure.criteria", "[\"hoffman\"]", "[\"hoffman\"]"),
            ("mesh.cells", "[2, 3]", "[2, 3]"),
            ("contact.law", "hertz", "\"hertz\""),
            ("impactor.2.mass", "2", "\"2 g\""),
            ("impactor.splinter.mass", "2", "\"2 g\""),
            ("impactor.1.mass", "2", "\"2 kg\""),
            ("impactor.3.mass", "2", "2"),
        ] {
            assert_eq!(written.toml(key, words), value);
        }
    }

    /// One that names another plug-in is made anew, and what is called as a key or as others is not chosen by that.
    #[test]
    fn what_a_list_has_is_no_name() {
        let criteria = "[[failure.criteria]]\nname = \"tsai-wu\"\nas = \"a\"\nf12 = 1\n\n[[failure.criteria]]\nname = \"hoffman\"\n";
        let impactors =
            "impactor = [{ name = \"at\", at = { x = 1 } }, { name = \"b\", at = { x = 2 } }, { name = \"b\" }]\n";
        for (scene, key, value, expected) in [
            (
                criteria,
                "failure.criteria.1.name",
                "\"puck\"",
                vec![("failure.criteria[0].name", "\"puck\""), ("failure.criteria[1].name", "\"hoffman\"")],
            ),
            (
                impactors,
                "impactor.at.x",
                "5",
                vec![
                    ("impactor[0].at.x", "5"),
                    ("impactor[0].name", "\"at\""),
                    ("impactor[1].at.x", "5"),
                    ("impactor[1].name", "\"b\""),
                    ("impactor[2].at.x", "5"),
                    ("impactor[2].name", "\"b\""),
                ],
            ),
        ] {
            let source = Arc::new(SceneSource::new(Path::new("scene"), scene, LIBRARY));
            let tree = |text: &str| crate::document::tree::Table::parse(text, Origin::Scene, &source).unwrap();
            let flat = |table: crate::document::tree::Table| {
                let mut keys = BTreeMap::new();
                table.flatten("", &mut keys);
                keys
            };
            let setting: Setting = [(key.to_owned(), value.to_owned())].into();
            let over = flat(tree(&text(&setting)).over(tree(scene)));
            assert_eq!(flat(tree(&write(scene, Path::new("scene"), &setting).unwrap().to_string())), over, "{key}");
            let expected: Vec<_> =
                expected.into_iter().map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
            assert_eq!(over.into_iter().collect::<Vec<_>>(), expected, "{key}");
        }
        // Nothing is done to what is no table.
        let mixed = "[failure]\ncriteria = [\"puck\", { name = \"hoffman\", as = \"a\" }]\n";
        let source = Arc::new(SceneSource::new(Path::new("scene"), mixed, LIBRARY));
        let tree = |text: &str| crate::document::tree::Table::parse(text, Origin::Scene, &source).unwrap();
        let mut keys = BTreeMap::new();
        tree("failure.criteria.2.as = \"b\"\n").over(tree(mixed)).flatten("", &mut keys);
        assert_eq!((&*keys["failure.criteria[0]"], &*keys["failure.criteria[1].as"]), ("\"puck\"", "\"b\""));
    }

    #[test]
    fn what_others_set_is_hidden() {
        let written = Written(
            [("impactor[0].mass", "\"1 kg\""), ("impactor[1].mass", "\"1 g\""), ("impactor[1].name", "\"splinter\"")]
                .map(|(key, value)| (key.to_owned(), value.to_owned()))
                .into(),
        );
        for (keys, hidden) in [
            (["impactor.2.mass", "impactor.splinter.mass"].as_slice(), Some("impactor.2.mass")),
            (&["impactor.1.mass", "impactor.2.mass", "impactor.mass"], Some("impactor.mass")),
            (&["impactor.1.mass", "impactor.mass"], None),
            (&["impactor.1.mass", "impactor.2.mass"], None),
            (&["impactor.1.mass", "impactor.1.velocity", "march.step"], None),
        ] {
            assert_eq!(written.hidden(keys.iter().copied()), hidden, "{keys:?}");
        }
    }

    /// One table of a list is set by its number or its name, whichever way the list is written and the setting is laid over it.
    #[test]
    fn a_table_of_a_list_is_chosen() {
        let tables = "[[impactor]]\nmass = 1\n\n[[impactor]]\nname = \"splinter\"\nmass = 2\n";
        let inline = "impactor = [{ mass = 1 }, { name = \"splinter\", mass = 2 }]\n";
        let source = Arc::new(SceneSource::new(Path::new("scene"), tables, LIBRARY));
        let tree = |text: &str| crate::document::tree::Table::parse(text, Origin::Scene, &source).unwrap();
        let flat = |table: crate::document::tree::Table| {
            let mut keys = BTreeMap::new();
            table.flatten("", &mut keys);
            ["impactor[0].mass", "impactor[1].mass", "impactor[1].name"]
                .map(|key| keys.get(key).cloned().unwrap_or_default())
        };
        for (setting, masses) in [
            ([("impactor.2.mass", "5")].as_slice(), ["1", "5"]),
            (&[("impactor.splinter.mass", "5")], ["1", "5"]),
            (&[("impactor.1.mass", "5"), ("impactor.mass", "6")], ["5", "6"]),
            (&[("impactor.1.mass", "5"), ("impactor.splinter.mass", "6")], ["5", "6"]),
            (&[("impactor.1", "{ mass = 5 }"), ("impactor.splinter", "{ mass = 6 }")], ["5", "6"]),
        ] {
            let setting: Setting = setting.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
            for scene in [tables, inline] {
                let over = flat(tree(&text(&setting)).over(tree(scene)));
                let written = flat(tree(&write(scene, Path::new("scene"), &setting).unwrap().to_string()));
                assert_eq!(over, [masses[0], masses[1], "\"splinter\""], "{setting:?} {scene}");
                assert_eq!(written, over, "{setting:?} {scene}");
            }
        }
    }

    #[test]
    fn a_setting_goes_into_the_text() {
        let folder = std::env::temp_dir();
        let path = folder.join("scene.toml");
        let scene = "# What it is.\nmesh = { file = \"plate.msh\", unit = \"mm\" }\n\n[[impactor]]\nmass = \"1 kg\" # heavy\n\n\
                     [reduction]\nmethod = \"guyan\"\ngovernors = 3\n\n[materials.m]\nfile = \"m.toml\"\n";
        let setting = [
            ("mesh.refine", "1"),
            ("impactor.patch_radius", "\"2 mm\""),
            ("reduction.method", "\"ritz\""),
            ("reduction.vectors", "20"),
            ("march.step", "\"0.1 us\""),
        ];
        let setting = setting.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
        let text = rewrite(&SceneSource::new(&path, scene, LIBRARY), &setting).unwrap();
        let root = folder.display();
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
    fn values_are_read_as_what_stands_there() {
        let text = "title = \"t\"\nlaminate = { plies = \"[0]\", layers = [1] }\nimpactor = { velocity = \"2 m/s\" }\n";
        let written = Written::of(text, "scene.toml".as_ref()).unwrap();
        let cases = [
            ("impactor.velocity", "3", "\"3 m/s\""),
            ("impactor.velocity", "3 mm/s", "\"3 mm/s\""),
            ("impactor.velocity", "'3 mm/s'", "'3 mm/s'"),
            ("laminate.plies", "[90]", "\"[90]\""),
            ("title", "{ name = 'x' }", "{ name = 'x' }"),
            ("laminate.layers", "[2]", "[2]"),
            // Of the preset.
            ("impactor.patch_radius", "2.5", "\"2.5 mm\""),
            ("reduction.vectors", "20", "20"),
            ("effects.membrane", "on", "\"on\""),
        ];
        for (key, value, toml) in cases {
            assert_eq!(written.toml(key, value), toml, "{key}");
        }
    }

    #[test]
    fn a_setting_that_leads_nowhere_is_refused() {
        let text = "title = \"t\"\naccuracy = 0.01\nmesh.cells = [2, 3]\nimpactor = [{ mass = \"1 kg\" }]\n";
        let set = |key: &str, value: &str| {
            let setting = [(key.to_owned(), value.to_owned())].into();
            write(text, Path::new("scene.toml"), &setting).map(|document| document.to_string())
        };
        assert!(set("title", "\"other\"").unwrap().starts_with("title = \"other\"\naccuracy = 0.01\n"));
        assert!(set("impactor.mass", "\"2 kg\"").unwrap().ends_with("impactor = [{ mass = \"2 kg\" }]\n"));
        let nowhere =
            [("title.short", "1"), ("mesh.cells.x", "4"), ("impactor.1", "4"), ("a..b", "1"), ("title", "1 kg")];
        for (key, value) in nowhere {
            let why = set(key, value).unwrap_err().to_string();
            assert!(why.contains(&format!("`{key}`")), "{why}");
        }
    }
}
