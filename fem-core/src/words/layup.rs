//! The field's notation of layups, `[0/45/-45/90]2s`, expanded to plies from the bottom up.
//!
//! ```text
//! layup    = "[" plies "]" suffix
//! plies    = item { ("/" | ",") item }
//! item     = ply | "(" plies ")" suffix | "[" plies "]" suffix
//! ply      = [sign] number ["°"] [bar] ["{" label "}"] [repeat]
//! sign     = "+" | "-" | "±" | "+-" | "∓" | "-+"       two plies for ± (45/-45) and ∓ (-45/45)
//! bar      = "bar" | "|" | a combining overline on the digits
//! suffix   = [repeat | number] ["s"]                   also all in one: "_2s", "_{2s}"
//! repeat   = "_" number | "_{" number "}"
//! ```
//!
//! `s` mirrors what precedes it, after any repetition; a barred last ply is the mid-ply of the mirror and is not
//! doubled: `[0/45/90bar]s` = 0/45/90/45/0. A label names a ply type: `45{core}`. Blanks are free.

use std::fmt;

/// One ply of an expanded layup.
#[derive(Debug, Clone, PartialEq)]
pub struct LayupPly {
    /// Fibre direction, degrees from x towards y.
    pub angle_deg: f64,
    /// Ply type, if the layup names one.
    pub label: Option<String>,
}

/// A layup that cannot be read; displayed with a caret below the text.
#[derive(Debug, Clone, PartialEq)]
pub struct LayupError {
    /// The layup.
    pub text: String,
    /// Byte offset of the trouble.
    pub at: usize,
    /// What is wrong and what would be right.
    pub why: String,
}

impl fmt::Display for LayupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let before = self.text.get(..self.at).unwrap_or(&self.text);
        let blank: String = before.chars().map(|c| if c.is_whitespace() { c } else { ' ' }).collect();
        write!(f, "{}\n  {}\n  {blank}^", self.why, self.text)
    }
}
impl std::error::Error for LayupError {}

/// Most plies that a layup may expand to.
pub const MAX_PLIES: usize = 10_000;

const MAX_DEPTH: usize = 16;
const MAX_LABEL: usize = 64;
const OVERLINE: char = '\u{305}';

/// Plies of the layup `text` from the bottom up.
///
/// Angles lie within ±180°; there are at most [`MAX_PLIES`] plies and sublaminates nest at most 16 deep.
///
/// # Errors
/// Text that the grammar of this module does not cover, with the place and the remedy.
///
/// ```
/// let angles = |text| fem_core::layup::parse(text).map(|p| p.iter().map(|p| p.angle_deg).collect::<Vec<_>>());
/// assert_eq!(angles("[0/90_2]s"), Ok(vec![0.0, 90.0, 90.0, 90.0, 90.0, 0.0]));
/// assert_eq!(angles("[±45/0bar]s"), Ok(vec![45.0, -45.0, 0.0, -45.0, 45.0]));
/// assert!(angles("[0/45").unwrap_err().to_string().contains("`]`"));
/// ```
pub fn parse(text: &str) -> Result<Vec<LayupPly>, LayupError> {
    let mut parser = Parser { text, at: 0 };
    if !parser.accept("[") {
        return Err(parser.error("a layup begins with `[`, for example [0/45/-45/90]s"));
    }
    let plies = parser.group("]", 1)?;
    match parser.peek() {
        None => Ok(plies),
        Some(_) => Err(parser.error("nothing may follow the layup but a repeat and `s`, as in [0/90]2s")),
    }
}

/// Plies of a sequence and, while its last ply is barred, the place of the bar.
struct Sequence {
    plies: Vec<LayupPly>,
    bar: Option<usize>,
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Parser<'a> {
    fn error_at(&self, at: usize, why: impl Into<String>) -> LayupError {
        LayupError { text: self.text.to_owned(), at, why: why.into() }
    }

    fn error(&self, why: impl Into<String>) -> LayupError {
        self.error_at(self.at, why)
    }

