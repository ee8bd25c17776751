//! Lines and records of a deck.

use super::record::{Record, Stated};
use super::source::{DeckError, DeckPlace, DeckSource, Fault};

/// Node numbers in a line of a list.
const TEN: usize = 10;
/// Longest title, label and name, characters.
const TITLE: usize = 78;
const LABEL: usize = 40;
const NAME: usize = 40;

/// Goes through a deck line by line.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    pub(super) source: &'a DeckSource,
    at: usize,
    /// What is odd but no mistake.
    pub(super) warnings: Vec<String>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a DeckSource) -> Self {
        Self { source, at: 0, warnings: Vec::new() }
    }

    /// An error at `place`.
    pub(super) fn error<T>(
        &self,
        place: &DeckPlace,
        fault: Fault,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Result<T, DeckError> {
        Err(self.source.error(place.clone(), fault, message, help))
    }

    /// The line of a place.
    pub(super) fn line_of(&self, place: &DeckPlace) -> usize {
        self.source.line(place)
    }

    pub(super) fn warn(&mut self, place: &DeckPlace, text: &str) {
        self.warnings.push(format!("line {}: {text}", self.source.line(place)));
    }

    /// The next line, without its end.
    fn line(&mut self) -> Option<DeckPlace> {
        let text = self.source.text();
        let rest = text.get(self.at..).filter(|rest| !rest.is_empty())?;
        let start = self.at;
        let length = rest.find('\n').unwrap_or(rest.len());
        self.at = start + (length + 1).min(rest.len());
        let line = &rest[..length];
        Some(start..start + line.strip_suffix('\r').unwrap_or(line).len())
    }

    /// The next line with items, comments taken away.
    fn line_of_items(&mut self) -> Option<DeckPlace> {
        loop {
            let line = self.line()?;
            let text = &self.source.text()[line.clone()];
            let end = text.find('!').unwrap_or(text.len());
            if !text[..end].trim_matches(BLANKS).is_empty() {
                return Some(line.start..line.start + end);
            }
        }
    }

    fn ends<T>(&self, what: &str) -> Result<T, DeckError> {
        let text = self.source.text();
        let end = text.trim_end().len();
        let last = text[..end].rfind('\n').map_or(0, |at| at + 1);
        // The mistake is on the line that is not there.
        let place = if end == 0 { 0..0 } else { self.after(end, last..end) };
        self.error(
            &place,
            Fault::EndOfFile,
            format!("the deck ends where {what} is expected"),
            "a record is missing, or a count above is too high",
        )
    }

    /// The line after `end`, if there is one, otherwise the `last`.
    fn after(&self, end: usize, last: DeckPlace) -> DeckPlace {
        match self.source.text()[end..].find('\n') {
            Some(at) => end + at + 1..end + at + 1,
            None => last,
        }
    }

    /// The next record of items, as many as `fields` at most.
    pub(super) fn record(&mut self, fields: &[&'static str]) -> Result<Record<'a>, DeckError> {
        let Some(line) = self.line_of_items() else { return self.ends(&fields.join(", ")) };
        let record = Record::new(self.source, line, fields);
        if record.items() > fields.len() {
            return self.error(
                &record.item_place(fields.len()),
                Fault::TooManyItems,
                format!("{} items where {} are expected: {}", record.items(), fields.len(), fields.join(", ")),
                "a comma too many, or a record is missing above",
            );
        }
        Ok(record)
    }

    /// A record of one whole number of at least `least`.
    pub(super) fn count(&mut self, field: &'static str, least: usize) -> Result<Stated<usize>, DeckError> {
        self.record(&[field])?.count(0, least)
    }

    /// A line of text, cut when it is too long.
    fn text(&mut self, what: &str, longest: usize) -> Result<String, DeckError> {
        let Some(line) = self.line() else { return self.ends(what) };
        let text = &self.source.text()[line.clone()];
        let cut: String = text.chars().take(longest).collect();
        if text.trim_end().chars().count() > longest {
            self.warn(&line, &format!("{what} is longer than {longest} characters and was cut"));
        }
        Ok(cut.trim_end().to_owned())
    }

    pub(super) fn title(&mut self) -> Result<String, DeckError> {
        self.text("TITLE", TITLE)
    }

    pub(super) fn label(&mut self) -> Result<String, DeckError> {
        self.text("LABEL", LABEL)
    }

    /// A line that holds a name.
    pub(super) fn name(&mut self, field: &'static str) -> Result<Stated<String>, DeckError> {
        let Some(line) = self.line() else { return self.ends(field) };
        let text = &self.source.text()[line.clone()];
        let name = text.trim_matches(BLANKS);
        let start = line.start + (text.len() - text.trim_start_matches(BLANKS).len());
        let place = if name.is_empty() { line } else { start..start + name.len() };
        let length = name.chars().count();
        if name.is_empty() {
            return self.error(
                &place,
                Fault::EmptyName,
                format!("{field} is empty"),
                format!("a name of 1 to {NAME} characters"),
            );
        }
        if length > NAME {
            return self.error(
                &place,
                Fault::LongName,
                format!("{field} has {length} characters, {NAME} at most"),
                "cutting it could make two names one: choose a shorter one",
            );
        }
        let odd = name.chars().find(|c| "/\\:,".contains(*c) || !(c.is_ascii_graphic() || *c == ' '));
        if let Some(c) = odd {
            return self.error(
                &place,
                Fault::BadName,
                format!("{field} holds {c:?}"),
                r"names are ASCII without / \ : and commas",
            );
        }
        if name.starts_with('.') {
            return self.error(&place, Fault::BadName, format!("{field} begins with a dot"), "begin with a letter");
        }
        Ok(Stated { value: name.to_owned(), place })
    }

    /// A list of `count` node numbers, ten in every line but the last; calls `take` with each.
    pub(super) fn list(
        &mut self,
        count: &Stated<usize>,
        what: &str,
        mut take: impl FnMut(&Self, Stated<u32>) -> Result<(), DeckError>,
    ) -> Result<(), DeckError> {
        let mut left = count.value;
        while left > 0 {
            let Some(line) = self.line_of_items() else { return self.ends(what) };
            let record = Record::new(self.source, line, &["NODE"]);
            let belong = left.min(TEN);
            if record.items() != belong {
                return self.error(
                    record.place(),
                    Fault::GroupOfTen,
                    format!(
                        "{} numbers in a line where {belong} belong ({what}, {} in all)",
                        record.items(),
                        count.value
                    ),
                    "lists have ten numbers in every line but the last, which has the rest",
                );
            }
            for i in 0..belong {
                take(self, record.node(i, 1)?)?;
            }
            left -= belong;
        }
        Ok(())
    }

    /// Whether the deck has another record.
    pub(super) fn more(&self) -> bool {
        Self { source: self.source, at: self.at, warnings: Vec::new() }.line_of_items().is_some()
    }

    /// Refuses what follows the last record; returns the warnings.
    pub(super) fn finish(mut self) -> Result<Vec<String>, DeckError> {
        match self.line_of_items() {
            None => Ok(self.warnings),
            Some(place) => self.error(
                &place,
                Fault::LeftOver,
                "the deck goes on after its last record",
                "a count above is too low, or a record stands there twice",
            ),
        }
    }
}

/// What may stand around an item.
pub(super) const BLANKS: [char; 3] = [' ', '\t', '\r'];
