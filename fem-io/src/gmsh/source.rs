//! The bytes of a mesh file: header, sections and places.

use super::cursor::{Cursor, Lacking};
use crate::raw::{FilePlace, Item, MeshError, MeshFault, Places};

/// Sections that concern us. Others are skipped.
const SECTIONS: [&str; 5] = ["PhysicalNames", "Entities", "PartitionedEntities", "Nodes", "Elements"];

/// Version of the format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    V22,
    V40,
    V41,
}

impl Version {
    const ALL: [(&'static [u8], Self); 6] = [
        (b"4.1", Self::V41),
        (b"4", Self::V40),
        (b"4.0", Self::V40),
        (b"2.2", Self::V22),
        (b"2.1", Self::V22),
        (b"2", Self::V22),
    ];
}

/// A file whose header is that of MSH and whose sections are known.
#[derive(Debug)]
pub(super) struct Source<'a> {
    name: &'a str,
    bytes: &'a [u8],
    pub(super) version: Version,
    pub(super) binary: bool,
    /// Sections and the offset at which each begins behind its marker.
    sections: Vec<(&'static str, usize)>,
}

impl<'a> Source<'a> {
    pub(super) fn open(name: &'a str, bytes: &'a [u8]) -> Result<Self, MeshError> {
        let (version, binary) =
            header(bytes).map_err(|(place, fault)| MeshError { file: name.to_owned(), place, fault })?;
        let mut source = Self { name, bytes, version, binary, sections: Vec::with_capacity(SECTIONS.len()) };
        source.find_sections()?;
        for (section, what) in [("Elements", "element"), ("Nodes", "node")] {
            match version {
                Version::V22 => source.begin_list(section, &format!("{what}s")).map(|_| ()),
                Version::V40 | Version::V41 => source.begin(section, what).map(|_| ()),
            }?;
        }
        match source.open_section() {
            Some(section) => Err(source.cut_off(&format!("inside ${section}"))),
            None => Ok(source),
        }
    }

    /// The last section, if it does not end.
    fn open_section(&self) -> Option<&'static str> {
        let (name, start) = *self.sections.last()?;
        let end = format!("$End{name}");
        (self.until(start, end.as_bytes()).len() == self.bytes.len() - start).then_some(name)
    }

    fn cut_off(&self, at: &str) -> MeshError {
        self.syntax(self.bytes.len(), &format!("the file ends {at}"))
    }

    /// What is said of a section that is not there. gmsh writes them in one order, nodes and elements both or neither.
    fn lacking(&self, section: &'static str) -> MeshError {
        let order = |name: &str| SECTIONS.iter().position(|known| *known == name);
        let behind = self.sections.iter().any(|(name, _)| order(name) > order(section));
        match self.open_section() {
            _ if behind => self.error(FilePlace::File, MeshFault::Missing(section)),
            Some(last) => self.cut_off(&format!("inside ${last}, before ${section}")),
            None if self.section("Nodes").is_some() => self.cut_off(&format!("before ${section}")),
            None => self.error(FilePlace::File, MeshFault::Missing(section)),
        }
    }

    pub(super) fn error(&self, place: FilePlace, fault: MeshFault) -> MeshError {
        MeshError { file: self.name.to_owned(), place, fault }
    }

    /// An error of the format at an offset.
    pub(super) fn syntax(&self, at: usize, what: &str) -> MeshError {
        self.error(self.place(at), MeshFault::Syntax(what.to_owned()))
    }

