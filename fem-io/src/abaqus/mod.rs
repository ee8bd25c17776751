//! Meshes in input files of Abaqus (INP), as Abaqus/CAE, CalculiX, gmsh, meshio and people write them.
//!
//! Shell, membrane and plane elements are cells, truss and beam elements edges; sets of nodes, elements and sides are groups. Of
//! parts and instances one with a mesh is read. Keywords by which a program would make nodes, elements or sets are refused;
//! others are no part of a mesh and are named.

mod keyword;
mod kinds;

use crate::raw::{Card, Gathered, Includes, Members, Mention, MeshError, Node, Place};
use keyword::Keyword;
use kinds::Kind;

/// Keywords that make or move nodes and elements in ways that are not read, with what to do.
const REFUSED: [&str; 9] =
    ["NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "SUBMODEL", "SYMMETRIC MODEL GENERATION"];

/// Keywords that say nothing of a mesh and go without saying.
const SILENT: [&str; 6] = ["HEADING", "PREPRINT", "ASSEMBLY", "END ASSEMBLY", "END INSTANCE", "RESTART"];

/// Nodes, elements and sets of a file and of those that it includes.
///
/// # Errors
/// What is not understood, with its line.
pub(crate) fn read(name: &str, bytes: &[u8], includes: Includes) -> Result<Gathered, MeshError> {
    let mut reader = Reader {
        gathered: Gathered::default(),
        includes,
        data: Data::Skipped,
        keyword: None,
        part: None,
        holder: None,
        instance: None,
    };
    let file = reader.gathered.file(name.to_owned());
    reader.lines(file, bytes)?;
    reader.end_of_data()?;
    Ok(reader.gathered)
}

/// What the data lines under a keyword say.
#[derive(Debug)]
enum Data {
    Skipped,
    Nodes { set: Option<String> },
    Elements { kind: Kind, set: Option<String>, card: Option<(Card, usize)> },
    Set { of: Members, name: String, range: bool },
    Surface { name: String },
    Instance { line: usize },
}

struct Reader {
    gathered: Gathered,
    includes: Includes,
    data: Data,
    /// A keyword line that goes on.
    keyword: Option<(Vec<u8>, Place)>,
    /// The part that is being read, and the one that holds nodes.
    part: Option<String>,
    holder: Option<String>,
    /// The instance with a mesh.
    instance: Option<String>,
}

impl Reader {
    fn lines(&mut self, file: u32, bytes: &[u8]) -> Result<(), MeshError> {
        for (line, text) in (1..).zip(bytes.split(|b| *b == b'\n')) {
            let (place, text) = (Place { file, line }, text.trim_ascii());
            if text.is_empty() || text.starts_with(b"**") {
                continue;
            }
            let pending = self.keyword.take();
            if pending.is_none() && text[0] != b'*' {
                self.data_line(text, place)?;
                continue;
            }
            let (mut whole, begun) = pending.unwrap_or((Vec::new(), place));
            whole.extend_from_slice(text);
            if text.ends_with(b",") {
                self.keyword = Some((whole, begun));
            } else {
                self.keyword_line(&whole, begun)?;
            }
        }
        Ok(())
    }

    fn wrong(&self, place: Place, what: impl Into<String>) -> MeshError {
        self.gathered.wrong(place, what.into())
    }

    fn keyword_line(&mut self, text: &[u8], place: Place) -> Result<(), MeshError> {
        self.end_of_data()?;
        let keyword = Keyword::read(text).map_err(|what| self.wrong(place, what))?;
        self.data = match keyword.name.as_str() {
            "NODE" => self.nodes(&keyword, place)?,
            "ELEMENT" => self.elements(&keyword, place)?,
            "NSET" => self.set(&keyword, Members::Nodes, "NSET", place)?,
            "ELSET" => self.set(&keyword, Members::Elements, "ELSET", place)?,
            "SURFACE" => match (keyword.value("NAME"), keyword.value("TYPE").unwrap_or("ELEMENT")) {
                (Some(name), kind) if kind.eq_ignore_ascii_case("ELEMENT") => Data::Surface { name: name.to_owned() },
                (_, kind) => {
                    self.gathered.pass_over(&format!("*SURFACE of type {kind}"), place);
                    Data::Skipped
                }
            },
            "PART" => {
                self.part = Some(keyword.value("NAME").unwrap_or("unnamed").to_owned());
                Data::Skipped
            }
            "END PART" => {
                self.part = None;
                Data::Skipped
            }
            "INSTANCE" => self.instance(&keyword, place)?,
            "INCLUDE" => {
                let named = keyword.value("INPUT").unwrap_or_default().to_owned();
                self.data = Data::Skipped;
                return self.include(&named, place);
            }
            name if REFUSED.contains(&name) => {
                let what =
                    format!("*{name} makes or moves nodes or elements by rules, which is not read: write them out");
                return Err(self.wrong(place, what));
            }
            name => {
                if !SILENT.contains(&name) {
                    self.gathered.pass_over(&format!("*{name}"), place);
                }
                Data::Skipped
            }
        };
        match keyword.value("INPUT") {
            Some(named) if !matches!(self.data, Data::Skipped) => self.include(named, place),
            _ => Ok(()),
        }
    }

    fn include(&mut self, named: &str, place: Place) -> Result<(), MeshError> {
        let (name, bytes) = self.includes.enter(named).map_err(|fault| self.gathered.error(place, fault))?;
        let file = self.gathered.file(name);
        self.lines(file, &bytes)?;
        self.includes.leave();
        Ok(())
    }

    /// Only one part has a mesh.
    fn hold(&mut self, place: Place) -> Result<(), MeshError> {
        if self.instance.is_some() && self.part.is_none() {
            // Reference points of an assembly.
            return Ok(());
        }
        let own = self.part.clone().unwrap_or_default();
        let holder = self.holder.get_or_insert_with(|| own.clone());
        if *holder == own {
            return Ok(());
        }
        let what =
            format!("the parts {holder:?} and {own:?} both have nodes, and one plate is read: export its part alone");
        Err(self.wrong(place, what))
    }

    fn nodes(&mut self, keyword: &Keyword<'_>, place: Place) -> Result<Data, MeshError> {
        if self.instance.is_some() && self.part.is_none() {
            self.gathered.pass_over("*NODE of the assembly", place);
            return Ok(Data::Skipped);
        }
        self.hold(place)?;
        match keyword.value("SYSTEM") {
            None | Some("R" | "r") => Ok(Data::Nodes { set: keyword.value("NSET").map(str::to_owned) }),
            Some(system) => {
                let what = format!("*NODE with SYSTEM={system}: only rectangular coordinates are read");
                Err(self.wrong(place, what))
            }
        }
    }

    fn elements(&mut self, keyword: &Keyword<'_>, place: Place) -> Result<Data, MeshError> {
        let Some(named) = keyword.value("TYPE") else {
            return Err(self.wrong(place, "*ELEMENT without TYPE: write for example TYPE=S4R"));
        };
        let set = keyword.value("ELSET").map(str::to_owned);
        match Kind::of(named) {
            Some(Kind::Solid) => {
                let what = format!(
                    "elements of the type {named} are solids: only flat meshes of shell, membrane and plane elements are \
                     read; export the mid-surface of the plate, whose plies come from the scene"
                );
                Err(self.wrong(place, what))
            }
            Some(kind) => Ok(Data::Elements { kind, set, card: None }),
            None => {
                self.gathered.pass_over(&format!("*ELEMENT of type {named}"), place);
                Ok(Data::Skipped)
            }
        }
    }

    fn set(&mut self, keyword: &Keyword<'_>, of: Members, key: &str, place: Place) -> Result<Data, MeshError> {
        let Some(name) = keyword.value(key) else {
            return Err(self.wrong(place, format!("*{key} without a name: write {key}=NAME")));
        };
        if keyword.has("ELSET") && of == Members::Nodes {
            return Err(self.wrong(place, "*NSET from an ELSET is not read: list the nodes"));
        }
        if let Some(instance) = keyword.value("INSTANCE").filter(|name| self.is_other(name)) {
            self.gathered.pass_over(&format!("*{key} of the instance {instance:?}"), place);
            return Ok(Data::Skipped);
        }
        // A set without members is one, too.
        self.gathered.set(of, name);
        if keyword.has("INTERNAL") {
            self.gathered.hide(of, name);
        }
        Ok(Data::Set { of, name: name.to_owned(), range: keyword.has("GENERATE") })
    }

    fn is_other(&self, instance: &str) -> bool {
        self.instance.as_ref().is_some_and(|own| !own.eq_ignore_ascii_case(instance))
    }

    fn instance(&mut self, keyword: &Keyword<'_>, place: Place) -> Result<Data, MeshError> {
        let part = keyword.value("PART").unwrap_or_default();
        if self.holder.as_ref().is_none_or(|holder| !holder.eq_ignore_ascii_case(part)) {
            return Ok(Data::Skipped);
        }
        if self.instance.is_some() {
            let what = format!("a second instance of the part {part:?}, and one plate is read: export it alone");
            return Err(self.wrong(place, what));
        }
        self.instance = Some(keyword.value("NAME").unwrap_or(part).to_owned());
        Ok(Data::Instance { line: 0 })
    }

    fn data_line(&mut self, text: &[u8], place: Place) -> Result<(), MeshError> {
        let Ok(text) = std::str::from_utf8(text) else {
            return match self.data {
                Data::Skipped => Ok(()),
                _ => Err(self.wrong(place, "the line is not UTF-8")),
            };
        };
        let mut items = text.split(',').map(str::trim).collect::<Vec<_>>();
        if items.last().is_some_and(|last| last.is_empty()) {
            items.pop();
        }
        match &mut self.data {
            Data::Skipped => {}
            Data::Nodes { set } => {
                let mut numbers = items.iter();
                let tag = whole(numbers.next());
                let x = [numbers.next(), numbers.next(), numbers.next()];
                let x = x.map(|x| x.map_or(Some(0.0), |x| if x.is_empty() { Some(0.0) } else { real(x) }));
                let (Some(tag), [Some(x), Some(y), Some(z)], true) = (tag, x, items.len() > 1) else {
                    return Err(self.wrong(place, "a node should stand here: number, x, y, z"));
                };
                if let Some(set) = set {
                    self.gathered.member(Members::Nodes, set, Mention::Number(tag), place);
                }
                self.gathered.nodes.push((Node { tag, x: [x, y, z] }, place));
            }
            Data::Elements { kind, set, card } => {
                let mut items = items.into_iter().peekable();
                while let Some(item) = items.next() {
                    let Some(number) = whole(Some(&item)) else {
                        let what = format!("{item:?} should be the number of an element or of a node");
                        return Err(self.wrong(place, what));
                    };
                    let Some((begun, found)) = card else {
                        let begun = Card { tag: number, place, corners: kind.corners(), nodes: [0; 8] };
                        *card = Some((begun, 0));
                        continue;
                    };
                    if let Some(slot) = kind.slot(*found) {
                        begun.nodes[slot] = number;
                    }
                    *found += 1;
                    if *found == kind.nodes() {
                        if let Some(set) = set {
                            self.gathered.member(Members::Elements, set, Mention::Number(begun.tag), place);
                        }
                        self.gathered.elements.push(*begun);
                        if items.peek().is_some() {
                            let what = format!("element {} has more than the {found} nodes of its type", begun.tag);
                            return Err(self.wrong(place, what));
                        }
                        *card = None;
                    }
                }
            }
            Data::Set { of, name, range: true } => {
                let numbers: Option<Vec<u64>> = items.iter().map(|item| whole(Some(item))).collect();
                let range = match numbers.as_deref() {
                    Some([first, last]) => [*first, *last, 1],
                    Some([first, last, step]) => [*first, *last, *step],
                    _ => [1, 0, 0],
                };
                if range[0] > range[1] || range[2] == 0 {
                    let what = "GENERATE should be followed by the first number, the last and the step";
                    return Err(self.wrong(place, what));
                }
                self.gathered.member(*of, name, Mention::Range(range), place);
            }
            Data::Set { of, name, .. } => {
                for item in items {
                    let mention = match own(item, &self.instance) {
                        Some(item) => mention(item),
                        None => continue,
                    };
                    self.gathered.member(*of, name, mention, place);
                }
            }
            Data::Surface { name } => {
                let (what, label) = (items[0], items.get(1).copied().unwrap_or_default());
                match (own(what, &self.instance), side(label)) {
                    (Some(item), Some(side)) => {
                        self.gathered.member(Members::Sides(side), name, mention(item), place);
                    }
                    (Some(_), None) => self.gathered.pass_over("a face of a *SURFACE", place),
                    (None, _) => self.gathered.pass_over("a *SURFACE of another instance", place),
                }
            }
            Data::Instance { line } => {
                *line += 1;
                let line = *line;
                let numbers: Option<Vec<f64>> = items.iter().map(|item| real(item)).collect();
                match numbers.as_deref() {
                    Some([x, y, z]) if line == 1 => {
                        for (node, _) in &mut self.gathered.nodes {
                            node.x.iter_mut().zip([x, y, z]).for_each(|(at, by)| *at += by);
                        }
                    }
                    Some(_) if line == 2 => {
                        return Err(self.wrong(place, "an instance that is turned is not read: turn the part itself"));
                    }
                    _ => return Err(self.wrong(place, "the shift of the instance should stand here: x, y, z")),
                }
            }
        }
        Ok(())
    }

    /// An element does not end with the next keyword.
    fn end_of_data(&mut self) -> Result<(), MeshError> {
        if let Some((_, place)) = self.keyword.take() {
            return Err(self.wrong(place, "the file ends within this keyword: it was cut short"));
        }
        let Data::Elements { kind, card: Some((card, found)), .. } = &self.data else { return Ok(()) };
        let what = format!(
            "element {} has {found} nodes, its type {}: the file was cut short or the type is another",
            card.tag,
            kind.nodes()
        );
        Err(self.wrong(card.place, what))
    }
}

/// What an item names, without the instance that is read; none if it is of another.
fn own<'i>(item: &'i str, instance: &Option<String>) -> Option<&'i str> {
    match (item.split_once('.'), instance) {
        (Some((of, item)), Some(own)) => own.eq_ignore_ascii_case(of.trim_matches('"')).then_some(item),
        _ => Some(item),
    }
}

fn mention(item: &str) -> Mention {
    let item = item.trim_matches('"');
    item.parse().map_or_else(|_| Mention::Set(item.to_owned()), Mention::Number)
}

/// Number of a side by its label: E1 of shells, S1 of plane elements.
fn side(label: &str) -> Option<u8> {
    let number = label.strip_prefix(['E', 'e', 'S', 's'])?.parse::<u8>().ok()?;
    number.checked_sub(1).filter(|side| *side < 4)
}

fn whole(item: Option<&&str>) -> Option<u64> {
    item?.parse().ok().filter(|number| *number > 0)
}

/// A number, with D for the exponent, too.
fn real(item: &str) -> Option<f64> {
    item.parse().ok().or_else(|| item.replace(['D', 'd'], "E").parse().ok())
}
