//! Typed reading of a table: every wrong value becomes an error at its place.

use super::keys::{Form, Key, Keys};
use super::source::{Located, Origin, Place, SceneError, SceneSource};
use super::tree::{Item, Node, Table};
use crate::units::{self, UnitError};
use fem_core::plugin::{Dimension, unknown_key};
use std::sync::Arc;

/// A table whose keys are all known.
pub struct Reader<'a> {
    table: &'a Table,
    path: String,
    place: Place,
    keys: Vec<&'static Key>,
    source: &'a Arc<SceneSource>,
}

impl<'a> Reader<'a> {
    /// The outermost table of a document.
    pub(crate) fn root(table: &'a Table, keys: Keys, source: &'a Arc<SceneSource>) -> Result<Self, SceneError> {
        Self::unchecked(table, keys, source).checked()
    }

    /// The same, whatever keys it has.
    pub(crate) fn unchecked(table: &'a Table, keys: Keys, source: &'a Arc<SceneSource>) -> Self {
        Self { table, path: String::new(), place: Place::TOP, keys: keys.iter().collect(), source }
    }

    /// Refuses unknown keys first of all: a misspelt key explains a missing one.
    fn checked(self) -> Result<Self, SceneError> {
        let stray = self.strays().next();
        stray.map_or(Ok(self), Err)
    }

    /// An error for each key that the table does not know.
    pub(crate) fn strays(&self) -> impl Iterator<Item = SceneError> {
        let stray = self.table.0.iter().filter(|e| self.keys.iter().all(|key| key.name != e.key));
        stray.map(|stray| {
            let path = self.path_of(&stray.key);
            let help = format!("`{}` {}", stray.key, unknown_key(&stray.key, self.keys.iter().map(|key| key.name)));
            self.source.error_at(&stray.place, format!("unknown key `{path}`"), help)
        })
    }

    /// The keys that the table may have.
    pub(crate) fn keys(&self) -> impl Iterator<Item = &'static Key> {
        self.keys.iter().copied()
    }

    fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    fn example(&self, key: &str) -> &'static str {
        self.keys.iter().find(|known| known.name == key).map_or("", |known| known.example)
    }

    /// The value of `key`, where the table has it.
    pub fn optional(&self, key: &str) -> Option<SceneValue<'a>> {
        let entry = self.table.get(key)?;
        let (path, example) = (self.path_of(key), self.example(key));
        Some(SceneValue::new(&entry.item, &entry.place, path, example, self.source))
    }

    /// The value of `key`.
    ///
    /// # Errors
    /// The table lacks it.
    pub fn required(&self, key: &str) -> Result<SceneValue<'a>, SceneError> {
        let example = || format!("write, for example: {} = {}", self.path_of(key), self.example(key));
        self.optional(key).ok_or_else(|| self.missing(key, example()))
    }

    pub(crate) fn missing(&self, key: &str, help: impl Into<String>) -> SceneError {
        self.error(format!("`{}` is missing", self.path_of(key)), help)
    }

    /// Another table in the place of this one, with the texts that its entries stand in.
    pub(crate) fn of<'b>(
        &self,
        table: &'b Table,
        keys: Keys,
        source: &'b Arc<SceneSource>,
    ) -> Result<Reader<'b>, SceneError> {
        Reader { table, path: self.path.clone(), place: self.place.clone(), keys: keys.iter().collect(), source }
            .checked()
    }

    /// Keys that exclude each other: at most one of them remains, that of the text which counts most.
    ///
    /// # Errors
    /// Two of them in that text.
    pub fn either<const N: usize>(&self, keys: [&str; N]) -> Result<[Option<SceneValue<'a>>; N], SceneError> {
        let mut found = keys.map(|key| self.optional(key));
        let strongest = found.iter().flatten().map(|value| value.place().origin).max();
        for value in &mut found {
            value.take_if(|value| Some(value.place().origin) != strongest);
        }
        let mut given = keys.iter().zip(&found).filter_map(|(key, value)| Some((key, value.as_ref()?)));
        if let (Some((first, _)), Some((_, second))) = (given.next(), given.next()) {
            return Err(second.error(format!("cannot be combined with `{first}`"), "leave one of the two out"));
        }
        Ok(found)
    }

    pub(crate) fn place(&self) -> &Place {
        &self.place
    }

    /// An error about the table as a whole.
    pub(crate) fn error(&self, message: impl Into<String>, help: impl Into<String>) -> SceneError {
        // A table that stands in the preset alone is no place to send anyone to.
        let place = if self.place.origin == Origin::Preset { &Place::TOP } else { &self.place };
        self.source.error_at(place, message, help)
    }
}

