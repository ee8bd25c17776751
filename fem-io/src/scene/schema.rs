//! The JSON Schema of a scene, for editors.

use super::root::KEYS;
use super::{Fidelity, effects};
use crate::document::keys::{Absent, Form, Key, Keys, Plugins};
use crate::document::source::{Origin, SceneSource};
use crate::document::tree::{Node, Table};
use crate::{materials, units};
use fem_core::plugin::{Kind, ParamDefault, ParamForm, ParamInfo};
use serde_json::{Map, Value, json};
use std::ops::Bound::{Excluded, Included, Unbounded};
use std::sync::Arc;

/// A number, and behind it what begins no longer number.
const QUANTITY: &str = r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?(\s+\S|[^\d\s.eE+-])";

/// The JSON Schema (draft 7, which editors know) of a scene whose plug-ins are `plugins`, and whose effects have the keys
/// `effects`.
///
/// It knows keys, kinds of values, words, plug-ins with their parameters and materials of the library. What hangs on
/// the mesh, on units or on other keys [`super::read`] alone finds out.
pub fn schema(plugins: Plugins<'_>, effects: &[Key]) -> Value {
    let presets = Fidelity::ALL.map(|(_, fidelity)| parsed(fidelity.preset()));
    let below: Vec<&Table> = presets.iter().collect();
    let Value::Object(mut root) = table(KEYS, &below) else { return Value::Null };
    if let Some(Value::Object(known)) =
        root.get_mut("properties").and_then(|all| all.pointer_mut("/effects/properties"))
    {
        known.extend(effects.iter().map(|key| (key.name.to_owned(), property(key, &[]))));
    }
    let definitions = Kind::ALL
        .iter()
        .filter(|kind| !plugins(**kind).is_empty())
        .map(|kind| (definition(*kind), names(*kind, plugins)));
    let mut definitions: Map<String, Value> = definitions.collect();
    for (kind, name, others) in tables_of_plugins(KEYS) {
        let of_kind: Vec<Value> =
            plugins(kind).iter().map(|p| plugin(name, p.name, p.summary, p.params, others)).collect();
        definitions.insert(format!("{}-table", definition(kind)), json!({ "type": "object", "anyOf": of_kind }));
    }
    let mut document = Map::new();
    document.insert("$schema".into(), "http://json-schema.org/draft-07/schema#".into());
    document.insert("title".into(), "A scene of fem".into());
    document.append(&mut root);
    document.insert("definitions".into(), Value::Object(definitions));
    Value::Object(document)
}

/// A TOML text of the program's own.
pub(super) fn parsed(text: &str) -> Table {
    Table::parse(text, Origin::Preset, &Arc::new(SceneSource::default())).unwrap_or_default()
}

/// A value in TOML of the program's own.
pub(super) fn value_of(text: &str) -> Option<Node> {
    Some(parsed(&format!("value = {text}")).0.pop()?.item.node)
}

fn definition(kind: Kind) -> String {
    kind.to_string().replace(' ', "-")
}

