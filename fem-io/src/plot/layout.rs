//! Where everything of a plot goes.

use super::flags::{Flag, GAP, flags};
use super::pens::{Pen, Stroke, color};
use super::scale::Range;
use super::shapes::{Anchor, Color, Drawing, Shape, Text};
use super::words::{estimate_width, shorten};
use super::{Axis, Doubt, LinePlot, Mark, PlotError, Scale, Series};

pub(super) const WIDTH: f64 = 1600.0;
/// Height of the area of the curves.
const AREA: f64 = 760.0;
pub(super) const EDGE: f64 = 40.0;
pub(super) const TITLE: f64 = 36.0;
pub(super) const LABEL: f64 = 32.0;
pub(super) const SMALL: f64 = 27.0;
/// Height of a row of the legend or of the marks' labels.
pub(super) const ROW: f64 = 40.0;

pub(super) const WHITE: Color = [0xff; 3];
pub(super) const INK: Color = [0x22, 0x22, 0x22];
pub(super) const FAINT: Color = [0x66, 0x66, 0x66];
const GRID: Color = [0xe3, 0xe3, 0xe3];
const MINOR_GRID: Color = [0xf0, 0xf0, 0xf0];
pub(super) const MARK: Color = [0xd5, 0x5e, 0x00];

/// The shapes of `plot`, which has points and is finite.
pub(super) fn lay_out(plot: &LinePlot) -> Result<Drawing, PlotError> {
    let values = || {
        let points = plot.series.iter().flat_map(|s| s.points.iter().copied());
        let bars = plot.doubts.iter().filter(|d| d.most.is_finite()).map(|d| (d.x, d.most));
        points.chain(plot.marks.iter().map(|m| (m.x, m.y))).chain(bars)
    };
    let range =
        |axis: &Axis, largest| PlotError::Range { title: plot.title.clone(), axis: axis.label.clone(), largest };
    let x = Range::of(plot.x.scale, values().map(|p| p.0)).map_err(|largest| range(&plot.x, largest))?;
    // Curves over time fill the width; one around zero, or without a zero, is a figure of its own and stands free.
    let x = if x.crosses_zero() || plot.x.scale == Scale::Logarithmic { x.with_margins() } else { x };
    let y = Range::of(plot.y.scale, values().map(|p| p.1)).map_err(|largest| range(&plot.y, largest))?.with_margins();

    let y_ticks = y.ticks(9);
    let widest = |ticks: &[(f64, String)]| ticks.iter().map(|t| estimate_width(&t.1, SMALL)).fold(0.0, f64::max);
    let left = EDGE + LABEL + 30.0 + widest(&y_ticks);
    let right = WIDTH - EDGE - 20.0;
    let fits = |ticks: &[(f64, String)]| widest(ticks) * 1.3 * ticks.len() as f64 <= right - left;
    let x_ticks = (3..=10).rev().map(|most| x.ticks(most)).find(|ticks| fits(ticks)).unwrap_or_else(|| x.ticks(2));

    let mut names: Vec<&Series> = Vec::new();
    for series in &plot.series {
        if names.iter().all(|n| n.label != series.label) {
            names.push(series);
        }
    }
    let place = |label: &str| names.iter().position(|n| n.label == label).unwrap_or(0);
    let pen = |s: &Series| Pen::new(s.style, place(&s.label));
    let texts = names.iter().map(|s| s.label.as_str()).filter(|_| names.len() > 1);
    let legend = legend(texts.chain((!plot.doubts.is_empty()).then_some(DOUBTED)), left, right);
    let flags = flags(&plot.marks, |m| left + x.fraction(m.x) * (right - left), left, right);
    let rows = |rows: Option<usize>| rows.map_or(0.0, |last| (last + 1) as f64 * ROW);
    let legend_top = EDGE + 1.4 * TITLE;
    let flags_top = legend_top + rows(legend.iter().map(|e| e.row).max());
    let top = flags_top + rows(flags.iter().map(|f| f.row).max()) + 14.0;

    let area = Area { x, y, left, right, top, bottom: top + AREA };
    let mut canvas = Canvas(Vec::new());
    canvas.text([left, EDGE + 0.8 * TITLE], &shorten(&plot.title, TITLE, right - left), TITLE, INK, Anchor::Start);
    canvas.axes(&area, &x_ticks, &y_ticks, plot);
    for flag in &flags {
        canvas.line(vec![[flag.x, flag.baseline(top) - 0.75 * SMALL], [flag.x, area.bottom]], 2.0, FAINT, true);
    }
    for series in &plot.series {
        canvas.curve(&area, series, &pen(series));
    }
    let mut doubts: Vec<(&Doubt, Color)> = plot.doubts.iter().map(|d| (d, color(place(&d.series)))).collect();
    // Short bars above long ones.
    doubts.sort_by(|a, b| b.0.most.total_cmp(&a.0.most));
    doubts.iter().for_each(|(doubt, color)| canvas.doubt(&area, doubt, *color));
    for (flag, mark) in flags.iter().zip(&plot.marks) {
        canvas.flag(&area, flag, mark, top);
    }
    for (entry, series) in legend.iter().zip(names.iter().filter(|_| names.len() > 1)) {
        canvas.legend(entry, &pen(series), legend_top);
    }
    if let Some(entry) = legend.last().filter(|_| !plot.doubts.is_empty()) {
        canvas.legend_of_doubts(entry, legend_top);
    }
    let height = (area.bottom + 2.0 * LABEL + EDGE + 30.0).ceil();
    Ok(Drawing { title: shorten(&plot.title, TITLE, WIDTH), width: WIDTH, height, shapes: canvas.0 })
}

