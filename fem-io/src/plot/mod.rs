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
//! assert_eq!((&*plot.x.unit, &*plot.y.unit), ("µs", "N"));
//! assert!(line_plot(&plot)?.svg.contains("peak, 20.0 µs"));
//! # Ok::<(), fem_io::plot::PlotError>(())
//! ```

mod flags;
mod layout;
mod map;
mod map_layout;
mod mesh;
mod over_time;
mod png;
mod scale;
mod shapes;
mod svg;
mod words;
mod work_precision;

pub use map::{Cell, Fill, MapPlot, Panel, Stroke, class_color, map_plot};
pub use mesh::mesh_map;
pub use over_time::{Physical, over_time, unit_of_time};
pub use work_precision::work_precision;

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
    /// Each as a dot, joined by a line. From the seventh name on colours begin again and the line is dashed, so that
    /// twelve names differ.
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

/// A plot, drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// SVG document.
    pub svg: String,
    /// PNG file, 1600 pixels wide.
    pub png: Vec<u8>,
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
        why: String,
    },
}

/// Draws `plot`.
///
/// A curve of any length is thinned to the first, lowest, highest and last point of every pixel column, which keeps
/// all its peaks. Colours are those of Okabe and Ito (2008), which the colour-blind can tell apart.
///
/// # Errors
/// No points; points or marks that are not finite, are beyond 10²⁵⁰ or are not positive where an axis is logarithmic;
/// more than 40 curves or marks.
pub fn line_plot(plot: &LinePlot) -> Result<Picture, PlotError> {
    check(plot)?;
    let drawing = layout::lay_out(plot)?;
    let png = png::render(&drawing).map_err(|why| PlotError::Png { title: plot.title.clone(), why })?;
    Ok(Picture { svg: svg::render(&drawing), png })
}

/// Most curves, and most marks, of a picture.
const MOST: usize = 40;

