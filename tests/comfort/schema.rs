//! The schema is that of the program, and agrees with the reader about what is a scene.

use crate::support::{fem, root, strip};
use serde_json::{Map, Value};
use std::fs;

fn printed() -> String {
    fem(&root(), &["schema"]).good().stdout
}

/// Why `value` does not fit `schema`, by the keywords of JSON Schema that ours has; any other keyword is a mistake.
fn misfit(schema: &Value, value: &Value, whole: &Value) -> Option<String> {
    let no = |why: &str| Some(format!("{value} {why}"));
    let fits = |schema: &Value, value: &Value| misfit(schema, value, whole).is_none();
    let empty = Map::new();
    let object = value.as_object().unwrap_or(&empty);
    let items = value.as_array().map_or(&[][..], Vec::as_slice);
    schema.as_object().unwrap().iter().find_map(|(keyword, rule)| match keyword.as_str() {
        "$schema" | "title" | "description" | "default" | "examples" | "definitions" => None,
        "$ref" => misfit(whole.pointer(rule.as_str().unwrap().strip_prefix('#').unwrap()).unwrap(), value, whole),
        "type" => {
            let is = |name: &Value| match name.as_str().unwrap() {
                "object" => value.is_object(),
                "array" => value.is_array(),
                "string" => value.is_string(),
                "boolean" => value.is_boolean(),
                "number" => value.is_number(),
                "integer" => value.as_f64().is_some_and(|n| n.fract() == 0.0),
                other => panic!("{other}"),
            };
            let any = rule.as_array().map_or_else(|| is(rule), |names| names.iter().any(is));
            if any { None } else { no(&format!("is no {rule}")) }
        }
        "enum" => {
            if rule.as_array().unwrap().contains(value) {
                None
            } else {
                no("is an unknown word")
            }
        }
        "const" => {
            if rule == value {
                None
            } else {
                no("is another word")
            }
        }
        "pattern" => {
            let pattern = regex_lite::Regex::new(rule.as_str().unwrap()).unwrap();
            value.as_str().filter(|text| !pattern.is_match(text)).and_then(|_| no("does not match"))
        }
        "minimum" => value.as_f64().filter(|n| *n < rule.as_f64().unwrap()).and_then(|_| no("is too small")),
        "maximum" => value.as_f64().filter(|n| *n > rule.as_f64().unwrap()).and_then(|_| no("is too large")),
        "exclusiveMinimum" => value.as_f64().filter(|n| *n <= rule.as_f64().unwrap()).and_then(|_| no("is too small")),
        "exclusiveMaximum" => value.as_f64().filter(|n| *n >= rule.as_f64().unwrap()).and_then(|_| no("is too large")),
        "minItems" => {
            if !value.is_array() || items.len() as u64 >= rule.as_u64().unwrap() {
                None
            } else {
                no("is short")
            }
        }
        "maxItems" => {
            if !value.is_array() || items.len() as u64 <= rule.as_u64().unwrap() {
                None
            } else {
                no("is long")
            }
        }
        "items" => items.iter().find_map(|item| misfit(rule, item, whole)),
        "minProperties" => {
            if object.is_empty() {
                no("is empty")
            } else {
                None
            }
        }
        "required" => {
            let lacks = rule.as_array().unwrap().iter().find(|key| !object.contains_key(key.as_str().unwrap()));
            lacks.and_then(|key| no(&format!("lacks {key}")))
        }
        "properties" => object.iter().find_map(|(key, value)| misfit(rule.get(key)?, value, whole)),
        "additionalProperties" => {
            let known = schema.get("properties");
            let mut others = object.iter().filter(|(key, _)| known.is_none_or(|known| known.get(key).is_none()));
            match rule {
                Value::Bool(false) => others.next().and_then(|(key, _)| no(&format!("has the unknown key {key}"))),
                rule => others.find_map(|(_, value)| misfit(rule, value, whole)),
            }
        }
        "anyOf" => {
            if rule.as_array().unwrap().iter().any(|rule| fits(rule, value)) {
                None
            } else {
                no("fits nothing")
            }
        }
        "allOf" => rule.as_array().unwrap().iter().find_map(|rule| misfit(rule, value, whole)),
        other => panic!("{other}"),
    })
}

