//! A summary as headings, facts and tables, whatever is in it: units are in the names of its keys.

use serde::Serialize;
use serde_json::{Map, Value};

/// A part of a summary.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Section {
    pub(super) id: String,
    pub(super) heading: String,
    pub(super) facts: Vec<Fact>,
    pub(super) table: Option<Grid>,
}

/// A named value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Fact {
    pub(super) label: String,
    pub(super) value: String,
    pub(super) unit: String,
}

/// A table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Grid {
    pub(super) columns: Vec<Column>,
    pub(super) rows: Vec<Vec<String>>,
}

/// A column of a table; numbers stand to the right.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(super) struct Column {
    pub(super) label: String,
    pub(super) unit: String,
    pub(super) numeric: bool,
}

/// Endings of keys, and the units they stand for; of two that fit, the longer one.
const UNITS: [(&str, &str); 19] = [
    ("_N_per_m", "N/m"),
    ("_J_m2", "J/m²"),
    ("_rad_s", "rad/s"),
    ("_N_m", "N/m"),
    ("_m_s", "m/s"),
    ("_N_s", "N s"),
    ("_MPa", "MPa"),
    ("_deg", "°"),
    ("_MB", "MB"),
    ("_mm", "mm"),
    ("_Hz", "Hz"),
    ("_kg", "kg"),
    ("_Pa", "Pa"),
    ("_J", "J"),
    ("_g", "g"),
    ("_N", "N"),
    ("_m", "m"),
    ("_s", "s"),
    ("_relative", ""),
];

const HEADINGS: [(&str, &str); 9] = [
    ("first_damage", "First damage of each mode, and its stress"),
    ("not_reached", "Modes that were not reached"),
    ("onsets", "How far the times of first damage are known"),
    ("delamination_threshold", "Delamination threshold"),
    ("advised", "What the advisor decided, and why"),
    ("modes", "Modes followed"),
    ("work", "Work"),
    ("frequencies_Hz", "Frequencies"),
    ("margins", "Reserve factors"),
];

/// A key's name for people, the unit to show it in, and how many of that are one of the key's own: millimetres for metres,
/// milliseconds for times, microseconds for steps.
pub(super) fn split_unit(key: &str) -> (String, &'static str, f64) {
    let (stem, unit) = UNITS.iter().find_map(|(end, unit)| Some((key.strip_suffix(end)?, *unit))).unwrap_or((key, ""));
    let (unit, factor) = match unit {
        "m" => ("mm", 1e3),
        "s" if stem.ends_with("time") => ("ms", 1e3),
        "s" if stem.ends_with("step") => ("µs", 1e6),
        unit => (unit, 1.0),
    };
    let relative = if key.ends_with("_relative") { ", relative" } else { "" };
    (format!("{}{relative}", stem.replace('_', " ")), unit, factor)
}

/// A number, `factor` times, with six digits at most, as text; other values as they are.
pub(super) fn format_value(value: &Value, factor: f64) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Bool(yes) => if *yes { "yes" } else { "no" }.to_owned(),
        Value::Number(number) => {
            let scaled = number.as_f64().filter(|_| number.is_f64()).map(|value| digits(value * factor));
            scaled.unwrap_or_else(|| number.to_string())
        }
        Value::Array(values) => values.iter().map(|value| format_value(value, factor)).collect::<Vec<_>>().join(", "),
        Value::Null | Value::Object(_) => String::new(),
    }
}

/// Six significant digits, by powers of ten where that is shorter.
pub(super) fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-4..1e7).contains(&rounded.abs()) { format!("{rounded:e}") } else { rounded.to_string() }
}

/// The parts of a summary; its single values come first, under the heading `rest`.
pub(super) fn sections(summary: &Map<String, Value>, rest: &str) -> Vec<Section> {
    let mut single = Section { id: "general".into(), heading: rest.to_owned(), facts: Vec::new(), table: None };
    let mut sections = Vec::new();
    for (key, value) in
        summary.iter().filter(|(key, _)| !["title", "warnings", "cautions", "stopped"].contains(&key.as_str()))
    {
        let plain = || key.replace('_', " ");
        let heading =
            HEADINGS.iter().find(|(name, _)| name == key).map_or_else(plain, |(_, heading)| (*heading).to_owned());
        let mut letters = heading.chars();
        let heading = letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect());
        let section = |facts, table| Section { id: key.clone(), heading, facts, table };
        match value {
            Value::Object(fields) => sections.push(section(facts(fields), None)),
            Value::Array(rows) if rows.iter().any(Value::is_object) => {
                sections.push(section(Vec::new(), Some(grid(rows))))
            }
            Value::Array(rows) if rows.is_empty() || rows.iter().any(Value::is_array) => {}
            _ => single.facts.push(fact(key, value)),
        }
    }
    sections.insert(0, single);
    sections
}