/// What a table of plug-ins looks like, once per kind.
fn tables_of_plugins(keys: Keys) -> Vec<(Kind, &'static str, Keys)> {
    fn visit(form: &Form, found: &mut Vec<(Kind, &'static str, Keys)>) {
        match form {
            Form::Plugin(kind, name, others) if found.iter().all(|(known, ..)| known != kind) => {
                found.push((*kind, *name, *others));
            }
            Form::Table(keys) => keys.iter().for_each(|key| visit(&key.form, found)),
            Form::List(form) | Form::Named(form) | Form::Several(_, form) => visit(form, found),
            Form::OneOf(forms) => forms.iter().for_each(|form| visit(form, found)),
            _ => {}
        }
    }
    let mut found = Vec::new();
    keys.iter().for_each(|key| visit(&key.form, &mut found));
    found
}

/// A table; keys that every preset has in it (`below`) need not be given.
fn table(keys: Keys, below: &[&Table]) -> Value {
    let mut properties = Map::new();
    let mut required = Vec::new();
    for key in keys {
        let below: Vec<_> = below.iter().filter_map(|table| table.get(key.name)).collect();
        let tables: Vec<_> = below.iter().filter_map(|entry| entry.item.node.table()).collect();
        properties.insert(key.name.into(), property(key, &tables));
        if key.absent == Absent::Refused && below.len() < Fidelity::ALL.len() {
            required.push(key.name);
        }
    }
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn property(key: &Key, below: &[&Table]) -> Value {
    let Value::Object(mut it) = form(&key.form, below) else { return Value::Null };
    let about = match it.remove("description") {
        Some(Value::String(more)) => format!("{} ({more})", key.about),
        _ => key.about.to_owned(),
    };
    it.insert("description".into(), about.into());
    let json = |text| value_of(text).map(|node| node.to_json());
    if let Absent::Default(default) = key.absent {
        it.insert("default".into(), json(default).into());
    }
    it.insert("examples".into(), Value::Array(json(key.example).into_iter().collect()));
    Value::Object(it)
}

fn form(form: &Form, below: &[&Table]) -> Value {
    let inner = |form: &Form| self::form(form, below);
    match form {
        Form::Text => json!({ "type": "string", "pattern": r"\S" }),
        Form::Flag => json!({ "type": "boolean" }),
        Form::Number => json!({ "type": "number" }),
        Form::Count(least) => json!({ "type": "integer", "minimum": least, "maximum": 1_000_000_000 }),
        Form::Quantity(dimension) => {
            let units = units::accepted(*dimension).join(", ");
            json!({ "type": "string", "pattern": QUANTITY, "description": format!("in {units}") })
        }
        Form::Words(words) => json!({ "enum": words }),
        Form::Library => json!({ "enum": materials::names().collect::<Vec<_>>() }),
        Form::Table(keys) => table(keys, below),
        Form::Effects => table(effects::KEYS, below),
        Form::Named(form) => json!({ "type": "object", "additionalProperties": inner(form) }),
        Form::List(form) => json!({ "type": "array", "items": inner(form), "minItems": 1 }),
        Form::Several(count, form) => {
            json!({ "type": "array", "items": inner(form), "minItems": count, "maxItems": count })
        }
        Form::OneOf(forms) => json!({ "anyOf": forms.iter().map(inner).collect::<Vec<_>>() }),
        Form::Plugin(kind, ..) => {
            json!({ "allOf": [{ "$ref": format!("#/definitions/{}-table", definition(*kind)) }] })
        }
        Form::PluginName(kind) => json!({ "allOf": [{ "$ref": format!("#/definitions/{}", definition(*kind)) }] }),
        Form::Setting => json!({ "type": "object", "minProperties": 1 }),
    }
}

/// The names of the plug-ins of a kind.
fn names(kind: Kind, plugins: Plugins<'_>) -> Value {
    json!({ "enum": plugins(kind).iter().map(|p| p.name).collect::<Vec<_>>() })
}

/// A table that names a plug-in; the name may be that of the preset.
fn plugin(key: &str, name: &str, summary: &str, params: &[ParamInfo], others: Keys) -> Value {
    let mut properties = Map::new();
    properties.insert(key.into(), json!({ "const": name, "description": summary }));
    for key in others {
        properties.insert(key.name.into(), property(key, &[]));
    }
    properties.extend(params.iter().map(|row| (row.name.into(), parameter(row))));
    let required = params.iter().filter(|row| row.default == ParamDefault::Required);
    let required: Vec<&str> = required.map(|row| row.name).collect();
    json!({ "title": name, "properties": properties, "required": required, "additionalProperties": false })
}

/// A parameter by its row.
fn parameter(row: &ParamInfo) -> Value {
    let mut about = row.to_string();
    let mut it = match row.form {
        ParamForm::Number => json!({ "type": "number" }),
        ParamForm::Count => json!({ "type": "integer" }),
        ParamForm::Quantity(_) => json!({ "type": "string", "pattern": QUANTITY }),
        ParamForm::Word(words) => json!({ "enum": words.iter().map(|(word, _)| word).collect::<Vec<_>>() }),
        ParamForm::Flag => json!({ "type": "boolean" }),
        ParamForm::Texts => json!({ "anyOf": [form(&Form::Text, &[]), form(&Form::List(&Form::Text), &[])] }),
    };
    if matches!(row.form, ParamForm::Number | ParamForm::Count) {
        match row.range.0 {
            Included(least) => it["minimum"] = number(least),
            Excluded(least) => it["exclusiveMinimum"] = number(least),
            Unbounded => {}
        }
        match row.range.1 {
            Included(most) => it["maximum"] = number(most),
            Excluded(most) => it["exclusiveMaximum"] = number(most),
            Unbounded => {}
        }
    }
    let units = row.dimension().map_or(Vec::new(), units::accepted);
    if !units.is_empty() {
        about.push_str(&format!(" (in {})", units.join(", ")));
    }
    it["description"] = about.into();
    if let Some(default) = row.default_value().and_then(|value| value_of(&value.in_scene())) {
        it["default"] = default.to_json();
    }
    it
}

/// Whole numbers without a point, as people write them.
fn number(value: f64) -> Value {
    if value.fract() == 0.0 { json!(value as i64) } else { json!(value) }
}
