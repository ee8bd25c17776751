//! One word per thing: no two public types of the workspace share a name.

use crate::support::root;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Product sources of all crates; tests lie in folders and files of that name.
fn sources() -> Vec<PathBuf> {
    let crates = ["", "fem-core", "fem-elements", "fem-dynamics", "fem-failure", "fem-io"];
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> = crates.iter().map(|name| root().join(name).join("src")).collect();
    while let Some(folder) = folders.pop() {
        for entry in folder.read_dir().unwrap() {
            let path = entry.unwrap().path();
            match path.file_stem().and_then(|stem| stem.to_str()) {
                Some("tests") => {}
                _ if path.is_dir() => folders.push(path),
                _ if path.extension().is_some_and(|ending| ending == "rs") => found.push(path),
                _ => {}
            }
        }
    }
    assert!(found.len() > 200, "{} sources below {}", found.len(), root().display());
    found
}

/// Names of the public types that a source defines, up to its tests.
fn public_types(text: &str) -> impl Iterator<Item = &str> {
    let product = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    product.lines().filter_map(|line| {
        let definition = line.trim_start().strip_prefix("pub ")?;
        let (kind, rest) = definition.split_once(' ')?;
        let name = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next()?;
        (["struct", "enum", "trait", "type", "union"].contains(&kind) && !name.is_empty()).then_some(name)
    })
}

/// Every name that has more than one definition, with the files.
fn repeated<'a>(sources: impl Iterator<Item = (&'a Path, String)>) -> Vec<String> {
    let mut all: BTreeMap<String, Vec<&Path>> = BTreeMap::new();
    for (path, text) in sources {
        for name in public_types(&text) {
            all.entry(name.to_owned()).or_default().push(path);
        }
    }
    all.retain(|_, files| files.len() > 1);
    all.into_iter().map(|(name, files)| format!("{name}: {files:?}")).collect()
}

#[test]
fn no_two_public_types_share_a_name() {
    let sources = sources();
    let found = repeated(sources.iter().map(|path| (path.as_path(), std::fs::read_to_string(path).unwrap())));
    assert!(found.is_empty(), "rename the lesser one by what it means:\n{}", found.join("\n"));
}

#[test]
fn a_name_used_twice_is_found() {
    let text = "pub struct Plate;\n    pub enum Kind<'a> {}\npub(crate) struct Own;\npub fn plate() {}\n\
                #[cfg(test)]\nmod tests {\n    pub struct Case;\n}\n";
    assert_eq!(public_types(text).collect::<Vec<_>>(), ["Plate", "Kind"]);
    let files = [("a.rs", text), ("b.rs", "pub type Kind = u8;\npub struct Case;\npub struct Own;")];
    let found = repeated(files.into_iter().map(|(name, text)| (Path::new(name), text.to_owned())));
    assert_eq!(found, ["Kind: [\"a.rs\", \"b.rs\"]"]);
}