fn fact(key: &str, value: &Value) -> Fact {
    let (label, unit, factor) = split_unit(key);
    Fact { label, value: format_value(value, factor), unit: unit.to_owned() }
}

/// Fields by name, those of a field within among them.
pub(super) fn facts(fields: &Map<String, Value>) -> Vec<Fact> {
    flat(fields).into_iter().map(|(key, value)| fact(&key, value)).collect()
}

/// All fields, with those of fields within.
fn flat(fields: &Map<String, Value>) -> Vec<(String, &Value)> {
    let mut all = Vec::new();
    for (key, value) in fields {
        match value {
            Value::Object(inner) => all.extend(flat(inner)),
            value => all.push((key.clone(), value)),
        }
    }
    all
}

fn grid(rows: &[Value]) -> Grid {
    let rows: Vec<_> = rows.iter().filter_map(Value::as_object).map(flat).collect();
    let mut keys: Vec<&String> = Vec::new();
    for (key, _) in rows.iter().flatten() {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let of = |row: &[(String, &Value)], key: &String| {
        row.iter().find(|(name, _)| name == key).map(|(_, value)| (*value).clone())
    };
    let column = |key: &&String| {
        let (label, unit, _) = split_unit(key);
        let numeric = rows.iter().filter_map(|row| of(row, key)).all(|value| value.is_number());
        Column { label, unit: unit.to_owned(), numeric }
    };
    Grid {
        columns: keys.iter().map(column).collect(),
        rows: rows
            .iter()
            .map(|row| {
                keys.iter()
                    .map(|key| of(row, key).map_or(String::new(), |v| format_value(&v, split_unit(key).2)))
                    .collect()
            })
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    #[test]
    fn keys_tell_their_units() {
        let both = |key: &str| {
            let (label, unit, _) = split_unit(key);
            format!("{label} [{unit}]")
        };
        let keys =
            ["peak_force_N", "static_stiffness_N_m", "final_impactor_velocity_m_s", "mesh_error_relative", "layers"];
        let want = [
            "peak force [N]",
            "static stiffness [N/m]",
            "final impactor velocity [m/s]",
            "mesh error, relative []",
            "layers []",
        ];
        assert_eq!(keys.map(both), want);
        assert_eq!(["w_m", "end_time_s", "wall_s", "step_s"].map(|key| split_unit(key).2), [1e3, 1e3, 1.0, 1e6]);
        assert_eq!(
            [0.1 + 0.2, 1913.2097520488533, 7.633260460168094e-9, 0.0].map(digits),
            ["0.3", "1913.21", "7.63326e-9", "0"]
        );
    }

    #[test]
    fn any_summary_becomes_facts_and_tables() {
        let summary = json!({"title": "t", "unknowns": 7, "frequencies_Hz": [1.5, 2.0], "model": {"plies": 16, "inner": {"x_m": 0.5}},
            "first_damage": [{"mode": "a", "stress": {"s11_MPa": 1.0}}, {"mode": "b", "reserve_factor": 2.0}], "warnings": ["w"]});
        let sections = sections(summary.as_object().unwrap(), "Rest");
        let headings: Vec<_> = sections.iter().map(|s| s.heading.as_str()).collect();
        assert_eq!(headings, ["Rest", "Model", "First damage of each mode, and its stress"]);
        assert_eq!(sections[0].facts[1].value, "1.5, 2");
        assert_eq!((sections[1].facts[1].value.as_str(), sections[1].facts[1].unit.as_str()), ("500", "mm"));
        let grid = sections[2].table.as_ref().unwrap();
        let labels: Vec<_> = grid.columns.iter().map(|c| (c.label.as_str(), c.numeric)).collect();
        assert_eq!(labels, [("mode", false), ("s11", true), ("reserve factor", true)]);
        assert_eq!(grid.rows, [["a", "1", ""], ["b", "", "2"]]);
    }
}
