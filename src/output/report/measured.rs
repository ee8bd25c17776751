//! A force that was measured, laid over a computed one.

use super::facts::{Column, Grid, Section};
use crate::error::Error;
use fem_core::plugin::{Dimension, digits};
use fem_io::results::{damaged, read_text};
use fem_io::units::parse_quantity;
use std::path::Path;

/// Forces over time, N and s.
#[derive(Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) points: Vec<(f64, f64)>,
}

impl Measured {
    /// Reads a table of two columns or more whose header names the units: `time_ms,force_kN` or `t (ms); F (kN)`.
    ///
    /// # Errors
    /// A file that cannot be read; no column of times or forces; what is not a finite number; times that do not grow.
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let text = read_text(path)?.ok_or_else(|| damaged(path, "there is no such file".into()))?;
        Self::parse(&text).map_err(|why| damaged(path, why).into())
    }

    fn parse(text: &str) -> Result<Self, String> {
        let mut lines = text.lines().map(str::trim).enumerate().filter(|(_, line)| !line.is_empty());
        let (_, header) = lines.next().ok_or("it is empty")?;
        let separator = [';', '\t', ','].into_iter().find(|c| header.contains(*c)).unwrap_or(',');
        let units: Vec<_> = header.split(separator).map(unit).collect();
        let column = |wanted: Dimension, what: &str| {
            let found = units.iter().position(|unit| unit.is_some_and(|(_, found)| found.matches(&wanted)));
            let help = "name the units in the first line, for example `time_ms,force_kN`";
            let at = found.ok_or_else(|| format!("no column of its first line has a unit of {what}: {help}"))?;
            Ok::<_, String>((at, units[at].map_or(1.0, |(size, _)| size)))
        };
        let (time, force) = (column(Dimension::TIME, "time")?, column(Dimension::FORCE, "force")?);
        let mut points: Vec<(f64, f64)> = Vec::new();
        for (number, line) in lines {
            let fields: Vec<&str> = line.split(separator).map(str::trim).collect();
            let value = |(at, size): (usize, f64)| {
                let field = fields.get(at).copied().unwrap_or_default();
                let value = field.parse::<f64>().ok().filter(|value| value.is_finite());
                value.map(|value| value * size).ok_or(format!("line {}: `{field}` is not a finite number", number + 1))
            };
            let point = (value(time)?, value(force)?);
            if points.last().is_some_and(|last| last.0 >= point.0) {
                return Err(format!("line {}: times must grow", number + 1));
            }
            points.push(point);
        }
        if points.len() < 2 { Err("it has fewer than two rows".into()) } else { Ok(Self { points }) }
    }

    /// How a computed force differs from it, while both are known; `None` where they are never.
    pub(super) fn against(&self, computed: &[(f64, f64)]) -> Option<Section> {
        let both: Vec<_> = self.points.iter().filter_map(|(t, m)| Some((*t, *m, at(computed, *t)?))).collect();
        let sum = |of: fn(&(f64, f64, f64)) -> f64| {
            both.windows(2).map(|w| 0.5 * (w[1].0 - w[0].0) * (of(&w[0]) + of(&w[1]))).sum::<f64>()
        };
        let peak = |of: fn(&(f64, f64, f64)) -> f64| {
            both.iter().map(|row| (row.0, of(row))).reduce(|a, b| if b.1 > a.1 { b } else { a })
        };
        let (measured, found) = (peak(|row| row.1)?, peak(|row| row.2)?);
        let impulses = [sum(|row| row.1), sum(|row| row.2)];
        let distance = (sum(|row| (row.2 - row.1).powi(2)) / sum(|row| row.1.powi(2))).sqrt();
        let impulse = |value: f64| format!("{} N s", digits(value));
        let row = |label: &str, [m, c]: [f64; 2], shown: &dyn Fn(f64) -> String| {
            vec![label.to_owned(), shown(m), shown(c), format!("{} %", digits(100.0 * (c - m) / m))]
        };
        let rows = vec![
            row("peak force", [measured.1, found.1], &|v| Dimension::FORCE.of(v)),
            row("time of the peak", [measured.0, found.0], &|v| Dimension::TIME.of(v)),
            row("impulse", impulses, &impulse),
            vec!["force over time, L2".into(), String::new(), String::new(), format!("{} %", digits(100.0 * distance))],
        ];
        let column = |label: &str| Column { label: label.into(), unit: String::new(), numeric: label != "result" };
        let columns = ["result", "measured", "computed", "difference"].map(column).to_vec();
        let heading = "Against what was measured, while both are known".into();
        Some(Section { id: "measured".into(), heading, facts: Vec::new(), table: Some(Grid { columns, rows }) })
    }
}

/// The value of a curve at `t` by a straight line between its points; `None` outside of them.
pub(super) fn at(points: &[(f64, f64)], t: f64) -> Option<f64> {
    let next = points.partition_point(|p| p.0 < t);
    let b = points.get(next)?;
    match next.checked_sub(1).map(|i| points[i]) {
        Some(a) => Some(a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0)),
        None => (b.0 == t).then_some(b.1),
    }
}

/// Size in SI units and dimension of the unit that a name of a column ends with.
fn unit(name: &str) -> Option<(f64, Dimension)> {
    let name = name.trim().trim_matches('"').trim_end_matches([')', ']']);
    let unit = name.rsplit(['(', '[', '_', '/']).next()?;
    parse_quantity(&format!("1 {}", unit.trim())).ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn units_are_those_of_the_header() {
        let want = Measured { points: vec![(0.0, 0.0), (1e-3, 2e3)] };
        for text in
            ["time_ms,force_kN\n0,0\n1,2\n", "F (kN);t (ms)\n0;0\n2;1", "n\tt [s]\tF [N]\n1\t0\t0\n2\t1e-3\t2000\n"]
        {
            assert_eq!(Measured::parse(text).unwrap(), want, "{text}");
        }
        for (text, words) in [
            ("", "empty"),
            ("time,force_N\n0,0\n1,1\n", "unit of time"),
            ("time_s,force_N\n0,0\n1,x\n", "line 3: `x`"),
            ("time_s,force_N\n0,0\n0,1\n", "line 3: times must grow"),
            ("time_s,force_N\n0,0\n", "two rows"),
        ] {
            let why = Measured::parse(text).unwrap_err();
            assert!(why.contains(words), "{why}");
        }
    }

    /// Half a sine against one a tenth as large again.
    #[test]
    fn differences_are_those_of_the_curves() {
        let sine = |factor: f64| {
            (0..=100)
                .map(|i| f64::from(i) * 1e-5)
                .map(|t| (t, factor * (t * std::f64::consts::PI * 1e3).sin()))
                .collect()
        };
        let measured = Measured { points: sine(1000.0) };
        let computed: Vec<_> = sine(1100.0);
        let rows = measured.against(&computed).unwrap().table.unwrap().rows;
        assert_eq!(rows[0], ["peak force", "1000 N", "1100 N", "10 %"]);
        assert_eq!([&rows[1][3], &rows[2][3], &rows[3][3]], ["0 %", "10 %", "10 %"]);
        assert_eq!(at(&computed, 2.0), None);
    }
}
