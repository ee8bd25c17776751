//! Quantities over time.

use super::{Axis, LinePlot, Mark, PlotError, Series, Style};

/// What is shown over time, by its unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Physical {
    /// m, shown in µm up to a tenth of a millimetre, else in mm.
    Length,
    /// N, shown in kN from one kilonewton on.
    Force,
    /// J, shown in mJ up to a tenth of a joule, else in J.
    Energy,
    /// A pure number.
    Number,
}

impl Physical {
    /// Unit for values up to `largest` in SI units, and how many of it are one of these.
    pub fn unit(self, largest: f64) -> (&'static str, f64) {
        match self {
            Self::Length if largest < 1e-4 => ("µm", 1e6),
            Self::Length => ("mm", 1e3),
            Self::Force if largest < 1e3 => ("N", 1.0),
            Self::Force => ("kN", 1e-3),
            Self::Energy if largest < 0.1 => ("mJ", 1e3),
            Self::Energy => ("J", 1.0),
            Self::Number => ("", 1.0),
        }
    }
}

/// Unit for times up to `longest`, s, and how many of it are a second: µs up to one millisecond, else ms.
pub fn unit_of_time(longest: f64) -> (&'static str, f64) {
    if longest <= 1.000_001e-3 { ("µs", 1e6) } else { ("ms", 1e3) }
}

/// Curves of `quantity` under the heading `title`: names, points (time in s, value in SI units) and how they are drawn.
pub fn over_time(title: &str, quantity: &str, kind: Physical, curves: Vec<Series>) -> LinePlot {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let (time_unit, per_s) = unit_of_time(largest(points().map(|p| p.0)));
    let (unit, per_si) = kind.unit(largest(points().map(|p| p.1)));
    let shown = |curve: &Series| Series {
        points: curve.points.iter().map(|(t, v)| (t * per_s, v * per_si)).collect(),
        label: curve.label.clone(),
        style: curve.style,
    };
    LinePlot {
        title: title.to_owned(),
        x: Axis::linear("Time", time_unit),
        y: Axis::linear(quantity, unit),
        series: curves.iter().map(shown).collect(),
        marks: Vec::new(),
        doubts: Vec::new(),
    }
}

impl Series {
    /// A curve drawn as a line.
    pub fn solid(label: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { label: label.into(), points, style: Style::Solid }
    }
}

/// Events that [`force_history`] names; a last mark counts those after them.
const NAMED_EVENTS: usize = 12;

/// Contact forces over time under the heading `title`, by name, with `events` (time in s, name) marked on the highest.
///
/// # Errors
/// Unequal numbers of times and forces.
pub fn force_history(
    title: &str,
    times_s: &[f64],
    forces_n: &[(&str, Vec<f64>)],
    events: &[(f64, String)],
) -> Result<LinePlot, PlotError> {
    if let Some((_, forces)) = forces_n.iter().find(|(_, forces)| forces.len() != times_s.len()) {
        return Err(PlotError::Lengths { times: times_s.len(), forces: forces.len() });
    }
    let points = |forces: &[f64]| times_s.iter().copied().zip(forces.iter().copied()).collect();
    let curves = forces_n.iter().map(|(label, forces)| Series::solid(*label, points(forces)));
    let plot = over_time(title, "Contact force", Physical::Force, curves.collect());

    let (unit, per_s) = unit_of_time(largest(times_s.iter().copied()));
    let mut events: Vec<_> = events.iter().map(|(t, name)| (t * per_s, name)).collect();
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let height = |x: f64| plot.series.iter().map(|curve| height_at(&curve.points, x)).reduce(f64::max).unwrap_or(0.0);
    let mark = |x: f64, label: String| Mark { x, y: height(x), label };
    let named = events.iter().take(NAMED_EVENTS);
    let mut marks: Vec<_> = named.map(|(x, name)| mark(*x, format!("{name}, {} {unit}", three_digits(*x)))).collect();
    if let Some((x, _)) = events.get(NAMED_EVENTS) {
        marks.push(mark(*x, format!("{} later events", events.len() - NAMED_EVENTS)));
    }
    Ok(LinePlot { marks, ..plot })
}

