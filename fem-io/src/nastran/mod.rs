//! Meshes in bulk data of Nastran (BDF): free, small and large fields, as Nastran's pre-processors, gmsh, meshio and people write
//! them.
//!
//! Plate elements are cells, bars and rods edges. Groups are those of a property, `pid-3`, or as a comment of the pre-processor
//! names it, and sets (`SET` of case control, `SET1`, `SET3`), `set-3`. Other cards are no part of a mesh and are named.

mod card;
mod comments;
mod sets;

use crate::raw::{Card as Element, Gathered, Includes, Members, Mention, MeshError, Node, Place};
use card::Card;
use comments::Names;

/// Words that a file may begin with.
pub(crate) const OPENINGS: [&[u8]; 22] = [
    b"GRID", b"GRDSET", b"BEGIN", b"SOL", b"CEND", b"ID", b"NASTRAN", b"ASSIGN", b"INIT", b"INCLUDE", b"SUBCASE",
    b"CTRIA3", b"CQUAD4", b"CTRIA6", b"CQUAD8", b"PSHELL", b"PCOMP", b"MAT1", b"MAT8", b"PARAM", b"SET", b"SET1",
];

/// Nodes, elements and sets of a file and of those that it includes.
///
/// # Errors
/// What is not understood, with its line.
pub(crate) fn read(name: &str, bytes: &[u8], includes: Includes) -> Result<Gathered, MeshError> {
    let mut reader = Reader {
        gathered: Gathered::default(),
        includes,
        // Without this line all is bulk data.
        bulk: !begins_bulk(bytes),
        ended: false,
        card: None,
        names: Names::default(),
        case: None,
    };
    let file = reader.gathered.file(name.to_owned());
    reader.lines(file, bytes)?;
    reader.finish_card()?;
    reader.finish_case()?;
    reader.names.give(&mut reader.gathered);
    Ok(reader.gathered)
}

fn begins_bulk(bytes: &[u8]) -> bool {
    bytes.split(|b| *b == b'\n').any(is_begin_bulk)
}

fn is_begin_bulk(line: &[u8]) -> bool {
    let mut words = line.split(|b| b.is_ascii_whitespace() || *b == b',').filter(|word| !word.is_empty());
    words.next().is_some_and(|word| word.eq_ignore_ascii_case(b"BEGIN"))
        && words.next().is_some_and(|word| word.len() >= 4 && word[..4].eq_ignore_ascii_case(b"BULK"))
}

struct Reader {
    gathered: Gathered,
    includes: Includes,
    /// Whether lines are cards.
    bulk: bool,
    ended: bool,
    /// The card that may go on.
    card: Option<(Card, Place)>,
    names: Names,
    /// A line of case control that goes on.
    case: Option<(String, Place)>,
}

