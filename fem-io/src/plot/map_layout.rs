//! Where everything of a map goes.

use super::layout::{Canvas, EDGE, FAINT, INK, LABEL, ROW, SMALL, TITLE, WHITE, WIDTH, axis_name};
use super::map::{Fill, MapOutline, MapPlot, Panel, STEPS, class, places, share};
use super::scale::Range;
use super::shapes::{Anchor, Color, Drawing, Shape, Text};
use super::words::{estimate_width, shorten};
use super::{Axis, PlotError, Scale};
use std::collections::BTreeMap;

/// Between two panels.
const GAP: f64 = 44.0;
/// Height of a map whose aspect is free, and the most of one whose is not.
const FREE: f64 = 700.0;
const TALLEST: f64 = 1150.0;
/// Air at each end of an axis, as a share of it.
const AIR: f64 = 0.03;
/// Length and height of the scale of shares in the legend.
const BAR: [f64; 2] = [300.0, 22.0];
/// Side of the sample of a class in the legend.
const SAMPLE: f64 = 26.0;
/// More cells of a panel than these have no edges of their own, which would be all there is to see.
const EDGED: usize = 3000;
/// Width of an outline.
const OUTLINE: f64 = 2.5;
/// Longest words beside the left edge.
const LONGEST: f64 = 0.4 * WIDTH;
const CELL_EDGE: Color = [0xcf; 3];

/// The shapes of `plot`, which has cells and is finite.
pub(super) fn lay_out(plot: &MapPlot) -> Result<Drawing, PlotError> {
    let x = range(plot, &plot.x, 0)?;
    let y = range(plot, &plot.y, 1)?;
    let notes =
        plot.panels.iter().flat_map(|p| &p.notes).map(|note| estimate_width(&note.1, SMALL)).fold(0.0, f64::max);
    let columns = match plot.panels.len() {
        1 => 1,
        2..=4 => 2,
        5..=9 => 3,
        _ => 4,
    };
    let rows = plot.panels.len().div_ceil(columns);
    let most = if rows > 2 { 4 } else { 8 };
    let widest = |ticks: &[(f64, String)]| ticks.iter().map(|t| estimate_width(&t.1, SMALL)).fold(0.0, f64::max);
    let words: Vec<(f64, String)> = plot.rows.iter().map(|(at, words)| (*at, shorten(words, SMALL, LONGEST))).collect();
    let y_ticks = |most: usize| if words.is_empty() { y.ticks(most) } else { words.clone() };
    let left = EDGE + LABEL + 30.0 + widest(&y_ticks(most));
    let right = WIDTH - EDGE - 20.0 - if notes > 0.0 { notes + 20.0 } else { 0.0 };
    // The last label of a panel stays apart from the first of the next.
    let gap = GAP.max(widest(&x.ticks(8)) + 12.0);
    let mut width = (right - left - (columns - 1) as f64 * gap) / columns as f64;
    let mut height = FREE / rows as f64;
    if plot.equal_aspect {
        let tall = (y.length() / x.length()).clamp(1e-3, 1e3);
        height = (width * tall).min(TALLEST);
        width = height / tall;
    }
    let height = height.max(40.0);
    let stack = |ticks: &Vec<(f64, String)>| 1.3 * SMALL * ticks.len() as f64 <= height;
    let y_ticks = (1..=most).rev().map(y_ticks).find(stack).unwrap_or_else(|| y_ticks(1));
    // Of more than there is room for, some all along.
    let every = ((SMALL * y_ticks.len() as f64 / height).ceil() as usize).max(1);
    let y_ticks: Vec<(f64, String)> = y_ticks.into_iter().step_by(every).collect();
    let fits = |ticks: &[(f64, String)]| widest(ticks) * 1.4 * ticks.len() as f64 <= width;
    let x_ticks = (2..=10).rev().map(|most| x.ticks(most)).find(|ticks| fits(ticks)).unwrap_or_else(|| x.ticks(1));

    let mut canvas = Canvas(Vec::new());
    canvas.text(
        [left, EDGE + 0.8 * TITLE],
        &shorten(&plot.title, TITLE, WIDTH - EDGE - left),
        TITLE,
        INK,
        Anchor::Start,
    );
    let seen = plot.outlines.iter().filter(|outline| visible(outline, x, y).next().is_some());
    let seen: Vec<&MapOutline> = seen.collect();
    let top = canvas.map_legend(plot, &seen, left, WIDTH - EDGE, EDGE + 1.4 * TITLE);
    let pitch = height + ROW + GAP;
    for (i, panel) in plot.panels.iter().enumerate() {
        let (row, column) = (i / columns, i % columns);
        let from = [left + column as f64 * (width + gap), top + row as f64 * pitch + ROW];
        let area = Area { x, y, left: from[0], top: from[1], width, height };
        canvas.panel(&area, panel);
        plot.outlines.iter().for_each(|outline| canvas.outline(&area, outline));
        let lowest = i + columns >= plot.panels.len();
        canvas.frame(&area, if column == 0 { &y_ticks } else { &[] }, if lowest { &x_ticks } else { &[] });
    }
    let bottom = top + (rows - 1) as f64 * pitch + ROW + height;
    let across = (columns - 1) as f64 * (width + gap) + width;
    let place = [left + 0.5 * across, bottom + 30.0 + 2.0 * LABEL];
    canvas.text(place, &axis_name(&plot.x, across.max(400.0)), LABEL, INK, Anchor::Middle);
    canvas.0.push(Shape::Text(Text {
        at: [EDGE + 0.6 * LABEL, 0.5 * (top + ROW + bottom)],
        text: axis_name(&plot.y, (bottom - top).max(200.0)),
        size: LABEL,
        color: INK,
        anchor: Anchor::Middle,
        upwards: true,
    }));
    let height = (bottom + 2.0 * LABEL + EDGE + 30.0).ceil();
    Ok(Drawing { title: shorten(&plot.title, TITLE, WIDTH), width: WIDTH, height, shapes: canvas.0 })
}

