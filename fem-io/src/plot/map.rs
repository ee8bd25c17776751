//! Maps: cells in their place, coloured by a number or by a name.

use super::shapes::Color;
use super::{Axis, Picture, PlotError, map_layout, png, svg};

/// Cells on one panel or several, all with the same axes.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPlot {
    /// Heading.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Words at values of the vertical axis, in place of its numbers where there are any.
    pub rows: Vec<(f64, String)>,
    /// Whether a unit is as long upwards as it is to the right.
    pub equal_aspect: bool,
    /// Name of the number that [`Fill::Share`] shows, where a scale of its colours is wanted.
    pub scale: Option<String>,
    /// Names of the classes, each with its [`class_color`]; those in use are in the legend.
    pub classes: Vec<String>,
    /// What is drawn above the cells of every panel, as far as it is in sight.
    pub outlines: Vec<MapOutline>,
    /// The panels, at least one, row by row.
    pub panels: Vec<Panel>,
}

/// Lines that say where something is.
#[derive(Debug, Clone, PartialEq)]
pub struct MapOutline {
    /// What it is, in the legend.
    pub name: String,
    /// Points of each line, in the units of the axes.
    pub lines: Vec<Vec<[f64; 2]>>,
    /// Whether the lines are dashed.
    pub dashed: bool,
}

/// One panel of a map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// Heading.
    pub title: String,
    /// Cells, the later above the earlier.
    pub cells: Vec<MapCell>,
    /// Lines above the cells.
    pub lines: Vec<Stroke>,
    /// Points of a class, as dots.
    pub dots: Vec<([f64; 2], usize)>,
    /// Points that a cross marks: where an impactor strikes.
    pub crosses: Vec<[f64; 2]>,
    /// Words beside the right edge at heights of the vertical axis.
    pub notes: Vec<(f64, String)>,
}

/// A polygon that does not cross itself.
#[derive(Debug, Clone, PartialEq)]
pub struct MapCell {
    /// Corners in the units of the axes, at least three.
    pub corners: Vec<[f64; 2]>,
    /// Its colour.
    pub fill: Fill,
}

/// Colour of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fill {
    /// White.
    Blank,
    /// Darker the larger the number, from 0, white, to 1; beyond them as at the ends.
    Share(f64),
    /// That of a class.
    Class(usize),
}

/// A line of a class.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// Points in the units of the axes.
    pub points: Vec<[f64; 2]>,
    /// Its class.
    pub class: usize,
}

/// Okabe and Ito (2008), the darker ones first; the colour-blind can tell them apart, and none is a grey.
const CLASSES: [Color; 7] = [
    [0xd5, 0x5e, 0x00],
    [0x00, 0x72, 0xb2],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
    [0xf0, 0xe4, 0x42],
];

/// Greys of ColorBrewer (Brewer and Harrower 2003), evenly spaced from 0 to 1: print and copy keep them apart, and the
/// colours of classes stand out from all of them.
const SHARES: [Color; 6] = [[0xff; 3], [0xf0; 3], [0xd9; 3], [0xbd; 3], [0x96; 3], [0x73; 3]];

/// Steps of the colours between 0 and 1.
pub(super) const STEPS: usize = 20;

pub(super) fn class(k: usize) -> Color {
    CLASSES[k % CLASSES.len()]
}

