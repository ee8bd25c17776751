//! Texts that a scene is made of, places in them, and errors that show the place.

use crate::bytes::{self, Links, ReadError};
use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Largest text file that is read: a larger one was given by mistake.
const MAX_BYTES: u64 = 1 << 22;

/// Why a file of text cannot be read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum TextError {
    #[error(transparent)]
    Unreadable(#[from] ReadError),
    #[error("it is in UTF-16; save it as UTF-8")]
    Utf16,
    #[error("it is not UTF-8 from line {line} on; save it as UTF-8")]
    NotUtf8 { line: usize },
}

/// The text of a file.
pub(crate) fn read_text(path: &Path) -> Result<String, TextError> {
    let bytes = bytes::read(path, MAX_BYTES, Links::Follow)?;
    String::from_utf8(bytes).map_err(|e| match e.as_bytes() {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => TextError::Utf16,
        before => {
            let valid = &before[..e.utf8_error().valid_up_to()];
            TextError::NotUtf8 { line: 1 + valid.iter().filter(|byte| **byte == b'\n').count() }
        }
    })
}

/// The text that a value comes from; of two that exclude each other the later one counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Origin {
    Library,
    Preset,
    Scene,
    Setting,
}

/// Where a value stands: in the scene, in its preset, in the materials library, in a file of materials or in what a study
/// sets.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    pub(crate) origin: Origin,
    pub(crate) span: Range<usize>,
}

impl Place {
    /// The beginning of the scene.
    pub const TOP: Self = Self { origin: Origin::Scene, span: 0..0 };
}

/// A value with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub place: Place,
}

/// The texts that a scene is made of; makes errors that show a place in them.
#[derive(Debug, Clone)]
pub struct SceneSource {
    /// In the order of [`Origin`].
    documents: [NamedSource<String>; 4],
}

impl Default for SceneSource {
    fn default() -> Self {
        Self { documents: [(); 4].map(|()| NamedSource::new("", String::new())) }
    }
}

impl SceneSource {
    /// Of the scene `text` in the file `path`, over the materials `library`.
    pub(crate) fn new(path: &Path, text: &str, library: &str) -> Self {
        Self::default().with(Origin::Scene, path.display(), text).with(Origin::Library, "materials library", library)
    }

    /// The file of the scene, as it was named.
    pub fn name(&self) -> &str {
        self.documents[Origin::Scene as usize].name()
    }

    /// The same as a path, in whose folder the files are that it names.
    pub(crate) fn path(&self) -> &Path {
        Path::new(self.name())
    }

    /// The text of the scene.
    pub fn text(&self) -> &str {
        self.documents[Origin::Scene as usize].inner()
    }

    /// The same with another text.
    pub(crate) fn with(mut self, origin: Origin, name: impl fmt::Display, text: &str) -> Self {
        self.documents[origin as usize] = NamedSource::new(name.to_string(), text.to_owned());
        self
    }

    /// An error that shows `place`, says `message` and advises `help`.
    ///
    /// For whoever turns a scene into a model: a plug-in refused a parameter, a mesh lacks a group.
    pub fn error_at(
        self: &Arc<Self>,
        place: &Place,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> SceneError {
        SceneError {
            message: message.into(),
            help: help.into(),
            place: Some(place.clone()),
            source: Arc::clone(self),
            others: Vec::new(),
        }
    }

    /// An error about the file as a whole.
    pub(crate) fn error(self: &Arc<Self>, message: impl Into<String>, help: impl Into<String>) -> SceneError {
        SceneError {
            message: message.into(),
            help: help.into(),
            place: None,
            source: Arc::clone(self),
            others: Vec::new(),
        }
    }

    fn document(&self, place: &Place) -> &NamedSource<String> {
        &self.documents[place.origin as usize]
    }

    /// Name of the text and line (from 1) of a place.
    pub(crate) fn line(&self, place: &Place) -> Option<(&str, usize)> {
        let document = self.document(place);
        let before = document.inner().get(..place.span.start)?;
        Some((document.name(), 1 + before.matches('\n').count()))
    }

    /// The part of `place` that holds `text` from byte `at` on, where the text stands there as it is read: a caret
    /// inside a string. The whole place where escapes make the two differ.
    pub(crate) fn within(&self, place: &Place, text: &str, at: usize) -> Place {
        let written = self.document(place).inner().get(place.span.clone()).unwrap_or_default();
        match written.find(text) {
            Some(offset) => {
                let from = place.span.start + offset + at;
                let length = text[at..].chars().next().map_or(0, char::len_utf8);
                Place { span: from..from + length, ..place.clone() }
            }
            None => place.clone(),
        }
    }
}

/// A scene that cannot be used: what is wrong, where, and what to do.
///
/// `Display` gives the message alone; a `miette` report handler shows file, line, caret and remedy.
#[derive(Debug, Clone)]
pub struct SceneError {
    message: String,
    help: String,
    place: Option<Place>,
    source: Arc<SceneSource>,
    /// What else is wrong, by its place.
    others: Vec<SceneError>,
}

/// Mistakes that are said at once.
const MOST: usize = 20;

impl SceneError {
    /// Name of the text and line (from 1) of the trouble; `None` if it is about no line.
    pub fn location(&self) -> Option<(&str, usize)> {
        self.source.line(self.place.as_ref()?)
    }

    /// This mistake and those that were found with it, by their places.
    pub fn mistakes(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(&self.others)
    }

    /// This and `others` as one, by their places; what has been said of a place is not said again.
    pub(crate) fn with(self, others: Vec<Self>) -> Self {
        let mut all = vec![self];
        for other in others {
            if all.iter().all(|known| known.message != other.message && known.start() != other.start()) {
                all.push(other);
            }
        }
        all.sort_by_key(Self::start);
        all.truncate(MOST);
        let mut first = all.remove(0);
        first.others = all;
        first
    }

    fn start(&self) -> Option<(Origin, usize)> {
        self.place.as_ref().map(|place| (place.origin, place.span.start))
    }

    /// What to do about it.
    pub fn remedy(&self) -> &str {
        &self.help
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}
impl std::error::Error for SceneError {}

impl Diagnostic for SceneError {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        (!self.help.is_empty()).then(|| Box::new(&self.help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.place.as_ref().map(|place| self.source.document(place) as &dyn SourceCode)
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        let others = self.others.iter().map(|other| other as &dyn Diagnostic);
        (!self.others.is_empty()).then(|| Box::new(others) as Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let place = self.place.as_ref()?;
        Some(Box::new(std::iter::once(LabeledSpan::underline(place.span.clone()))))
    }
}