/// The straight parts of an outline that are in sight.
fn visible(outline: &MapOutline, x: Range, y: Range) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let inside = move |p: [f64; 2]| (0.0..=1.0).contains(&x.fraction(p[0])) && (0.0..=1.0).contains(&y.fraction(p[1]));
    let parts = outline.lines.iter().flat_map(|line| line.windows(2)).map(|w| [w[0], w[1]]);
    parts.filter(move |part| part.iter().all(|p| inside(*p)))
}

/// What an axis reaches over: all places, with some air.
fn range(plot: &MapPlot, axis: &Axis, d: usize) -> Result<Range, PlotError> {
    let values = || plot.panels.iter().flat_map(places).map(|p| p[d]);
    let (lo, hi) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let error = |largest| PlotError::Range { title: plot.title.clone(), axis: axis.label.clone(), largest };
    let [low, high] = match axis.scale {
        Scale::Linear => [lo - AIR * (hi - lo), hi + AIR * (hi - lo)],
        Scale::Logarithmic => [lo / (hi / lo).powf(AIR), hi * (hi / lo).powf(AIR)],
    };
    Range::of(axis.scale, [low, high].into_iter()).map_err(error)
}

/// Where a panel is.
struct Area {
    x: Range,
    y: Range,
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Area {
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.left + self.x.fraction(x) * self.width, self.top + (1.0 - self.y.fraction(y)) * self.height]
    }
}

fn color(fill: Fill) -> Color {
    match fill {
        Fill::Blank => WHITE,
        Fill::Share(value) => share(value),
        Fill::Class(k) => class(k),
    }
}

impl Canvas {
    /// Scale of shares and samples of the classes in use, in as many rows as they need; returns where they end.
    fn map_legend(&mut self, plot: &MapPlot, outlines: &[&MapOutline], left: f64, right: f64, top: f64) -> f64 {
        let mut used: Vec<usize> = plot.panels.iter().flat_map(classes_of).collect();
        used.sort_unstable();
        used.dedup();
        let (mut x, mut middle) = (left, top + 0.5 * ROW);
        if let Some(name) = &plot.scale {
            self.bar([x, middle - 0.5 * BAR[1]]);
            let name = shorten(name, SMALL, 500.0);
            self.text([x + BAR[0] + 14.0, middle + 0.35 * SMALL], &name, SMALL, INK, Anchor::Start);
            x += BAR[0] + 14.0 + estimate_width(&name, SMALL) + 40.0;
        }
        let classes = used.into_iter().map(|k| (plot.classes[k].as_str(), Ok(k)));
        for (name, what) in classes.chain(outlines.iter().map(|outline| (outline.name.as_str(), Err(outline.dashed)))) {
            let name = shorten(name, SMALL, 0.6 * (right - left));
            let width = SAMPLE + 12.0 + estimate_width(&name, SMALL);
            if x + width > right && x > left {
                (x, middle) = (left, middle + if middle < top + ROW { 1.6 * ROW } else { ROW });
            }
            match what {
                Ok(k) => {
                    let [a, b] = [[x, middle - 0.5 * SAMPLE], [x + SAMPLE, middle + 0.5 * SAMPLE]];
                    let ring = vec![a, [b[0], a[1]], b, [a[0], b[1]]];
                    self.0.push(Shape::Polygons { rings: vec![ring], fill: class(k), edge: class(k) });
                }
                Err(dashed) => self.line(vec![[x, middle], [x + SAMPLE, middle]], OUTLINE, INK, dashed),
            }
            self.text([x + SAMPLE + 12.0, middle + 0.35 * SMALL], &name, SMALL, INK, Anchor::Start);
            x += width + 40.0;
        }
        middle + if plot.scale.is_some() { 1.1 * ROW } else { 0.6 * ROW }
    }

