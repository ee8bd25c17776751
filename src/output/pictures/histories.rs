//! Curves of an impact.

use crate::effect::LedgerColumn;
use fem_core::plugin::Dimension;
use fem_io::plot::{Axis, LinePlot, MOST_CURVES, Series, Style, over_time};
use fem_io::tables::{HistoryRow, ImpactorRow};

/// Share of the largest energy below which a curve would lie on the axis.
const VISIBLE: f64 = 1e-3;

/// "plate under the impactor" of the only impactor, "plate, first" of the one called `first`.
fn label(what: &str, of: &str, name: &str) -> String {
    if name.is_empty() { format!("{what}{of}") } else { format!("{what}, {name}") }
}

/// Impactors by number and name, as they come: all of them, or as many as a picture can show with `curves` for each, those that press
/// hardest; and the title, which says so.
pub(super) fn shown<'a>(
    title: &str,
    names: &[&'a str],
    rows: &[HistoryRow],
    curves: usize,
) -> (String, Vec<(usize, &'a str)>) {
    let mut all: Vec<_> = names.iter().copied().enumerate().collect();
    let most = MOST_CURVES / curves;
    if all.len() <= most {
        return (title.to_owned(), all);
    }
    let peak = |i: usize| rows.iter().map(|row| row.impactors[i].contact_force_n).fold(0.0, f64::max);
    all.sort_by(|a, b| peak(b.0).total_cmp(&peak(a.0)));
    all.truncate(most);
    all.sort_unstable();
    (format!("{title} ({most} of {} impactors)", names.len()), all)
}

/// Displacement of each impactor and of the plate under it; the name of an only one is empty. `None` where nothing moves.
pub(super) fn displacement(title: &str, names: &[&str], rows: &[HistoryRow]) -> Option<LinePlot> {
    let (title, names) = shown(title, names, rows, 2);
    let curve = |i: usize, value: fn(&ImpactorRow) -> f64| -> Vec<_> {
        rows.iter().map(|row| (row.time_s, value(&row.impactors[i]))).collect()
    };
    let curves = names.iter().copied().flat_map(|(i, name)| {
        [
            Series::solid(label("impactor", "", name), curve(i, |r| r.impactor_displacement_m)),
            Series::solid(label("plate", " under the impactor", name), curve(i, |r| r.plate_displacement_m)),
        ]
    });
    unless_zero(over_time(&title, "Displacement", Dimension::LENGTH, curves.collect()))
}

/// Where the energy is, and its sum; what is lost counts. Parts too small to be seen are left out. `columns` are those of
/// effects.
pub(super) fn energy(title: &str, columns: &[&LedgerColumn], rows: &[HistoryRow]) -> Option<LinePlot> {
    let curve = |label: &str, value: fn(&HistoryRow) -> f64| {
        Series::solid(label, rows.iter().map(|row| (row.time_s, value(row))).collect())
    };
    let parts = vec![
        curve("impactor", |r| r.impactor_kinetic_j),
        curve("plate, strain", |r| r.plate_strain_j),
        curve("plate, kinetic", |r| r.plate_kinetic_j),
        curve("contact", |r| r.contact_stored_j),
        curve("lost in the contact", |r| r.contact_dissipated_j),
    ];
    let of_effects = columns.iter().enumerate().filter(|(_, column)| column.unit == "J").map(|(k, column)| {
        let points = rows.iter().map(|row| (row.time_s, row.effects[k])).collect();
        (column.counts, Series::solid(column.label.to_owned(), points))
    });
    let (counted, shares): (Vec<_>, Vec<_>) = of_effects.partition(|(counts, _)| *counts);
    let [counted, shares] = [counted, shares].map(|all| all.into_iter().map(|(_, curve)| curve));
    let parts: Vec<_> = parts.into_iter().chain(counted).collect();
    let size = |curve: &Series| curve.points.iter().fold(0.0_f64, |m, p| m.max(p.1.abs()));
    let largest = parts.iter().map(size).fold(0.0, f64::max);
    let sum = |i: usize| parts.iter().map(|part| part.points[i].1).sum();
    let total = rows.iter().enumerate().map(|(i, row)| (row.time_s, sum(i))).collect();
    let total = Series { label: "sum".into(), points: total, style: Style::Guide };
    let seen = parts.into_iter().chain(shares).filter(|part| size(part) > VISIBLE * largest);
    unless_zero(over_time(title, "Energy", Dimension::ENERGY, seen.chain([total]).collect()))
}

type Length = fn(&ImpactorRow) -> f64;

/// Contact force over the displacement of the plate, of the impactor and over the indentation, their difference.
pub(super) fn force_displacement(title: &str, names: &[&str], rows: &[HistoryRow]) -> Option<LinePlot> {
    let (title, names) = shown(title, names, rows, 3);
    let lengths: [(&str, &str, Length); 3] = [
        ("plate", " under the impactor", |r| r.plate_displacement_m),
        ("impactor", "", |r| r.impactor_displacement_m),
        ("indentation", "", |r| r.impactor_displacement_m - r.plate_displacement_m),
    ];
    // Out of contact there is no force to show; the ends of a contact are.
    let touches = |i: usize, k: usize| rows.get(k).is_some_and(|row| row.impactors[i].contact_force_n != 0.0);
    let near = |i: usize, k: usize| touches(i, k) || touches(i, k + 1) || k > 0 && touches(i, k - 1);
    let mut series = Vec::new();
    for (i, name) in names {
        for (what, of, length) in lengths {
            let points = rows.iter().enumerate().filter(|(k, _)| near(i, *k)).map(|(_, row)| &row.impactors[i]);
            let points: Vec<_> = points.map(|r| (length(r), r.contact_force_n)).collect();
            if !points.is_empty() {
                series.push(Series::solid(label(what, of, name), points));
            }
        }
    }
    let points = || series.iter().flat_map(|s| &s.points);
    let (x, length) = Axis::fitting("Displacement", Dimension::LENGTH, points().map(|p| p.0));
    let (y, force) = Axis::fitting("Contact force", Dimension::FORCE, points().map(|p| p.1));
    for p in series.iter_mut().flat_map(|s| &mut s.points) {
        *p = (p.0 * length, p.1 * force);
    }
    unless_zero(LinePlot { title, x, y, series, marks: Vec::new(), doubts: Vec::new() })
}

/// The plot if something of it differs from zero.
fn unless_zero(plot: LinePlot) -> Option<LinePlot> {
    let something = plot.series.iter().flat_map(|s| &s.points).any(|p| p.1 != 0.0);
    something.then_some(plot)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Row `k` of five: no contact at the ends, energies that sum to 4 J.
    fn row(k: u32) -> HistoryRow {
        let force = [0.0, 10.0, 20.0, 0.0, 0.0][k as usize];
        let t = f64::from(k) * 1e-4;
        HistoryRow {
            time_s: t,
            impactors: vec![ImpactorRow {
                contact_force_n: force,
                impactor_displacement_m: 3e-4 + t,
                impactor_velocity_m_s: 1.0,
                plate_displacement_m: t,
            }],
            impactor_kinetic_j: 4.0 - f64::from(k),
            plate_strain_j: f64::from(k) - 1e-5,
            contact_stored_j: 1e-5,
            ..HistoryRow::default()
        }
    }

    #[test]
    fn curves_are_what_their_names_say() {
        let rows: Vec<_> = (0..5).map(row).collect();
        let names = |plot: &LinePlot| plot.series.iter().map(|s| s.label.clone()).collect::<Vec<_>>();
        let plot = displacement("t", &[""], &rows).unwrap();
        assert_eq!(names(&plot), ["impactor", "plate under the impactor"]);
        assert_eq!(names(&displacement("t", &["a"], &rows).unwrap()), ["impactor, a", "plate, a"]);
        let plot = energy("t", &[], &rows).unwrap();
        assert_eq!(names(&plot), ["impactor", "plate, strain", "sum"], "what cannot be seen is left out");
        assert!(plot.series[2].points.iter().all(|p| (p.1 - 4.0).abs() < 1e-12), "but it counts: {plot:?}");
        let plot = force_displacement("t", &[""], &rows).unwrap();
        assert_eq!(names(&plot), ["plate under the impactor", "impactor", "indentation"]);
        let indentation: Vec<_> = plot.series[2].points.iter().map(|p| ((p.0 * 1e9).round() / 1e9, p.1)).collect();
        assert_eq!(indentation, [(0.3, 0.0), (0.3, 10.0), (0.3, 20.0), (0.3, 0.0)]);
    }

    #[test]
    fn of_more_impactors_than_curves_the_hardest_are_shown() {
        let force = |i: usize| ImpactorRow { contact_force_n: ((7 * i) % 15) as f64, ..ImpactorRow::default() };
        let rows = [HistoryRow { impactors: (0..15).map(force).collect(), ..row(1) }];
        let names: Vec<String> = (0..15).map(|i| i.to_string()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let (title, three) = shown("t", &names, &rows, 3);
        assert_eq!((title.as_str(), three.len()), ("t (13 of 15 impactors)", 13));
        // The forces 0 and 1 are those of numbers 0 and 13.
        assert!(three.iter().all(|(i, name)| *i != 0 && *i != 13 && *name == names[*i]), "{three:?}");
        assert_eq!(shown("t", &names, &rows, 2), ("t".to_owned(), names.iter().copied().enumerate().collect()));
    }

    #[test]
    fn nothing_to_show_is_not_shown() {
        let mut rows: Vec<_> = (0..5).map(row).collect();
        rows.iter_mut().for_each(|r| r.impactors[0].contact_force_n = 0.0);
        assert_eq!(force_displacement("t", &[""], &rows), None);
        assert_eq!(displacement("t", &[""], &[HistoryRow { impactors: vec![ImpactorRow::default()], ..row(0) }]), None);
    }
}
