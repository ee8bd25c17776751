//! Quantities over time.

use super::{Axis, LinePlot, Mark, PlotError, Series, Style};
use fem_core::plugin::Dimension;

/// Curves of `quantity` under the heading `title`: names, points (time in s, value in SI units) and how they are drawn.
pub fn over_time(title: &str, quantity: &str, of: Dimension, curves: Vec<Series>) -> LinePlot {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let (time, x) = Axis::fitting("Time", Dimension::TIME, points().map(|p| p.0));
    let (value, y) = Axis::fitting(quantity, of, points().map(|p| p.1));
    let shown = |curve: &Series| Series {
        points: curve.points.iter().map(|(t, v)| (t * x, v * y)).collect(),
        label: curve.label.clone(),
        style: curve.style,
    };
    LinePlot {
        title: title.to_owned(),
        x: time,
        y: value,
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
    let plot = over_time(title, "Contact force", Dimension::FORCE, curves.collect());

    let (_, unit) = Axis::fitting("Time", Dimension::TIME, times_s.iter().copied());
    let mut events: Vec<_> = events.iter().collect();
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let height = |x: f64| plot.series.iter().map(|curve| height_at(&curve.points, x)).reduce(f64::max).unwrap_or(0.0);
    let mark = |t: f64, label: String| Mark { x: t * unit, y: height(t * unit), label };
    let named = events.iter().take(NAMED_EVENTS);
    let mut marks: Vec<_> = named.map(|(t, name)| mark(*t, format!("{name}, {}", Dimension::TIME.of(*t)))).collect();
    if let Some((t, _)) = events.get(NAMED_EVENTS) {
        marks.push(mark(*t, format!("{} later events", events.len() - NAMED_EVENTS)));
    }
    Ok(LinePlot { marks, ..plot })
}

/// Indices from here on are not drawn.
const INDEX_DRAWN: f64 = 1e100;

/// Failure indices over time under the heading `title`: for every name its points (time in s, index), and a dashed line at
/// 1. A point whose index is infinite is left out.
pub fn index_history(title: &str, curves: &[(String, Vec<(f64, f64)>)]) -> LinePlot {
    let last = curves.iter().flat_map(|(_, points)| points.iter().map(|p| p.0)).fold(0.0, f64::max);
    let failure = Series { label: "failure".into(), points: vec![(0.0, 1.0), (last, 1.0)], style: Style::Dashed };
    let finite = |points: &[(f64, f64)]| points.iter().copied().filter(|p| p.1 < INDEX_DRAWN).collect();
    let curves = curves.iter().map(|(label, points)| Series::solid(label, finite(points)));
    let curves = curves.filter(|series| !series.points.is_empty()).chain([failure]);
    over_time(title, "Failure index", Dimension::NONE, curves.collect())
}

/// A deflection over time under the heading `title` with its parts by mode: names and points (time in s, deflection in m).
pub fn modal_history(title: &str, sum: Vec<(f64, f64)>, parts: Vec<(String, Vec<(f64, f64)>)>) -> LinePlot {
    let sum = Series { label: "all modes".into(), points: sum, style: Style::Dashed };
    let parts = parts.into_iter().map(|(label, points)| Series::solid(label, points));
    over_time(title, "Deflection under the impactor", Dimension::LENGTH, [sum].into_iter().chain(parts).collect())
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
        assert_eq!(shown(Dimension::LENGTH, -5e-5), ("ms".into(), "um".into(), (2.0, -50.0)));
        assert_eq!(shown(Dimension::LENGTH, 2e-3), ("ms".into(), "mm".into(), (2.0, 2.0)));
        assert_eq!(shown(Dimension::ENERGY, 0.05), ("ms".into(), "mJ".into(), (2.0, 50.0)));
        assert_eq!(shown(Dimension::ENERGY, 3.0), ("ms".into(), "J".into(), (2.0, 3.0)));
    }

    #[test]
    fn a_force_history_chooses_its_units_and_puts_events_on_the_curve() {
        let small =
            force_history("title", &[0.0, 1e-3], &[("force", vec![0.0, 900.0])], &[(2.5e-4, "shear".into())]).unwrap();
        assert_eq!((small.x.unit.as_str(), small.y.unit.as_str()), ("ms", "N"));
        assert_eq!(small.marks, [Mark { x: 0.25, y: 225.0, label: "shear, 0.25 ms".into() }]);

        let large = force_history(
            "title",
            &[0.0, 2e-3],
            &[("force", vec![0.0, 40_000.0])],
            &[(1.5e-3, "b".into()), (5e-5, "a".into())],
        )
        .unwrap();
        assert_eq!((large.x.unit.as_str(), large.y.unit.as_str()), ("ms", "kN"));
        let labels: Vec<_> = large.marks.iter().map(|m| m.label.as_str()).collect();
        assert_eq!(labels, ["a, 50 us", "b, 1.5 ms"]);
        assert!((large.marks[1].y - 30.0).abs() < 1e-12);
    }

    #[test]
    fn an_index_history_shows_every_curve_and_where_failure_is() {
        let curves = [
            ("a".to_owned(), vec![(0.0, 0.0), (1e-3, 4.0)]),
            ("b".to_owned(), vec![(0.0, 0.5), (5e-4, f64::INFINITY), (1e-3, 2.0)]),
            ("c".to_owned(), vec![(0.0, f64::INFINITY)]),
        ];
        let plot = index_history("title", &curves);
        assert_eq!((plot.x.unit.as_str(), plot.y.label.as_str()), ("ms", "Failure index"));
        let drawn: Vec<_> = plot.series.iter().map(|s| (s.label.as_str(), s.points.clone(), s.style)).collect();
        let line = |points: [(f64, f64); 2]| points.to_vec();
        let want = [
            ("a", line([(0.0, 0.0), (1.0, 4.0)]), Style::Solid),
            ("b", line([(0.0, 0.5), (1.0, 2.0)]), Style::Solid),
            ("failure", line([(0.0, 1.0), (1.0, 1.0)]), Style::Dashed),
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
        assert_eq!(modal_history("title", points(5e-5), Vec::new()).y.unit, "um");
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
