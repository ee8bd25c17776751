//! What is on the page.

use super::curves::{self, Curves, curves};
use super::facts::{self, Column, Fact, Grid, Section};
use super::folder::{Folder, Picture};
use super::headline::Headline;
use super::measured::Measured;
use super::what_if::WhatIf;
use crate::effect::LedgerColumn;
use crate::error::Error;
use crate::output::damage::DamageMap;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fem_core::plugin::digits;
use fem_io::plot::class_color;
use fem_io::results::{Table, damaged};
use fem_io::tables::EventRow;
use minijinja::value::Serde;
use minijinja::{Environment, HtmlEscape, Value as Any, context};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use sha2::{Digest as _, Sha256};

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
/// One after the other in a scope of their own; the first is what the others share.
const SCRIPTS: [&str; 8] = [
    include_str!("common.js"),
    include_str!("charts.js"),
    include_str!("loops.js"),
    include_str!("damage.js"),
    include_str!("table.js"),
    include_str!("march.js"),
    include_str!("judge.js"),
    include_str!("what_if.js"),
];

/// A picture with more than this many bytes of SVG is shown by its PNG where that is smaller.
const LARGE_SVG: usize = 200_000;
/// Most bytes of the damage map; beyond, cells with small indices are left out.
const LARGE_MAP: usize = 900_000;
/// Indices below which cells are left out, one after the other, until the map is small enough.
const LEAST: [f64; 5] = [0.0, 0.1, 0.3, 0.6, 1.0];

#[derive(Serialize)]
struct Figure {
    name: String,
    caption: String,
    svg: Option<Any>,
    png: Option<String>,
    interactive: bool,
}

/// The page of a folder of results.
pub(super) fn render(
    folder: &Folder,
    measured: Option<&Measured>,
    columns: &[&LedgerColumn],
    what_if: Option<&WhatIf>,
) -> Result<String, Error> {
    let none = Map::new();
    let summary = folder.summary.as_ref().and_then(Value::as_object).unwrap_or(&none);
    let text = |key: &str| summary.get(key).and_then(Value::as_str);
    let history = folder.path.join("history.csv");
    let curves = folder.history.as_ref().map_or(Ok(None), |history| curves(history, columns));
    let mut curves = curves.map_err(|(column, row, text)| {
        damaged(&history, format!("row {row}, column {column}: `{text}` is not a finite number"))
    })?;
    let force = folder.history.as_ref().map(curves::force);
    let against = measured.zip(force).and_then(|(measured, force)| measured.against(&force));
    if let Some((measured, curves)) = measured.zip(curves.as_mut()) {
        curves.lay_over(measured);
    }
    let (damage, least) = folder.damage.as_ref().map_or((Value::Null, 0.0), damage);
    let colors: Vec<String> = (0..7).map(class_color).collect();
    let marks = first_damage(summary).map(|event| json!([event.time_s, event.mode]));
    let marks = marks.collect::<Vec<_>>();
    let mut data = json!({ "curves": curves, "damage": damage, "colors": colors, "marks": marks });
    if let Some(what_if) = what_if {
        data["what_if"] = json!(what_if);
    }
    let warnings: Vec<&str> = list(summary, "warnings").filter_map(Value::as_str).collect();
    let interactive = |name: &str| curves.iter().any(|c: &Curves| c.charts.iter().any(|chart| chart.id == name));
    let figures: Vec<_> = folder.pictures.iter().map(|picture| figure(picture, interactive(&picture.name))).collect();
    let others: Vec<&str> = match &curves {
        Some(curves) => {
            let drawn = |id: &&str| !folder.pictures.iter().any(|picture| picture.name == *id);
            curves.charts.iter().map(|chart| chart.id).filter(drawn).collect()
        }
        None => Vec::new(),
    };

    let context = context! {
        title => text("title").unwrap_or("A run that was stopped"),
        version => text("version"),
        finished => folder.summary.is_some(),
        stopped => text("stopped"),
        cautions => any(list(summary, "cautions").filter_map(Value::as_str).collect::<Vec<_>>()),
        headline => any(Headline::new(summary)),
        tiles => any(tiles(summary)),
        warnings => any(warnings),
        sections => any(against.into_iter().chain(facts::sections(summary, "General")).collect::<Vec<_>>()),
        figures => any(figures),
        curves => curves.is_some(),
        charts => others,
        damage => !damage.is_null(),
        least => least,
        what_if => what_if.is_some(),
        no_what_if => what_if.and_then(|what_if| match what_if {
            WhatIf::Missing { why } => Some(why),
            WhatIf::Plate(_) => None,
        }),
        events => any(folder.events.as_ref().map(table)),
        modes => any(folder.modes.as_ref().map(table)),
        cost => any(folder.cost.as_ref().map(cost)),
        provenance => any(folder.cost.as_ref().and_then(|cost| cost.get("provenance"))),
        scene => folder.scene.as_deref(),
        deck => folder.deck.as_deref(),
    };
    fill(&data, context)
}

