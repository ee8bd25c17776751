//! The bytes of a mesh file: header, sections and places.

use super::cursor::Cursor;
use super::error::{FilePlace, MeshError, MeshFault};

/// Sections that concern us. Others are skipped.
const SECTIONS: [&str; 5] = ["PhysicalNames", "Entities", "PartitionedEntities", "Nodes", "Elements"];

/// A thing in a file, by its number there.
#[derive(Debug, Clone, Copy)]
pub(super) enum Item {
    Node(u64),
    Coordinates(u64),
    Element(u64),
}

/// A file whose header is that of MSH 4.1 and whose sections are known.
#[derive(Debug)]
pub(super) struct Source<'a> {
    name: &'a str,
    bytes: &'a [u8],
    pub(super) binary: bool,
    /// Sections and the offset at which each begins behind its marker.
    sections: Vec<(&'static str, usize)>,
}

impl<'a> Source<'a> {
    pub(super) fn open(name: &'a str, bytes: &'a [u8]) -> Result<Self, MeshError> {
        let binary = header(bytes).map_err(|(place, fault)| MeshError { file: name.to_owned(), place, fault })?;
        let mut source = Self { name, bytes, binary, sections: Vec::with_capacity(SECTIONS.len()) };
        source.find_sections()?;
        for (section, what) in [("Elements", "element"), ("Nodes", "node")] {
            source.begin(section, what)?;
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
    /// tag, and what follows.
    pub(super) fn begin(&self, section: &'static str, what: &str) -> Result<(Cursor<'a>, [u64; 4]), MeshError> {
        let start = self.section(section).ok_or_else(|| self.lacking(section))?;
        let mut cursor = self.cursor(start);
        let mut head = [0; 4];
        for (number, name) in head.iter_mut().zip(["entity blocks", "entries", "least tag", "largest tag"]) {
            *number = cursor.size().map_err(|at| {
                self.syntax(
                    at,
                    &format!("the section ${section} does not begin with four whole numbers: number of {what} {name}"),
                )
            })?;
        }
        if head[1] == 0 { Err(self.error(self.place(start), MeshFault::Missing(section))) } else { Ok((cursor, head)) }
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
    pub(super) fn find(&self, item: Item) -> FilePlace {
        self.search(item).map_or(FilePlace::File, FilePlace::Line)
    }

    fn search(&self, item: Item) -> Option<usize> {
        if self.binary {
            return None;
        }
        let (section, tag) = match item {
            Item::Node(tag) | Item::Coordinates(tag) => ("Nodes", tag),
            Item::Element(tag) => ("Elements", tag),
        };
        let mut lines = self.lines(self.section(section)?);
        lines.next()?;
        loop {
            let block: usize = number(lines.next()?.1.split(u8::is_ascii_whitespace).nth(3)?)?;
            for _ in 0..block {
                let (line, text) = lines.next()?;
                if text.split(u8::is_ascii_whitespace).next().and_then(number) == Some(tag) {
                    return Some(if matches!(item, Item::Coordinates(_)) { line + block } else { line });
                }
            }
            if section == "Nodes" && block > 0 {
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

/// Whether the file is binary.
fn header(bytes: &[u8]) -> Result<bool, (FilePlace, MeshFault)> {
    let at_line_2 = |fault| Err((FilePlace::Line(2), fault));
    let Some(rest) = bytes.strip_prefix(b"$MeshFormat") else {
        return Err((FilePlace::File, MeshFault::NotMsh));
    };
    let mut lines = rest.splitn(3, |b| *b == b'\n');
    let (Some(b"" | b"\r"), Some(text)) = (lines.next(), lines.next()) else {
        return Err((FilePlace::File, MeshFault::NotMsh));
    };
    let text = text.trim_ascii();
    let shown = || String::from_utf8_lossy(&text[..text.len().min(40)]).into_owned();
    let mut words = text.split(u8::is_ascii_whitespace);
    match words.next() {
        Some(b"4.1") => {}
        Some(version)
            if (1..8).contains(&version.len()) && version.iter().all(|b| b.is_ascii_digit() || *b == b'.') =>
        {
            return at_line_2(MeshFault::Version(String::from_utf8_lossy(version).into_owned()));
        }
        _ => return at_line_2(MeshFault::Header(shown())),
    }
    match (words.next(), words.next(), words.next()) {
        (Some(b"0"), Some(b"8"), None) => Ok(false),
        (Some(b"1"), Some(b"8"), None) if lines.next().is_some_and(|r| r.starts_with(&1_u32.to_le_bytes())) => Ok(true),
        _ => at_line_2(MeshFault::Header(shown())),
    }
}

fn number<T: std::str::FromStr>(digits: &[u8]) -> Option<T> {
    std::str::from_utf8(digits).ok()?.parse().ok()
}
