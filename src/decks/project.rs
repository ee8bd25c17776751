//! A project: a folder of results by name, which later decks go on from.

use crate::error::Error;
use fem_core::time::State;
use fem_io::checkpoint;
use fem_io::deck::{self, Deck, DeckSource, Extent, Fault, Generation, KnownResults, NoResults, Program};
use fem_io::files::{FileError, OutputDir};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// Endings of the files of a project, and the file that the last analysis is gone on from.
const MATRICES: &str = ".matrices";
const SET: &str = ".displacements";
const LATEST: &str = "latest.restart";

/// What a generation leaves under NAME6: K̂ and M̂ of a piece, and its deck, from which everything else follows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Matrices {
    /// Name and text of the deck.
    pub deck: (String, String),
    /// Whether LAMSUB made it, or LAMCEL.
    pub lamsub: bool,
    /// NAME1 to NAME6.
    pub names: [String; 6],
    /// Node and label of each master.
    pub masters: Vec<(u32, String)>,
    /// Number of elements.
    pub elements: usize,
    /// K̂, column-major.
    pub k: Vec<f64>,
    /// M̂.
    pub m: Vec<f64>,
}

impl Matrices {
    pub(super) fn new(source: &DeckSource, deck: &Generation, k: Vec<f64>, m: Vec<f64>) -> Self {
        let per_node = deck.freedom.directions.len();
        let master =
            |dof: &usize| (deck.freedom.nodes[dof / per_node], deck.freedom.directions[dof % per_node].clone());
        Self {
            deck: (source.name().to_owned(), source.text().to_owned()),
            lamsub: deck.program == Program::Lamsub,
            names: deck.names.clone(),
            masters: deck.freedom.kept.iter().map(master).collect(),
            elements: deck.piece.elements.len(),
            k,
            m,
        }
    }

    /// Whether the matrices have a row for each master.
    fn fits(&self) -> bool {
        let entries = self.masters.len().pow(2);
        self.k.len() == entries && self.m.len() == entries
    }

    /// Its deck, read once more; nothing of one that is none.
    pub(super) fn piece(&self) -> Option<Generation> {
        let source = DeckSource::new(&self.deck.0, self.deck.1.clone());
        match deck::parse(&source, self.program(), &NoResults).ok()?.deck {
            Deck::Generation(piece) => Some(piece),
            _ => None,
        }
    }

    /// The program that made it.
    pub fn program(&self) -> Program {
        if self.lamsub { Program::Lamsub } else { Program::Lamcel }
    }

    /// By which two versions of it are told apart.
    pub(super) fn checksum(&self) -> String {
        let mut hash = Sha256::new();
        hash.update(&self.deck.1);
        self.k.iter().chain(&self.m).for_each(|value| hash.update(value.to_le_bytes()));
        hash.finalize().iter().fold(String::new(), |mut text, byte| {
            let _ = write!(text, "{byte:02x}");
            text
        })
    }
}

/// An analysis that can be gone on with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Analysis {
    /// Name and text of the deck that began it.
    pub(super) deck: (String, String),
    /// Names and checksums of the matrices of its substructures.
    pub(super) parts: Vec<(String, String)>,
    /// Where it has come to; nothing where it was only checked.
    pub(super) state: Option<State>,
}

/// What TRADYR leaves under NAME1: the motion of all degrees of freedom of the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct DisplacementSet {
    pub(super) analysis: Analysis,
    /// Number of print steps.
    pub(super) count: usize,
    /// Time and displacements of each; none where they were only checked.
    pub(super) steps: Vec<(f64, Vec<f64>)>,
}

impl DisplacementSet {
    /// Whether it has the print steps that it counts, all of one length.
    fn fits(&self) -> bool {
        self.steps.len() == self.count && self.steps.windows(2).all(|pair| pair[0].1.len() == pair[1].1.len())
    }
}

/// Results by name, in a folder or in memory.
#[derive(Debug, Default)]
pub struct Project {
    dir: Option<OutputDir>,
    matrices: BTreeMap<String, Matrices>,
    sets: BTreeMap<String, DisplacementSet>,
    latest: Option<Analysis>,
}

impl Project {
    /// A project that leaves nothing behind.
    pub fn in_memory() -> Self {
        Self::default()
    }