/// First, lowest, highest and last of every run of points within one pixel column.
fn thin(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut kept = Vec::new();
    for run in points.chunk_by(|a, b| a[0].floor() == b[0].floor()) {
        let (mut lowest, mut highest) = (0, 0);
        for (i, point) in run.iter().enumerate() {
            if point[1] < run[lowest][1] {
                lowest = i;
            }
            if point[1] > run[highest][1] {
                highest = i;
            }
        }
        kept.extend([0, lowest.min(highest), lowest.max(highest), run.len() - 1].map(|i| run[i]));
    }
    kept.dedup();
    kept
}

/// An entry of the legend.
struct Entry {
    row: usize,
    left: f64,
    text: String,
}

/// Radius of the dot of a point.
const DOT: f64 = 6.0;
/// Length of the line beside a name in the legend.
const SAMPLE: f64 = 56.0;

/// What open points are, in the legend.
const DOUBTED: &str = "open: may be as high as its bar";
/// Half of the line across the end of a bar, and what is drawn of one without an end.
const CAP: f64 = 7.0;
const ARROW: f64 = 44.0;

/// Entries side by side, in as many rows as they need.
fn legend<'a>(labels: impl Iterator<Item = &'a str>, left: f64, right: f64) -> Vec<Entry> {
    let (mut row, mut x) = (0, left);
    labels
        .map(|label| {
            let text = shorten(label, SMALL, 0.5 * (right - left));
            let width = SAMPLE + 14.0 + estimate_width(&text, SMALL);
            if x + width > right && x > left {
                (row, x) = (row + 1, left);
            }
            let entry = Entry { row, left: x, text };
            x += width + 40.0;
            entry
        })
        .collect()
}

/// The area of the curves.
struct Area {
    x: Range,
    y: Range,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Area {
    fn across(&self, x: f64) -> f64 {
        self.left + self.x.fraction(x) * (self.right - self.left)
    }

    fn up(&self, y: f64) -> f64 {
        self.bottom - self.y.fraction(y) * (self.bottom - self.top)
    }

    fn place(&self, x: f64, y: f64) -> [f64; 2] {
        [self.across(x), self.up(y)]
    }
}

/// What an axis shows, in its unit.
pub(super) fn axis_name(axis: &Axis, most: f64) -> String {
    let unit = if axis.unit.is_empty() { String::new() } else { format!(" ({})", axis.unit) };
    shorten(&format!("{}{unit}", axis.label), LABEL, most)
}

/// The shapes so far.
pub(super) struct Canvas(pub(super) Vec<Shape>);

impl Canvas {
    pub(super) fn line(&mut self, points: Vec<[f64; 2]>, width: f64, color: Color, dashed: bool) {
        self.0.push(Shape::Line { points, color, width, dashed });
    }

