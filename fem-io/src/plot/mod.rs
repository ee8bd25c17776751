//! Line plots and maps as SVG and PNG.
//!
//! A plot is laid out once, as a list of shapes in pixels, and drawn twice, so that both pictures look alike. The PNG
//! carries its own font; the SVG keeps its words as text. Neither needs a font or a library of the system, and equal
//! plots give equal bytes.
//!
//! ```
//! use fem_io::plot::{force_history, line_plot};
//!
//! let times = [0.0, 20e-6, 40e-6]; // s
//! let plot = force_history("A hat", &times, &[("impactor", vec![0.0, 900.0, 0.0])], &[(20e-6, "peak".into())])?;
//! assert_eq!((&*plot.x.unit, &*plot.y.unit), ("us", "N"));
//! assert!(line_plot(&plot)?.svg.contains("peak, 20 us"));
//! # Ok::<(), fem_io::plot::PlotError>(())
//! ```

#[cfg(test)]
mod boxes;
mod flags;
mod layout;
mod map;
mod map_layout;
mod mesh;
mod over_time;
mod pens;
mod png;
mod scale;
mod shapes;
mod svg;
mod words;
mod work_precision;

pub use map::{Fill, MapCell, MapOutline, MapPlot, Panel, Stroke, class_color, map_plot};
pub use mesh::mesh_map;
pub use over_time::{force_history, index_history, modal_history, over_time};
pub use pens::curve_color;
pub use png::PngError;
pub use work_precision::work_precision;

use crate::files::{FileError, OutputDir};
use fem_core::plugin::Dimension;

/// Curves over a common axis.
#[derive(Debug, Clone, PartialEq)]
pub struct LinePlot {
    /// Heading.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves, at least one. Those of one name share colour and entry in the legend, which appears from two names on.
    pub series: Vec<Series>,
    /// Marked points.
    pub marks: Vec<Mark>,
    /// Points of the curves that are not known well, drawn open.
    pub doubts: Vec<Doubt>,
}

/// What an axis shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity, e.g. `Contact force`.
    pub label: String,
    /// Unit that the values are in, e.g. `kN`; empty for a pure number.
    pub unit: String,
    /// Where its values stand.
    pub scale: Scale,
}

/// Where the values of an axis stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// At distances in proportion to their differences.
    Linear,
    /// At distances in proportion to their ratios, for positive values.
    Logarithmic,
}

impl Axis {
    /// An axis with a linear scale.
    pub fn linear(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), scale: Scale::Linear }
    }

    /// A linear axis for `values` in SI units, in the unit that fits them; with how many of that are one in SI units.
    pub fn fitting(label: &str, of: Dimension, values: impl Iterator<Item = f64>) -> (Self, f64) {
        match of.unit_for(values.fold(0.0, |most, value| value.abs().max(most))) {
            Some(unit) => (Self::linear(label, unit.symbol), unit.per),
            None => (Self::linear(label, of.to_string()), 1.0),
        }
    }

    /// An axis with a logarithmic scale, for positive values.
    pub fn logarithmic(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { scale: Scale::Logarithmic, ..Self::linear(label, unit) }
    }
}

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub label: String,
    /// Points (x, y) in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// How the points are drawn.
    pub style: Style,
}

/// How the points of a curve are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Joined by a line.
    Solid,
    /// Joined by a dashed line.
    Dashed,
    /// Each as a dot.
    Dots,
    /// Each as a dot, joined by a line. From the seventh name on the line is dashed.
    Joined,
    /// Joined by a thin dark dashed line, for what other curves are compared with.
    Guide,
}

/// A named point, with a dashed line from the axis through the point to its label above the curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Place, in the unit of the axis.
    pub x: f64,
    /// Place, in the unit of the axis.
    pub y: f64,
    /// Its name.
    pub label: String,
}

/// A point of a curve that is not known well: open, with a bar up to the most that it may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Doubt {
    /// Name of its curve.
    pub series: String,
    /// Place, in the unit of the axis.
    pub x: f64,
    /// Place, in the unit of the axis.
    pub y: f64,
    /// The most that y may be; an arrow upwards shows that it is infinite.
    pub most: f64,
}

