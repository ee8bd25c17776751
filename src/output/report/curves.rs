//! The history as curves to move through.

use crate::effect::LedgerColumn;
use fem_core::plugin::Dimension;
use fem_io::plot::Axis;
use fem_io::results::Table;
use serde::Serialize;

/// Rows that a page keeps at most, but for the extremes of every curve, which it keeps all.
const ROWS: usize = 1200;

/// Curves over a common time.
#[derive(Debug, Serialize)]
pub(super) struct Curves {
    pub(super) time_unit: String,
    /// How many of that unit are a second.
    pub(super) per_s: f64,
    pub(super) times: Vec<f64>,
    pub(super) charts: Vec<Chart>,
}

/// Curves of one quantity.
#[derive(Debug, Serialize)]
pub(super) struct Chart {
    /// Name of the picture that shows the same.
    pub(super) id: &'static str,
    pub(super) quantity: &'static str,
    pub(super) unit: String,
    pub(super) series: Vec<Series>,
}

#[derive(Debug, Serialize)]
pub(super) struct Series {
    pub(super) name: String,
    pub(super) values: Vec<f64>,
}

/// A chart by its columns: which they are and what they show.
struct Kind {
    id: &'static str,
    quantity: &'static str,
    endings: &'static [(&'static str, &'static str)],
    of: Dimension,
}

const KINDS: [Kind; 4] = [
    Kind {
        id: "contact_force",
        quantity: "Contact force",
        endings: &[("contact_force_N", "contact force")],
        of: Dimension::FORCE,
    },
    Kind {
        id: "displacement",
        quantity: "Displacement",
        endings: &[("impactor_displacement_m", "impactor"), ("plate_displacement_m", "plate under the impactor")],
        of: Dimension::LENGTH,
    },
    Kind {
        id: "velocity",
        quantity: "Velocity",
        endings: &[("impactor_velocity_m_s", "impactor")],
        of: Dimension::VELOCITY,
    },
    Kind {
        id: "energy",
        quantity: "Energy",
        endings: &[
            ("impactor_kinetic_J", "impactor"),
            ("plate_strain_J", "plate, strain"),
            ("plate_kinetic_J", "plate, kinetic"),
            ("contact_stored_J", "contact"),
            ("contact_dissipated_J", "lost in the contact"),
        ],
        of: Dimension::ENERGY,
    },
];

/// The curves of `history.csv`, of which `effects` have these columns; the error is the column, row (from 1) and text that is not a finite number.
pub(super) fn curves(history: &Table, effects: &[&LedgerColumn]) -> Result<Option<Curves>, (String, usize, String)> {
    let columns = 0..history.header.len();
    let numbers = |k: usize| history.numbers(k).map_err(|(row, text)| (history.header[k].clone(), row, text));
    let values: Vec<Vec<f64>> = columns.map(numbers).collect::<Result<_, _>>()?;
    let Some(times) = history.header.iter().position(|name| name == "time_s").map(|k| &values[k]) else {
        return Ok(None);
    };
    let (time, second) = Axis::fitting("Time", Dimension::TIME, times.iter().copied());
    let kept = choose_rows(&values, times.len());
    let pick = |values: &[f64], unit: f64| kept.iter().map(|i| six_digits(values[*i] * unit)).collect::<Vec<_>>();
    let chart = |kind: &Kind| {
        let mut found: Vec<(String, &[f64])> = Vec::new();
        let of_effects = effects.iter().filter(|column| kind.id == "energy" && column.unit == "J");
        let of_effects = of_effects.map(|column| (column.name, column.label));
        for (ending, name) in kind.endings.iter().copied().chain(of_effects) {
            for (column, values) in history.header.iter().zip(&values) {
                let Some(impactor) = column.strip_suffix(ending) else { continue };
                let of = impactor.strip_suffix('.').map_or(String::new(), |impactor| format!(", {impactor}"));
                found.push((format!("{name}{of}"), values));
            }
        }
        let (axis, unit) = Axis::fitting(kind.quantity, kind.of, found.iter().flat_map(|f| f.1).copied());
        let series = found.into_iter().map(|(name, values)| Series { name, values: pick(values, unit) });
        Chart { id: kind.id, quantity: kind.quantity, unit: axis.unit, series: series.collect() }
    };
    let charts = KINDS.iter().map(chart).filter(|chart| !chart.series.is_empty()).collect();
    Ok(Some(Curves { time_unit: time.unit, per_s: second, times: pick(times, second), charts }))
}

/// Rows at equal distances, and those of the lowest and the highest value of every column, ascending.
fn choose_rows(columns: &[Vec<f64>], rows: usize) -> Vec<usize> {
    let stride = rows.div_ceil(ROWS).max(1);
    let extreme = |values: &Vec<f64>| {
        let better =
            |sign: f64| values.iter().enumerate().max_by(|a, b| (sign * a.1).total_cmp(&(sign * b.1))).map(|(i, _)| i);
        [better(1.0), better(-1.0)]
    };
    let extremes = columns.iter().flat_map(extreme).flatten();
    let mut kept: Vec<usize> = (0..rows).step_by(stride).chain(rows.checked_sub(1)).chain(extremes).collect();
    kept.sort_unstable();
    kept.dedup();
    kept
}

fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn table(rows: usize) -> Table {
        let header = ["time_s", "a.contact_force_N", "a.plate_displacement_m", "energy_balance_J"];
        let row = |i: usize| {
            let force = if i == 4321 { 99.0 } else { 1.0 };
            [i as f64 * 1e-6, force, 1e-3, 0.0].map(|v| v.to_string()).to_vec()
        };
        Table { header: header.map(str::to_owned).to_vec(), rows: (0..rows).map(row).collect() }
    }

    /// Curves of the page are in the colours of the pictures.
    #[test]
    fn colours_are_those_of_the_pictures() {
        let script = include_str!("charts.js");
        assert!((0..12).all(|k| script.contains(&fem_io::plot::curve_color(k))));
    }

    #[test]
    fn a_long_history_is_thinned_but_for_its_peak() {
        let curves = curves(&table(10_000), &[]).unwrap().unwrap();
        assert!((ROWS / 2..ROWS + 8).contains(&curves.times.len()), "{}", curves.times.len());
        assert_eq!((&*curves.time_unit, curves.times.last()), ("ms", Some(&9.999)));
        let names: Vec<_> = curves.charts.iter().map(|c| (c.id, c.series[0].name.as_str())).collect();
        assert_eq!(names, [("contact_force", "contact force, a"), ("displacement", "plate under the impactor, a")]);
        let peak = curves.charts[0].series[0].values.iter().position(|v| *v == 99.0).unwrap();
        assert_eq!((curves.times[peak], curves.charts[1].series[0].values[0]), (4.321, 1.0));
    }

    #[test]
    fn what_is_no_number_is_named() {
        let mut table = table(3);
        table.rows[1][2] = "NaN".into();
        assert_eq!(curves(&table, &[]).unwrap_err(), ("a.plate_displacement_m".to_owned(), 2, "NaN".to_owned()));
    }
}
