//! All that is wrong with the form of a document at once: each value by itself, whatever the others say.
//!
//! Reading stops at the first mistake, because what a key means may hang on another. Whether a key is known, and whether its
//! value has the form of [`Key`](super::keys::Key), hangs on nothing else.

use super::keys::{Absent, Form, Key};
use super::reader::{Reader, SceneValue};
use super::source::{Origin, SceneError};
use super::tree::Node;

impl Reader<'_> {
    /// What is wrong with the form of this table and of all in it.
    pub(crate) fn faults(&self) -> Vec<SceneError> {
        let mut faults: Vec<SceneError> = self.strays().collect();
        // A misspelt key explains a missing one, and what the preset alone has is no fault of the scene.
        if faults.is_empty() && self.place().origin != Origin::Preset {
            let wanted = self.keys().filter(|key| key.absent == Absent::Refused);
            faults.extend(wanted.filter_map(|key| self.required(key.name).err()));
        }
        faults.extend(self.faults_of_values());
        faults
    }

    fn faults_of_values(&self) -> Vec<SceneError> {
        let of = |key: &'static Key| self.optional(key.name).map_or(Vec::new(), |value| value.faults(&key.form));
        self.keys().flat_map(of).collect()
    }

    /// Of a key that has a form of its own in each of several tables: none, where one of them takes its value.
    fn faults_of_each(&self, name: &str, tables: &'static [Form]) -> Vec<SceneError> {
        let Some(value) = self.optional(name) else { return Vec::new() };
        let same = tables.iter().filter_map(Form::keys).flatten().filter(|key| key.name == name);
        same.map(|key| value.faults(&key.form)).min_by_key(Vec::len).unwrap_or_default()
    }
}

impl SceneValue<'_> {
    fn faults(&self, form: &'static Form) -> Vec<SceneError> {
        let all = |faults: Result<Vec<SceneError>, SceneError>| faults.unwrap_or_else(|wrong| vec![wrong]);
        let each = |values: Vec<SceneValue<'_>>, form| values.iter().flat_map(|value| value.faults(form)).collect();
        let value = match form {
            Form::Text | Form::Library | Form::PluginName(_) => self.text().err(),
            Form::Flag => self.flag().err(),
            Form::Number => self.number().err(),
            Form::Count(least) => self.at_least(*least).err(),
            Form::Quantity(dimension) => self.quantity(*dimension).err(),
            Form::Words(words) => self.word(words.iter().copied()).err(),
            Form::Table(keys) => return all(self.unchecked_table(keys.iter().collect()).map(|table| table.faults())),
            // Parameters are for the plug-in to judge.
            Form::Plugin(_, _, keys) => {
                return all(self.unchecked_table(keys.iter().collect()).map(|table| table.faults_of_values()));
            }
            Form::Named(form) => {
                return all(self
                    .entries()
                    .map(|named| each(named.into_iter().map(|(_, value)| value).collect(), form)));
            }
            Form::List(form) => return all(self.list().map(|items| each(items, form))),
            Form::OneOf(forms) => return self.faults_of_any(forms),
            Form::Several(..) | Form::Effects | Form::Setting => None,
        };
        value.into_iter().collect()
    }

    /// Of the forms of the kind of the value, a single one counts, and of several tables the keys of all: which of them is meant
    /// is for the reader to say, and with it what is missing.
    fn faults_of_any(&self, forms: &'static [Form]) -> Vec<SceneError> {
        let mut alike = forms.iter().filter(|form| form.is_like(self.node()));
        match (alike.next(), alike.next()) {
            (Some(only), None) => self.faults(only),
            (Some(Form::Table(_)), Some(Form::Table(_))) => self.unchecked_table(Form::keys_of_any(forms)).map_or_else(
                |wrong| vec![wrong],
                |table| {
                    let values = table.keys().flat_map(|key| table.faults_of_each(key.name, forms));
                    table.strays().chain(values).collect()
                },
            ),
            _ => Vec::new(),
        }
    }
}

impl Form {
    /// Whether a value of this form is what `node` is: a table, a list, a text, a number or a flag.
    fn is_like(&self, node: &Node) -> bool {
        match node {
            Node::Table(_) => {
                matches!(self, Self::Table(_) | Self::Plugin(..) | Self::Named(_) | Self::Effects | Self::Setting)
            }
            Node::List(_) => matches!(self, Self::List(_) | Self::Several(..)),
            Node::Flag(_) => matches!(self, Self::Flag),
            Node::Number(_) => matches!(self, Self::Number | Self::Count(_)),
            Node::Text(_) => {
                matches!(self, Self::Text | Self::Quantity(_) | Self::Words(_) | Self::Library | Self::PluginName(_))
            }
            Node::Date => false,
        }
    }
}
