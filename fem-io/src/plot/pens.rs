//! What curves are drawn with.

use super::Style;
use super::layout::INK;
use super::shapes::Color;

/// Okabe and Ito (2008), without the yellow, which is lost on white, the vermilion, which is for marks, and the black, which is
/// for guides; then seven more, each as far from all others as can be (OKLab).
pub(super) const PALETTE: [Color; 12] = [
    [0x00, 0x72, 0xb2],
    [0xe6, 0x9f, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0x56, 0xb4, 0xe9],
    [0x7a, 0x01, 0x77],
    [0x8c, 0x56, 0x4b],
    [0x00, 0x5a, 0x32],
    [0xb2, 0xdf, 0x8a],
    [0x00, 0x00, 0x75],
    [0xd0, 0xa0, 0xff],
    [0x98, 0x4e, 0xa3],
];

/// From this name on, joined curves are dashed as well.
const DASHED: usize = 6;

/// How much darker colours are when they come again.
const DARKER: f64 = 0.7;

/// Colour of the `n`-th name.
pub(super) fn color(n: usize) -> Color {
    let shade = DARKER.powi((n / PALETTE.len()) as i32);
    PALETTE[n % PALETTE.len()].map(|c| (f64::from(c) * shade).round() as u8)
}

/// Colour of the `n`-th name of a picture, as `#rrggbb`.
pub fn curve_color(n: usize) -> String {
    let [r, g, b] = color(n);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// What a curve is drawn with: a line, dots or both.
pub(super) struct Pen {
    pub(super) color: Color,
    pub(super) line: Option<Stroke>,
    pub(super) dots: bool,
}

#[derive(Clone, Copy)]
pub(super) struct Stroke {
    pub(super) width: f64,
    pub(super) dashed: bool,
}

impl Pen {
    /// Pen of the `n`-th name.
    pub(super) fn new(style: Style, n: usize) -> Self {
        let stroke = |dashed| Some(Stroke { width: 3.5, dashed });
        let color = color(n);
        match style {
            Style::Solid => Self { color, line: stroke(false), dots: false },
            Style::Dashed => Self { color, line: stroke(true), dots: false },
            Style::Dots => Self { color, line: None, dots: true },
            Style::Joined => Self { color, line: stroke(n / DASHED % 2 == 1), dots: true },
            Style::Guide => Self { color: INK, line: Some(Stroke { width: 2.5, dashed: true }), dots: false },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::MOST_CURVES;
    use crate::plot::layout::{MARK, WHITE};

    /// Distance of two colours in OKLab (Ottosson 2020).
    fn distance(a: Color, b: Color) -> f64 {
        let lab = |color: Color| {
            let [r, g, b] = color.map(|c| f64::from(c) / 255.0).map(|c| match c {
                c if c <= 0.040_45 => c / 12.92,
                c => ((c + 0.055) / 1.055).powf(2.4),
            });
            let l = (0.412_221 * r + 0.536_333 * g + 0.051_446 * b).cbrt();
            let m = (0.211_903 * r + 0.680_700 * g + 0.107_397 * b).cbrt();
            let s = (0.088_302 * r + 0.281_719 * g + 0.629_979 * b).cbrt();
            [
                0.210_454 * l + 0.793_618 * m - 0.004_072 * s,
                1.977_998 * l - 2.428_592 * m + 0.450_594 * s,
                0.025_904 * l + 0.782_772 * m - 0.808_676 * s,
            ]
        };
        let (a, b) = (lab(a), lab(b));
        a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn no_two_curves_are_of_one_colour() {
        // What a reader tells apart at a glance: twelve names, guides, marks and the ground.
        let first: Vec<Color> = (0..12).map(color).chain([INK, MARK, WHITE]).collect();
        for (i, a) in first.iter().enumerate() {
            for b in &first[..i] {
                assert!(distance(*a, *b) > 0.1, "{a:x?} and {b:x?}: {}", distance(*a, *b));
            }
        }
        let all: std::collections::BTreeSet<Color> = (0..MOST_CURVES).map(color).collect();
        assert_eq!(all.len(), MOST_CURVES);
    }
}
