//! Several runs on one page: their curves over each other, their results side by side, what differs in their scenes.

use super::curves::{Curves, overlaid};
use super::facts::{Column, Grid, Section};
use super::folder::Folder;
use super::measured::Measured;
use super::page;
use crate::error::Error;
use fem_core::plugin::{Dimension, digits};
use fem_io::scene;
use minijinja::context;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// What is compared of an impact: label, place in the summary, dimension.
const RESULTS: [(&str, &str, Dimension); 6] = [
    ("impact energy", "/impact/energy_J", Dimension::ENERGY),
    ("peak force", "/impact/peak_force_N", Dimension::FORCE),
    ("time of the peak", "/impact/peak_force_time_s", Dimension::TIME),
    ("peak deflection", "/impact/peak_plate_displacement_m", Dimension::LENGTH),
    ("first damage", "/first_damage/0/time_s", Dimension::TIME),
    ("unknowns", "/model/unknowns", Dimension::NONE),
];

/// The page of `folders`, at least two.
pub(super) fn render(folders: &[Folder], measured: Option<&Measured>) -> Result<String, Error> {
    let names = names(folders);
    let runs = names.iter().zip(folders).filter_map(|(name, folder)| Some((name.as_str(), folder.history.as_ref()?)));
    let curves: Option<Curves> = overlaid(&runs.collect::<Vec<_>>(), measured);
    let mut sections = vec![results(&names, folders), scenes(&names, folders)];
    if let Some(measured) = measured {
        for (name, folder) in names.iter().zip(folders) {
            let force = folder.history.as_ref().map(super::curves::force);
            sections.extend(force.and_then(|force| measured.against(&force)).map(|section| Section {
                id: format!("measured-{name}"),
                heading: format!("{name}: {}", section.heading),
                ..section
            }));
        }
    }
    let charts: Vec<_> = curves.iter().flat_map(|curves| &curves.charts).map(|chart| chart.id).collect();
    let data = json!({ "curves": curves, "damage": Value::Null, "colors": [], "marks": [] });
    page::fill(
        &data,
        context! {
            title => format!("{} runs compared: {}", folders.len(), names.join(", ")),
            compared => true,
            finished => true,
            sections => page::any(sections),
            curves => curves.is_some(),
            charts => charts,
        },
    )
}

/// Names of the folders, or their paths where two have one name.
fn names(folders: &[Folder]) -> Vec<String> {
    let name = |folder: &Folder| folder.path.file_name().map(|name| name.to_string_lossy().into_owned());
    let short: Vec<_> = folders.iter().map(|folder| name(folder).unwrap_or_default()).collect();
    let alone = |i: usize| !short[i].is_empty() && short.iter().filter(|other| **other == short[i]).count() == 1;
    (0..folders.len())
        .map(|i| if alone(i) { short[i].clone() } else { folders[i].path.display().to_string() })
        .collect()
}

fn grid(first: &str, names: &[String], rows: Vec<Vec<String>>) -> Option<Grid> {
    let column = |label: &str, numeric| Column { label: label.to_owned(), unit: String::new(), numeric };
    let columns = [column(first, false)].into_iter().chain(names.iter().map(|name| column(name, true))).collect();
    (!rows.is_empty()).then_some(Grid { columns, rows })
}

fn results(names: &[String], folders: &[Folder]) -> Section {
    let row = |(label, path, dimension): &(&str, &str, Dimension)| {
        let value = |folder: &Folder| folder.summary.as_ref()?.pointer(path)?.as_f64();
        let values: Vec<_> = folders.iter().map(value).collect();
        let first = values.first().copied().flatten();
        let shown = |(i, value): (usize, &Option<f64>)| match (value, first) {
            (None, _) => String::new(),
            (Some(value), Some(first)) if i > 0 && first != 0.0 && *value != first => {
                format!("{} ({:+.2} %)", dimension.of(*value), 100.0 * (value / first - 1.0))
            }
            (Some(value), _) => dimension.of(*value),
        };
        let each = values.iter().enumerate().map(shown);
        let row: Vec<_> = [(*label).to_owned()].into_iter().chain(each).collect();
        values.iter().any(Option::is_some).then_some(row)
    };
    let doubts = |folder: &Folder| {
        let count = |key: &str| folder.summary.as_ref()?.get(key)?.as_array().map(Vec::len);
        digits((count("cautions").unwrap_or(0) + count("warnings").unwrap_or(0)) as f64)
    };
    let doubts = ["cautions and warnings".to_owned()].into_iter().chain(folders.iter().map(doubts)).collect();
    let rows = RESULTS.iter().filter_map(row).chain([doubts]).collect();
    Section { id: "compared".into(), heading: "Results".into(), facts: Vec::new(), table: grid("result", names, rows) }
}

/// Keys whose values differ; what a scene leaves to its preset is empty.
fn scenes(names: &[String], folders: &[Folder]) -> Section {
    let keys = |folder: &Folder| folder.scene.as_deref().and_then(|text| scene::keys(text).ok()).unwrap_or_default();
    let each: Vec<BTreeMap<String, String>> = folders.iter().map(keys).collect();
    let all: std::collections::BTreeSet<&String> = each.iter().flat_map(BTreeMap::keys).collect();
    let differ = |key: &&String| each.iter().any(|keys| keys.get(*key) != each[0].get(*key));
    let row = |key: &String| {
        let values = each.iter().map(|keys| keys.get(key).cloned().unwrap_or_default());
        [key.clone()].into_iter().chain(values).collect()
    };
    let rows: Vec<_> = all.into_iter().filter(differ).map(row).collect();
    let heading = if rows.is_empty() { "Their scenes do not differ" } else { "What differs in their scenes" };
    Section { id: "scenes".into(), heading: heading.into(), facts: Vec::new(), table: grid("key", names, rows) }
}