/// Indices from here on are not drawn.
const INDEX_DRAWN: f64 = 1e100;

/// Failure indices over time under the heading `title`: for every name its points (time in s, index), and a dashed line at
/// 1. A point whose index is infinite is left out.
pub fn index_history(title: &str, curves: &[(String, Vec<(f64, f64)>)]) -> LinePlot {
    let last = largest(curves.iter().flat_map(|(_, points)| points.iter().map(|p| p.0)));
    let failure = Series { label: "failure".into(), points: vec![(0.0, 1.0), (last, 1.0)], style: Style::Dashed };
    let finite = |points: &[(f64, f64)]| points.iter().copied().filter(|p| p.1 < INDEX_DRAWN).collect();
    let curves = curves.iter().map(|(label, points)| Series::solid(label, finite(points)));
    let curves = curves.filter(|series| !series.points.is_empty()).chain([failure]);
    over_time(title, "Failure index", Physical::Number, curves.collect())
}

/// A deflection over time under the heading `title` with its parts by mode: names and points (time in s, deflection in m).
pub fn modal_history(title: &str, sum: Vec<(f64, f64)>, parts: Vec<(String, Vec<(f64, f64)>)>) -> LinePlot {
    let sum = Series { label: "all modes".into(), points: sum, style: Style::Dashed };
    let parts = parts.into_iter().map(|(label, points)| Series::solid(label, points));
    over_time(title, "Deflection under the impactor", Physical::Length, [sum].into_iter().chain(parts).collect())
}

/// The largest magnitude, 0 of none.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m, v| m.max(v.abs()))
}

/// Height of the curve at `x`, between its points by a straight line; the end's height beyond an end.
fn height_at(points: &[(f64, f64)], x: f64) -> f64 {
    let next = points.partition_point(|p| p.0 < x);
    match (next.checked_sub(1).map(|i| points[i]), points.get(next).copied()) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0),
        (Some(end), None) | (None, Some(end)) => end.1,
        (None, None) => 0.0,
    }
}