/// Colour of class `k` as `#rrggbb`; from the eighth class on they begin again.
pub fn class_color(k: usize) -> String {
    let [r, g, b] = class(k);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Colour of a share, in [`STEPS`] steps.
pub(super) fn share(value: f64) -> Color {
    let at = (value.clamp(0.0, 1.0) * STEPS as f64).round() / STEPS as f64 * (SHARES.len() - 1) as f64;
    let low = (at.floor() as usize).min(SHARES.len() - 2);
    let between = at - low as f64;
    std::array::from_fn(|c| {
        let [a, b] = [SHARES[low][c], SHARES[low + 1][c]].map(f64::from);
        (a + (b - a) * between).round() as u8
    })
}

/// Most panels of a picture.
const MOST_PANELS: usize = 24;

/// Draws `plot`. Cells of one colour are one path of the SVG.
///
/// # Errors
/// No panels or no cells; more than 24 panels; a cell of fewer than three corners, a class without a name; coordinates
/// and shares that are not finite or beyond 10²⁵⁰.
pub fn map_plot(plot: &MapPlot) -> Result<Picture, PlotError> {
    check(plot)?;
    let drawing = map_layout::lay_out(plot)?;
    let png = png::render(&drawing).map_err(|why| PlotError::Png { title: plot.title.clone(), why })?;
    Ok(Picture { svg: svg::render(&drawing), png })
}

fn check(plot: &MapPlot) -> Result<(), PlotError> {
    let title = || plot.title.clone();
    let count = plot.panels.len();
    if count > MOST_PANELS {
        return Err(PlotError::TooMany { title: title(), what: "panels", count, most: MOST_PANELS });
    }
    if plot.panels.iter().all(|panel| panel.cells.is_empty()) {
        return Err(PlotError::Empty { title: title(), what: "the whole map".into() });
    }
    for panel in &plot.panels {
        let what = || format!("panel `{}`", panel.title);
        let cells = panel.cells.iter();
        if cells.clone().any(|cell| cell.corners.len() < 3) {
            return Err(PlotError::Empty { title: title(), what: format!("a cell of {}", what()) });
        }
        let lines = panel.lines.iter().map(|line| line.class);
        let filled = cells.clone().filter_map(|cell| if let Fill::Class(k) = cell.fill { Some(k) } else { None });
        if let Some(k) =
            lines.chain(panel.dots.iter().map(|dot| dot.1)).chain(filled).find(|k| *k >= plot.classes.len())
        {
            return Err(PlotError::Empty { title: title(), what: format!("class {k} of {}", what()) });
        }
        let shares = cells.clone().filter_map(|cell| if let Fill::Share(v) = cell.fill { Some([v, v]) } else { None });
        let notes = panel.notes.iter().chain(&plot.rows).map(|note| [0.0, note.0]);
        if let Some([x, y]) = places(panel).chain(shares).chain(notes).find(|p| !p.iter().all(|v| v.is_finite())) {
            return Err(PlotError::NonFinite { title: title(), what: what(), x, y });
        }
    }
    Ok(())
}

/// All places of a panel that the axes must reach.
pub(super) fn places(panel: &Panel) -> impl Iterator<Item = [f64; 2]> {
    let corners = panel.cells.iter().flat_map(|cell| cell.corners.iter().copied());
    let lines = panel.lines.iter().flat_map(|line| line.points.iter().copied());
    corners.chain(lines).chain(panel.dots.iter().map(|dot| dot.0)).chain(panel.crosses.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tiny_skia::Pixmap;

    fn square(x: f64, fill: Fill) -> MapCell {
        MapCell { corners: vec![[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]], fill }
    }

    fn map(cells: Vec<MapCell>) -> MapPlot {
        MapPlot {
            title: "Test".into(),
            x: Axis::linear("x", "mm"),
            y: Axis::linear("y", "mm"),
            rows: Vec::new(),
            equal_aspect: true,
            scale: Some("index".into()),
            classes: vec!["tension".into(), "shear".into()],
            outlines: Vec::new(),
            panels: vec![Panel { title: "ply 1".into(), cells, ..Panel::default() }],
        }
    }

    fn count(picture: &Picture, color: Color) -> usize {
        let pixels = Pixmap::decode_png(&picture.png).unwrap();
        pixels.pixels().iter().filter(|p| [p.red(), p.green(), p.blue()] == color).count()
    }

    /// Two of four equal squares in a row are of one class: their pixels are as many as those of the two greys.
    #[test]
    fn areas_are_those_of_the_cells_in_both_pictures() {
        let cells = [Fill::Class(1), Fill::Share(0.4), Fill::Class(1), Fill::Share(0.4)];
        let plot = map(cells.iter().enumerate().map(|(i, fill)| square(i as f64, *fill)).collect());
        let picture = map_plot(&plot).unwrap();
        assert_eq!(picture, map_plot(&plot).unwrap());
        let (blue, grey) = (count(&picture, [0x00, 0x72, 0xb2]) as f64, count(&picture, [0xd9; 3]) as f64);
        assert!(blue > 1e5 && (blue / grey - 1.0).abs() < 0.03, "{blue} {grey}");
        for words in [">ply 1<", ">x (mm)<", ">index<", ">shear<", "fill=\"#0072b2\"", "fill=\"#d9d9d9\""] {
            assert!(picture.svg.contains(words), "{words}");
        }
        assert!(!picture.svg.contains(">tension<"), "a class that is not there is in the legend");
    }

    #[test]
    fn aspect_is_equal_where_asked_for() {
        // Four times as wide as high, which fills the width only where the aspect is free.
        let mut plot = map(vec![square(0.0, Fill::Class(0)), square(3.0, Fill::Share(0.5))]);
        let sides = |plot: &MapPlot| {
            let svg = map_plot(plot).unwrap().svg;
            // The first such path is the sample in the legend.
            let path = svg.lines().filter(|l| l.starts_with("<path fill=\"#d55e00\"")).nth(1).unwrap();
            let d = path.split(" d=\"M").nth(1).unwrap().split('Z').next().unwrap();
            let p: Vec<Vec<f64>> = d.split('L').map(|p| p.split(',').map(|v| v.parse().unwrap()).collect()).collect();
            [(p[1][0] - p[0][0]).abs(), (p[2][1] - p[1][1]).abs()]
        };
        let [width, height] = sides(&plot);
        assert!((width - height).abs() < 0.3 && width > 100.0, "{width} {height}");
        plot.equal_aspect = false;
        let [width, height] = sides(&plot);
        assert!((width / height - 1.0).abs() > 0.1, "{width} {height}");
    }

    #[test]
    fn shares_grow_darker_and_never_reach_a_class() {
        let greys: Vec<u8> = (0..=STEPS).map(|k| share(k as f64 / STEPS as f64)[0]).collect();
        assert!(greys.windows(2).all(|pair| pair[0] > pair[1]), "{greys:?}");
        assert_eq!([share(-1.0), share(0.4), share(7.0)], [[0xff; 3], [0xd9; 3], [0x73; 3]]);
        assert_eq!(class_color(8), class_color(1));
    }

    #[test]
    fn words_stand_in_place_of_numbers() {
        let mut plot = map(vec![square(0.0, Fill::Blank)]);
        let has = |plot: &MapPlot, words: &str| map_plot(plot).unwrap().svg.contains(words);
        assert!(has(&plot, ">y (mm)<") && has(&plot, ">0.8<"));
        plot.x = Axis::linear("x", "");
        plot.rows = vec![(0.25, "low".into()), (0.75, "high".into())];
        let svg = map_plot(&plot).unwrap().svg;
        assert_eq!(svg.matches(">0.8<").count(), 1, "of x alone");
        assert!(svg.contains(">low<") && svg.contains(">high<"));
        plot.rows[0].0 = f64::NAN;
        assert!(matches!(map_plot(&plot), Err(PlotError::NonFinite { .. })));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        let refused = |plot: MapPlot| map_plot(&plot).unwrap_err();
        assert!(matches!(refused(map(Vec::new())), PlotError::Empty { .. }));
        assert!(matches!(refused(map(vec![square(0.0, Fill::Class(2))])), PlotError::Empty { .. }));
        assert!(matches!(refused(map(vec![square(f64::NAN, Fill::Blank)])), PlotError::NonFinite { .. }));
        assert!(matches!(refused(map(vec![square(0.0, Fill::Share(f64::NAN))])), PlotError::NonFinite { .. }));
        assert!(matches!(refused(map(vec![square(1e300, Fill::Blank)])), PlotError::Range { .. }));
        let mut many = map(vec![square(0.0, Fill::Blank)]);
        many.panels = vec![many.panels[0].clone(); 25];
        assert!(matches!(refused(many), PlotError::TooMany { count: 25, .. }));
    }
}
