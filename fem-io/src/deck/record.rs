//! One record of items: whole numbers, real numbers, labels.

use super::reader::BLANKS;
use super::source::{DeckError, DeckPlace, DeckSource, Fault};
use std::ops::RangeInclusive;

/// A value with its place in the deck.
#[derive(Debug, Clone, PartialEq)]
pub struct Stated<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub place: DeckPlace,
}

/// The items of a line.
#[derive(Debug)]
pub(super) struct Record<'a> {
    source: &'a DeckSource,
    line: DeckPlace,
    items: Vec<DeckPlace>,
    fields: Vec<&'static str>,
}

impl<'a> Record<'a> {
    pub(super) fn new(source: &'a DeckSource, line: DeckPlace, fields: &[&'static str]) -> Self {
        let text = &source.text()[line.clone()];
        let (mut items, mut at) = (Vec::new(), line.start);
        for item in text.split(',') {
            let inner = item.trim_matches(BLANKS);
            let start = at + (item.len() - item.trim_start_matches(BLANKS).len());
            items.push(start..start + inner.len());
            at += item.len() + 1;
        }
        Self { source, line, items, fields: fields.to_vec() }
    }

    pub(super) fn items(&self) -> usize {
        self.items.len()
    }

    /// The line.
    pub(super) fn place(&self) -> &DeckPlace {
        &self.line
    }

    /// Item `i`, or the end of the line where it is missing or empty.
    pub(super) fn item_place(&self, i: usize) -> DeckPlace {
        match self.items.get(i) {
            Some(item) if !item.is_empty() => item.clone(),
            _ => self.line.clone(),
        }
    }

    pub(super) fn text(&self, i: usize) -> &'a str {
        self.items.get(i).map_or("", |item| &self.source.text()[item.clone()])
    }

    fn field(&self, i: usize) -> &'static str {
        self.fields.get(i).or(self.fields.last()).copied().unwrap_or("item")
    }

    pub(super) fn error<T>(
        &self,
        i: usize,
        fault: Fault,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Result<T, DeckError> {
        Err(self.source.error(self.item_place(i), fault, message, help))
    }

    fn one(&self, i: usize) -> Result<&'a str, DeckError> {
        let text = self.text(i);
        if text.contains(BLANKS) {
            return self.error(
                i,
                Fault::NoComma,
                format!("{}: `{text}` holds two values without a comma", self.field(i)),
                "separate items by commas",
            );
        }
        Ok(text)
    }

    fn whole(&self, i: usize) -> Result<i64, DeckError> {
        let text = self.one(i)?;
        let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
        if text.is_empty() {
            return Ok(0);
        }
        let plain = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
        match text.parse() {
            Ok(number) if plain => Ok(number),
            _ => self.error(
                i,
                Fault::NotANumber,
                format!("{}: `{text}` is not a whole number", self.field(i)),
                if plain { "it has too many digits" } else { "a sign if need be, then digits alone" },
            ),
        }
    }

    /// A whole number of at least `least`.
    pub(super) fn count(&self, i: usize, least: usize) -> Result<Stated<usize>, DeckError> {
        let number = self.whole(i)?;
        match usize::try_from(number) {
            Ok(value) if value >= least => Ok(Stated { value, place: self.item_place(i) }),
            _ => self.error(
                i,
                Fault::Count,
                format!("{} is {number}", self.field(i)),
                format!("{least} or more belongs there; what is left out is 0"),
            ),
        }
    }

    /// A flag or choice.
    pub(super) fn choice(&self, i: usize, known: RangeInclusive<usize>) -> Result<usize, DeckError> {
        let number = self.whole(i)?;
        match usize::try_from(number) {
            Ok(value) if known.contains(&value) => Ok(value),
            _ => self.error(
                i,
                Fault::Flag,
                format!("{} is {number}, {} to {} are known", self.field(i), known.start(), known.end()),
                "what is left out is 0",
            ),
        }
    }

    /// A flag that prints when it is 0.
    pub(super) fn prints(&self, i: usize) -> Result<bool, DeckError> {
        Ok(self.choice(i, 0..=1)? == 0)
    }

    /// A number from 1 on of one of `known` things.
    pub(super) fn number(&self, i: usize, known: usize, fault: Fault, what: &str) -> Result<Stated<usize>, DeckError> {
        let number = self.whole(i)?;
        match usize::try_from(number) {
            Ok(value) if (1..=known).contains(&value) => Ok(Stated { value, place: self.item_place(i) }),
            _ => self.error(
                i,
                fault,
                format!("{} is {number}, there are {known} {what}", self.field(i)),
                format!("1 to {known} belongs there; what is left out is 0"),
            ),
        }
    }

    /// A node number of at least `least`.
    pub(super) fn node(&self, i: usize, least: u32) -> Result<Stated<u32>, DeckError> {
        let number = self.whole(i)?;
        match u32::try_from(number) {
            Ok(value) if value >= least => Ok(Stated { value, place: self.item_place(i) }),
            _ => self.error(
                i,
                Fault::NoSuchNode,
                format!("{} is {number}, which is no number of a node", self.field(i)),
                format!("node numbers are {least} or more; what is left out is 0"),
            ),
        }
    }

    /// A real number; an empty item is 0.
    pub(super) fn real(&self, i: usize) -> Result<f64, DeckError> {
        let text = self.one(i)?;
        if text.is_empty() {
            return Ok(0.0);
        }
        match parse_real(text) {
            Some(value) if value.is_finite() => Ok(value),
            found => self.error(
                i,
                Fault::NotANumber,
                format!(
                    "{}: `{text}` is {}",
                    self.field(i),
                    if found.is_some() { "too large a number" } else { "not a number" }
                ),
                "such as 1, 1., .5, -1.5E-9 or 2.D-7",
            ),
        }
    }

    /// A real number above zero.
    pub(super) fn positive(&self, i: usize, fault: Fault) -> Result<f64, DeckError> {
        let value = self.real(i)?;
        if value > 0.0 {
            return Ok(value);
        }
        self.error(i, fault, format!("{} is {value}, it must be above zero", self.field(i)), "what is left out is 0")
    }
}

/// A real number as FORTRAN writes it, without NAN, infinities and repeat counts.
fn parse_real(text: &str) -> Option<f64> {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    let (mantissa, exponent) = match unsigned.find(['e', 'E', 'd', 'D']) {
        Some(at) => (&unsigned[..at], Some(&unsigned[at + 1..])),
        None => (unsigned, None),
    };
    let digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let (before, after) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let sound = digits(before) && digits(after) && !(before.is_empty() && after.is_empty());
    let power = |text: &str| {
        let number = text.strip_prefix(['+', '-']).unwrap_or(text);
        !number.is_empty() && digits(number)
    };
    if !sound || !exponent.is_none_or(power) {
        return None;
    }
    text.replace(['d', 'D'], "e").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::parse_real;

    #[test]
    fn numbers_of_fortran() {
        for (text, value) in
            [("1", 1.0), ("1.", 1.0), (".5", 0.5), ("-1.5E-9", -1.5e-9), ("2.D-7", 2e-7), ("+3d2", 300.0)]
        {
            assert_eq!(parse_real(text), Some(value), "{text}");
        }
        for text in ["", ".", "-", "e5", "1e", "1e+", "nan", "inf", "3*0.", "1_0", "1.2.3", "O.1", "0x1", "1 2", "--1"]
        {
            assert_eq!(parse_real(text), None, "{text}");
        }
        assert_eq!(parse_real("1e999"), Some(f64::INFINITY));
    }
}
