//! What a table of a scene may hold: one list for the reader, the schema, new scenes and `fem check --explain`.

use super::tree::{Node, Table};
use fem_core::plugin::{Dimension, Kind, PluginInfo};

/// The keys of a table.
pub type Keys = &'static [Key];

/// The plug-ins of a kind that a scene can name.
pub type Plugins<'a> = &'a dyn Fn(Kind) -> Vec<PluginInfo>;

/// A key of a table.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// The key.
    pub name: &'static str,
    /// What its value may be.
    pub form: Form,
    /// A value in TOML.
    pub example: &'static str,
    /// What it means, in a line.
    pub about: &'static str,
    /// What holds without it.
    pub absent: Absent,
}

/// What holds where neither scene nor preset has a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Absent {
    /// The scene does not mention it.
    Nothing,
    /// The scene is refused.
    Refused,
    /// This value in TOML.
    Default(&'static str),
}

/// What the value of a key may be.
#[derive(Debug, Clone, Copy)]
pub enum Form {
    /// A text.
    Text,
    /// `true` or `false`.
    Flag,
    /// A number without unit.
    Number,
    /// A whole number of at least this.
    Count(u32),
    /// A text with a number and a unit of this dimension.
    Quantity(Dimension),
    /// One of these words.
    Words(&'static [&'static str]),
    /// A material of the library.
    Library,
    /// A table with these keys.
    Table(Keys),
    /// The table of effects: the keys that every scene may have, and those of registered effects.
    Effects,
    /// A table whose keys are the scene's own names.
    Named(&'static Form),
    /// A list that is not empty.
    List(&'static Form),
    /// A list of so many values.
    Several(usize, &'static Form),
    /// Any of these.
    OneOf(&'static [Form]),
    /// A table that names a plug-in under this key beside its parameters and keys of others.
    Plugin(Kind, &'static str, Keys),
    /// The name of a plug-in.
    PluginName(Kind),
    /// Keys of a scene by their paths.
    Setting,
}

/// A key whose absence says nothing.
pub const fn key(name: &'static str, form: Form, example: &'static str, about: &'static str) -> Key {
    Key { name, form, example, about, absent: Absent::Nothing }
}

impl Key {
    /// The same key; a scene without it is refused.
    #[must_use]
    pub const fn required(self) -> Self {
        Self { absent: Absent::Refused, ..self }
    }

    /// The same key; without it this value in TOML holds.
    #[must_use]
    pub const fn default(self, value: &'static str) -> Self {
        Self { absent: Absent::Default(value), ..self }
    }
}

/// The words of `choices`, for [`Form::Words`].
pub const fn words<T, const N: usize>(choices: &[(&'static str, T); N]) -> [&'static str; N] {
    let mut words = [""; N];
    let mut i = 0;
    while i < N {
        words[i] = choices[i].0;
        i += 1;
    }
    words
}

impl Form {
    /// The keys of a table.
    pub(crate) const fn keys(&self) -> Option<Keys> {
        match self {
            Self::Table(keys) => Some(keys),
            _ => None,
        }
    }

    /// The keys of all tables among `forms`.
    pub(crate) fn keys_of_any(forms: &'static [Self]) -> Vec<&'static Key> {
        let mut all: Vec<&'static Key> = Vec::new();
        for key in forms.iter().filter_map(Self::keys).flatten() {
            if all.iter().all(|known| known.name != key.name) {
                all.push(key);
            }
        }
        all
    }

    /// Of several forms the one that `node` is meant to have.
    pub(crate) fn form_of(&self, node: &Node) -> &Form {
        match self {
            Self::OneOf(forms) => {
                forms.iter().map(|form| form.form_of(node)).find(|form| form.fits(node)).unwrap_or(&forms[0])
            }
            form => form,
        }
    }

    pub(crate) fn fits(&self, node: &Node) -> bool {
        let holds = |table: &Table, keys: Keys| table.0.iter().all(|e| keys.iter().any(|key| key.name == e.key));
        match (self, node) {
            (Self::Table(keys), Node::Table(table)) => {
                let wanted = |key: &&Key| key.absent == Absent::Refused;
                holds(table, keys) && keys.iter().filter(wanted).all(|key| table.get(key.name).is_some())
            }
            (Self::Named(_) | Self::Plugin(..) | Self::Effects | Self::Setting, Node::Table(_))
            | (Self::Flag, Node::Flag(_)) => true,
            (Self::Words(words), Node::Text(text)) => words.contains(&text.as_str()),
            (Self::Text | Self::Quantity(_) | Self::Library | Self::PluginName(_), Node::Text(_)) => true,
            (Self::Number | Self::Count(_), Node::Number(_)) => true,
            (Self::List(form), Node::List(items)) => items.iter().all(|item| form.form_of(&item.node).fits(&item.node)),
            (Self::Several(count, form), Node::List(items)) => {
                items.len() == *count && items.iter().all(|item| form.form_of(&item.node).fits(&item.node))
            }
            _ => false,
        }
    }
}