/// A plot, drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// SVG document.
    pub svg: String,
    /// PNG file, 1200 pixels wide.
    pub png: Vec<u8>,
}

impl Picture {
    /// Writes `NAME.svg` and `NAME.png`.
    ///
    /// # Errors
    /// As [`OutputDir::write`].
    pub fn write(&self, dir: &OutputDir, name: &str) -> Result<(), FileError> {
        dir.write(&format!("{name}.svg"), |out| out.write_all(self.svg.as_bytes()))?;
        dir.write(&format!("{name}.png"), |out| out.write_all(&self.png))
    }
}

/// Why a plot cannot be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlotError {
    /// Nothing to show.
    #[error("plot `{title}`: no points to draw in {what}")]
    Empty {
        /// Title of the plot.
        title: String,
        /// The empty part.
        what: String,
    },
    /// NaN or infinity.
    #[error("plot `{title}`: ({x}, {y}) in {what} is not finite")]
    NonFinite {
        /// Title of the plot.
        title: String,
        /// The curve and point, or the mark.
        what: String,
        /// Its coordinate.
        x: f64,
        /// Its coordinate.
        y: f64,
    },
    /// Values beyond 10²⁵⁰.
    #[error("plot `{title}`: values up to {largest:e} on the axis `{axis}` are too large to draw")]
    Range {
        /// Title of the plot.
        title: String,
        /// Label of the axis.
        axis: String,
        /// Largest magnitude.
        largest: f64,
    },
    /// Zero or less where there is no place for it.
    #[error(
        "plot `{title}`: {value} in {what} has no place on the logarithmic axis `{axis}`, which is for values above 0"
    )]
    NotPositive {
        /// Title of the plot.
        title: String,
        /// Label of the axis.
        axis: String,
        /// The curve and point, or the mark.
        what: String,
        /// Its coordinate.
        value: f64,
    },
    /// More labels than a picture holds.
    #[error("plot `{title}`: {count} {what} are too many for one picture, which holds {most}")]
    TooMany {
        /// Title of the plot.
        title: String,
        /// Curves or marks.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// Columns that do not belong together.
    #[error("{times} times but {forces} forces")]
    Lengths {
        /// Number of times.
        times: usize,
        /// Number of forces.
        forces: usize,
    },
    /// The PNG could not be made.
    #[error("plot `{title}`: no PNG: {why}")]
    Png {
        /// Title of the plot.
        title: String,
        /// The cause.
        why: PngError,
    },
}

/// Draws `plot`.
///
/// A curve of any length is thinned to the first, lowest, highest and last point of every pixel column, which keeps
/// all its peaks. No two names have one colour. The first five are those of Okabe and Ito (2008), which the colour-blind can
/// tell apart.
///
/// # Errors
/// No points; points, marks or doubts that are not finite, are beyond 10²⁵⁰ or are not positive where an axis is logarithmic;
/// more than 40 curves or marks.
pub fn line_plot(plot: &LinePlot) -> Result<Picture, PlotError> {
    check(plot)?;
    let drawing = layout::lay_out(plot)?;
    let png = png::render(&drawing).map_err(|why| PlotError::Png { title: plot.title.clone(), why })?;
    Ok(Picture { svg: svg::render(&drawing), png })
}

/// Most curves, and most marks, of a picture.
pub const MOST_CURVES: usize = 40;

