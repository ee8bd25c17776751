//! A summary as headings, facts and tables, whatever is in it: units are in the names of its keys.

use fem_core::plugin::{Dimension, digits};
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

/// The unit that the ending of a key stands for.
#[derive(Debug, Clone, Copy)]
pub(super) enum KeyUnit {
    /// One of a dimension, so large in SI units: it is shown with the prefix that fits.
    Of(Dimension, f64),
    /// One that is shown as it is; empty for none.
    As(&'static str),
}
use KeyUnit::{As, Of};

/// Endings of keys, and the units they stand for; of two that fit, the longer one.
const UNITS: [(&str, KeyUnit); 21] = [
    ("_N_per_m", As("N/m")),
    ("_J_m2", As("J/m^2")),
    ("_rad_s", As("rad/s")),
    ("_N_m", As("N/m")),
    ("_m_s", Of(Dimension::VELOCITY, 1.0)),
    ("_N_s", As("N s")),
    ("_MPa", Of(Dimension::PRESSURE, 1e6)),
    ("_mm2", Of(Dimension::AREA, 1e-6)),
    ("_deg", As("°")),
    ("_m2", Of(Dimension::AREA, 1.0)),
    ("_MB", As("MB")),
    ("_mm", Of(Dimension::LENGTH, 1e-3)),
    ("_Hz", Of(Dimension::FREQUENCY, 1.0)),
    ("_kg", Of(Dimension::MASS, 1.0)),
    ("_Pa", Of(Dimension::PRESSURE, 1.0)),
    ("_J", Of(Dimension::ENERGY, 1.0)),
    ("_g", Of(Dimension::MASS, 1e-3)),
    ("_N", Of(Dimension::FORCE, 1.0)),
    ("_m", Of(Dimension::LENGTH, 1.0)),
    ("_s", Of(Dimension::TIME, 1.0)),
    ("_relative", As("")),
];

impl KeyUnit {
    /// The unit to show `values` in, and how many of it are one of these.
    pub(super) fn fit(self, values: impl Iterator<Item = f64>) -> (&'static str, f64) {
        match self {
            As(symbol) => (symbol, 1.0),
            Of(dimension, size) => {
                let largest = values.fold(0.0, |most: f64, value| value.abs().max(most));
                dimension.unit_for(size * largest).map_or(("", 1.0), |unit| (unit.symbol, size * unit.per))
            }
        }
    }
}

const HEADINGS: [(&str, &str); 11] = [
    ("first_damage", "First damage of each mode, and its stress"),
    ("not_reached", "Modes that were not reached"),
    ("onsets", "How far the times of first damage are known"),
    ("delamination_threshold", "Delamination threshold"),
    ("advised", "What the advisor decided, and why"),
    ("modes", "Modes followed"),
    ("work", "Work"),
    ("frequencies_Hz", "Frequencies"),
    ("preload", "Preload of the edges"),
    ("load_factors", "Load factors of the preload"),
    ("margins", "Reserve factors"),
];

/// A key's name for people, and its unit.
pub(super) fn split_unit(key: &str) -> (String, KeyUnit) {
    let (stem, unit) =
        UNITS.iter().find_map(|(end, unit)| Some((key.strip_suffix(end)?, *unit))).unwrap_or((key, As("")));
    let relative = if key.ends_with("_relative") { ", relative" } else { "" };
    (format!("{}{relative}", stem.replace('_', " ")), unit)
}

/// The numbers of a value.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(values) => values.iter().flat_map(numbers).collect(),
        value => value.as_f64().into_iter().collect(),
    }
}

/// A number, `factor` times, with four significant digits at most, as text; other values as they are.
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

