//! Every key that holds in a scene: its value, where that comes from, and what it means.

use super::root::KEYS;
use super::{AS_WRITTEN, Merged, effects, list_unused_keys, material, run};
use crate::document::keys::{Absent, Form, Key, Keys, Plugins};
use crate::document::reader::Reader;
use crate::document::source::{Origin, Place, SceneError, SceneSource};
use crate::document::tree::{Item, Node, Table};
use crate::materials::constants;
use fem_core::plugin::Kind;
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;

/// A key that holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Explained {
    /// Its path, `laminate.plies` or `support[0].at`.
    pub key: String,
    /// Its value in TOML.
    pub value: String,
    /// Where the value comes from: `line 12`, a preset, a library, or `default`.
    pub from: String,
    /// What it means.
    pub about: String,
}

/// The keys that hold in the scene that has been read from `source`, in the order of the tables of a scene, with the parameters of
/// `plugins` and the keys of `effects`.
///
/// # Errors
/// As [`super::parse`].
pub fn explain(source: &SceneSource, plugins: Plugins<'_>, effects: &[Key]) -> Result<Vec<Explained>, SceneError> {
    let path = Path::new(source.name());
    let Merged { mut table, source, .. } = Merged::new(source.text(), path, "", AS_WRITTEN)?;
    let analysis = match table.get("analysis").map(|entry| &entry.item.node) {
        Some(Node::Text(text)) => text.clone(),
        _ => "impact".to_owned(),
    };
    table.0.retain(|entry| !list_unused_keys(&analysis).contains(&entry.key.as_str()));
    for entry in table.0.iter_mut().filter(|entry| entry.key == "impactor") {
        match &mut entry.item.node {
            Node::List(items) => items.iter_mut().filter_map(|item| item.node.table_mut()).for_each(keep_one_load),
            node => node.table_mut().into_iter().for_each(keep_one_load),
        }
    }
    let mut walk = Walk { plugins, effects, source: Arc::clone(&source), found: Vec::new() };
    for key in KEYS.iter().filter(|key| !list_unused_keys(&analysis).contains(&key.name)) {
        if key.name == "materials" {
            let materials = Reader::root(&table, KEYS, &source)?.required("materials")?;
            for (name, field) in materials.entries()? {
                let whole = material::whole(&field, path.parent().unwrap_or(Path::new("")))?;
                let (constants, texts) = match whole {
                    Some(whole) => whole,
                    None => (field.any_table()?.clone(), Arc::clone(&source)),
                };
                walk.source = texts;
                walk.table(constants::KEYS, &constants, &format!("materials.{name}"));
            }
            walk.source = Arc::clone(&source);
        } else {
            walk.table(std::slice::from_ref(key), &table, "");
        }
    }
    Ok(walk.found)
}

struct Walk<'a> {
    plugins: Plugins<'a>,
    effects: &'a [Key],
    source: Arc<SceneSource>,
    found: Vec<Explained>,
}

impl Walk<'_> {
    fn table(&mut self, keys: &[Key], table: &Table, path: &str) {
        for key in keys {
            let path = if path.is_empty() { key.name.to_owned() } else { format!("{path}.{}", key.name) };
            match (table.get(key.name), key.absent, &key.form) {
                (Some(entry), ..) => self.value(&key.form, &entry.item, &path, key.about),
                // A table of which nothing is said holds defaults.
                (None, Absent::Default("{}"), Form::Table(keys)) => self.table(keys, &Table::default(), &path),
                (None, Absent::Default("{}"), Form::Effects) => self.effects(&Table::default(), &path),
                (None, Absent::Default(value), _) => self.add(path, value.to_owned(), "default", key.about),
                (None, Absent::Nothing | Absent::Refused, _) => {}
            }
        }
    }

    fn effects(&mut self, table: &Table, path: &str) {
        self.table(effects::KEYS, table, path);
        self.table(self.effects, table, path);
    }

    fn value(&mut self, form: &Form, item: &Item, path: &str, about: &str) {
        match (form.form_of(&item.node), &item.node) {
            (Form::Table(keys), Node::Table(table)) => self.table(keys, table, path),
            (Form::Effects, Node::Table(table)) => self.effects(table, path),
            (Form::Named(form), Node::Table(table)) => {
                table.0.iter().for_each(|e| self.value(form, &e.item, &format!("{path}.{}", e.key), about));
            }
            (Form::Plugin(kind, name, others), Node::Table(table)) => {
                self.plugin((*kind, name, others), table, path, about);
            }
            (Form::List(form), Node::List(items)) if items.iter().any(|item| item.node.table().is_some()) => {
                let each = items.iter().enumerate();
                each.for_each(|(i, item)| self.value(form, item, &format!("{path}[{i}]"), about));
            }
            (_, node) => {
                let from = self.origin(&item.place);
                let value = node.to_toml().map_or(String::new(), |value| value.to_string());
                self.add(path.to_owned(), value, &from, about);
            }
        }
    }

    fn plugin(&mut self, (kind, name, others): (Kind, &str, Keys), table: &Table, path: &str, about: &str) {
        let named = table.get(name).map(|entry| &entry.item);
        let plugin = named.and_then(|item| match &item.node {
            Node::Text(text) => (self.plugins)(kind).into_iter().find(|plugin| plugin.name == text),
            _ => None,
        });
        let about = plugin.map_or(about, |plugin| plugin.summary);
        named.into_iter().for_each(|item| self.value(&Form::Text, item, &format!("{path}.{name}"), about));
        for param in plugin.into_iter().flat_map(|plugin| plugin.params) {
            let path = format!("{path}.{}", param.name);
            match (table.get(param.name), param.default_value()) {
                (Some(entry), _) => self.value(&Form::Text, &entry.item, &path, param.about),
                (None, Some(value)) => self.add(path, value.in_scene(), "default", param.about),
                (None, None) => {}
            }
        }
        self.table(others, table, path);
    }

    fn add(&mut self, key: String, value: String, from: &str, about: &str) {
        self.found.push(Explained { key, value, from: from.to_owned(), about: about.to_owned() });
    }

    fn origin(&self, place: &Place) -> String {
        match (place.origin, self.source.line(place)) {
            (Origin::Scene, Some((_, line))) => format!("line {line}"),
            (_, Some((name, _))) => name.to_owned(),
            (_, None) => String::new(),
        }
    }
}

/// Leaves an impactor one way in which its force enters the plate: that of the text that counts more.
fn keep_one_load(impactor: &mut Table) {
    let is_load = |key: &str| run::LOADS.contains(&key);
    let counts = impactor.0.iter().filter(|e| is_load(&e.key)).map(|e| e.item.place.origin).max();
    impactor.0.retain(|e| !is_load(&e.key) || Some(e.item.place.origin) == counts);
}