/// A scene as JSON; `None` where it is no TOML.
fn json(scene: &str) -> Option<Value> {
    fn convert(value: toml_edit::Value) -> Value {
        match value {
            toml_edit::Value::String(text) => text.into_value().into(),
            toml_edit::Value::Integer(n) => n.into_value().into(),
            toml_edit::Value::Float(x) => x.into_value().into(),
            toml_edit::Value::Boolean(flag) => flag.into_value().into(),
            toml_edit::Value::Datetime(date) => date.to_string().into(),
            toml_edit::Value::Array(items) => items.into_iter().map(convert).collect(),
            toml_edit::Value::InlineTable(table) => {
                Value::Object(table.into_iter().map(|(key, value)| (key.to_string(), convert(value))).collect())
            }
        }
    }
    let document: toml_edit::DocumentMut = scene.parse().ok()?;
    Some(convert(document.as_table().clone().into_inline_table().into()))
}

fn refused(schema: &Value, scene: &str) -> Option<String> {
    misfit(schema, &json(scene)?, schema)
}

#[test]
fn the_committed_schema_is_that_of_the_program() {
    let file = root().join("docs/scene.schema.json");
    if std::env::var_os("UPDATE_BOOK").is_some() {
        fs::write(&file, printed()).unwrap();
    }
    let written = fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
    assert_eq!(written, printed(), "write the schema anew: UPDATE_BOOK=1 cargo test --test all schema");
}

#[test]
fn every_shipped_scene_fits_the_schema() {
    let schema: Value = serde_json::from_str(&printed()).unwrap();
    let mut scenes = Vec::new();
    for folder in ["examples", "src/cli/templates", "docs/accuracy"] {
        let entries = root().join(folder).read_dir().unwrap().map(|entry| entry.unwrap().path());
        // The scene of an outside crate names what only that crate knows.
        scenes.extend(entries.filter(|path| !path.join("Cargo.toml").exists()).map(|path| match path.is_dir() {
            true => path.join("scene.toml"),
            false => path,
        }));
    }
    let scenes: Vec<_> = scenes.into_iter().filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    assert!(scenes.len() >= 18, "{scenes:?}");
    for path in scenes.iter().filter(|path| path.exists()) {
        let text = fs::read_to_string(path).unwrap();
        assert_eq!(refused(&schema, &text), None, "{}", path.display());
    }
}

#[test]
fn examples_and_defaults_of_the_schema_fit_it() {
    fn visit(node: &Value, whole: &Value, seen: &mut usize) {
        if let Some(properties) = node.get("properties").and_then(Value::as_object) {
            for (name, property) in properties {
                let examples = property.get("examples").and_then(Value::as_array).into_iter().flatten();
                for value in examples.chain(property.get("default")) {
                    assert_eq!(misfit(property, value, whole), None, "{name}");
                    *seen += 1;
                }
            }
        }
        let inner: Vec<&Value> = match node {
            Value::Object(entries) => entries.values().collect(),
            Value::Array(items) => items.iter().collect(),
            _ => Vec::new(),
        };
        inner.iter().for_each(|inner| visit(inner, whole, seen));
    }
    let schema: Value = serde_json::from_str(&printed()).unwrap();
    let mut seen = 0;
    visit(&schema, &schema, &mut seen);
    assert!(seen > 100, "{seen}");
}