/// The parts of a summary; its single values come first, under the heading `rest`.
pub(super) fn sections(summary: &Map<String, Value>, rest: &str) -> Vec<Section> {
    let mut single = Section { id: "general".into(), heading: rest.to_owned(), facts: Vec::new(), table: None };
    let mut sections = Vec::new();
    for (key, value) in summary
        .iter()
        .filter(|(key, _)| !["title", "format", "warnings", "cautions", "stopped"].contains(&key.as_str()))
    {
        let plain = || key.replace('_', " ");
        let heading =
            HEADINGS.iter().find(|(name, _)| name == key).map_or_else(plain, |(_, heading)| (*heading).to_owned());
        let mut letters = heading.chars();
        let heading: String =
            letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect());
        match value {
            Value::Object(_) => sections.extend(parts(key, &heading, value)),
            Value::Array(rows) if rows.iter().any(Value::is_object) => sections.extend(parts(key, &heading, value)),
            Value::Array(rows) if rows.is_empty() || rows.iter().any(Value::is_array) => {}
            _ => single.facts.push(fact(key, value)),
        }
    }
    sections.insert(0, single);
    sections
}

/// Whether a value is or holds a table.
fn holds_table(value: &Value) -> bool {
    match value {
        Value::Object(fields) => fields.values().any(holds_table),
        Value::Array(rows) => rows.iter().any(Value::is_object),
        _ => false,
    }
}

/// A table, or fields and what they hold: what holds a table is a part of its own.
fn parts(id: &str, heading: &str, value: &Value) -> Vec<Section> {
    let section = |facts, table| Section { id: id.to_owned(), heading: heading.to_owned(), facts, table };
    match value {
        Value::Object(fields) => {
            let (apart, own): (Vec<_>, Vec<_>) = fields.iter().partition(|(_, value)| holds_table(value));
            let own: Map<_, _> = own.into_iter().map(|(key, value)| (key.clone(), value.clone())).collect();
            let within = apart.into_iter().flat_map(|(key, value)| {
                parts(&format!("{id}-{key}"), &format!("{heading}: {}", key.replace('_', " ")), value)
            });
            std::iter::once(section(facts(&own), None)).chain(within).collect()
        }
        Value::Array(rows) => vec![section(Vec::new(), Some(grid(rows)))],
        _ => Vec::new(),
    }
}

/// A value by its key.
pub(super) fn fact(key: &str, value: &Value) -> Fact {
    let (label, unit) = split_unit(key);
    let (unit, factor) = unit.fit(numbers(value).into_iter());
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
        let values = || rows.iter().filter_map(|row| of(row, key));
        let (label, unit) = split_unit(key);
        let (unit, factor) = unit.fit(values().flat_map(|value| numbers(&value)));
        let numeric = values().all(|value| value.is_number());
        (Column { label, unit: unit.to_owned(), numeric }, factor)
    };
    let (columns, factors): (Vec<_>, Vec<_>) = keys.iter().map(column).unzip();
    let shown = |row: &Vec<(String, &Value)>| {
        let fields = keys.iter().zip(&factors);
        fields.map(|(key, factor)| of(row, key).map_or(String::new(), |v| format_value(&v, *factor))).collect()
    };
    Grid { columns, rows: rows.iter().map(shown).collect() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    #[test]
    fn keys_tell_their_units() {
        let both = |key: &str| {
            let (label, unit) = split_unit(key);
            format!("{label} [{}]", unit.fit([1.0].into_iter()).0)
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
        let of = |key: &str, value: f64| {
            let Fact { value, unit, .. } = fact(key, &value.into());
            format!("{value} {unit}")
        };
        assert_eq!(of("w_m", 0.0135), "13.5 mm");
        assert_eq!(of("step_s", 3.5e-7), "0.35 us");
        assert_eq!(of("s11_MPa", 535.61), "535.6 MPa");
        assert_eq!(of("energy_error_relative", 7.633260460168094e-9), "7.633e-9 ");
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

    #[test]
    fn a_table_within_is_a_part_of_its_own() {
        let summary = json!({"path": {"dissipated_J": 1.0, "delamination": {"dissipated_J": 2.0,
            "interfaces": [{"interface": "1|2", "area_mm2": 3.0}]}}});
        let sections = sections(summary.as_object().unwrap(), "Rest");
        let headings: Vec<_> = sections.iter().skip(1).map(|s| (s.heading.as_str(), s.facts.len())).collect();
        assert_eq!(headings, [("Path", 1), ("Path: delamination", 1), ("Path: delamination: interfaces", 0)]);
        assert_eq!(sections[3].table.as_ref().unwrap().rows, [["1|2", "3"]]);
    }
}
