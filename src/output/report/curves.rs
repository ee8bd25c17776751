//! The history as curves to move through.

use super::measured::{Measured, at};
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
    /// How many of that unit are one in SI units.
    #[serde(skip)]
    per_si: f64,
    pub(super) series: Vec<Series>,
}

#[derive(Debug, Serialize)]
pub(super) struct Series {
    pub(super) name: String,
    /// At the times; none where the curve has ended.
    pub(super) values: Vec<Option<f64>>,
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
        let some = |values: Vec<f64>| values.into_iter().map(Some).collect();
        let series = found.into_iter().map(|(name, values)| Series { name, values: some(pick(values, unit)) });
        Chart { id: kind.id, quantity: kind.quantity, unit: axis.unit, per_si: unit, series: series.collect() }
    };
    let charts = KINDS.iter().map(chart).filter(|chart| !chart.series.is_empty()).collect();
    Ok(Some(Curves { time_unit: time.unit, per_s: second, times: pick(times, second), charts }))
}

impl Curves {
    /// Adds a measured force to the computed one.
    pub(super) fn lay_over(&mut self, measured: &Measured) {
        let times: Vec<f64> = self.times.iter().map(|t| t / self.per_s).collect();
        for chart in self.charts.iter_mut().filter(|chart| chart.id == FORCE) {
            let value = |t: &f64| at(&measured.points, *t).map(|force| six_digits(force * chart.per_si));
            let values = times.iter().map(value).collect();
            chart.series.push(Series { name: "measured".into(), values });
        }
    }
}

/// The chart of the contact force.
const FORCE: &str = "contact_force";

/// What runs are compared by: chart, quantity, column, dimension.
const COMPARED: [(&str, &str, &str, Dimension); 3] = [
    (FORCE, "Contact force", "contact_force_N", Dimension::FORCE),
    ("displacement", "Plate under the impactor", "plate_displacement_m", Dimension::LENGTH),
    ("energy", "Energy of the impactor", "impactor_kinetic_J", Dimension::ENERGY),
];

/// Points (s, SI unit) of the sum of all columns of a history that end in `ending`.
fn points(history: &Table, ending: &str) -> Vec<(f64, f64)> {
    let column = |k: usize| history.numbers(k).unwrap_or_default();
    let Some(times) = history.header.iter().position(|name| name == "time_s").map(column) else { return Vec::new() };
    let all = history.header.iter().enumerate().filter(|(_, name)| name.ends_with(ending));
    let all: Vec<Vec<f64>> = all.map(|(k, _)| column(k)).collect();
    if all.is_empty() {
        return Vec::new();
    }
    let sum = |i: usize| all.iter().filter_map(|values| values.get(i)).sum();
    times.iter().enumerate().map(|(i, t)| (*t, sum(i))).collect()
}

/// The contact force of all impactors, s and N.
pub(super) fn force(history: &Table) -> Vec<(f64, f64)> {
    points(history, "contact_force_N")
}

/// Histories of several runs over a common time; `None` where there are none.
pub(super) fn overlaid(runs: &[(&str, &Table)], measured: Option<&Measured>) -> Option<Curves> {
    let end = |history: &Table| force(history).last().map_or(0.0, |p| p.0);
    let end = runs.iter().map(|(_, history)| end(history)).fold(0.0, f64::max);
    let times: Vec<f64> = (0..=ROWS).map(|i| end * i as f64 / ROWS as f64).collect();
    let chart = |(id, quantity, ending, of): &(&'static str, &'static str, &str, Dimension)| {
        let each: Vec<_> = runs.iter().map(|(name, history)| (*name, points(history, ending))).collect();
        let (axis, per_si) = Axis::fitting(quantity, *of, each.iter().flat_map(|(_, points)| points).map(|p| p.1));
        let series = each.iter().filter(|(_, points)| !points.is_empty()).map(|(name, points)| Series {
            name: (*name).to_owned(),
            values: times.iter().map(|t| at(points, *t).map(|value| six_digits(value * per_si))).collect(),
        });
        Chart { id, quantity, unit: axis.unit, per_si, series: series.collect() }
    };
    let charts: Vec<_> = COMPARED.iter().map(chart).filter(|chart| !chart.series.is_empty()).collect();
    let (time, per_s) = Axis::fitting("Time", Dimension::TIME, times.iter().copied());
    let shown = times.iter().map(|t| six_digits(t * per_s)).collect();
    let mut curves = Curves { time_unit: time.unit, per_s, times: shown, charts };
    if let Some(measured) = measured {
        curves.lay_over(measured);
    }
    (end > 0.0).then_some(curves)
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
        let peak = curves.charts[0].series[0].values.iter().position(|v| *v == Some(99.0)).unwrap();
        assert_eq!((curves.times[peak], curves.charts[1].series[0].values[0]), (4.321, Some(1.0)));
    }

    #[test]
    fn what_is_no_number_is_named() {
        let mut table = table(3);
        table.rows[1][2] = "NaN".into();
        assert_eq!(curves(&table, &[]).unwrap_err(), ("a.plate_displacement_m".to_owned(), 2, "NaN".to_owned()));
    }
}