/// What the schema refuses the program refuses as well.
#[test]
fn wrong_scenes_are_refused_by_schema_and_program() {
    let schema: Value = serde_json::from_str(&printed()).unwrap();
    strip().fem("check", &[]).good();
    for (what, from, to) in [
        ("an unknown key", "velocity = ", "speed = "),
        ("a missing key", "mass = \"2.49 kg\"\n", ""),
        ("a missing table", "[laminate]\nplies", "[laminated]\nplies"),
        ("a bare number", "\"2.49 kg\"", "2.49"),
        ("a number without unit in quotes", "\"2.49 kg\"", "\"2.49\""),
        ("a quantity that is a word", "\"2.49 kg\"", "\"heavy\""),
        ("a flag for a quantity", "\"1.56 m/s\"", "true"),
        ("an unknown contact law", "law = \"sun-yang\"", "law = \"sun-young\""),
        ("a parameter of another law", "beta = 0.4", "radius = \"6 mm\""),
        ("a parameter out of range", "beta = 0.4", "beta = 1.4"),
        ("a parameter without its unit", "k = \"1.07e5 N/mm^1.5\"", "k = 1.07e5"),
        ("a missing parameter", "k = \"1.07e5 N/mm^1.5\"\n", ""),
        ("an unknown criterion", "\"octahedral\"", "\"octohedral\""),
        ("an unknown material", "\"AS4/3502\"", "\"AS4\""),
        ("an unknown level", "at = \"all\"", "at = \"middle\""),
        ("a support of two kinds", "restrain = \"rigid-motions\"", "restrain = \"rigid-motions\"\ngroup = \"clamped\""),
        ("half a layer", "layers = [8, 8]", "layers = [7.5, 8.5]"),
        ("no layer", "layers = [8, 8]", "layers = 0"),
        ("a table that is none", "[march]\nend = \"20 us\"", "march = 3"),
        ("an unknown fidelity", "mesh = {", "fidelity = \"high\"\nmesh = {"),
        ("a mesh of two kinds", "unit = \"mm\"", "unit = \"mm\", cells = [2, 2]"),
        ("an empty list", "criteria = [\"hashin-report\", \"octahedral\"]", "criteria = []"),
    ] {
        let case = strip().scene(from, to);
        let done = case.fem("check", &[]);
        assert_eq!((done.status, done.stdout.as_str()), (1, ""), "{what}: {done:#?}");
        let scene = case.read("plate/scene.toml");
        assert!(refused(&schema, &scene).is_some(), "{what} fits the schema");
    }
}

/// The head of what the tests write.
const WRITTEN: &str = "<!-- Written by `UPDATE_BOOK=1 cargo test --test all schema`. -->\n";

/// Every key of a scene, in Markdown: those at the top, then a table per table.
fn keys_table(schema: &Value) -> String {
    let (mut top, mut below) = (Vec::new(), String::new());
    for (name, property) in schema["properties"].as_object().unwrap() {
        let mut rows = Vec::new();
        collect("", property, &mut rows);
        top.push(row(name, property, schema));
        if !rows.is_empty() {
            below += &format!("\n### `{name}`\n\n{HEAD}{}", rows.concat());
        }
    }
    format!("{WRITTEN}\n{HEAD}{}{below}", top.concat())
}

const HEAD: &str = "| key | what it means | without it | example |\n| --- | --- | --- | --- |\n";

/// Rows of the keys within `schema`, whose path is `path`.
fn collect(path: &str, schema: &Value, rows: &mut Vec<String>) {
    for (name, property) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
        let path = format!("{path}{name}");
        let row = row(&path, property, schema);
        if !rows.contains(&row) {
            rows.push(row);
        }
        collect(&format!("{path}."), property, rows);
    }
    let alternatives = schema.get("anyOf").and_then(Value::as_array).into_iter().flatten();
    for inner in alternatives.chain(schema.get("items")) {
        collect(path, inner, rows);
    }
    if let Some(inner) = schema.get("additionalProperties").filter(|inner| inner.is_object()) {
        collect(&format!("{path}NAME."), inner, rows);
    }
}

fn row(path: &str, property: &Value, within: &Value) -> String {
    let name = path.rsplit('.').next().unwrap();
    let required = within["required"].as_array().is_some_and(|keys| keys.iter().any(|key| key == name));
    let without = match property.get("default") {
        _ if required => "refused".to_owned(),
        Some(value) if value != &serde_json::json!({}) => format!("`{value}`"),
        _ => String::new(),
    };
    let example = toml(&property["examples"][0]);
    let cells =
        [format!("`{path}`"), property["description"].as_str().unwrap().to_owned(), without, format!("`{example}`")];
    format!("| {} |\n", cells.map(|cell| cell.replace('|', "\\|")).join(" | "))
}

fn toml(value: &Value) -> String {
    match value {
        Value::Object(entries) => {
            let entries: Vec<_> = entries.iter().map(|(key, value)| format!("{key} = {}", toml(value))).collect();
            format!("{{ {} }}", entries.join(", "))
        }
        Value::Array(items) => format!("[{}]", items.iter().map(toml).collect::<Vec<_>>().join(", ")),
        other => other.to_string(),
    }
}

#[test]
fn the_book_has_every_key() {
    let schema: Value = serde_json::from_str(&printed()).unwrap();
    let file = root().join("docs/book/src/scene-keys.md");
    if std::env::var_os("UPDATE_BOOK").is_some() {
        fs::write(&file, keys_table(&schema)).unwrap();
    }
    let written = fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
    assert_eq!(written, keys_table(&schema), "write the table anew: UPDATE_BOOK=1 cargo test --test all schema");
}