    /// What is left, blanks skipped.
    fn rest(&mut self) -> &'a str {
        let rest = self.text[self.at..].trim_start();
        self.at = self.text.len() - rest.len();
        rest
    }

    fn peek(&mut self) -> Option<char> {
        self.rest().chars().next()
    }

    fn accept(&mut self, token: &str) -> bool {
        let found = self.rest().starts_with(token);
        if found {
            self.at += token.len();
        }
        found
    }

    /// The rest of a bracketed sequence with its suffix.
    fn group(&mut self, close: &str, depth: usize) -> Result<Vec<LayupPly>, LayupError> {
        if depth > MAX_DEPTH {
            return Err(self.error(format!("sublaminates nest at most {MAX_DEPTH} deep")));
        }
        let mut sequence = Sequence { plies: Vec::new(), bar: None };
        loop {
            if let Some(at) = sequence.bar {
                return Err(self.error_at(at, "only the last ply before a mirror `s` can be the mid-ply"));
            }
            let item = self.item(depth)?;
            self.check_count(sequence.plies.len() + item.plies.len())?;
            sequence.plies.extend(item.plies);
            sequence.bar = item.bar;
            if self.accept(close) {
                break;
            }
            if !(self.accept("/") || self.accept(",")) {
                return Err(self.error(format!("expected `/` and the next ply, or `{close}`")));
            }
        }
        self.suffix(sequence)
    }

    fn item(&mut self, depth: usize) -> Result<Sequence, LayupError> {
        for (open, close) in [("(", ")"), ("[", "]")] {
            if self.accept(open) {
                return Ok(Sequence { plies: self.group(close, depth + 1)?, bar: None });
            }
        }
        self.ply()
    }

    fn ply(&mut self) -> Result<Sequence, LayupError> {
        const SIGNS: [(&str, &[f64]); 6] = [
            ("+-", &[1.0, -1.0]),
            ("-+", &[-1.0, 1.0]),
            ("±", &[1.0, -1.0]),
            ("∓", &[-1.0, 1.0]),
            ("+", &[1.0]),
            ("-", &[-1.0]),
        ];
        self.rest();
        let start = self.at;
        let signs = SIGNS.iter().find(|(token, _)| self.accept(token)).map_or(&[1.0][..], |(_, signs)| signs);
        let (angle, overlined) = self.angle(start)?;
        self.accept("°");
        let bar_at = self.at;
        let barred = self.accept("bar") || self.accept("|") || overlined;
        let label = self.label()?;
        let repeat = self.repeat()?;
        if barred && (signs.len() > 1 || repeat != 1) {
            return Err(self.error_at(bar_at, "a mid-ply is one ply: no ± and no repeat with a bar"));
        }
        self.check_count(signs.len().saturating_mul(repeat))?;
        let once = signs.iter().map(|sign| LayupPly { angle_deg: positive_zero(sign * angle), label: label.clone() });
        let plies = vec![once.collect::<Vec<_>>(); repeat].concat();
        Ok(Sequence { plies, bar: barred.then_some(bar_at) })
    }

    /// A decimal number without sign, and whether its digits carry an overline.
    fn angle(&mut self, start: usize) -> Result<(f64, bool), LayupError> {
        let rest = self.rest();
        let digits = rest.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.' || c == OVERLINE);
        let written = &rest[..rest.len() - digits.len()];
        self.at += written.len();
        let plain: String = written.chars().filter(|c| *c != OVERLINE).collect();
        match plain.parse::<f64>() {
            Ok(angle) if angle <= 180.0 => Ok((angle, plain.len() != written.len())),
            Ok(angle) => {
                Err(self.error_at(start, format!("angles lie within ±180 degrees, got {angle}: is a `/` missing?")))
            }
            Err(_) => Err(self.error_at(start, "expected a ply angle in degrees or a sublaminate in ( )")),
        }
    }

    fn label(&mut self) -> Result<Option<String>, LayupError> {
        if !self.accept("{") {
            return Ok(None);
        }
        let Some((label, _)) = self.text[self.at..].split_once('}') else {
            return Err(self.error("the label of a ply type ends with `}`"));
        };
        let name = label.trim();
        let named = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_');
        if !named || name.len() > MAX_LABEL {
            return Err(self.error("a ply type is named by up to 64 letters, digits, `-` and `_`, as in 45{core}"));
        }
        self.at += label.len() + 1;
        Ok(Some(name.to_owned()))
    }

    /// `_2` or `_{2}`; 1 if there is none.
    fn repeat(&mut self) -> Result<usize, LayupError> {
        if self.accept("_{") {
            let n = self.count()?;
            return if self.accept("}") { Ok(n) } else { Err(self.error("a repeat in braces ends with `}`")) };
        }
        if self.accept("_") { self.count() } else { Ok(1) }
    }

    fn count(&mut self) -> Result<usize, LayupError> {
        let rest = self.rest();
        let digits = &rest[..rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len()];
        if digits.is_empty() {
            return Err(self.error("expected how many times to repeat"));
        }
        // A number too long for usize is a repeat that the limit on plies refuses anyway.
        let n = digits.parse().unwrap_or(usize::MAX);
        if n == 0 {
            return Err(self.error("a repeat of 0 leaves no ply"));
        }
        self.at += digits.len();
        Ok(n)
    }

    fn suffix(&mut self, sequence: Sequence) -> Result<Vec<LayupPly>, LayupError> {
        let Sequence { mut plies, bar } = sequence;
        let braced = self.accept("_{");
        if !braced {
            self.accept("_");
        }
        let repeat = if self.peek().is_some_and(|c| c.is_ascii_digit()) { self.count()? } else { 1 };
        let mirrored = self.accept("s");
        if braced && !self.accept("}") {
            return Err(self.error("a suffix in braces ends with `}`, as in [0/90]_{2s}"));
        }
        if let Some(at) = bar.filter(|_| !mirrored || repeat > 1) {
            return Err(self.error_at(at, "a mid-ply needs a mirror without repeat: write [...]s"));
        }
        self.check_count(plies.len().saturating_mul(repeat).saturating_mul(1 + usize::from(mirrored)))?;
        plies = vec![plies; repeat].concat();
        if mirrored {
            let own = plies.len() - usize::from(bar.is_some());
            plies.extend_from_within(..own);
            plies[own + usize::from(bar.is_some())..].reverse();
        }
        Ok(plies)
    }

    fn check_count(&self, plies: usize) -> Result<(), LayupError> {
        if plies <= MAX_PLIES { Ok(()) } else { Err(self.error(format!("more than {MAX_PLIES} plies"))) }
    }
}

