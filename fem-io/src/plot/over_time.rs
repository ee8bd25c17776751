//! Quantities over time.

use super::{Axis, LinePlot, Series, Style, largest, time_unit};

/// What is shown over time, by its unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Physical {
    /// m, shown in µm up to a tenth of a millimetre, else in mm.
    Length,
    /// J, shown in mJ up to a tenth of a joule, else in J.
    Energy,
}

impl Physical {
    /// Unit for values up to `largest` in SI units, and how many of it are one of these.
    pub fn unit(self, largest: f64) -> (&'static str, f64) {
        match self {
            Self::Length if largest < 1e-4 => ("µm", 1e6),
            Self::Length => ("mm", 1e3),
            Self::Energy if largest < 0.1 => ("mJ", 1e3),
            Self::Energy => ("J", 1.0),
        }
    }
}

/// Unit for times up to `longest`, s, and how many of it are a second: µs up to one millisecond, else ms.
pub fn unit_of_time(longest: f64) -> (&'static str, f64) {
    time_unit([longest].into_iter())
}

/// Curves of `quantity` under the heading `title`: names, points (time in s, value in SI units) and how they are drawn.
pub fn over_time(title: &str, quantity: &str, kind: Physical, curves: Vec<Series>) -> LinePlot {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let (time_unit, per_s) = time_unit(points().map(|p| p.0));
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
    }
}

impl Series {
    /// A curve drawn as a line.
    pub fn solid(label: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { label: label.into(), points, style: Style::Solid }
    }
}

#[cfg(test)]
mod tests {
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
}