    pub(super) fn cursor(&self, at: usize) -> Cursor<'a> {
        Cursor::new(self.bytes, at, self.binary)
    }

    /// The numbers at the beginning of `$Nodes` or `$Elements`, blocks of `what`, all of them, their least and largest
    /// tag (0 in version 4.0), and what follows.
    pub(super) fn begin(&self, section: &'static str, what: &str) -> Result<(Cursor<'a>, [u64; 4]), MeshError> {
        let start = self.section(section).ok_or_else(|| self.lacking(section))?;
        let mut cursor = self.cursor(start);
        let mut head = [0; 4];
        let (numbers, many) = if self.version == Version::V41 { (4, "four") } else { (2, "two") };
        for (number, name) in head[..numbers].iter_mut().zip(["entity blocks", "entries", "least tag", "largest tag"]) {
            *number = cursor.size().map_err(|at| {
                self.syntax(
                    at,
                    &format!(
                        "the section ${section} does not begin with {many} whole numbers: number of {what} {name}"
                    ),
                )
            })?;
        }
        if head[1] == 0 { Err(self.error(self.place(start), MeshFault::Missing(section))) } else { Ok((cursor, head)) }
    }

    /// The number of things in a section of version 2.2, and what follows.
    pub(super) fn begin_list(&self, section: &'static str, what: &str) -> Result<(Cursor<'a>, u64), MeshError> {
        let start = self.section(section).ok_or_else(|| self.lacking(section))?;
        // The number is text in binary files, too.
        let mut cursor = Cursor::new(self.bytes, start, false);
        let announced = cursor.size().map_err(|at| {
            self.syntax(at, &format!("the section ${section} does not begin with the number of its {what}"))
        })?;
        if announced == 0 {
            return Err(self.error(self.place(start), MeshFault::Missing(section)));
        }
        let line_end = self.bytes[cursor.at()..].iter().position(|b| *b == b'\n').map_or(0, |n| n + 1);
        Ok((self.cursor(cursor.at() + line_end), announced))
    }

    /// Number of a node or an element.
    pub(super) fn tag(&self, cursor: &mut Cursor<'_>) -> Result<u64, Lacking> {
        match self.version {
            Version::V41 => cursor.size(),
            Version::V22 | Version::V40 => {
                let at = cursor.at();
                cursor.int().and_then(|tag| u64::try_from(tag).map_err(|_| at))
            }
        }
    }

    /// Dimension and number of the entity of a block.
    pub(super) fn entity(&self, cursor: &mut Cursor<'_>) -> Result<(i32, i32), Lacking> {
        let (first, second) = (cursor.int()?, cursor.int()?);
        Ok(if self.version == Version::V41 { (first, second) } else { (second, first) })
    }

    /// No more than so many of `announced` things fit into the file.
    pub(super) fn at_most(&self, announced: u64) -> usize {
        usize::try_from(announced).map_or(self.bytes.len() / 8, |n| n.min(self.bytes.len() / 8))
    }

    /// The section `$MeshFormat`.
    pub(super) fn header(&self) -> &'a [u8] {
        let end = b"$EndMeshFormat";
        let length = self.until(0, end).len() + end.len();
        // With the end of its line.
        let rest = self.bytes.get(length..).unwrap_or_default();
        let line = rest.iter().position(|b| *b == b'\n').map_or(rest.len(), |n| n + 1);
        self.bytes.get(..length + line).unwrap_or_default()
    }

    /// What stands between an offset and a marker, or the end of the file.
    pub(super) fn until(&self, from: usize, marker: &[u8]) -> &'a [u8] {
        let rest = &self.bytes[from..];
        let found = rest.windows(marker.len()).position(|window| window == marker);
        &rest[..found.unwrap_or(rest.len())]
    }

    /// Offset behind the marker of a section.
    pub(super) fn section(&self, name: &str) -> Option<usize> {
        self.sections.iter().find(|s| s.0 == name).map(|s| s.1)
    }

    /// Lines of the file from an offset on, with their numbers.
    pub(super) fn lines(&self, from: usize) -> impl Iterator<Item = (usize, &[u8])> {
        (self.line(from)..).zip(self.bytes[from..].split(|b| *b == b'\n').map(<[u8]>::trim_ascii))
    }

    pub(super) fn place(&self, offset: usize) -> FilePlace {
        if self.binary { FilePlace::Byte(offset) } else { FilePlace::Line(self.line(offset)) }
    }

    /// Where a thing is described, in files with one thing on a line, as gmsh writes them.
    fn search(&self, item: Item) -> Option<usize> {
        if self.binary {
            return None;
        }
        let (section, tag) = match item {
            Item::Node(tag) | Item::Coordinates(tag) => ("Nodes", tag),
            Item::Element(tag) => ("Elements", tag),
        };
        let is_it = |text: &[u8]| text.split(u8::is_ascii_whitespace).next().and_then(number) == Some(tag);
        let mut lines = self.lines(self.section(section)?);
        lines.next()?;
        if self.version == Version::V22 {
            return lines.find(|(_, text)| is_it(text)).map(|(line, _)| line);
        }
        loop {
            let block: usize = number(lines.next()?.1.split(u8::is_ascii_whitespace).nth(3)?)?;
            for _ in 0..block {
                let (line, text) = lines.next()?;
                if is_it(text) {
                    let behind = matches!(item, Item::Coordinates(_)) && self.version == Version::V41;
                    return Some(if behind { line + block } else { line });
                }
            }
            if section == "Nodes" && block > 0 && self.version == Version::V41 {
                lines.nth(block - 1)?;
            }
        }
    }

    fn line(&self, offset: usize) -> usize {
        1 + self.bytes[..offset].iter().filter(|b| **b == b'\n').count()
    }

    /// A marker stands at the beginning of a line, and occurs once in a file outside of comments.
    fn find_sections(&mut self) -> Result<(), MeshError> {
        let begins = |at: usize| self.bytes[at] == b'$' && (at == 0 || self.bytes[at - 1] == b'\n');
        let mut skipped = 0;
        for at in (0..self.bytes.len()).filter(|at| begins(*at)) {
            if at < skipped {
                continue;
            }
            if self.bytes[at..].starts_with(b"$Comments") {
                skipped = at + self.until(at, b"$EndComments").len();
                continue;
            }
            let rest = &self.bytes[at + 1..];
            let marker = SECTIONS.iter().find_map(|name| {
                let tail = rest.strip_prefix(name.as_bytes())?;
                let line_end = if tail.starts_with(b"\n") { 1 } else { 2 * usize::from(tail.starts_with(b"\r\n")) };
                (line_end > 0).then_some((*name, at + 1 + name.len() + line_end))
            });
            if let Some((name, start)) = marker {
                if self.section(name).is_some() {
                    return Err(self.error(self.place(at), MeshFault::Repeated(name)));
                }
                self.sections.push((name, start));
            }
        }
        Ok(())
    }
}