    pub(super) fn text(&mut self, at: [f64; 2], text: &str, size: f64, color: Color, anchor: Anchor) {
        self.0.push(Shape::Text(Text { at, text: text.to_owned(), size, color, anchor, upwards: false }));
    }

    fn axes(&mut self, area: &Area, x_ticks: &[(f64, String)], y_ticks: &[(f64, String)], plot: &LinePlot) {
        let &Area { left, right, top, bottom, .. } = area;
        for x in area.x.minor_ticks().into_iter().map(|value| area.across(value)) {
            self.line(vec![[x, bottom], [x, top]], 1.5, MINOR_GRID, false);
        }
        for y in area.y.minor_ticks().into_iter().map(|value| area.up(value)) {
            self.line(vec![[left, y], [right, y]], 1.5, MINOR_GRID, false);
        }
        for (value, label) in x_ticks {
            let x = area.across(*value);
            self.line(vec![[x, bottom], [x, top]], 1.5, GRID, false);
            self.line(vec![[x, bottom], [x, bottom + 8.0]], 2.0, INK, false);
            self.text([x, bottom + 14.0 + SMALL], label, SMALL, INK, Anchor::Middle);
        }
        for (value, label) in y_ticks {
            let y = area.up(*value);
            self.line(vec![[left, y], [right, y]], 1.5, GRID, false);
            self.line(vec![[left - 8.0, y], [left, y]], 2.0, INK, false);
            self.text([left - 16.0, y + 0.35 * SMALL], label, SMALL, INK, Anchor::End);
        }
        if area.y.crosses_zero() {
            self.line(vec![[left, area.up(0.0)], [right, area.up(0.0)]], 1.5, FAINT, false);
        }
        if area.x.crosses_zero() {
            self.line(vec![[area.across(0.0), bottom], [area.across(0.0), top]], 1.5, FAINT, false);
        }
        self.line(vec![[left, top], [left, bottom], [right, bottom]], 2.0, INK, false);
        let middle = 0.5 * (left + right);
        self.text([middle, bottom + 30.0 + 2.0 * LABEL], &axis_name(&plot.x, right - left), LABEL, INK, Anchor::Middle);
        self.0.push(Shape::Text(Text {
            at: [EDGE + 0.6 * LABEL, 0.5 * (top + bottom)],
            text: axis_name(&plot.y, AREA),
            size: LABEL,
            color: INK,
            anchor: Anchor::Middle,
            upwards: true,
        }));
    }

    /// A curve of a single point is a dot whatever the pen.
    fn curve(&mut self, area: &Area, series: &Series, pen: &Pen) {
        let points: Vec<_> = series.points.iter().map(|&(x, y)| area.place(x, y)).collect();
        let points = thin(&points);
        let dots = if pen.dots || points.len() == 1 { points.clone() } else { Vec::new() };
        if let Some(Stroke { width, dashed }) = pen.line.filter(|_| points.len() > 1) {
            self.line(points, width, pen.color, dashed);
        }
        self.0.extend(dots.into_iter().map(|centre| Shape::Dot { centre, radius: DOT, color: pen.color }));
    }

    /// An open point with a bar up to the most that it may be; an arrow, where there is no such most.
    fn doubt(&mut self, area: &Area, doubt: &Doubt, color: Color) {
        let at @ [x, y] = area.place(doubt.x, doubt.y);
        let end = if doubt.most.is_finite() { area.up(doubt.most) } else { (y - ARROW).max(area.top) };
        // An arrow turns back from its end, a cap goes across it.
        let back = if doubt.most.is_finite() { 0.0 } else { 1.5 * CAP };
        self.line(vec![[x, y], [x, end]], 2.5, color, false);
        self.line(vec![[x - CAP, end + back], [x, end], [x + CAP, end + back]], 2.5, color, false);
        self.ring(at, color);
    }