fn check(plot: &LinePlot) -> Result<(), PlotError> {
    let title = || plot.title.clone();
    for (what, count) in [("curves", plot.series.len()), ("marks", plot.marks.len())] {
        if count > MOST_CURVES {
            return Err(PlotError::TooMany { title: title(), what, count, most: MOST_CURVES });
        }
    }
    if plot.series.is_empty() {
        return Err(PlotError::Empty { title: title(), what: "the whole plot".into() });
    }
    let drawable = |x: f64, y: f64, what: &dyn Fn() -> String| {
        if !(x.is_finite() && y.is_finite()) {
            return Err(PlotError::NonFinite { title: title(), what: what(), x, y });
        }
        for (axis, value) in [(&plot.x, x), (&plot.y, y)] {
            if axis.scale == Scale::Logarithmic && value <= 0.0 {
                return Err(PlotError::NotPositive { title: title(), axis: axis.label.clone(), what: what(), value });
            }
        }
        Ok(())
    };
    for series in &plot.series {
        if series.points.is_empty() {
            return Err(PlotError::Empty { title: title(), what: format!("curve `{}`", series.label) });
        }
        for (i, &(x, y)) in series.points.iter().enumerate() {
            drawable(x, y, &|| format!("curve `{}`, point {}", series.label, i + 1))?;
        }
    }
    for doubt in &plot.doubts {
        let what = || format!("open point of `{}`", doubt.series);
        drawable(doubt.x, doubt.y, &what)?;
        drawable(doubt.x, if doubt.most == f64::INFINITY { doubt.y } else { doubt.most }, &what)?;
    }
    plot.marks.iter().try_for_each(|m| drawable(m.x, m.y, &|| format!("mark `{}`", m.label)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tiny_skia::Pixmap;

    fn plot(points: &[(f64, f64)]) -> LinePlot {
        LinePlot {
            title: "Test".into(),
            x: Axis::linear("Time", "ms"),
            y: Axis::linear("Ratio", ""),
            series: vec![Series { label: "curve".into(), points: points.to_vec(), style: Style::Solid }],
            marks: Vec::new(),
            doubts: Vec::new(),
        }
    }

    /// What is purely of this colour, in square units of the drawing.
    fn area(picture: &Picture, [r, g, b]: [u8; 3]) -> f64 {
        let pixels = Pixmap::decode_png(&picture.png).unwrap();
        let count = pixels.pixels().iter().filter(|p| [p.red(), p.green(), p.blue()] == [r, g, b]).count();
        count as f64 * (layout::WIDTH / f64::from(pixels.width())).powi(2)
    }

    #[test]
    fn equal_plots_give_equal_bytes_1200_pixels_wide() {
        let history = |n: usize| -> Vec<_> { (0..n).map(|i| (i as f64, (i as f64 * 0.1).sin())).collect() };
        let picture = line_plot(&plot(&history(500))).unwrap();
        assert_eq!(picture, line_plot(&plot(&history(500))).unwrap());
        let pixels = Pixmap::decode_png(&picture.png).unwrap();
        assert_eq!(pixels.width(), 1200);
        assert!(picture.svg.starts_with("<svg xmlns") && picture.svg.contains("viewBox=\"0 0 1600 "));
    }

    #[test]
    fn a_long_history_gives_a_small_svg_with_its_peak() {
        let mut points: Vec<_> = (0..200_000).map(|i| (f64::from(i), (f64::from(i) * 1.7).sin())).collect();
        points[77_777].1 = 3.0;
        let picture = line_plot(&plot(&points)).unwrap();
        assert!(picture.svg.len() < 100_000, "{}", picture.svg.len());
        // The range is −1.2 to 3.2 over 760 pixels, so the peak is 0.2/4.4 · 760 below the upper edge at 104.4.
        assert!(picture.svg.contains(",138.9 "), "no peak");
    }

    #[test]
    fn curve_and_marks_are_in_both_pictures() {
        let mut plot = plot(&[(0.0, 0.0), (1.0, 1.0)]);
        plot.marks.push(Mark { x: 0.5, y: 0.5, label: "a < b & c".into() });
        let picture = line_plot(&plot).unwrap();
        assert!(picture.svg.contains("stroke=\"#0072b2\"") && picture.svg.contains(">a &lt; b &amp; c</text>"));
        assert!(picture.svg.contains(">Time (ms)</text>") && picture.svg.contains(">Ratio</text>"));
        // A line 1560 long and 3.5 wide, and a dot of radius 8.
        assert!((2000.0..6000.0).contains(&area(&picture, [0x00, 0x72, 0xb2])));
        assert!((120.0..220.0).contains(&area(&picture, [0xd5, 0x5e, 0x00])));
    }

    #[test]
    fn styles_differ_and_two_curves_have_a_legend() {
        let mut plot = plot(&[(0.0, 0.0), (1.0, 1.0)]);
        plot.series.push(Series { label: "other".into(), style: Style::Dashed, ..plot.series[0].clone() });
        plot.series.push(Series { label: "third".into(), style: Style::Dots, ..plot.series[0].clone() });
        let svg = line_plot(&plot).unwrap().svg;
        assert_eq!(svg.matches("stroke-dasharray").count(), 2);
        assert_eq!(svg.matches("<circle").count(), 3);
        assert!(["curve", "other", "third"].iter().all(|name| svg.contains(&format!(">{name}</text>"))));
    }

    #[test]
    fn joined_curves_of_twelve_names_differ() {
        let mut plot = plot(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)]);
        let curve = |k: usize| Series { label: format!("curve {k}"), style: Style::Joined, ..plot.series[0].clone() };
        plot.series = (0..12).map(curve).collect();
        let svg = line_plot(&plot).unwrap().svg;
        // Every curve has three dots and a line, its sample in the legend one of each.
        assert_eq!((svg.matches("<circle").count(), svg.matches("stroke-dasharray").count()), (48, 12));
        let line = |l: &&str| l.contains("stroke-width=\"3.5\"");
        let pens = svg.lines().filter(line).map(|l| l.split(" points").next().unwrap());
        assert_eq!(pens.collect::<std::collections::BTreeSet<_>>().len(), 12);
    }

    #[test]
    fn what_is_not_known_well_is_open_with_a_bar() {
        let mut plot = plot(&[(0.0, 0.0), (1.0, 1.0)]);
        let known = line_plot(&plot).unwrap().svg;
        plot.doubts = [3.0, f64::INFINITY].map(|most| Doubt { series: "curve".into(), x: 1.0, y: 1.0, most }).to_vec();
        let svg = line_plot(&plot).unwrap().svg;
        assert!(svg.contains(">open: may be as high as its bar</text>") && !known.contains("open"));
        // Each ring is a dot in the colour of its curve and a white one; that of the legend is of no curve.
        assert_eq!((svg.matches("<circle").count(), svg.matches("fill=\"#fff").count()), (6, 4));
        let bars = svg.lines().filter(|l| l.contains("stroke=\"#0072b2\" stroke-width=\"2.5\""));
        assert_eq!(bars.count(), 4);
        // The axis reaches as far as the bar that has an end.
        assert!(svg.contains(">3.0</text>") && !known.contains(">3.0</text>"));
        plot.doubts[0].most = f64::NAN;
        assert!(line_plot(&plot).unwrap_err().to_string().contains("open point of `curve` is not finite"));
    }

    #[test]
    fn logarithmic_axes_turn_powers_into_straight_lines() {
        let mut plot = plot(&[(0.01, 1e-4), (1.0, 1.0), (10.0, 100.0)]);
        (plot.x.scale, plot.y.scale) = (Scale::Logarithmic, Scale::Logarithmic);
        let svg = line_plot(&plot).unwrap().svg;
        let curve = svg.lines().find(|l| l.contains("stroke-width=\"3.5\"")).unwrap();
        let places = curve.split("points=\"").nth(1).unwrap().trim_end_matches("\"/>").split([' ', ',']);
        let p: Vec<f64> = places.map(|number| number.parse().unwrap()).collect();
        assert!((p[2] - p[0] - 2.0 * (p[4] - p[2])).abs() < 0.4, "{curve}");
        assert!((p[3] - p[1] - 2.0 * (p[5] - p[3])).abs() < 0.4, "{curve}");
        assert!(["0.01", "0.1", "1", "10", "1e−4"].iter().all(|label| svg.contains(&format!(">{label}</text>"))));
        // Two to nine times 0.01, 0.1 and 1, and 0.9 and 0.8 in the air below 0.01, at x; six decades at y have none.
        assert_eq!(svg.matches("#f0f0f0").count(), 26);
    }

    #[test]
    fn a_curve_in_pieces_has_one_colour_and_one_name() {
        let mut plot = plot(&[(-1.0, 0.0), (1.0, 1.0)]);
        plot.series.push(Series { label: "other".into(), ..plot.series[0].clone() });
        plot.series.push(plot.series[0].clone());
        let svg = line_plot(&plot).unwrap().svg;
        assert_eq!(svg.matches(">curve</text>").count(), 1);
        // Two pieces and the sample in the legend; the other curve and its sample.
        assert_eq!((svg.matches("#0072b2").count(), svg.matches("#e69f00").count()), (3, 2));
    }

    #[test]
    fn poor_curves_are_still_drawn() {
        for points in
            [&[(0.0, 0.0)][..], &[(3.0, 5.0)], &[(0.0, 0.0), (1e-3, 0.0)], &[(1.0, 2.0); 9], &[(1e200, -1e-200)]]
        {
            let picture = line_plot(&plot(points)).unwrap();
            assert!(!picture.svg.contains("NaN") && !picture.svg.contains("inf"), "{points:?}");
            assert!(area(&picture, [0x00, 0x72, 0xb2]) > 50.0, "{points:?}");
        }
    }

    #[test]
    fn poor_curves_are_still_drawn_on_logarithmic_axes() {
        for points in [&[(3.0, 5.0)][..], &[(1e-3, 7.0), (1e-3, 7.0)], &[(1e-250, 1e250), (1e250, 5e-324)]] {
            let mut plot = plot(points);
            (plot.x.scale, plot.y.scale) = (Scale::Logarithmic, Scale::Logarithmic);
            let picture = line_plot(&plot).unwrap();
            assert!(!picture.svg.contains("NaN") && !picture.svg.contains("inf"), "{points:?}");
            assert!(area(&picture, [0x00, 0x72, 0xb2]) > 50.0, "{points:?}");
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused_by_name() {
        let refusal = |plot: &LinePlot| line_plot(plot).unwrap_err().to_string();
        assert_eq!(refusal(&plot(&[])), "plot `Test`: no points to draw in curve `curve`");
        let nan = plot(&[(0.0, 0.0), (1.0, f64::NAN)]);
        assert_eq!(refusal(&nan), "plot `Test`: (1, NaN) in curve `curve`, point 2 is not finite");
        assert!(refusal(&plot(&[(0.0, 1e300)])).contains("on the axis `Ratio` are too large"));
        let mut ratios = plot(&[(0.0, 1.0), (1.0, -2.0)]);
        ratios.y = Axis::logarithmic("Ratio", "");
        let where_it_is = "in curve `curve`, point 2 has no place on the logarithmic axis `Ratio`";
        assert!(refusal(&ratios).contains(&format!("-2 {where_it_is}")), "{}", refusal(&ratios));
        ratios.series[0].points[1].1 = 0.0;
        assert!(refusal(&ratios).contains(&format!("0 {where_it_is}")));
        ratios.series[0].points[1].1 = 1e-300;
        assert!(line_plot(&ratios).is_ok());
        ratios.x = Axis::logarithmic("Time", "ms");
        ratios.series[0].points[0].0 = 1.0;
        ratios.marks = vec![Mark { x: 0.0, y: 1.0, label: "m".into() }];
        assert!(refusal(&ratios).contains("0 in mark `m` has no place on the logarithmic axis `Time`"));
        let mut bare = plot(&[(0.0, 0.0)]);
        bare.marks = vec![Mark { x: f64::INFINITY, y: 0.0, label: "m".into() }];
        assert!(refusal(&bare).contains("mark `m` is not finite"));
        bare.marks = vec![Mark { x: 0.0, y: 0.0, label: String::new() }; 41];
        assert!(refusal(&bare).contains("41 marks are too many"));
        bare.series.clear();
        bare.marks.clear();
        assert!(refusal(&bare).contains("no points to draw in the whole plot"));
    }
}