impl Places for Source<'_> {
    fn error_at(&self, item: Option<Item>, fault: MeshFault) -> MeshError {
        self.error(item.and_then(|item| self.search(item)).map_or(FilePlace::File, FilePlace::Line), fault)
    }
}

/// The version, and whether the file is binary.
fn header(bytes: &[u8]) -> Result<(Version, bool), (FilePlace, MeshFault)> {
    let at_line_2 = |fault| Err((FilePlace::Line(2), fault));
    let Some(rest) = bytes.strip_prefix(b"$MeshFormat") else {
        return Err((FilePlace::File, MeshFault::NotAMesh));
    };
    let mut lines = rest.splitn(3, |b| *b == b'\n');
    let (Some(b"" | b"\r"), Some(text)) = (lines.next(), lines.next()) else {
        return Err((FilePlace::File, MeshFault::NotAMesh));
    };
    let text = text.trim_ascii();
    let shown = || String::from_utf8_lossy(&text[..text.len().min(40)]).into_owned();
    let mut words = text.split(u8::is_ascii_whitespace);
    let word = words.next().unwrap_or_default();
    let Some((_, version)) = Version::ALL.iter().find(|known| known.0 == word) else {
        let is_version = (1..8).contains(&word.len()) && word.iter().all(|b| b.is_ascii_digit() || *b == b'.');
        let version = || MeshFault::Version(String::from_utf8_lossy(word).into_owned());
        return at_line_2(if is_version { version() } else { MeshFault::Header(shown()) });
    };
    match (words.next(), words.next(), words.next()) {
        (Some(b"0"), Some(b"8"), None) => Ok((*version, false)),
        (Some(b"1"), Some(b"8"), None) if lines.next().is_some_and(|r| r.starts_with(&1_u32.to_le_bytes())) => {
            Ok((*version, true))
        }
        _ => at_line_2(MeshFault::Header(shown())),
    }
}

fn number<T: std::str::FromStr>(digits: &[u8]) -> Option<T> {
    std::str::from_utf8(digits).ok()?.parse().ok()
}