    fn ring(&mut self, centre: [f64; 2], color: Color) {
        self.0.push(Shape::Dot { centre, radius: DOT + 2.0, color });
        self.0.push(Shape::Dot { centre, radius: DOT - 1.5, color: WHITE });
    }

    fn legend_of_doubts(&mut self, entry: &Entry, top: f64) {
        let baseline = top + (entry.row as f64 + 0.6) * ROW;
        let (x, middle) = (entry.left + 0.5 * SAMPLE, baseline - 0.35 * SMALL);
        let end = middle - 0.35 * ROW;
        self.line(vec![[x, middle], [x, end]], 2.5, FAINT, false);
        self.line(vec![[x - CAP, end], [x + CAP, end]], 2.5, FAINT, false);
        self.ring([x, middle], FAINT);
        self.text([entry.left + SAMPLE + 14.0, baseline], &entry.text, SMALL, INK, Anchor::Start);
    }

    fn flag(&mut self, area: &Area, flag: &Flag, mark: &Mark, top: f64) {
        self.0.push(Shape::Dot { centre: area.place(mark.x, mark.y), radius: 11.0, color: WHITE });
        self.0.push(Shape::Dot { centre: area.place(mark.x, mark.y), radius: 8.0, color: MARK });
        let baseline = flag.baseline(top);
        let ([from, to], middle) = (flag.span(), baseline - 0.35 * SMALL);
        self.line(vec![[from + GAP, middle], [to - GAP, middle]], SMALL, WHITE, false);
        let (x, anchor) = if flag.to_left { (flag.x - GAP, Anchor::End) } else { (flag.x + GAP, Anchor::Start) };
        self.text([x, baseline], &flag.text, SMALL, INK, anchor);
    }

    fn legend(&mut self, entry: &Entry, pen: &Pen, top: f64) {
        let baseline = top + (entry.row as f64 + 0.6) * ROW;
        let middle = baseline - 0.35 * SMALL;
        if let Some(Stroke { width, dashed }) = pen.line {
            self.line(vec![[entry.left, middle], [entry.left + SAMPLE, middle]], width, pen.color, dashed);
        }
        if pen.dots {
            self.0.push(Shape::Dot { centre: [entry.left + 0.5 * SAMPLE, middle], radius: DOT, color: pen.color });
        }
        self.text([entry.left + SAMPLE + 14.0, baseline], &entry.text, SMALL, INK, Anchor::Start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn thinning_keeps_the_ends_and_the_extremes_of_every_column(
            heights in proptest::collection::vec(-1e3..1e3, 1..500), columns in 1..40usize
        ) {
            let n = heights.len();
            let points: Vec<_> =
                heights.iter().enumerate().map(|(i, &y)| [(i * columns) as f64 / n as f64, y]).collect();
            let kept = thin(&points);
            prop_assert!(kept.len() <= 4 * columns);
            prop_assert_eq!(kept.first(), points.first());
            prop_assert_eq!(kept.last(), points.last());
            for column in 0..columns {
                let bounds = |points: &[[f64; 2]]| {
                    let inside = points.iter().filter(|p| p[0].floor() == column as f64).map(|p| p[1]);
                    inside.fold((f64::MAX, f64::MIN), |(lo, hi), y| (lo.min(y), hi.max(y)))
                };
                prop_assert_eq!(bounds(&kept), bounds(&points));
            }
        }
    }

    #[test]
    fn a_loop_keeps_its_way_back() {
        let points = [[0.0, 0.0], [1.0, 5.0], [0.0, 9.0], [0.5, 8.0]];
        assert_eq!(thin(&points), points);
    }
}