/// The page of a context, with its style, its scripts and their `data`.
pub(super) fn fill(data: &Value, context: Any) -> Result<String, Error> {
    let script = format!("(() => {{\n\"use strict\";\n{}}})();\n", SCRIPTS.join("\n"));
    let mut environment = Environment::new();
    environment.add_filter("with_code", with_code);
    environment.add_template("page.html", TEMPLATE)?;
    let own = context! {
        style_hash => hash(STYLE),
        style => Any::from_safe_string(STYLE.to_owned()),
        data => Any::from_safe_string(escape_json(data)),
        script_hash => hash(&script),
        script => Any::from_safe_string(script),
        ..context
    };
    Ok(environment.get_template("page.html")?.render(own)?)
}

/// A page with a `body` of its own: the style of all pages, a `script` after what their scripts share, the `data` of both.
pub(crate) fn standalone(title: &str, body: &str, script: &str, data: &Value) -> String {
    let script = format!("(() => {{\n\"use strict\";\n{}\n{script}}})();\n", SCRIPTS[0]);
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    let (style_hash, script_hash, data) = (hash(STYLE), hash(&script), escape_json(data));
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src '{style_hash}'; \
         script-src '{script_hash}'; img-src data:; base-uri 'none'; form-action 'none'\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<header><h1>{title}</h1></header>\n<main>\n{body}</main>\n\
         <script type=\"application/json\" id=\"data\">{data}</script>\n<script>{script}</script>\n</body>\n</html>\n"
    )
}

/// By which the policy of the page knows what it permits: the content of our own elements and nothing else.
fn hash(content: &str) -> String {
    format!("sha256-{}", STANDARD.encode(Sha256::digest(content)))
}

pub(super) fn any(value: impl Serialize) -> Any {
    Any::from(Serde(value))
}

fn list<'a>(summary: &'a Map<String, Value>, key: &str) -> impl Iterator<Item = &'a Value> + use<'a> {
    summary.get(key).and_then(Value::as_array).into_iter().flatten()
}

/// The first events of a summary.
fn first_damage(summary: &Map<String, Value>) -> impl Iterator<Item = EventRow> + use<'_> {
    list(summary, "first_damage").filter_map(|event| EventRow::deserialize(event).ok())
}

/// A message with what stands in backquotes set as code.
fn with_code(message: &str) -> Any {
    let mut html = String::new();
    for (number, part) in message.split('`').enumerate() {
        let escaped = HtmlEscape(part);
        html += &if number % 2 == 0 { escaped.to_string() } else { format!("<code>{escaped}</code>") };
    }
    Any::from_safe_string(html)
}

/// JSON that cannot end the element that it stands in.
fn escape_json(data: &Value) -> String {
    data.to_string().replace('<', "\\u003c")
}

fn figure(picture: &Picture, interactive: bool) -> Figure {
    let png = picture.png.as_ref().filter(|png| picture.svg.len() > LARGE_SVG && 4 * png.len() / 3 < picture.svg.len());
    let png = png.map(|png| format!("data:image/png;base64,{}", STANDARD.encode(png)));
    let svg = if png.is_some() { None } else { Some(Any::from_safe_string(picture.svg.clone())) };
    Figure { name: picture.name.clone(), caption: picture.caption.clone(), svg, png, interactive }
}