/// -0.0 would print as such in tables.
fn positive_zero(angle: f64) -> f64 {
    if angle == 0.0 { 0.0 } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn angles(text: &str) -> Vec<f64> {
        parse(text).unwrap_or_else(|e| panic!("{e}")).iter().map(|p| p.angle_deg).collect()
    }

    fn refused(text: &str) -> LayupError {
        parse(text).expect_err(text)
    }

    #[test]
    fn the_notations_of_the_field() {
        let quasi = [0.0, 45.0, -45.0, 90.0];
        assert_eq!(angles("[0/45/-45/90]"), quasi);
        assert_eq!(angles("[0,+45,-45,90]"), quasi);
        assert_eq!(angles("[ 0 / ±45 / 90 ]"), quasi);
        assert_eq!(angles("[0/+-45/90°]"), quasi);
        let twice_mirrored: Vec<f64> = [0.0, 45.0, -45.0, 90.0, 0.0, 45.0, -45.0, 90.0]
            .into_iter()
            .chain([90.0, -45.0, 45.0, 0.0, 90.0, -45.0, 45.0, 0.0])
            .collect();
        for text in ["[0/45/-45/90]2s", "[0/45/-45/90]_2s", "[0/45/-45/90]_{2s}", "[(0/45/-45/90)2]s"] {
            assert_eq!(angles(text), twice_mirrored, "{text}");
        }
        assert_eq!(angles("[0_2/90_{3}]"), [0.0, 0.0, 90.0, 90.0, 90.0]);
        assert_eq!(angles("[0/(45/-45)2/90]"), [0.0, 45.0, -45.0, 45.0, -45.0, 90.0]);
        assert_eq!(angles("[0/(45/(0/90)_2)s]"), [0.0, 45.0, 0.0, 90.0, 0.0, 90.0, 90.0, 0.0, 90.0, 0.0, 45.0]);
        assert_eq!(angles("[∓45_2/22.5/-0]"), [-45.0, 45.0, -45.0, 45.0, 22.5, 0.0]);
    }

    #[test]
    fn a_barred_ply_is_the_mid_ply() {
        for text in ["[0/45/90bar]s", "[0/45/90|]s", "[0/45/9\u{305}0\u{305}]s", "[0/45/90 bar]_s"] {
            assert_eq!(angles(text), [0.0, 45.0, 90.0, 45.0, 0.0], "{text}");
        }
        assert_eq!(angles("[30bar]s"), [30.0]);
        for text in ["[0/90bar]", "[0/90bar]2s", "[0bar/90]s", "[0/±45bar]s", "[0/90bar_2]s", "[(0/90bar)/0]s"] {
            assert!(refused(text).why.contains("mid-ply"), "{text}");
        }
    }

    #[test]
    fn labels_follow_their_ply() {
        let plies = parse("[0/±45{ core }_2]").unwrap();
        assert_eq!(plies.iter().filter(|p| p.label.as_deref() == Some("core")).count(), 4);
        assert_eq!(plies[0].label, None);
        assert!(refused("[45{co re}]").why.contains("45{core}"));
        assert!(refused("[45{core]").why.contains("`}`"));
    }

    #[test]
    fn the_caret_stands_below_the_trouble() {
        assert_eq!(
            refused("[0/±45/x]").to_string(),
            "expected a ply angle in degrees or a sublaminate in ( )\n  [0/±45/x]\n         ^"
        );
        for (text, at, why) in [
            ("", 0, "begins with `[`"),
            ("0/90", 0, "begins with `[`"),
            ("[0/90", 5, "`]`"),
            ("[0/(45/-45]", 10, "`)`"),
            ("[]", 1, "angle"),
            ("[0//90]", 3, "angle"),
            ("[0/4590]", 3, "is a `/` missing"),
            ("[0/1.2.3]", 3, "angle"),
            ("[0]0s", 3, "no ply"),
            ("[0]s2", 4, "nothing may follow"),
            ("[0_]", 3, "how many"),
        ] {
            let error = refused(text);
            assert_eq!(error.at, at, "{text}: {error}");
            assert!(error.why.contains(why), "{text}: {error}");
        }
    }

    #[test]
    fn no_text_makes_it_allocate_without_bound() {
        for text in ["[0]999999999", "[0_99999999999999999999999]", "[(0_5000)3]", "[((((0_99)99)99)99)99]", "[0]9999s"]
        {
            assert!(refused(text).why.contains("more than 10000 plies"), "{text}");
        }
        assert_eq!(angles("[0]5000s").len(), MAX_PLIES);
        assert!(refused(&"(".repeat(100_000)).why.contains("begins"));
        assert!(refused(&"[".repeat(100_000)).why.contains("16 deep"));
    }

    /// A layup as text together with its plies.
    fn layups() -> impl Strategy<Value = (String, Vec<LayupPly>)> {
        let ply = (-720_i32..=720, proptest::option::of("[a-z][a-z0-9_-]{0,5}"), 1_usize..4).prop_map(
            |(quarters, label, repeat)| {
                let angle_deg = f64::from(quarters) / 4.0;
                let braces = label.as_ref().map_or(String::new(), |l| format!("{{{l}}}"));
                let text =
                    if repeat == 1 { format!("{angle_deg}{braces}") } else { format!("{angle_deg}{braces}_{repeat}") };
                (text, vec![LayupPly { angle_deg, label }; repeat])
            },
        );
        let sequence = ply.prop_recursive(3, 24, 4, |item| {
            (prop::collection::vec(item, 1..4), 1_usize..3, any::<bool>()).prop_map(|(items, repeat, mirrored)| {
                let (texts, plies): (Vec<_>, Vec<_>) = items.into_iter().unzip();
                let mut plies = vec![plies.concat(); repeat].concat();
                if mirrored {
                    plies.extend(plies.clone().into_iter().rev());
                }
                (format!("({}){repeat}{}", texts.join("/"), if mirrored { "s" } else { "" }), plies)
            })
        });
        sequence.prop_map(|(text, plies)| (format!("[{text}]"), plies))
    }

    proptest! {
        #[test]
        fn expansion_agrees_with_the_text_it_was_made_from((text, plies) in layups()) {
            prop_assert_eq!(parse(&text), Ok(plies));
        }

        #[test]
        fn no_text_panics(text in "\\PC*") {
            if let Err(error) = parse(&text) { let _ = error.to_string(); }
        }

        #[test]
        fn no_text_of_the_alphabet_panics(text in "\\[[\\[\\]()/,0-9.±∓+°|_{}s\u{305}a -]{0,40}") {
            if let Ok(plies) = parse(&text) { prop_assert!(!plies.is_empty() && plies.len() <= MAX_PLIES); }
        }
    }
}
