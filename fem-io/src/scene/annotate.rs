//! A scene with every key it may have: those that it gives, the others commented out, each with what it means.

use super::root::KEYS;
use super::{Fidelity, effects, list_unused_keys, schema};
use crate::document::keys::{Absent, Form, Key, Plugins};
use crate::document::source::{Origin, SceneError, SceneSource};
use crate::document::tree::{Node, Table};
use crate::materials::LIBRARY;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

/// The scene `text` with comments: what every key means, and, commented out, those that it leaves out, with the values
/// that hold without them or with an example. Parameters of plug-ins are looked up in `plugins`, keys of effects are `effects`.
///
/// # Errors
/// As [`super::parse`].
pub fn annotate(text: &str, plugins: Plugins<'_>, effects: &[Key]) -> Result<String, SceneError> {
    super::parse(text, Path::new("scene.toml"))?;
    let source = Arc::new(SceneSource::new(Path::new("scene.toml"), text, LIBRARY));
    let own = Table::parse(text, Origin::Scene, &source)?;
    let word = |key: &str| match own.get(key).map(|entry| &entry.item.node) {
        Some(Node::Text(text)) => Some(text.as_str()),
        _ => None,
    };
    let named = Fidelity::ALL.iter().find(|(name, _)| Some(*name) == word("fidelity"));
    let preset = schema::parsed(named.map_or(Fidelity::Engineering, |(_, fidelity)| *fidelity).preset());
    let unused = list_unused_keys(word("analysis").unwrap_or("impact"));
    let keys = || KEYS.iter().filter(|key| !unused.contains(&key.name));
    let mut writer = Writer { plugins, effects, text: String::new() };
    let (sections, lines): (Vec<&Key>, Vec<&Key>) = keys().partition(|key| is_section(key, &own));
    lines.iter().for_each(|key| writer.write_key(key, &own, Some(&preset)));
    for key in sections {
        let node = own.get(key.name).map(|entry| &entry.item.node);
        let below = preset.get(key.name).and_then(|entry| entry.item.node.table());
        writer.write_sections(key, node, below);
    }
    Ok(writer.text)
}

/// Whether a key is written as a table of its own.
fn is_section(key: &Key, own: &Table) -> bool {
    match (own.get(key.name).map(|entry| &entry.item.node), &key.form) {
        (Some(Node::Table(_)), _) => true,
        (Some(Node::List(items)), _) => items.iter().all(|item| item.node.table().is_some()),
        // What a preset gives, or what may be left empty, is shown as a table; else an example in one line.
        (None, Form::Table(_) | Form::Effects) => key.absent == Absent::Default("{}"),
        (None, Form::Plugin(..)) => ["element", "reduction"].contains(&key.name),
        _ => false,
    }
}

struct Writer<'a> {
    plugins: Plugins<'a>,
    effects: &'a [Key],
    text: String,
}

impl Writer<'_> {
    fn write_line(&mut self, line: std::fmt::Arguments<'_>) {
        let _ = self.text.write_fmt(line);
        self.text.push('\n');
    }

    /// A key with what it means; commented out where `own` leaves it out.
    fn write_key(&mut self, key: &Key, own: &Table, preset: Option<&Table>) {
        let about = match key.form {
            Form::Words(words) if words.len() > 1 => format!("{}: {}", key.about, words.join(", ")),
            _ => key.about.to_owned(),
        };
        let otherwise = match key.absent {
            Absent::Default(value) if value != "{}" => value,
            _ => key.example,
        };
        self.entry((key.name, &about, otherwise), own, preset);
    }

    /// Name, meaning, and the value that is shown where nobody gives one.
    fn entry(&mut self, (name, about, otherwise): (&str, &str, &str), own: &Table, preset: Option<&Table>) {
        let given = |table: &Table| Some(table.get(name)?.item.node.to_toml()?.to_string());
        self.write_line(format_args!("# {about}"));
        match (given(own), preset.and_then(given)) {
            (Some(value), _) => self.write_line(format_args!("{name} = {}", value.trim())),
            (None, Some(value)) => self.write_line(format_args!("#{name} = {}", value.trim())),
            (None, None) => self.write_line(format_args!("#{name} = {otherwise}")),
        }
    }

    /// The table or the list of tables under a key.
    fn write_sections(&mut self, key: &Key, node: Option<&Node>, preset: Option<&Table>) {
        self.write_line(format_args!("\n# {}", key.about));
        match (&key.form, node) {
            (Form::Named(form), Some(Node::Table(table))) => {
                for (number, entry) in table.0.iter().enumerate() {
                    let gap = if number == 0 { "" } else { "\n" };
                    let name = toml_edit::Key::new(&*entry.key);
                    self.write_line(format_args!("{gap}[{}.{name}]", key.name));
                    self.write_table(form, &entry.item.node, None, number == 0);
                }
            }
            (form, Some(Node::List(items))) => {
                let form = match form {
                    Form::OneOf(forms) => forms.last().unwrap_or(form),
                    form => form,
                };
                let Form::List(each) = form else { return };
                for (number, item) in items.iter().enumerate() {
                    self.write_line(format_args!("{}[[{}]]", if number == 0 { "" } else { "\n" }, key.name));
                    self.write_table(each, &item.node, preset, number == 0);
                }
            }
            (form, node) => {
                self.write_line(format_args!("[{}]", key.name));
                self.write_table(form, node.unwrap_or(&Node::Table(Table::default())), preset, true);
            }
        }
    }

    /// The keys of a table; those that it leaves out where it is `whole`.
    fn write_table(&mut self, form: &Form, node: &Node, preset: Option<&Table>, whole: bool) {
        let Node::Table(own) = node else { return };
        let meant = form.form_of(node);
        if let (Form::OneOf(forms), true) = (form, whole) {
            for keys in forms.iter().filter(|other| !std::ptr::eq(*other, meant)).filter_map(Form::keys) {
                let names: Vec<_> = keys.iter().map(|key| key.name).collect();
                self.write_line(format_args!("# or, of another kind, with the keys {}", names.join(", ")));
            }
        }
        let shown = |key: &&Key| whole || own.get(key.name).is_some();
        match meant {
            Form::Table(keys) => keys.iter().filter(shown).for_each(|key| self.write_key(key, own, preset)),
            Form::Effects => {
                let all = effects::KEYS.iter().chain(self.effects);
                all.filter(shown).for_each(|key| self.write_key(key, own, preset));
            }
            Form::Plugin(kind, name, others) => {
                let plugins = (self.plugins)(*kind);
                let called = [Some(own), preset].into_iter().flatten().find_map(|table| table.get(name));
                let plugin = plugins.iter().find(|plugin| match called.map(|entry| &entry.item.node) {
                    Some(Node::Text(text)) => text == plugin.name,
                    _ => false,
                });
                let Some(plugin) = plugin else { return };
                // Parameters of the preset belong to the plug-in that it names.
                let preset = preset.filter(|_| called.is_some() && own.get(name).is_none());
                self.entry((name, plugin.summary, ""), own, preset);
                for row in plugin.params {
                    let default = row.default_value().map_or("...".to_owned(), |value| value.in_scene());
                    self.entry((row.name, &row.to_string(), &default), own, preset);
                }
                others.iter().filter(shown).for_each(|key| self.write_key(key, own, preset));
            }
            _ => {}
        }
    }
}