    /// The project in `folder`, which may hold other files as well.
    ///
    /// # Errors
    /// A folder that cannot be used, a result in it that is damaged.
    pub fn open(folder: &Path) -> Result<Self, FileError> {
        let dir = OutputDir::open(folder)?;
        let mut project = Self::default();
        let entries = std::fs::read_dir(folder).map_err(|cause| FileError::Io {
            action: "read the folder",
            path: folder.to_owned(),
            cause,
        })?;
        for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            if let Some(name) = name.strip_suffix(MATRICES) {
                project.matrices.insert(name.to_owned(), load(&path, Matrices::fits)?);
            } else if let Some(name) = name.strip_suffix(SET) {
                project.sets.insert(name.to_owned(), load(&path, DisplacementSet::fits)?);
            } else if name == LATEST {
                project.latest = Some(load(&path, |_| true)?);
            }
        }
        project.dir = Some(dir);
        Ok(project)
    }

    /// Where its files lie, if anywhere.
    pub fn dir(&self) -> Option<&OutputDir> {
        self.dir.as_ref()
    }

    /// The matrices `name`.
    pub fn matrices(&self, name: &str) -> Option<&Matrices> {
        self.matrices.get(name)
    }

    /// Names of all results.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.matrices.keys().chain(self.sets.keys()).map(String::as_str)
    }

    /// The displacement set `name`.
    pub(super) fn set(&self, name: &str) -> Option<&DisplacementSet> {
        self.sets.get(name)
    }

    /// The generation whose NAME1 to NAME5 are the first of `names`.
    pub(super) fn generation(&self, names: &[String; 6]) -> Option<&Matrices> {
        self.matrices.values().find(|matrices| matrices.names[..5] == names[..5])
    }

    /// What a restart goes on from: the last analysis, or that of a displacement set.
    pub(super) fn analysis(&self, set: Option<&str>) -> Option<&Analysis> {
        match set {
            Some(name) => Some(&self.sets.get(name)?.analysis),
            None => self.latest.as_ref(),
        }
    }

    /// Refuses results of matrices that are other ones by now.
    ///
    /// # Errors
    /// Which matrices were made anew.
    pub(super) fn fresh(&self, parts: &[(String, String)]) -> Result<(), String> {
        let mut known = BTreeMap::new();
        for (name, then) in parts {
            let now = known.entry(name).or_insert_with(|| self.matrices.get(name).map(Matrices::checksum));
            if now.as_ref() != Some(then) {
                return Err(format!("the matrices `{name}` were made anew since"));
            }
        }
        Ok(())
    }

    /// Keeps an analysis: where it has come to, and its print steps under `name`.
    ///
    /// # Errors
    /// As [`Project::keep_matrices`].
    pub(super) fn keep_analysis(
        &mut self,
        source: &DeckSource,
        name: Option<&str>,
        set: DisplacementSet,
    ) -> Result<(), Error> {
        self.save(LATEST, "", &set.analysis)?;
        self.latest = Some(set.analysis.clone());
        if let Some(name) = name {
            alike(source, name, self.sets.keys())?;
            self.save(name, SET, &set)?;
            self.sets.insert(name.to_owned(), set);
        }
        Ok(())
    }

    /// Keeps what a generation came to under its NAME6.
    ///
    /// # Errors
    /// A name that another one differs from by capitals alone; a folder that cannot be written.
    pub(super) fn keep_matrices(
        &mut self,
        source: &DeckSource,
        deck: &Generation,
        matrices: Matrices,
    ) -> Result<(), Error> {
        let name = &deck.names[5];
        alike(source, name, self.matrices.keys())?;
        self.save(name, MATRICES, &matrices)?;
        self.matrices.insert(name.clone(), matrices);
        Ok(())
    }

    fn save(&self, name: &str, ending: &str, what: &impl Serialize) -> Result<(), FileError> {
        let Some(dir) = &self.dir else { return Ok(()) };
        let file = format!("{name}{ending}");
        let payload = postcard::to_stdvec(what);
        let payload = payload.map_err(|e| FileError::Damaged { path: dir.path().join(&file), why: e.to_string() })?;
        checkpoint::write(dir, &file, &payload)
    }
}

fn load<T: DeserializeOwned>(path: &Path, fits: impl Fn(&T) -> bool) -> Result<T, FileError> {
    let damaged = |why: String| {
        let why = format!("{why}; remove it, and run the deck that made it again");
        FileError::Damaged { path: path.to_owned(), why }
    };
    let payload = checkpoint::read(path).map_err(|error| match error {
        FileError::Damaged { why, .. } => damaged(why),
        other => other,
    })?;
    let loaded = postcard::from_bytes(&payload).map_err(|e| damaged(e.to_string()))?;
    if fits(&loaded) { Ok(loaded) } else { Err(damaged("its parts do not fit each other".into())) }
}

/// Refuses a name that differs from one of `others` by capitals alone.
fn alike<'a>(source: &DeckSource, name: &str, others: impl Iterator<Item = &'a String>) -> Result<(), Error> {
    match others.into_iter().find(|other| other.eq_ignore_ascii_case(name) && *other != name) {
        Some(other) => {
            let found = format!("the project holds `{other}`, from which `{name}` differs by capitals alone");
            Err(source.error(0..0, Fault::Twice, found, "choose another name, or spell it the same").into())
        }
        None => Ok(()),
    }
}

impl KnownResults for Project {
    fn masters(&self, name: &str) -> Result<Option<usize>, String> {
        match self.matrices.get(name) {
            Some(matrices) => Ok(Some(matrices.masters.len())),
            None => Err(format!("there are no matrices `{name}`")),
        }
    }

    fn extent(&self, program: Program, names: &[String; 6]) -> Result<Option<Extent>, (usize, String)> {
        let Some(matrices) = self.generation(names) else {
            let wrong = (0..5).find(|i| !self.matrices.values().any(|other| other.names[*i] == names[*i])).unwrap_or(4);
            return Err((4.max(wrong), "no generation wrote NAME1 to NAME5 of this deck".into()));
        };
        if matrices.program() != program {
            return Err((4, format!("these names were written by {}", matrices.program())));
        }
        let Some(set) = self.sets.get(&names[5]) else {
            return Err((5, format!("there is no displacement set `{}`", names[5])));
        };
        self.fresh(&set.analysis.parts).map_err(|why| (5, format!("`{}` is stale: {why}", names[5])))?;
        let extent = Extent { steps: set.count, substructures: set.analysis.parts.len(), elements: matrices.elements };
        Ok(Some(extent))
    }

    fn made_of(&self, names: &[String; 6], substructure: usize) -> Result<(), String> {
        let part = self.sets.get(&names[5]).and_then(|set| set.analysis.parts.get(substructure - 1));
        let own = self.generation(names).map(|matrices| &matrices.names[5]);
        match part {
            Some((name, _)) if Some(name) == own => Ok(()),
            Some((name, _)) => Err(format!("substructure {substructure} is made of `{name}`, not of these matrices")),
            None => Err(format!("there is no substructure {substructure}")),
        }
    }

    fn restart(&self) -> Option<bool> {
        Some(self.latest.is_some())
    }
}