    fn outline(&mut self, area: &Area, outline: &MapOutline) {
        for [a, b] in visible(outline, area.x, area.y) {
            self.line(vec![area.place(a), area.place(b)], OUTLINE, INK, outline.dashed);
        }
    }

    /// The colours of shares from 0 to 1.
    fn bar(&mut self, [left, top]: [f64; 2]) {
        let step = BAR[0] / STEPS as f64;
        for k in 0..STEPS {
            let [a, b] = [left + k as f64 * step, left + (k + 1) as f64 * step];
            let color = share((k as f64 + 0.5) / STEPS as f64);
            let ring = vec![[a, top], [b, top], [b, top + BAR[1]], [a, top + BAR[1]]];
            self.0.push(Shape::Polygons { rings: vec![ring], fill: color, edge: color });
        }
        let right = left + BAR[0];
        let corners = [[left, top], [right, top], [right, top + BAR[1]], [left, top + BAR[1]], [left, top]];
        self.line(corners.to_vec(), 1.5, FAINT, false);
        for (share, label) in [(0.0, "0"), (0.5, "0.5"), (1.0, "1")] {
            let at = [left + share * BAR[0], top + BAR[1] + 0.85 * SMALL];
            self.text(at, label, 0.8 * SMALL, INK, Anchor::Middle);
        }
    }

    fn panel(&mut self, area: &Area, panel: &Panel) {
        let most = if panel.notes.is_empty() { area.width } else { WIDTH };
        let size = if estimate_width(&panel.title, SMALL) > most { 0.85 * SMALL } else { SMALL };
        self.text([area.left, area.top - 12.0], &shorten(&panel.title, size, most), size, INK, Anchor::Start);
        let mut paths: BTreeMap<Color, Vec<Vec<[f64; 2]>>> = BTreeMap::new();
        for cell in &panel.cells {
            let ring = cell.corners.iter().map(|p| area.place(*p)).collect();
            paths.entry(color(cell.fill)).or_default().push(ring);
        }
        for (fill, rings) in paths {
            let edge = if panel.cells.len() > EDGED { fill } else { CELL_EDGE };
            self.0.push(Shape::Polygons { rings, fill, edge });
        }
        for line in &panel.lines {
            self.line(line.points.iter().map(|p| area.place(*p)).collect(), 5.0, class(line.class), false);
        }
        for (centre, k) in &panel.dots {
            self.0.push(Shape::Dot { centre: area.place(*centre), radius: 7.0, color: class(*k) });
        }
        for cross in &panel.crosses {
            let [x, y] = area.place(*cross);
            for (width, color) in [(7.0, WHITE), (3.0, INK)] {
                self.line(vec![[x - 13.0, y], [x + 13.0, y]], width, color, false);
                self.line(vec![[x, y - 13.0], [x, y + 13.0]], width, color, false);
            }
        }
        for (height, words) in &panel.notes {
            let y = area.place([0.0, *height])[1];
            self.text([area.left + area.width + 16.0, y + 0.35 * SMALL], words, SMALL, INK, Anchor::Start);
        }
    }

    fn frame(&mut self, area: &Area, y_ticks: &[(f64, String)], x_ticks: &[(f64, String)]) {
        let &Area { left, top, width, height, .. } = area;
        let (right, bottom) = (left + width, top + height);
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        self.line(corners.to_vec(), 2.0, FAINT, false);
        for (value, label) in x_ticks {
            let x = left + area.x.fraction(*value) * width;
            self.line(vec![[x, bottom], [x, bottom + 8.0]], 2.0, INK, false);
            self.text([x, bottom + 14.0 + SMALL], label, SMALL, INK, Anchor::Middle);
        }
        for (value, label) in y_ticks {
            let y = bottom - area.y.fraction(*value) * height;
            self.line(vec![[left - 8.0, y], [left, y]], 2.0, INK, false);
            self.text([left - 16.0, y + 0.35 * SMALL], label, SMALL, INK, Anchor::End);
        }
    }
}

fn classes_of(panel: &Panel) -> impl Iterator<Item = usize> {
    let filled = panel.cells.iter().filter_map(|cell| if let Fill::Class(k) = cell.fill { Some(k) } else { None });
    filled.chain(panel.lines.iter().map(|line| line.class)).chain(panel.dots.iter().map(|dot| dot.1))
}
