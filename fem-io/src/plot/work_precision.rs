//! What accuracy costs.

use super::{Axis, Doubt, LinePlot, Mark, Series, Style};

/// Relative error of `quantity` over processor time in s, both logarithmic, under the heading `title`.
///
/// Points of `series` are (time, error); those of them that are not known well are `doubts`. `front` are the points
/// that no other one beats in both, drawn as stairs: the least error within a time. `named` points (time, error, name)
/// are marked.
///
/// A point whose time or error is not a positive finite number has no place on such axes and is left out: an error of
/// exactly 0 is that of the reference itself. So is a series that has no points then.
pub fn work_precision(
    title: &str,
    quantity: &str,
    series: Vec<Series>,
    doubts: Vec<Doubt>,
    front: &[(f64, f64)],
    named: &[(f64, f64, String)],
) -> LinePlot {
    let studies = series.into_iter().map(|series| Series { points: drawable(&series.points), ..series });
    let mut curves: Vec<_> = studies.filter(|series| !series.points.is_empty()).collect();
    let longest = curves.iter().flat_map(|series| &series.points).map(|p| p.0).fold(0.0, f64::max);
    let points = stairs(drawable(front), longest);
    if !points.is_empty() {
        curves.push(Series { label: "best for its time".into(), points, style: Style::Guide });
    }
    let marks = named.iter().filter(|(x, y, _)| fits_axes(*x, *y));
    LinePlot {
        title: title.to_owned(),
        x: Axis::logarithmic("Processor time", "s"),
        y: Axis::logarithmic(format!("Error of {quantity}"), ""),
        series: curves,
        marks: marks.map(|(x, y, label)| Mark { x: *x, y: *y, label: label.clone() }).collect(),
        doubts: doubts.into_iter().filter(|doubt| fits_axes(doubt.x, doubt.y)).collect(),
    }
}

fn fits_axes(time: f64, error: f64) -> bool {
    [time, error].iter().all(|v| v.is_finite() && *v > 0.0)
}

fn drawable(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    points.iter().copied().filter(|p| fits_axes(p.0, p.1)).collect()
}

/// Each error of `front` from its time until the next one's, the last until `longest`.
fn stairs(mut front: Vec<(f64, f64)>, longest: f64) -> Vec<(f64, f64)> {
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    let until = front.iter().skip(1).map(|p| p.0).chain([longest]);
    front.iter().zip(until).flat_map(|(&(time, error), end)| [(time, error), (end.max(time), error)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Scale, line_plot};

    fn study(label: &str, points: &[(f64, f64)]) -> Series {
        Series { label: label.to_owned(), points: points.to_vec(), style: Style::Joined }
    }

    #[test]
    fn studies_front_and_names_are_drawn() {
        let series = [study("mesh", &[(0.1, 0.2), (1.0, 0.05)]), study("step", &[(0.3, 0.01), (4.0, 0.02)])];
        let plot = work_precision(
            "title",
            "the force",
            series.to_vec(),
            Vec::new(),
            &[(0.3, 0.01), (0.1, 0.2)],
            &[(0.3, 0.01, "knee".into())],
        );
        assert_eq!((plot.x.scale, plot.y.scale), (Scale::Logarithmic, Scale::Logarithmic));
        let drawn: Vec<_> = plot.series.iter().map(|s| (s.label.as_str(), s.points.as_slice(), s.style)).collect();
        let stairs = [(0.1, 0.2), (0.3, 0.2), (0.3, 0.01), (4.0, 0.01)];
        let want = [
            ("mesh", series[0].points.as_slice(), Style::Joined),
            ("step", &series[1].points, Style::Joined),
            ("best for its time", &stairs, Style::Guide),
        ];
        assert_eq!(drawn, want);
        let svg = line_plot(&plot).unwrap().svg;
        let words = ["Processor time (s)", "Error of the force", "mesh", "step", "best for its time", "knee"];
        assert!(words.iter().all(|word| svg.contains(&format!(">{word}</text>"))), "{svg}");
    }

    #[test]
    fn points_without_a_place_are_left_out() {
        let bad = [(1.0, 0.0), (1.0, f64::NAN), (1.0, f64::INFINITY), (1.0, -0.1), (0.0, 0.1), (f64::NAN, 0.1)];
        let mixed: Vec<_> = bad.iter().copied().chain([(2.0, 0.3)]).collect();
        let named: Vec<_> = mixed.iter().map(|p| (p.0, p.1, "name".to_owned())).collect();
        let doubt = |p: &(f64, f64)| Doubt { series: "one".into(), x: p.0, y: p.1, most: f64::INFINITY };
        let doubts = mixed.iter().map(doubt).collect();
        let plot =
            work_precision("title", "x", vec![study("none", &bad), study("one", &mixed)], doubts, &mixed, &named);
        let drawn: Vec<_> = plot.series.iter().map(|s| (s.label.as_str(), s.points.as_slice())).collect();
        assert_eq!(drawn, [("one", &[(2.0, 0.3)][..]), ("best for its time", &[(2.0, 0.3), (2.0, 0.3)])]);
        assert_eq!(plot.marks, [Mark { x: 2.0, y: 0.3, label: "name".into() }]);
        assert_eq!(plot.doubts, [doubt(&(2.0, 0.3))]);
        assert!(line_plot(&plot).is_ok());

        let nothing = work_precision("title", "x", vec![study("none", &bad)], Vec::new(), &bad, &[]);
        assert_eq!(nothing.series, []);
    }
}