impl Reader {
    fn lines(&mut self, file: u32, bytes: &[u8]) -> Result<(), MeshError> {
        for (line, text) in (1..).zip(bytes.split(|b| *b == b'\n')) {
            let place = Place { file, line };
            if self.ended {
                return Ok(());
            }
            if text.first() == Some(&b'$') {
                self.names.comment(&String::from_utf8_lossy(text));
                continue;
            }
            let text = text.split(|b| *b == b'$').next().unwrap_or_default().trim_ascii_end();
            if text.trim_ascii().is_empty() {
                continue;
            }
            let Ok(text) = std::str::from_utf8(text) else {
                return Err(self.wrong(place, "the line is not UTF-8"));
            };
            let word = text.trim_start().split(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or_default();
            if word.eq_ignore_ascii_case("INCLUDE") {
                self.include(text.trim()[7..].trim().trim_matches(['\'', '"', '=']), place)?;
            } else if self.bulk {
                self.bulk_line(text, word, place)?;
            } else if is_begin_bulk(text.as_bytes()) {
                self.finish_case()?;
                self.bulk = true;
            } else {
                self.case_line(text, place)?;
            }
        }
        Ok(())
    }

    fn wrong(&self, place: Place, what: impl Into<String>) -> MeshError {
        self.gathered.wrong(place, what.into())
    }

    fn include(&mut self, named: &str, place: Place) -> Result<(), MeshError> {
        self.finish_card()?;
        let (name, bytes) = self.includes.enter(named).map_err(|fault| self.gathered.error(place, fault))?;
        let file = self.gathered.file(name);
        self.lines(file, &bytes)?;
        self.includes.leave();
        Ok(())
    }

    fn bulk_line(&mut self, text: &str, word: &str, place: Place) -> Result<(), MeshError> {
        if Card::goes_on(text) {
            let Some((card, _)) = &mut self.card else {
                return Err(self.wrong(place, "a line that goes on a card, but there is none before it"));
            };
            return card.extend(text).map_err(|what| self.gathered.wrong(place, what));
        }
        self.finish_card()?;
        if word.eq_ignore_ascii_case("ENDDATA") {
            self.ended = true;
        } else if !is_begin_bulk(text.as_bytes()) {
            let mut card = Card::default();
            card.extend(text).map_err(|what| self.gathered.wrong(place, what))?;
            self.card = Some((card, place));
        }
        Ok(())
    }

    fn case_line(&mut self, text: &str, place: Place) -> Result<(), MeshError> {
        let goes_on = text.ends_with(',');
        match &mut self.case {
            Some((whole, _)) => whole.push_str(text),
            None => {
                let word = text.trim_start().get(..3).unwrap_or_default();
                if !word.eq_ignore_ascii_case("SET") {
                    return Ok(());
                }
                self.case = Some((text.trim().to_owned(), place));
            }
        }
        if goes_on { Ok(()) } else { self.finish_case() }
    }

    fn finish_case(&mut self) -> Result<(), MeshError> {
        let Some((text, place)) = self.case.take() else { return Ok(()) };
        sets::case_control(&text, place, &mut self.gathered)
    }

    fn finish_card(&mut self) -> Result<(), MeshError> {
        let Some((card, place)) = self.card.take() else { return Ok(()) };
        let said = |what: String| self.gathered.wrong(place, what);
        match card.name() {
            "GRID" => {
                let (tag, system) = (card.whole(1).map_err(said)?, card.whole_or(2, 0).map_err(said)?);
                if system != 0 {
                    let what =
                        format!("node {tag} has its coordinates in the system {system}: only the basic one is read");
                    return Err(self.wrong(place, what));
                }
                let x = [card.real(3).map_err(said)?, card.real(4).map_err(said)?, card.real(5).map_err(said)?];
                self.gathered.nodes.push((Node { tag, x }, place));
            }
            "GRDSET" => {
                if card.whole_or(2, 0).map_err(said)? != 0 {
                    return Err(self.wrong(place, "GRDSET names a coordinate system: only the basic one is read"));
                }
            }
            "CTRIA3" | "CTRIAR" => self.element(&card, place, 3, 3)?,
            "CQUAD4" | "CQUADR" => self.element(&card, place, 4, 4)?,
            "CTRIA6" => self.element(&card, place, 3, 6)?,
            "CQUAD8" | "CQUAD" => self.element(&card, place, 4, 8)?,
            "CBAR" | "CBEAM" | "CROD" | "CTUBE" => self.element(&card, place, 2, 2)?,
            "PLOTEL" => self.plot_element(&card, place)?,
            name @ ("CTETRA" | "CHEXA" | "CPENTA" | "CPYRAM" | "CPYRA") => {
                let what = format!(
                    "{name} is a solid: only flat meshes of plate elements are read; export the mid-surface of the plate, \
                     whose plies come from the scene"
                );
                return Err(self.wrong(place, what));
            }
            "SET1" | "SET3" => sets::bulk(&card, place, &mut self.gathered)?,
            name if name.starts_with('=') => {
                let what = "a card that repeats the one before it: only cards that are written out are read; write the mesh without \
                            replication";
                return Err(self.wrong(place, what));
            }
            name if ["CQUAD", "CTRIA", "CSHEAR"].iter().any(|cell| name.starts_with(cell)) => {
                let what = format!(
                    "{name} is no cell that is read, and would leave a hole: write CQUAD4, CQUAD8, CTRIA3 or CTRIA6"
                );
                return Err(self.wrong(place, what));
            }
            name => {
                if name.starts_with('P') {
                    self.names.property(&card);
                }
                self.gathered.pass_over(name, place);
            }
        }
        Ok(())
    }

    fn element(&mut self, card: &Card, place: Place, corners: u8, nodes: usize) -> Result<(), MeshError> {
        let said = |what: String| self.gathered.wrong(place, what);
        let tag = card.whole(1).map_err(said)?;
        let property = card.whole_or(2, 0).map_err(said)?;
        let mut element = Element { tag, place, corners, nodes: [0; 8] };
        for (i, node) in element.nodes.iter_mut().enumerate().take(nodes) {
            // Nodes in the middles of sides may be left out.
            let at = 3 + i;
            *node = if i < corners.into() { card.whole(at) } else { card.whole_or(at, 0) }.map_err(said)?;
        }
        self.gathered.elements.push(element);
        if property > 0 {
            self.gathered.member(Members::Elements, &format!("pid-{property}"), Mention::Number(tag), place);
        }
        Ok(())
    }

    /// Lines that are drawn have no property.
    fn plot_element(&mut self, card: &Card, place: Place) -> Result<(), MeshError> {
        let said = |what: String| self.gathered.wrong(place, what);
        let tag = card.whole(1).map_err(said)?;
        let ends = [card.whole(2).map_err(said)?, card.whole(3).map_err(said)?];
        let mut nodes = [0; 8];
        nodes[..2].copy_from_slice(&ends);
        self.gathered.elements.push(Element { tag, place, corners: 2, nodes });
        Ok(())
    }
}