/// `x` to three significant digits, never fewer than its whole ones.
fn three_digits(x: f64) -> String {
    let whole = if x == 0.0 { 1.0 } else { x.abs().log10().floor() + 1.0 };
    format!("{x:.*}", (3.0 - whole).clamp(0.0, 12.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::super::line_plot;
    use super::*;

    #[test]
    fn units_suit_the_values() {
        let shown = |kind, value| {
            let plot =
                over_time("title", "quantity", kind, vec![Series::solid("one", vec![(0.0, 0.0), (2e-3, value)])]);
            (plot.x.unit, plot.y.unit, plot.series[0].points[1])
        };
        assert_eq!(shown(Physical::Length, -5e-5), ("ms".into(), "µm".into(), (2.0, -50.0)));
        assert_eq!(shown(Physical::Length, 2e-3), ("ms".into(), "mm".into(), (2.0, 2.0)));
        assert_eq!(shown(Physical::Energy, 0.05), ("ms".into(), "mJ".into(), (2.0, 50.0)));
        assert_eq!(shown(Physical::Energy, 3.0), ("ms".into(), "J".into(), (2.0, 3.0)));
        assert_eq!(unit_of_time(1e-3), ("µs", 1e6));
    }

    #[test]
    fn a_force_history_chooses_its_units_and_puts_events_on_the_curve() {
        let small =
            force_history("title", &[0.0, 1e-3], &[("force", vec![0.0, 900.0])], &[(2.5e-4, "shear".into())]).unwrap();
        assert_eq!((small.x.unit.as_str(), small.y.unit.as_str()), ("µs", "N"));
        assert_eq!(small.marks, [Mark { x: 250.0, y: 225.0, label: "shear, 250 µs".into() }]);

        let large = force_history(
            "title",
            &[0.0, 2e-3],
            &[("force", vec![0.0, 4000.0])],
            &[(1.5e-3, "b".into()), (5e-5, "a".into())],
        )
        .unwrap();
        assert_eq!((large.x.unit.as_str(), large.y.unit.as_str()), ("ms", "kN"));
        let labels: Vec<_> = large.marks.iter().map(|m| m.label.as_str()).collect();
        assert_eq!(labels, ["a, 0.0500 ms", "b, 1.50 ms"]);
        assert!((large.marks[1].y - 3.0).abs() < 1e-12);
    }

    #[test]
    fn an_index_history_shows_every_curve_and_where_failure_is() {
        let curves = [
            ("a".to_owned(), vec![(0.0, 0.0), (1e-3, 4.0)]),
            ("b".to_owned(), vec![(0.0, 0.5), (5e-4, f64::INFINITY), (1e-3, 2.0)]),
            ("c".to_owned(), vec![(0.0, f64::INFINITY)]),
        ];
        let plot = index_history("title", &curves);
        assert_eq!((plot.x.unit.as_str(), plot.y.label.as_str()), ("µs", "Failure index"));
        let drawn: Vec<_> = plot.series.iter().map(|s| (s.label.as_str(), s.points.clone(), s.style)).collect();
        let line = |points: [(f64, f64); 2]| points.to_vec();
        let want = [
            ("a", line([(0.0, 0.0), (1e3, 4.0)]), Style::Solid),
            ("b", line([(0.0, 0.5), (1e3, 2.0)]), Style::Solid),
            ("failure", line([(0.0, 1.0), (1e3, 1.0)]), Style::Dashed),
        ];
        assert_eq!(drawn, want);
        assert!(line_plot(&plot).unwrap().svg.contains(">failure</text>"));
    }

    #[test]
    fn a_modal_history_shows_the_sum_dashed_and_the_parts_solid() {
        let points = |w: f64| vec![(0.0, 0.0), (2e-3, w)];
        let plot = modal_history("title", points(1e-3), vec![("mode 1".into(), points(5e-4))]);
        assert_eq!((plot.x.unit.as_str(), plot.y.unit.as_str()), ("ms", "mm"));
        let drawn: Vec<_> = plot.series.iter().map(|s| (s.label.as_str(), s.points[1], s.style)).collect();
        assert_eq!(drawn, [("all modes", (2.0, 1.0), Style::Dashed), ("mode 1", (2.0, 0.5), Style::Solid)]);
        assert_eq!(modal_history("title", points(5e-5), Vec::new()).y.unit, "µm");
    }

    #[test]
    fn events_beyond_the_first_dozen_are_counted() {
        let events: Vec<_> = (0..30).map(|i| (f64::from(i) * 1e-5, "x".to_owned())).collect();
        let marks = force_history("title", &[0.0, 1e-3], &[("force", vec![0.0, 1.0])], &events).unwrap().marks;
        assert_eq!((marks.len(), marks[12].label.as_str()), (13, "18 later events"));
        assert!(
            line_plot(&force_history("title", &[0.0, 1e-3], &[("force", vec![0.0, 1.0])], &events).unwrap()).is_ok()
        );
    }

    #[test]
    fn a_force_history_refuses_what_does_not_fit() {
        assert_eq!(
            force_history("title", &[0.0], &[("force", vec![])], &[]),
            Err(PlotError::Lengths { times: 1, forces: 0 })
        );
        for (t, f, event) in [(f64::NAN, 1.0, 0.0), (1.0, f64::INFINITY, 0.0), (1.0, 1.0, f64::NAN)] {
            let plot = force_history("title", &[0.0, t], &[("force", vec![0.0, f])], &[(event, "x".into())]).unwrap();
            assert!(matches!(line_plot(&plot), Err(PlotError::NonFinite { .. })));
        }
    }
}
