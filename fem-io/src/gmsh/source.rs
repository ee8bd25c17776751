//! The bytes of a mesh file: header, sections and places.

use super::error::{MeshError, MeshFault, Place};

/// Sections that concern us. Others are skipped.
const SECTIONS: [&str; 5] = ["PhysicalNames", "Entities", "PartitionedEntities", "Nodes", "Elements"];

/// A thing in a file, by its number there.
#[derive(Debug, Clone, Copy)]
pub(super) enum Item {
    Node(u64),
    Coordinates(u64),
    Element(u64),
}

/// A file whose header and sections are known to be ones that mshio can be given.
#[derive(Debug)]
pub(super) struct Source<'a> {
    name: &'a str,
    pub(super) bytes: Vec<u8>,
    pub(super) binary: bool,
    /// Sections and the offset at which each begins behind its marker.
    sections: Vec<(&'static str, usize)>,
    /// Number of nodes that the file announces.
    pub(super) announced_nodes: u64,
}

impl<'a> Source<'a> {
    /// Checks what mshio 0.4.2 takes on trust (it panics on some headers), and changes one number for it: where
    /// `max tag - min tag < number of nodes` it drops the node tags and takes the nodes in the order of the file, which
    /// is wrong for every renumbered mesh. With 1 for the number of nodes it keeps them.
    pub(super) fn open(name: &'a str, bytes: &[u8]) -> Result<Self, MeshError> {
        let binary = header(bytes).map_err(|(place, fault)| MeshError { file: name.to_owned(), place, fault })?;
        let mut source = Self {
            name,
            bytes: bytes.to_vec(),
            binary,
            sections: Vec::with_capacity(SECTIONS.len()),
            announced_nodes: 0,
        };
        source.find_sections()?;
        if source.section("PartitionedEntities").is_some() {
            return Err(source.error(Place::File, MeshFault::Partitioned));
        }
        source.count("Elements")?;
        let (nodes, digits) = source.count("Nodes")?;
        source.announced_nodes = nodes;
        let number = &mut source.bytes[digits];
        if binary {
            number.copy_from_slice(&1_u64.to_le_bytes());
        } else {
            number.fill(b'0');
            number[number.len() - 1] = b'1';
        }
        Ok(source)
    }

    pub(super) fn error(&self, place: Place, fault: MeshFault) -> MeshError {
        MeshError { file: self.name.to_owned(), place, fault }
    }

    /// Offset behind the marker of a section.
    pub(super) fn section(&self, name: &str) -> Option<usize> {
        self.sections.iter().find(|s| s.0 == name).map(|s| s.1)
    }

    /// Lines of the file from an offset on, with their numbers.
    pub(super) fn lines(&self, from: usize) -> impl Iterator<Item = (usize, &[u8])> {
        (self.line(from)..).zip(self.bytes[from..].split(|b| *b == b'\n').map(<[u8]>::trim_ascii))
    }

    pub(super) fn place(&self, offset: usize) -> Place {
        if self.binary { Place::Byte(offset) } else { Place::Line(self.line(offset)) }
    }

    /// Where a thing is described, in files with one thing on a line, as gmsh writes them.
    pub(super) fn find(&self, item: Item) -> Place {
        self.search(item).map_or(Place::File, Place::Line)
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

    /// A marker may occur once in a file, so that mshio and we cannot mean different sections.
    fn find_sections(&mut self) -> Result<(), MeshError> {
        for at in (0..self.bytes.len()).filter(|i| self.bytes[*i] == b'$') {
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

    /// The second number of a section, which is how much it holds, and where it stands.
    fn count(&self, section: &'static str) -> Result<(u64, std::ops::Range<usize>), MeshError> {
        let start = self.section(section).ok_or_else(|| self.error(Place::File, MeshFault::Missing(section)))?;
        let bad = || {
            let why = format!("the section ${section} does not begin with four whole numbers");
            self.error(self.place(start), MeshFault::Syntax(why))
        };
        let (count, digits) = if self.binary {
            let digits = start + 8..start + 16;
            let count = self.bytes.get(digits.clone()).and_then(|b| b.try_into().ok()).map(u64::from_le_bytes);
            (count, digits)
        } else {
            let digits = token(&self.bytes, token(&self.bytes, start).end);
            (number(&self.bytes[digits.clone()]), digits)
        };
        match count {
            None => Err(bad()),
            Some(0) => Err(self.error(self.place(start), MeshFault::Missing(section))),
            Some(count) => Ok((count, digits)),
        }
    }
}

/// Whether the file is binary.
fn header(bytes: &[u8]) -> Result<bool, (Place, MeshFault)> {
    let at_line_2 = |fault| Err((Place::Line(2), fault));
    let Some(rest) = bytes.strip_prefix(b"$MeshFormat") else {
        return Err((Place::File, MeshFault::NotMsh));
    };
    let mut lines = rest.splitn(3, |b| *b == b'\n');
    let (Some(b"" | b"\r"), Some(text)) = (lines.next(), lines.next()) else {
        return Err((Place::File, MeshFault::NotMsh));
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

/// The next word from an offset on; empty at the end.
fn token(bytes: &[u8], from: usize) -> std::ops::Range<usize> {
    let start = bytes[from..].iter().position(|b| !b.is_ascii_whitespace()).map_or(bytes.len(), |n| from + n);
    let end = bytes[start..].iter().position(u8::is_ascii_whitespace).map_or(bytes.len(), |n| start + n);
    start..end
}

fn number<T: std::str::FromStr>(digits: &[u8]) -> Option<T> {
    std::str::from_utf8(digits).ok()?.parse().ok()
}
