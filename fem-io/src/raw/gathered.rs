//! What a text of lines says of a mesh, one thing after the other: nodes, elements, sets that name both.

use std::collections::{BTreeMap, BTreeSet};

use fem_core::domain::Corners;

use super::error::{FilePlace, MeshError, MeshFault};
use super::sets::Sets;
use super::{Element, Item, Node, NodeTable, Places, Raw};

/// A line of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct Place {
    /// Which of [`Gathered::files`].
    pub(crate) file: u32,
    /// Counted from 1.
    pub(crate) line: u32,
}

/// An element by the numbers of its nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Card {
    pub(crate) tag: u64,
    pub(crate) place: Place,
    /// 2 of an edge, 3 or 4 of a cell.
    pub(crate) corners: u8,
    /// Corners first, then the nodes in the middles of the sides, 0 where there are none.
    pub(crate) nodes: [u64; 8],
}

/// What a set is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Members {
    Nodes,
    Elements,
    /// The sides of this number of elements, counted from 0.
    Sides(u8),
    /// Nodes if the file has nodes of all these numbers, elements otherwise.
    Either,
}

/// How a set names its members.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mention {
    Number(u64),
    /// Those of the numbers from the first to the last, in steps, that there are.
    Range([u64; 3]),
    /// All of another set.
    Set(String),
}

/// Sets by what they are of and their names in capitals: the name as it is written first, and what it names.
pub(super) type SetList = BTreeMap<(Members, String), (String, Vec<(Mention, Place)>)>;

/// Everything that was found.
#[derive(Debug, Default)]
pub(crate) struct Gathered {
    /// Their names.
    pub(crate) files: Vec<String>,
    pub(crate) nodes: Vec<(Node, Place)>,
    pub(crate) elements: Vec<Card>,
    sets: SetList,
    /// Sets that others name and that are no groups.
    hidden: BTreeSet<(Members, String)>,
    /// What was passed over: how often, and where first.
    aside: BTreeMap<String, (Place, usize)>,
}

impl Gathered {
    /// Another file begins; its number.
    pub(crate) fn file(&mut self, name: String) -> u32 {
        self.files.push(name);
        self.files.len() as u32 - 1
    }

    /// `name` has one more member.
    pub(crate) fn member(&mut self, of: Members, name: &str, mention: Mention, place: Place) {
        self.set(of, name).push((mention, place));
    }

    /// What a set names so far.
    pub(crate) fn set(&mut self, of: Members, name: &str) -> &mut Vec<(Mention, Place)> {
        &mut self.sets.entry((of, name.to_uppercase())).or_insert_with(|| (name.to_owned(), Vec::new())).1
    }

    /// A set that only others name.
    pub(crate) fn hide(&mut self, of: Members, name: &str) {
        self.hidden.insert((of, name.to_uppercase()));
    }

    /// Whether a set is a group.
    pub(super) fn shows(&self, of: Members, key: &str) -> bool {
        !self.hidden.contains(&(of, key.to_owned()))
    }

    /// Calls sets by another name; two of one name are one.
    pub(crate) fn rename(&mut self, from: &str, to: &str) {
        for of in [Members::Nodes, Members::Elements, Members::Either] {
            if let Some((_, mentions)) = self.sets.remove(&(of, from.to_uppercase())) {
                self.set(of, to).extend(mentions);
            }
        }
    }

    /// Something that concerns no mesh, or that is not understood.
    pub(crate) fn pass_over(&mut self, what: &str, place: Place) {
        match self.aside.get_mut(what) {
            Some((_, count)) => *count += 1,
            None => drop(self.aside.insert(what.to_owned(), (place, 1))),
        }
    }

    pub(crate) fn error(&self, place: Place, fault: MeshFault) -> MeshError {
        let file = self.files.get(place.file as usize).cloned().unwrap_or_default();
        MeshError { file, place: FilePlace::Line(place.line as usize), fault }
    }

    /// An error in words, which hold the remedy.
    pub(crate) fn wrong(&self, place: Place, what: String) -> MeshError {
        self.error(place, MeshFault::NotUnderstood(what))
    }

