//! What a plot is drawn with, in pixels from the upper left corner.

/// A colour, red green blue.
pub(super) type Color = [u8; 3];

/// A picture on a white ground.
#[derive(Debug)]
pub(super) struct Drawing {
    pub(super) title: String,
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) shapes: Vec<Shape>,
}

#[derive(Debug)]
pub(super) enum Shape {
    Line {
        points: Vec<[f64; 2]>,
        color: Color,
        width: f64,
        dashed: bool,
    },
    Dot {
        centre: [f64; 2],
        radius: f64,
        color: Color,
    },
    /// Convex polygons of one look, with lines of 1 pixel along their edges.
    Polygons {
        rings: Vec<Vec<[f64; 2]>>,
        fill: Color,
        edge: Color,
    },
    Text(Text),
}

/// A line of text; `at` is on its baseline.
#[derive(Debug)]
pub(super) struct Text {
    pub(super) at: [f64; 2],
    pub(super) text: String,
    pub(super) size: f64,
    pub(super) color: Color,
    pub(super) anchor: Anchor,
    /// Turned to read upwards.
    pub(super) upwards: bool,
}

/// Which part of a text is at its place.
#[derive(Debug, Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Lengths of a dash and of the gap after it.
pub(super) const DASH: [f64; 2] = [12.0, 8.0];
