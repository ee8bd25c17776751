//! The text of a deck, places in it, and errors that show the place.

use crate::bytes::{self, Links};
use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Largest deck that is read.
const MAX_BYTES: u64 = 1 << 22;

/// Where something stands in a deck, bytes.
pub type DeckPlace = Range<usize>;

/// What is wrong with a deck, in one word that programs can tell apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Fault {
    Unreadable,
    EndOfFile,
    LeftOver,
    TooManyItems,
    NoComma,
    NotANumber,
    Flag,
    Count,
    GroupOfTen,
    EmptyName,
    LongName,
    BadName,
    Twice,
    Material,
    Thickness,
    NoSuchMaterial,
    NoSuchPly,
    Layers,
    ElementNodes,
    Geometry,
    NotConnected,
    NoSuchColumn,
    NoSuchNode,
    NoSuchElement,
    NoSuchResult,
    BadDirection,
    Constrained,
    ZeroFactor,
    Masters,
    NotAGovernor,
    Step,
    Impact,
    Unstable,
    Singular,
    SingularMass,
    NoRestart,
    NoUnits,
    NothingToJudge,
    TooLarge,
}

impl fmt::Display for Fault {
    /// The variant in lower case with hyphens: `too-many-items`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, c) in format!("{self:?}").chars().enumerate() {
            match c {
                c if c.is_ascii_uppercase() && i > 0 => write!(f, "-{}", c.to_ascii_lowercase())?,
                c => write!(f, "{}", c.to_ascii_lowercase())?,
            }
        }
        Ok(())
    }
}

/// The text of a deck with its name; makes errors that show a place in it.
#[derive(Debug, Clone)]
pub struct DeckSource(Arc<NamedSource<String>>);

impl DeckSource {
    /// The text of the file `path`; bytes that are no UTF-8 may stand in titles and comments.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(path: &Path) -> Result<Self, DeckError> {
        let name = path.display().to_string();
        match bytes::read(path, MAX_BYTES, Links::Follow) {
            Ok(bytes) => Ok(Self::new(&name, String::from_utf8_lossy(&bytes).into_owned())),
            Err(why) => Err(Self::new(&name, String::new()).error(
                0..0,
                Fault::Unreadable,
                format!("cannot read the deck `{name}`: {why}"),
                "name a file of text",
            )),
        }
    }

    /// A deck that is no file. A byte order mark is no part of its title, and lines may end as those of old Macs do.
    pub fn new(name: &str, text: String) -> Self {
        let text = text.strip_prefix('\u{feff}').map_or_else(|| text.clone(), str::to_owned);
        let text = if text.contains('\n') { text } else { text.replace('\r', "\n") };
        Self(Arc::new(NamedSource::new(name, text)))
    }

    /// The text.
    pub fn text(&self) -> &str {
        self.0.inner()
    }

    /// Its name.
    pub fn name(&self) -> &str {
        self.0.name()
    }

    /// Line of a place, from 1.
    pub fn line(&self, place: &DeckPlace) -> usize {
        let before = &self.text().as_bytes()[..place.start.min(self.text().len())];
        1 + before.iter().filter(|b| **b == b'\n').count()
    }

    /// An error at `place`.
    pub fn error(
        &self,
        place: DeckPlace,
        fault: Fault,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> DeckError {
        DeckError(Box::new(Inner { source: self.clone(), place, fault, message: message.into(), help: help.into() }))
    }
}

/// Why a deck is refused: what is wrong, where, what was found and what belongs there.
#[derive(Debug, Clone)]
pub struct DeckError(Box<Inner>);

#[derive(Debug, Clone)]
struct Inner {
    source: DeckSource,
    place: DeckPlace,
    fault: Fault,
    message: String,
    help: String,
}

impl DeckError {
    /// Line, from 1.
    pub fn line(&self) -> usize {
        self.0.source.line(&self.0.place)
    }

    /// The kind of mistake.
    pub fn fault(&self) -> Fault {
        self.0.fault
    }

    /// What to do about it.
    pub fn remedy(&self) -> &str {
        &self.0.help
    }
}

impl fmt::Display for DeckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.message)
    }
}
impl std::error::Error for DeckError {}

impl Diagnostic for DeckError {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.0.fault))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        (!self.0.help.is_empty()).then(|| Box::new(&self.0.help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        (!self.0.source.text().is_empty()).then_some(&*self.0.source.0 as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(std::iter::once(LabeledSpan::underline(self.0.place.clone()))))
    }
}