    /// Nodes, elements and groups by their numbers.
    ///
    /// # Errors
    /// Numbers that occur twice or that there are not.
    pub(crate) fn raw(&mut self) -> Result<Raw, MeshError> {
        self.elements.sort_unstable_by_key(|card| (card.tag, card.place));
        if let Some(pair) = self.elements.windows(2).find(|pair| pair[0].tag == pair[1].tag) {
            let first = self.place_of(pair[0].place);
            let fault = MeshFault::RepeatedTag(format!("the file has element {} (first {first})", pair[0].tag));
            return Err(self.error(pair[1].place, fault));
        }
        let mut raw = Raw::new(NodeTable::checked(&*self, self.nodes.iter().map(|node| node.0).collect())?);
        if self.elements.iter().all(|card| card.corners < 3) {
            return Err(self.error_at(None, MeshFault::NoPlaneElements));
        }
        let sets = Sets::of(&raw.nodes, self, &self.sets)?;
        raw.groups.clone_from(&sets.lists);
        for (card, groups) in self.elements.iter().zip(&sets.of_elements) {
            let lookup = |node: u64| {
                let unknown = || self.error(card.place, MeshFault::UnknownNode { element: card.tag, node });
                raw.nodes.index(node).ok_or_else(unknown)
            };
            let mut nodes = [0; 4];
            for (index, node) in nodes.iter_mut().zip(&card.nodes).take(card.corners.into()) {
                *index = lookup(*node)?;
            }
            let Some(corners) = Corners::from_slice(&nodes[..card.corners.into()]) else {
                if *groups > 0 {
                    raw.edges.push(Element { tag: card.tag, nodes: [nodes[0], nodes[1]], groups: *groups });
                }
                continue;
            };
            raw.cells.push(Element { tag: card.tag, nodes: corners, groups: *groups });
            let middles = card.nodes[corners.len()..].iter().take(corners.len());
            let middles: Vec<Option<u32>> = middles
                .map(|node| if *node == 0 { Ok(None) } else { lookup(*node).map(Some) })
                .collect::<Result<_, _>>()?;
            if middles.iter().any(Option::is_some) {
                raw.middles_of(card.tag, corners, middles.into_iter());
            }
        }
        sets.into_points_and_edges(&mut raw);
        raw.warnings.extend(self.said_aside());
        Ok(raw)
    }

    fn said_aside(&self) -> Option<String> {
        const NAMED: usize = 12;
        let mut all: Vec<_> = self.aside.iter().collect();
        all.sort_unstable_by_key(|(_, (place, _))| *place);
        let said = all.iter().take(NAMED).map(|(what, (place, count))| {
            let first = self.place_of(*place);
            if *count == 1 { format!("{what} ({first})") } else { format!("{what} ({count}, first {first})") }
        });
        let mut said = said.collect::<Vec<_>>().join(", ");
        if all.len() > NAMED {
            said.push_str(&format!(" and {} more", all.len() - NAMED));
        }
        (!all.is_empty()).then(|| {
            format!("left aside, since it is no part of a mesh or not understood: {said}; what matters of it belongs in the scene")
        })
    }

    /// "line 3", with the name of a file that is not the first.
    pub(crate) fn place_of(&self, place: Place) -> String {
        match self.files.get(place.file as usize).filter(|_| place.file > 0) {
            Some(file) => format!("{file}:{}", place.line),
            None => format!("line {}", place.line),
        }
    }
}

impl Places for Gathered {
    fn error_at(&self, item: Option<Item>, fault: MeshFault) -> MeshError {
        let place = match item {
            // The last of several is the one too many.
            Some(Item::Node(tag) | Item::Coordinates(tag)) => {
                self.nodes.iter().rev().find(|(node, _)| node.tag == tag).map(|(_, place)| *place)
            }
            Some(Item::Element(tag)) => self.elements.iter().find(|card| card.tag == tag).map(|card| card.place),
            None => None,
        };
        match place {
            Some(place) => self.error(place, fault),
            None => MeshError { file: self.files.first().cloned().unwrap_or_default(), place: FilePlace::File, fault },
        }
    }
}
