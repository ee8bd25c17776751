//! Words that fit.

use super::png::text_width;

/// Room for the reader's own font in an SVG, which may be wider than ours.
const SLACK: f64 = 1.2;
/// Most characters of a text.
const LONGEST: usize = 400;

/// Width to keep free for `text`.
pub(super) fn estimate_width(text: &str, size: f64) -> f64 {
    SLACK * text_width(text, size)
}

/// `text` without control characters, cut with an ellipsis where it would be wider than `most` pixels.
pub(super) fn shorten(text: &str, size: f64, most: f64) -> String {
    let unprintable = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    let mut kept: String = text.chars().take(LONGEST).map(|c| if unprintable(c) { ' ' } else { c }).collect();
    if estimate_width(&kept, size) > most || text.chars().nth(LONGEST).is_some() {
        while estimate_width(&kept, size) > most - estimate_width("…", size) && kept.pop().is_some() {}
        kept.truncate(kept.trim_end().len());
        kept.push('…');
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_fit() {
        assert_eq!(shorten("matrix tension", 20.0, 500.0), "matrix tension");
        assert_eq!(shorten("a\nb\u{0}c", 20.0, 500.0), "a b c");
        for text in ["matrix tension and a lot more of it", &"x".repeat(100_000)] {
            let cut = shorten(text, 20.0, 150.0);
            assert!(estimate_width(&cut, 20.0) <= 150.0 && cut.ends_with('…') && cut.len() > 10, "{cut}");
        }
    }
}