/// A value being read, with its path for messages and an example of what would be right.
pub struct SceneValue<'a> {
    item: &'a Item,
    key_place: &'a Place,
    path: String,
    /// Path of the key that the example is of: its own, or that of the list or the table it is an element of.
    example_of: String,
    example: &'static str,
    source: &'a Arc<SceneSource>,
}

impl<'a> SceneValue<'a> {
    /// The value `item` of the key at `path`.
    pub(crate) fn new(
        item: &'a Item,
        key_place: &'a Place,
        path: String,
        example: &'static str,
        source: &'a Arc<SceneSource>,
    ) -> Self {
        Self { item, key_place, example_of: path.clone(), path, example, source }
    }

    /// Whether the value is the word `word`.
    pub fn is_word(&self, word: &str) -> bool {
        matches!(self.node(), Node::Text(text) if text == word)
    }

    /// Whether the value is a text.
    pub fn is_text(&self) -> bool {
        matches!(self.node(), Node::Text(_))
    }

    /// The same value with another example for its messages.
    pub(crate) fn with_example(self, example: &'static str) -> Self {
        Self { example, example_of: self.path.clone(), ..self }
    }

    pub(crate) fn key_place(&self) -> &'a Place {
        self.key_place
    }

    pub(crate) fn item(&self) -> &'a Item {
        self.item
    }

    pub(crate) fn place(&self) -> &'a Place {
        &self.item.place
    }

    /// Key and value together.
    pub(crate) fn entry_place(&self) -> Place {
        Place { span: self.key_place.span.start..self.place().span.end, ..self.key_place.clone() }
    }

    pub(crate) fn source(&self) -> &'a Arc<SceneSource> {
        self.source
    }

    pub(crate) fn node(&self) -> &'a Node {
        &self.item.node
    }

    /// `value`, which stands here.
    pub fn at<T>(&self, value: T) -> Located<T> {
        Located { value, place: self.item.place.clone() }
    }

    /// An error about this value; `message` follows the path of its key.
    pub fn error(&self, message: impl AsRef<str>, help: impl Into<String>) -> SceneError {
        self.source.error_at(self.place(), format!("`{}`: {}", self.path, message.as_ref()), help)
    }

    /// An error about the text of this value from byte `at` on.
    pub(crate) fn error_within(&self, text: &str, at: usize, message: &str, help: &str) -> SceneError {
        let place = self.source.within(self.place(), text, at);
        self.source.error_at(&place, format!("`{}`: {message}", self.path), help)
    }

    fn wrong(&self, wanted: &str) -> SceneError {
        self.error(format!("must be {wanted}, got {}", self.node().describe()), self.by_example())
    }

    fn by_example(&self) -> String {
        format!("write, for example: {} = {}", self.example_of, self.example)
    }

    fn unit_error(&self, error: &UnitError, wanted: Option<Dimension>) -> SceneError {
        self.error(error.to_string(), error.remedy(wanted))
    }

    /// A finite quantity of dimension `wanted`, in SI units.
    ///
    /// # Errors
    /// A value without unit, or of another dimension.
    pub fn quantity(&self, wanted: Dimension) -> Result<f64, SceneError> {
        match self.node() {
            Node::Text(text) => units::parse_as(text, wanted).map_err(|e| self.unit_error(&e, Some(wanted))),
            Node::Number(value) => Err(self.unit_error(&UnitError::BareNumber(value.to_string()), Some(wanted))),
            _ => Err(self.wrong("a text with a number and its unit")),
        }
    }

    /// A quantity above zero.
    ///
    /// # Errors
    /// As [`SceneValue::quantity`], and any other value.
    pub fn positive(&self, wanted: Dimension) -> Result<f64, SceneError> {
        let value = self.quantity(wanted)?;
        if value > 0.0 {
            return Ok(value);
        }
        let got = match self.node() {
            Node::Text(text) => format!("`{text}`"),
            other => other.describe(),
        };
        Err(self.error(format!("must be positive, got {got}"), self.by_example()))
    }

    /// A quantity of any dimension.
    pub(crate) fn any_quantity(&self, text: &str) -> Result<(f64, Dimension), SceneError> {
        units::parse_quantity(text).map_err(|e| self.unit_error(&e, None))
    }

    /// A whole number of at least 1.
    pub(crate) fn count(&self) -> Result<usize, SceneError> {
        self.at_least(1)
    }

    /// A whole number of at least `least`, a thousand million at most.
    pub(crate) fn at_least(&self, least: u32) -> Result<usize, SceneError> {
        match self.node() {
            Node::Number(n) if n.fract() == 0.0 && (f64::from(least)..=1e9).contains(n) => Ok(*n as usize),
            _ => Err(self.wrong(&format!("a whole number of at least {least}"))),
        }
    }

    /// A finite pure number.
    ///
    /// # Errors
    /// Anything else.
    pub fn number(&self) -> Result<f64, SceneError> {
        match self.node() {
            Node::Number(value) if value.is_finite() => Ok(*value),
            _ => Err(self.wrong("a finite number without unit")),
        }
    }

    /// The text, which is not empty.
    ///
    /// # Errors
    /// Another value, or an empty text.
    pub fn text(&self) -> Result<&'a str, SceneError> {
        match self.node() {
            Node::Text(text) if text.trim().is_empty() => Err(self.wrong("a text with something in it")),
            Node::Text(text) => Ok(text),
            _ => Err(self.wrong("a text")),
        }
    }

    pub(crate) fn flag(&self) -> Result<bool, SceneError> {
        match self.node() {
            Node::Flag(flag) => Ok(*flag),
            _ => Err(self.wrong("true or false")),
        }
    }

    /// One word out of `choices`.
    ///
    /// # Errors
    /// Any other value.
    pub fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Result<T, SceneError> {
        self.word(choices.iter().map(|c| c.0)).map(|i| choices[i].1)
    }

    /// Position of this text among `known` words.
    pub(crate) fn word<'b>(&self, known: impl Iterator<Item = &'b str> + Clone) -> Result<usize, SceneError> {
        let Node::Text(text) = self.node() else {
            return Err(self.wrong(&format!("one of the words {}", known.collect::<Vec<_>>().join(", "))));
        };
        known.clone().position(|k| k == text).ok_or_else(|| {
            self.error(
                format!("`{text}` is not one of the known words"),
                format!("`{text}` {}", unknown_key(text, known)),
            )
        })
    }

    /// The elements of a list that is not empty.
    ///
    /// # Errors
    /// No list, or an empty one.
    pub fn list(&self) -> Result<Vec<SceneValue<'a>>, SceneError> {
        match self.node() {
            Node::List(items) if !items.is_empty() => Ok(items
                .iter()
                .enumerate()
                .map(|(i, item)| SceneValue {
                    item,
                    key_place: self.key_place,
                    path: format!("{}[{i}]", self.path),
                    example_of: self.example_of.clone(),
                    example: self.example,
                    source: self.source,
                })
                .collect()),
            Node::List(_) => Err(self.error("the list is empty", self.by_example())),
            _ => Err(self.wrong("a list")),
        }
    }

    /// A table with known keys.
    ///
    /// # Errors
    /// No table, or one with another key.
    pub fn table(&self, keys: Keys) -> Result<Reader<'a>, SceneError> {
        self.table_with(keys.iter().collect())
    }

    /// A table with the keys of any of `forms`.
    pub(crate) fn table_of(&self, forms: &'static [Form]) -> Result<Reader<'a>, SceneError> {
        self.table_with(Form::keys_of_any(forms))
    }

    fn table_with(&self, keys: Vec<&'static Key>) -> Result<Reader<'a>, SceneError> {
        self.unchecked_table(keys)?.checked()
    }

    /// A table that is meant to have `keys`, whatever it has.
    pub(crate) fn unchecked_table(&self, keys: Vec<&'static Key>) -> Result<Reader<'a>, SceneError> {
        let table = self.any_table()?;
        Ok(Reader { table, path: self.path.clone(), place: self.place().clone(), keys, source: self.source })
    }

    /// A table whose keys are the scene's own names.
    pub(crate) fn entries(&self) -> Result<Vec<(&'a str, SceneValue<'a>)>, SceneError> {
        let field = |entry: &'a super::tree::Entry| {
            let path = format!("{}.{}", self.path, entry.key);
            let field = SceneValue {
                item: &entry.item,
                key_place: &entry.place,
                path,
                example_of: self.example_of.clone(),
                example: self.example,
                source: self.source,
            };
            (entry.key.as_str(), field)
        };
        Ok(self.any_table()?.0.iter().map(field).collect())
    }

    pub(crate) fn any_table(&self) -> Result<&'a Table, SceneError> {
        match self.node() {
            Node::Table(table) => Ok(table),
            _ => Err(self.wrong("a table")),
        }
    }
}
