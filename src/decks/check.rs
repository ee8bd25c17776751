//! All decks of a folder, checked without a march.

use super::{DeckOptions, Matrices, Project, run};
use crate::error::Error;
use fem_io::deck::{self, Deck, DeckSource, NoResults, Program};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Endings of decks.
const ENDINGS: [&str; 2] = ["dat", "deck"];

/// What was found of a deck.
#[derive(Debug, Clone, Serialize)]
pub struct Checked {
    /// Its file.
    pub deck: String,
    /// The program that it is for, as far as that can be seen.
    pub program: String,
    /// The first mistake.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<Mistake>,
    /// What is odd.
    pub warnings: Vec<String>,
}

/// A mistake in a deck.
#[derive(Debug, Clone, Serialize)]
pub struct Mistake {
    /// Line, from 1.
    pub line: usize,
    /// Its kind.
    pub fault: String,
    /// What was found.
    pub message: String,
    /// What belongs there.
    pub remedy: String,
}

/// Checks the decks in `folder`: all is done in the order in which they need each other, but for the march in time and what
/// would be written.
///
/// # Errors
/// A folder that cannot be read.
pub fn check(folder: &Path) -> Result<Vec<Checked>, Error> {
    let mut decks = decks(folder)?;
    let program = |source: &DeckSource| named(source).unwrap_or_else(|| deck::guess(source));
    let rank = |source: &DeckSource| match deck::parse(source, program(source), &NoResults).map(|parsed| parsed.deck) {
        Ok(Deck::Generation(_)) => 0,
        Ok(Deck::Impact(_)) => 1,
        Ok(Deck::Restart(_)) => 2,
        Ok(Deck::BackSubstitution(_)) | Err(_) => 3,
    };
    decks.sort_by_cached_key(|source| (rank(source), source.name().to_owned()));
    let mut project = Project::in_memory();
    let check = |source: &DeckSource| {
        let mut program = program(source);
        if named(source).is_none()
            && let Ok(Deck::BackSubstitution(back)) = deck::parse(source, program, &NoResults).map(|parsed| parsed.deck)
        {
            // What wrote the names is the program, which such a deck does not show.
            program = project.generation(&back.names).map_or(program, Matrices::program);
        }
        let done = run(source, program, &mut project, &DeckOptions { check: true, ..DeckOptions::default() });
        let (warnings, error) = match done {
            Ok(outcome) => (outcome.warnings, None),
            Err(Error::Deck(error)) => {
                let (line, fault, message) = (error.line(), error.fault().to_string(), error.to_string());
                (Vec::new(), Some(Mistake { line, fault, message, remedy: error.remedy().to_owned() }))
            }
            Err(error) => return Err(error),
        };
        Ok(Checked { deck: source.name().to_owned(), program: program.to_string(), error, warnings })
    };
    let mut checked = decks.iter().map(check).collect::<Result<Vec<_>, Error>>()?;
    checked.sort_by(|a, b| a.deck.cmp(&b.deck));
    Ok(checked)
}

/// The program that the name of a deck's file holds; of several the first, as in 62-lamsub-of-lamcel.
fn named(source: &DeckSource) -> Option<Program> {
    let name = Path::new(source.name()).file_name()?.to_string_lossy().to_lowercase();
    let programs = [("lamcel", Program::Lamcel), ("lamsub", Program::Lamsub), ("tradyr", Program::Tradyr)];
    let found = programs.into_iter().filter_map(|(text, program)| Some((name.find(text)?, program)));
    found.min_by_key(|(at, _)| *at).map(|(_, program)| program)
}

fn decks(folder: &Path) -> Result<Vec<DeckSource>, Error> {
    let entries = std::fs::read_dir(folder).map_err(|cause| fem_io::files::FileError::Io {
        action: "read the folder",
        path: folder.to_owned(),
        cause,
    })?;
    let is_deck =
        |path: &PathBuf| path.extension().is_some_and(|e| ENDINGS.iter().any(|known| e.eq_ignore_ascii_case(known)));
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path())).filter(is_deck);
    Ok(paths.map(|path| DeckSource::read(&path)).collect::<Result<_, _>>()?)
}
