//! A TOML document with the place of every key and value, and the laying of one over another.

use super::source::{Origin, Place, SceneError, SceneSource};
use std::collections::BTreeMap;
use std::sync::Arc;
use toml::de::{DeTable, DeValue};

/// A value and its place.
#[derive(Debug, Clone)]
pub(crate) struct Item {
    pub(crate) node: Node,
    pub(crate) place: Place,
}

#[derive(Debug, Clone)]
pub(crate) enum Node {
    Text(String),
    /// Integer or not; a number beyond the range of `f64` is infinite.
    Number(f64),
    Flag(bool),
    List(Vec<Item>),
    Table(Table),
    Date,
}

impl Node {
    /// What it is, in words.
    pub(crate) fn describe(&self) -> String {
        match self {
            Self::Text(text) => format!("the text \"{text}\""),
            Self::Number(value) => format!("the number {value}"),
            Self::Flag(flag) => flag.to_string(),
            Self::List(_) => "a list".to_owned(),
            Self::Table(_) => "a table".to_owned(),
            Self::Date => "a date".to_owned(),
        }
    }
}

impl Node {
    pub(crate) fn table(&self) -> Option<&Table> {
        match self {
            Self::Table(table) => Some(table),
            _ => None,
        }
    }

    pub(crate) fn table_mut(&mut self) -> Option<&mut Table> {
        match self {
            Self::Table(table) => Some(table),
            _ => None,
        }
    }

    /// As JSON; nothing for a date, which no key of a scene takes.
    pub(crate) fn to_json(&self) -> serde_json::Value {
        match self {
            Self::Text(text) => text.as_str().into(),
            Self::Number(value) if value.fract() == 0.0 && value.abs() < 1e15 => (*value as i64).into(),
            Self::Number(value) => (*value).into(),
            Self::Flag(flag) => (*flag).into(),
            Self::List(items) => items.iter().map(|item| item.node.to_json()).collect(),
            Self::Table(Table(entries)) => {
                serde_json::Value::Object(entries.iter().map(|e| (e.key.clone(), e.item.node.to_json())).collect())
            }
            Self::Date => serde_json::Value::Null,
        }
    }

    /// As a value in a line of TOML; `None` for a date, which no key of a scene takes.
    pub(crate) fn to_toml(&self) -> Option<toml_edit::Value> {
        Some(match self {
            Self::Text(text) => text.as_str().into(),
            Self::Number(value) if value.fract() == 0.0 && value.abs() < 1e15 => (*value as i64).into(),
            Self::Number(value) => (*value).into(),
            Self::Flag(flag) => (*flag).into(),
            Self::List(items) => {
                let items = items.iter().map(|item| item.node.to_toml());
                toml_edit::Value::Array(items.collect::<Option<toml_edit::Array>>()?)
            }
            Self::Table(Table(entries)) => {
                let entries = entries.iter().map(|e| Some((e.key.as_str(), e.item.node.to_toml()?)));
                toml_edit::Value::InlineTable(entries.collect::<Option<toml_edit::InlineTable>>()?)
            }
            Self::Date => return None,
        })
    }

    fn flatten(&self, path: String, into: &mut BTreeMap<String, String>) {
        let text = match self {
            Self::Table(table) => return table.flatten(&path, into),
            Self::List(items) => {
                let each = items.iter().enumerate();
                return each.for_each(|(i, item)| item.node.flatten(format!("{path}[{i}]"), into));
            }
            Self::Text(text) => format!("\"{text}\""),
            Self::Number(value) => value.to_string(),
            Self::Flag(flag) => flag.to_string(),
            Self::Date => self.describe(),
        };
        into.insert(path, text);
    }
}

/// Entries in the order of the text.
#[derive(Debug, Clone, Default)]
pub(crate) struct Table(pub(crate) Vec<Entry>);

#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) place: Place,
    pub(crate) item: Item,
}

impl Table {
    pub(crate) fn parse(text: &str, origin: Origin, source: &Arc<SceneSource>) -> Result<Self, SceneError> {
        let document = DeTable::parse(text).map_err(|e| {
            let place = Place { origin, span: e.span().unwrap_or(0..0) };
            let help = "write key = value, texts in double quotes, each key once";
            source.error_at(&place, format!("this is not valid TOML: {}", e.message()), help)
        })?;
        Ok(table(document.into_inner(), origin))
    }

    pub(crate) fn get(&self, key: &str) -> Option<&Entry> {
        self.0.iter().find(|e| e.key == key)
    }

    /// Lays `self` over `under`: tables merge key by key, each table of a list with the one table above or beneath it, or with that part
    /// of the one above that [chooses](chosen) it; any other value replaces what lies beneath. A table that names another plug-in than
    /// the one beneath replaces it, because its parameters mean nothing to the new one.
    pub(crate) fn over(mut self, under: Table) -> Table {
        for below in under.0 {
            let Some(above) = self.0.iter_mut().find(|e| e.key == below.key) else {
                self.0.push(below);
                continue;
            };
            match (&mut above.item.node, below.item.node) {
                (Node::Table(over), Node::Table(under)) => over.merge(under, &below.key),
                (Node::List(items), Node::Table(under)) => {
                    let tables = items.iter_mut().filter_map(|item| item.node.table_mut());
                    tables.for_each(|over| over.merge(under.clone(), &below.key));
                }
                (Node::Table(over), Node::List(mut items)) if !items.is_empty() => {
                    let all = std::mem::take(over);
                    let tables: Vec<_> = items.iter().map(|item| item.node.table().cloned()).collect();
                    for (i, item) in items.iter_mut().enumerate() {
                        let mut over = all.of_item(i, &tables);
                        match item.node.table_mut() {
                            Some(under) => over.merge(std::mem::take(under), &below.key),
                            None if over.0.is_empty() => continue,
                            None => {}
                        }
                        item.node = Node::Table(over);
                    }
                    above.item.node = Node::List(items);
                }
                _ => {}
            }
        }
        self
    }

