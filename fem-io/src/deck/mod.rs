//! The input decks of LAMCEL, LAMSUB and TRADYR (appendix of AFWAL-TR-87-4117).
//!
//! A deck is lines of items between commas; what belongs in each is said by its program, not by the deck. Whatever is wrong is
//! refused in the order of the records, with its line, what was found and what belongs there. Numbers stay in the deck's units.
//!
//! | records | where |
//! | --- | --- |
//! | lines, items, numbers | `reader`, `record` |
//! | materials and plies (C) | `laminate` |
//! | cells and substructures (D) | `cell` |
//! | constraints, masters, governors (E, F) | `freedom` |
//! | generation | `generation` |
//! | back substitution (B) | `back` |
//! | new analysis and restart of TRADYR | `impact` |
//!
//! ```
//! use fem_io::deck::{Deck, DeckSource, NoResults, Program, parse};
//!
//! let deck = "Go on\n1,1\n4,2000,100,1\n1,1,1\n2.E-7\n";
//! let parsed = parse(&DeckSource::new("restart.dat", deck.into()), Program::Tradyr, &NoResults)?;
//! assert!(matches!(parsed.deck, Deck::Restart(march) if march.steps == 2000));
//! let error = parse(&DeckSource::new("restart.dat", deck.replace("4,", "5,")), Program::Tradyr, &NoResults).unwrap_err();
//! assert_eq!((error.line(), error.to_string().as_str()), (3, "INTALG is 5, 1 to 4 are known"));
//! # Ok::<(), fem_io::deck::DeckError>(())
//! ```

mod back;
mod cell;
mod freedom;
mod generation;
mod impact;
mod laminate;
mod reader;
mod record;
mod source;

pub use back::{BackSubstitution, Prints, Set};
pub use cell::{DeckPiece, ElementCard, Node};
pub use freedom::{Freedom, Relation};
pub use generation::{Generation, PieceKind};
pub use impact::{ImpactDeck, ImpactorCard, MarchCard, Placed};
pub use laminate::DeckLaminate;
pub use record::Stated;
pub use source::{DeckError, DeckPlace, DeckSource, Fault};

use reader::Reader;
use std::fmt;

/// The program that a deck is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Program {
    Lamcel,
    Lamsub,
    Tradyr,
}

impl fmt::Display for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Lamcel => "LAMCEL",
            Self::Lamsub => "LAMSUB",
            Self::Tradyr => "TRADYR",
        })
    }
}

/// What a deck says.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum Deck {
    Generation(Generation),
    BackSubstitution(BackSubstitution),
    Impact(ImpactDeck),
    Restart(MarchCard),
}

impl Deck {
    /// Its title.
    pub fn title(&self) -> &str {
        match self {
            Self::Generation(deck) => &deck.title,
            Self::BackSubstitution(deck) => &deck.title,
            Self::Impact(deck) => &deck.march.title,
            Self::Restart(march) => &march.title,
        }
    }

    /// Whether more than a data check is asked for.
    pub fn analyses(&self) -> bool {
        match self {
            Self::Generation(deck) => deck.analyse,
            Self::BackSubstitution(deck) => deck.analyse,
            Self::Impact(deck) => deck.march.analyse,
            Self::Restart(march) => march.analyse,
        }
    }
}

/// A deck that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Parsed {
    /// What it says.
    pub deck: Deck,
    /// What is odd but no mistake, each with its line.
    pub warnings: Vec<String>,
}

/// What a displacement set holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    /// Its print steps.
    pub steps: usize,
    /// Substructures of its model.
    pub substructures: usize,
    /// Elements of the generation that is asked about.
    pub elements: usize,
}

/// The results that a deck may name.
///
/// Every answer may be `None`: it is not known, and nothing is checked against it. An error says what is there instead.
pub trait KnownResults {
    /// Number of masters of the matrices `name`; `Ok(None)` where nothing is to be checked.
    ///
    /// # Errors
    /// There are no such matrices.
    fn masters(&self, name: &str) -> Result<Option<usize>, String>;

    /// What a back substitution of `program` finds under its names: the generation of the first five, the displacement set of
    /// the last.
    ///
    /// # Errors
    /// Which of the six names is wrong, and why.
    fn extent(&self, program: Program, names: &[String; 6]) -> Result<Option<Extent>, (usize, String)>;

    /// Refuses a substructure that is made of other matrices than those of the generation.
    ///
    /// # Errors
    /// What it is made of.
    fn made_of(&self, names: &[String; 6], substructure: usize) -> Result<(), String>;

    /// Whether there is an analysis to go on with; `None` where nothing is to be checked.
    fn restart(&self) -> Option<bool>;
}

/// No results are known: a deck is checked by itself.
#[derive(Debug, Clone, Copy)]
pub struct NoResults;

impl KnownResults for NoResults {
    fn masters(&self, _: &str) -> Result<Option<usize>, String> {
        Ok(None)
    }

    fn extent(&self, _: Program, _: &[String; 6]) -> Result<Option<Extent>, (usize, String)> {
        Ok(None)
    }

    fn made_of(&self, _: &[String; 6], _: usize) -> Result<(), String> {
        Ok(())
    }

    fn restart(&self) -> Option<bool> {
        None
    }
}

/// Reads a deck of `program`, checked against `results` record by record.
///
/// # Errors
/// The first mistake.
pub fn parse(source: &DeckSource, program: Program, results: &dyn KnownResults) -> Result<Parsed, DeckError> {
    let mut reader = Reader::new(source);
    let deck = match program {
        Program::Tradyr => impact::read(&mut reader, results)?,
        lam => generation::read(&mut reader, lam, results)?,
    };
    Ok(Parsed { deck, warnings: reader.finish()? })
}

/// The program that `source` was most likely written for: TRADYR's third record are numbers where the others have a name; of
/// LAMCEL and LAMSUB the one that reads it, or reads more of it.
pub fn guess(source: &DeckSource) -> Program {
    let third = source.text().lines().filter(|line| !line.trim().is_empty()).nth(2).unwrap_or_default();
    let numbers = |line: &str| line.split(',').all(|item| item.trim().parse::<i64>().is_ok() || item.trim().is_empty());
    if numbers(third.split('!').next().unwrap_or_default()) {
        return Program::Tradyr;
    }
    let reaches = |program| parse(source, program, &NoResults).map_or_else(|error| error.line(), |_| usize::MAX);
    if reaches(Program::Lamsub) > reaches(Program::Lamcel) { Program::Lamsub } else { Program::Lamcel }
}