fn check(plot: &LinePlot) -> Result<(), PlotError> {
    let title = || plot.title.clone();
    for (what, count) in [("curves", plot.series.len()), ("marks", plot.marks.len())] {
        if count > MOST {
            return Err(PlotError::TooMany { title: title(), what, count, most: MOST });
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
    plot.marks.iter().try_for_each(|m| drawable(m.x, m.y, &|| format!("mark `{}`", m.label)))
}

/// Events that [`force_history`] names; a last mark counts those after them.
const NAMED_EVENTS: usize = 12;

/// Contact forces over time under the heading `title`, by name, with `events` (time in s, name) marked on the highest.
///
/// Times in s are shown in µs up to one millisecond, else in ms; forces in N are shown in kN from one kilonewton on.
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
    let (time_unit, per_s) = time_unit(times_s.iter().copied());
    let highest = largest(forces_n.iter().flat_map(|(_, forces)| forces.iter().copied()));
    let (force_unit, per_n) = if highest < 1e3 { ("N", 1.0) } else { ("kN", 1e-3) };
    let curve = |(label, forces): &(&str, Vec<f64>)| Series {
        label: (*label).to_owned(),
        points: times_s.iter().zip(forces).map(|(t, f)| (t * per_s, f * per_n)).collect(),
        style: Style::Solid,
    };
    let series: Vec<_> = forces_n.iter().map(curve).collect();

    let mut events: Vec<_> = events.iter().map(|(t, name)| (t * per_s, name)).collect();
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let height = |x: f64| series.iter().map(|curve| height_at(&curve.points, x)).reduce(f64::max).unwrap_or(0.0);
    let mark = |x: f64, name: &str| Mark { x, y: height(x), label: name.to_owned() };
    let mut marks: Vec<_> = events
        .iter()
        .take(NAMED_EVENTS)
        .map(|(x, name)| mark(*x, &format!("{name}, {} {time_unit}", three_digits(*x))))
        .collect();
    if let Some((x, _)) = events.get(NAMED_EVENTS) {
        marks.push(mark(*x, &format!("{} later events", events.len() - NAMED_EVENTS)));
    }
    Ok(LinePlot {
        title: title.to_owned(),
        x: Axis::linear("Time", time_unit),
        y: Axis::linear("Contact force", force_unit),
        series,
        marks,
    })
}

/// Indices from here on are not drawn.
const INDEX_DRAWN: f64 = 1e100;

/// Failure indices over time under the heading `title`: for every name its points (time in s, index), and a dashed line at 1.
///
/// Times are shown as by [`force_history`]. A point whose index is infinite is left out.
pub fn index_history(title: &str, curves: &[(String, Vec<(f64, f64)>)]) -> LinePlot {
    let times = || curves.iter().flat_map(|(_, points)| points.iter().map(|p| p.0));
    let (time_unit, per_s) = time_unit(times());
    let curve = |(label, points): &(String, Vec<(f64, f64)>)| Series {
        label: label.clone(),
        points: points.iter().filter(|p| p.1 < INDEX_DRAWN).map(|p| (p.0 * per_s, p.1)).collect(),
        style: Style::Solid,
    };
    let failure = Series {
        label: "failure".into(),
        points: vec![(0.0, 1.0), (largest(times()) * per_s, 1.0)],
        style: Style::Dashed,
    };
    let curves = curves.iter().map(curve).filter(|series| !series.points.is_empty());
    LinePlot {
        title: title.to_owned(),
        x: Axis::linear("Time", time_unit),
        y: Axis::linear("Failure index", ""),
        series: curves.chain([failure]).collect(),
        marks: Vec::new(),
    }
}

/// A deflection over time under the heading `title` with its parts by mode: names and points (time in s, deflection in m).
///
/// Times are shown as by [`force_history`], deflections in µm up to a tenth of a millimetre, else in mm.
pub fn modal_history(title: &str, sum: Vec<(f64, f64)>, parts: Vec<(String, Vec<(f64, f64)>)>) -> LinePlot {
    let (time_unit, per_s) = time_unit(sum.iter().map(|p| p.0));
    let (unit, per_m) = if largest(sum.iter().map(|p| p.1)) < 1e-4 { ("µm", 1e6) } else { ("mm", 1e3) };
    let series = |label: String, points: Vec<(f64, f64)>, style: Style| Series {
        label,
        points: points.into_iter().map(|(t, w)| (t * per_s, w * per_m)).collect(),
        style,
    };
    let parts = parts.into_iter().map(|(label, points)| series(label, points, Style::Solid));
    LinePlot {
        title: title.to_owned(),
        x: Axis::linear("Time", time_unit),
        y: Axis::linear("Deflection under the impactor", unit),
        series: [series("all modes".into(), sum, Style::Dashed)].into_iter().chain(parts).collect(),
        marks: Vec::new(),
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m, v| m.max(v.abs()))
}

/// Unit for times up to the largest of `times`, s, and how many of it are a second.
fn time_unit(times: impl Iterator<Item = f64>) -> (&'static str, f64) {
    if largest(times) <= 1.000_001e-3 { ("µs", 1e6) } else { ("ms", 1e3) }
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
    use super::*;
    use tiny_skia::Pixmap;

    fn plot(points: &[(f64, f64)]) -> LinePlot {
        LinePlot {
            title: "Test".into(),
            x: Axis::linear("Time", "ms"),
            y: Axis::linear("Ratio", ""),
            series: vec![Series { label: "curve".into(), points: points.to_vec(), style: Style::Solid }],
            marks: Vec::new(),
        }
    }

    fn colored(picture: &Picture, [r, g, b]: [u8; 3]) -> usize {
        let pixels = Pixmap::decode_png(&picture.png).unwrap();
        pixels.pixels().iter().filter(|p| [p.red(), p.green(), p.blue()] == [r, g, b]).count()
    }

    #[test]
    fn equal_plots_give_equal_bytes_1600_pixels_wide() {
        let history = |n: usize| -> Vec<_> { (0..n).map(|i| (i as f64, (i as f64 * 0.1).sin())).collect() };
        let picture = line_plot(&plot(&history(500))).unwrap();
        assert_eq!(picture, line_plot(&plot(&history(500))).unwrap());
        let pixels = Pixmap::decode_png(&picture.png).unwrap();
        assert_eq!(pixels.width(), 1600);
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
        // A line of 1560 pixels, 3.5 wide, and a dot of radius 8.
        assert!((2000..6000).contains(&colored(&picture, [0x00, 0x72, 0xb2])));
        assert!((120..220).contains(&colored(&picture, [0xd5, 0x5e, 0x00])));
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
            assert!(colored(&picture, [0x00, 0x72, 0xb2]) > 50, "{points:?}");
        }
    }

    #[test]
    fn poor_curves_are_still_drawn_on_logarithmic_axes() {
        for points in [&[(3.0, 5.0)][..], &[(1e-3, 7.0), (1e-3, 7.0)], &[(1e-250, 1e250), (1e250, 5e-324)]] {
            let mut plot = plot(points);
            (plot.x.scale, plot.y.scale) = (Scale::Logarithmic, Scale::Logarithmic);
            let picture = line_plot(&plot).unwrap();
            assert!(!picture.svg.contains("NaN") && !picture.svg.contains("inf"), "{points:?}");
            assert!(colored(&picture, [0x00, 0x72, 0xb2]) > 50, "{points:?}");
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