/// What is asked first of an impact.
fn tiles(summary: &Map<String, Value>) -> Vec<Fact> {
    let mut tiles = Vec::new();
    let mut tile = |label: &str, key: &str, value: Option<f64>| {
        tiles.extend(value.map(|v| Fact { label: label.into(), ..facts::fact(key, &v.into()) }));
    };
    let impacts: Vec<&Value> = match summary.get("impact") {
        Some(Value::Array(several)) => several.iter().collect(),
        one => one.into_iter().collect(),
    };
    for impact in impacts {
        let of = impact.get("name").and_then(Value::as_str).map_or(String::new(), |name| format!(", {name}"));
        let number = |key: &str| impact.get(key).and_then(Value::as_f64);
        for (label, key) in [
            ("impact energy", "energy_J"),
            ("peak force", "peak_force_N"),
            ("peak deflection", "peak_plate_displacement_m"),
            ("energy that the impactor lost", "absorbed_energy_J"),
        ] {
            tile(&format!("{label}{of}"), key, number(key));
        }
    }
    let first = first_damage(summary).map(|event| event.time_s).reduce(f64::min);
    tile("first damage", "time_s", first);
    if summary.get("first_damage").is_some() && first.is_none() {
        let judged = summary.get("not_reached").and_then(Value::as_array).is_some_and(|modes| !modes.is_empty());
        let value = if judged { "none" } else { "not looked for" };
        tiles.push(Fact { label: "first damage".into(), value: value.into(), unit: String::new() });
    }
    tiles
}

fn four(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// A CSV table; numbers have four significant digits.
fn table(table: &Table) -> Grid {
    let number = |text: &str| text.parse::<f64>().ok();
    let column = |(k, key): (usize, &String)| {
        let values = || table.rows.iter().map(|row| number(&row[k]));
        let (label, unit) = facts::split_unit(key);
        let (unit, factor) = unit.fit(values().flatten());
        (Column { label, unit: unit.to_owned(), numeric: values().all(|value| value.is_some()) }, factor)
    };
    let (columns, factors): (Vec<_>, Vec<f64>) = table.header.iter().enumerate().map(column).unzip();
    let field =
        |(text, factor): (&String, &f64)| number(text).map_or_else(|| text.clone(), |value| digits(value * factor));
    let rows = table.rows.iter().map(|row| row.iter().zip(&factors).map(field).collect()).collect();
    Grid { columns, rows }
}

/// Costs as facts and tables; what says how to run again stands elsewhere.
fn cost(cost: &Value) -> Vec<Section> {
    let mut fields = cost.as_object().cloned().unwrap_or_default();
    fields.remove("provenance");
    facts::sections(&fields, "")
}

/// The map for the page, and the index below which cells are left out of it.
fn damage(map: &DamageMap) -> (Value, f64) {
    let size = |value: &Value| value.to_string().len();
    let tries = LEAST.iter().map(|least| (compact(map, *least), *least));
    tries.reduce(|a, b| if size(&a.0) <= LARGE_MAP { a } else { b }).unwrap_or((Value::Null, 0.0))
}

/// The cells whose index reaches `least` somewhere, places in mm, the rest as in the file.
fn compact(map: &DamageMap, least: f64) -> Value {
    let reaches = |i: &usize| map.places.iter().any(|place| place.index[*i] >= least);
    let kept: Vec<usize> = (0..map.judged.len()).filter(reaches).collect();
    let mut position = vec![None; map.judged.len()];
    kept.iter().enumerate().for_each(|(new, old)| position[*old] = Some(new));
    let um = |v: f64| (v * 1e6).round() / 1e3;
    let cells = kept
        .iter()
        .map(|i| map.outline(map.judged[*i]).into_iter().map(|p| p.map(um)).collect::<Vec<_>>())
        .collect::<Vec<_>>();
    let tags = kept.iter().map(|i| map.cells[map.judged[*i] as usize]).collect::<Vec<_>>();
    let places = map.places.iter().map(|place| {
        let index: Vec<f64> = kept.iter().map(|i| four(place.index[*i]).min(1e9)).collect();
        let failed = place.failed.iter().filter_map(|f| Some(json!([position[f.0 as usize]?, f.1, f.2])));
        let mut place_of = json!({ "ply": place.ply, "index": index, "failed": failed.collect::<Vec<_>>() });
        if let Some(region) = &place.region {
            place_of["region"] = json!(region);
        }
        place_of
    });
    json!({
        "end_s": map.end_s, "modes": map.modes, "plies": map.plies, "cells": cells, "tags": tags,
        "impacts": map.impacts_m.iter().map(|p| p.map(um)).collect::<Vec<_>>(),
        "places": places.collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::with_code;

    #[test]
    fn code_in_messages_is_set_as_code_and_nothing_else_is_markup() {
        let of = |message: &str| with_code(message).to_string();
        assert_eq!(of("later than `march.end`, <b>"), "later than <code>march.end</code>, &lt;b&gt;");
        assert_eq!(of("`<i>` & one ` alone"), "<code>&lt;i&gt;</code> &amp; one <code> alone</code>");
    }
}
