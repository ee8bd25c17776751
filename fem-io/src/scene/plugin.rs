//! A plug-in as a scene names it, with its parameters.

use crate::document::reader::SceneValue;
use crate::document::source::{Located, Place, SceneError};
use crate::document::tree::Node;
use fem_core::plugin::{Params, Value};
use std::collections::BTreeMap;

/// A plug-in and its parameters, checked by the registry.
#[derive(Debug, Clone)]
pub struct PluginSpec {
    /// Its name and where it stands.
    pub name: Located<String>,
    /// Its parameters as the scene gives them, quantities as texts.
    pub params: Params,
    places: BTreeMap<String, Place>,
}

impl PluginSpec {
    /// Where parameter `key` stands; the plug-in's name for a key that was not given, or for none (`""`).
    pub fn place_of(&self, key: &str) -> &Place {
        self.places.get(key).unwrap_or(&self.name.place)
    }

    /// A plug-in with parameters that follow from the value of `field`.
    pub(super) fn made<const N: usize>(name: &str, values: [(&str, Value); N], field: &SceneValue<'_>) -> Self {
        let mut params = Params::default();
        let places = values.iter().map(|(key, _)| ((*key).to_owned(), field.place().clone())).collect();
        values.into_iter().for_each(|(key, value)| params.insert(key, value));
        Self { name: field.at(name.to_owned()), params, places }
    }

    /// Reads a bare name, or a table with the key `name`; keys of `others` belong to somebody else.
    pub(super) fn read_or_name(field: &SceneValue<'_>, others: &[&str]) -> Result<Self, SceneError> {
        match field.node() {
            Node::Text(_) => {
                let name = field.at(field.text()?.to_owned());
                Ok(Self { name, params: Params::default(), places: BTreeMap::new() })
            }
            _ => Self::read(field, "name", others),
        }
    }

    /// Reads a table with the name under `name_key`; keys of `others` belong to somebody else.
    pub(super) fn read(field: &SceneValue<'_>, name_key: &str, others: &[&str]) -> Result<Self, SceneError> {
        let mut name = None;
        let mut params = Params::default();
        let mut places = BTreeMap::new();
        for (key, value) in field.entries()? {
            if key == name_key {
                name = Some(value.at(value.text()?.to_owned()));
            } else if !others.contains(&key) {
                params.insert(key, read_value(&value)?);
                places.insert(key.to_owned(), value.entry_place());
            }
        }
        let name = name.ok_or_else(|| {
            field.error(format!("the key `{name_key}` is missing"), "it names the plug-in that the other keys are for")
        })?;
        Ok(Self { name, params, places })
    }
}

/// A value as it stands there: whether a text is a quantity, only the plug-in's row of the parameter tells.
fn read_value(field: &SceneValue<'_>) -> Result<Value, SceneError> {
    Ok(match field.node() {
        Node::Text(text) => Value::Text(text.clone()),
        Node::Number(_) => Value::Number(field.number()?),
        Node::Flag(flag) => Value::Flag(*flag),
        Node::List(items) if items.is_empty() => Value::List(Vec::new()),
        Node::List(_) => Value::List(field.list()?.iter().map(read_value).collect::<Result<_, _>>()?),
        Node::Table(_) | Node::Date => {
            return Err(field.error(
                format!("a parameter cannot be {}", field.node().describe()),
                "write a number, a quantity in quotes, a word, true, false or a list of these",
            ));
        }
    })
}