    /// What of a table that lies over a list lies over the `i`th of its `tables`: what it has for that one, over what it has for all.
    fn of_item(&self, i: usize, tables: &[Option<Table>]) -> Table {
        let names: Vec<_> = tables.iter().map(|table| table.as_ref().and_then(Table::name)).collect();
        let (mut own, mut all) = (Table::default(), Table::default());
        for entry in &self.0 {
            let is_key = tables.iter().flatten().any(|table| table.get(&entry.key).is_some());
            match entry.item.node.table().zip(chosen(&entry.key, &names, is_key)) {
                Some((table, k)) if k == i => own = table.clone().over(own),
                Some(_) => {}
                None => all.0.push(entry.clone()),
            }
        }
        own.over(all)
    }

    /// What it says that it is called.
    fn name(&self) -> Option<&str> {
        match &self.get("name")?.item.node {
            Node::Text(name) => Some(name),
            _ => None,
        }
    }

    /// As [`Table::over`], of tables of this key.
    fn merge(&mut self, under: Table, key: &str) {
        if !self.names_another_plugin(&under, key) {
            *self = std::mem::take(self).over(under);
        }
    }

    /// Every value below the key `path` (empty at the top) by its own path, `failure.watch[0].ply`, as text.
    pub(crate) fn flatten(&self, path: &str, into: &mut BTreeMap<String, String>) {
        for Entry { key, item, .. } in &self.0 {
            item.node.flatten(if path.is_empty() { key.clone() } else { format!("{path}.{key}") }, into);
        }
    }

    /// Its values by the paths of their keys, both TOML.
    pub(crate) fn setting(&self) -> Option<BTreeMap<String, String>> {
        let mut setting = BTreeMap::new();
        for Entry { key, item, .. } in &self.0 {
            let key = toml_edit::Key::new(key.as_str()).to_string();
            match &item.node {
                Node::Table(table) => {
                    setting.extend(table.setting()?.into_iter().map(|(path, value)| (format!("{key}.{path}"), value)));
                }
                node => {
                    setting.insert(key, node.to_toml()?.to_string());
                }
            }
        }
        Some(setting)
    }

    fn names_another_plugin(&self, other: &Table, key: &str) -> bool {
        plugin_key(key).is_some_and(|name| match (self.get(name), other.get(name)) {
            (Some(a), Some(b)) => matches!((&a.item.node, &b.item.node), (Node::Text(a), Node::Text(b)) if a != b),
            _ => false,
        })
    }
}

/// Which of the tables of a list `key` chooses: by its number, from 1 on, or by a name that is its own and no key of theirs.
pub(crate) fn chosen(key: &str, names: &[Option<&str>], is_key: bool) -> Option<usize> {
    if let Ok(number) = key.parse::<usize>() {
        return number.checked_sub(1).filter(|i| *i < names.len());
    }
    let mut called = (0..names.len()).filter(|i| names[*i] == Some(key));
    called.next().filter(|_| called.next().is_none() && !is_key)
}

/// The key by which tables of key `table` name the plug-in whose parameters they hold.
pub(crate) fn plugin_key(table: &str) -> Option<&'static str> {
    match table {
        "element" => Some("kind"),
        "contact" | "delamination" => Some("law"),
        "reduction" => Some("method"),
        "criteria" | "integrator" | "law" => Some("name"),
        _ => None,
    }
}

fn table(entries: DeTable<'_>, origin: Origin) -> Table {
    let entry = |(key, value): (toml::Spanned<_>, toml::Spanned<_>)| {
        let place = Place { origin, span: key.span() };
        let item = Item { place: Place { origin, span: value.span() }, node: node(value.into_inner(), origin) };
        Entry { key: std::borrow::Cow::into_owned(key.into_inner()), place, item }
    };
    Table(entries.into_iter().map(entry).collect())
}

fn node(value: DeValue<'_>, origin: Origin) -> Node {
    match value {
        DeValue::String(text) => Node::Text(text.into_owned()),
        DeValue::Integer(i) => {
            Node::Number(i128::from_str_radix(i.as_str(), i.radix()).map_or(f64::INFINITY, |i| i as f64))
        }
        DeValue::Float(f) => Node::Number(f.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(flag) => Node::Flag(flag),
        DeValue::Datetime(_) => Node::Date,
        DeValue::Array(items) => Node::List(
            items
                .into_iter()
                .map(|v| Item { place: Place { origin, span: v.span() }, node: node(v.into_inner(), origin) })
                .collect(),
        ),
        DeValue::Table(entries) => Node::Table(table(entries, origin)),
    }
}
