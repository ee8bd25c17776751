//! `$Elements`, as far as they belong to physical groups.

use fem_core::domain::Corners;
use std::collections::BTreeSet;

use super::cursor::Cursor;
use super::groups::Groups;
use super::source::{Source, Version};
use crate::raw::{Element, FilePlace, Item, MeshError, MeshFault, Places as _, Raw};

/// Nodes of the largest shape.
const MOST_NODES: usize = 64;

/// Shapes of elements: number in the file, name, nodes.
const KINDS: [(i32, &str, usize); 36] = [
    (1, "Lin2", 2),
    (2, "Tri3", 3),
    (3, "Qua4", 4),
    (4, "Tet4", 4),
    (5, "Hex8", 8),
    (6, "Pri6", 6),
    (7, "Pyr5", 5),
    (8, "Lin3", 3),
    (9, "Tri6", 6),
    (10, "Qua9", 9),
    (11, "Tet10", 10),
    (12, "Hex27", 27),
    (13, "Pri18", 18),
    (14, "Pyr14", 14),
    (15, "Pnt", 1),
    (16, "Qua8", 8),
    (17, "Hex20", 20),
    (18, "Pri15", 15),
    (19, "Pyr13", 13),
    (20, "Tri9", 9),
    (21, "Tri10", 10),
    (22, "Tri12", 12),
    (23, "Tri15", 15),
    (24, "Tri15", 15),
    (25, "Tri21", 21),
    (26, "Lin4", 4),
    (27, "Lin5", 5),
    (28, "Lin6", 6),
    (29, "Tet20", 20),
    (30, "Tet35", 35),
    (31, "Tet56", 56),
    (36, "Qua16", 16),
    (37, "Qua25", 25),
    (38, "Qua36", 36),
    (39, "Qua12", 12),
    (92, "Hex64", 64),
];

/// What an element lies on and belongs to.
#[derive(Debug, Clone, Copy)]
struct Holder {
    /// Dimension of what it lies on.
    dim: i32,
    /// Which of [`Raw::groups`] it belongs to.
    groups: u32,
}

/// Elements on their way into `raw`.
struct Elements<'a, 's> {
    source: &'a Source<'s>,
    raw: &'a mut Raw,
    /// All numbers.
    tags: Vec<u64>,
    /// Number of surface elements in no group.
    left_out: usize,
}

/// Reads the elements into `raw`.
pub(super) fn read(source: &Source<'_>, groups: &mut Groups, raw: &mut Raw) -> Result<(), MeshError> {
    let mut elements = Elements { source, raw, tags: Vec::new(), left_out: 0 };
    let announced = match source.version {
        Version::V22 => elements.one_by_one(groups)?,
        Version::V40 | Version::V41 => elements.in_blocks(groups)?,
    };
    let Elements { mut tags, left_out, .. } = elements;
    if tags.len() as u64 != announced {
        let fault = MeshFault::Count { section: "Elements", announced, found: tags.len() };
        return Err(source.error(FilePlace::File, fault));
    }
    tags.sort_unstable();
    if let Some(pair) = tags.windows(2).find(|pair| pair[0] == pair[1]) {
        let fault = MeshFault::RepeatedTag(format!("the file has element {}", pair[0]));
        return Err(source.error_at(Some(Item::Element(pair[0])), fault));
    }
    raw.groups = groups.lists().to_vec();
    if left_out > 0 {
        raw.warnings.push(format!(
            "{left_out} surface elements belong to no physical group and are left out; unset Mesh.SaveAll or name their \
             surface"
        ));
    }
    let used: BTreeSet<u32> = raw
        .cells
        .iter()
        .map(|e| e.groups)
        .chain(raw.edges.iter().map(|e| e.groups))
        .chain(raw.points.iter().map(|e| e.groups))
        .collect();
    let held: BTreeSet<&String> = used.iter().flat_map(|set| &raw.groups[*set as usize]).collect();
    let empty = groups.names().filter(|name| !held.contains(name));
    let empty = empty.map(|name| format!("the physical group {name:?} holds no elements and is left out"));
    raw.warnings.extend(empty);
    Ok(())
}

impl Elements<'_, '_> {
    /// The blocks of versions 4.
    fn in_blocks(&mut self, names: &Groups) -> Result<u64, MeshError> {
        let source = self.source;
        let (mut cursor, [blocks, announced, low, _]) = source.begin("Elements", "element")?;
        let mut surfaces = BTreeSet::new();
        self.tags.reserve(source.at_most(announced));
        for block in 1..=blocks {
            let at_block = format!("in element entity block ({block} of {blocks})");
            let wrong = |what: &'static str| {
                move |at| source.syntax(at, &format!("{what}, in element entity block ({block} of {blocks})"))
            };
            let (dim, entity) = source.entity(&mut cursor).map_err(wrong("entity dimension or tag"))?;
            let kind = shape(cursor.int().map_err(wrong("element type"))?)
                .ok_or_else(|| wrong("an element type that is not known")(cursor.at()))?;
            let count = cursor.size().map_err(wrong("number of elements"))?;
            let mut holder = None;
            for i in 1..=count {
                let definition = |at| source.syntax(at, &format!("element definition ({i} of {count}), {at_block}"));
                let tag = source.tag(&mut cursor).map_err(definition)?;
                let unknown = || {
                    let fault = MeshFault::UnknownEntity { element: tag, dim, entity };
                    source.error_at(Some(Item::Element(tag)), fault)
                };
                let groups = match holder {
                    Some(groups) => groups,
                    None => *holder.insert(names.of(dim, entity).ok_or_else(unknown)?),
                };
                if dim == 2 {
                    surfaces.insert(entity);
                }
                self.take(&mut cursor, tag, kind, Holder { dim, groups }, names, definition)?;
            }
        }
        cursor.end("$EndElements").map_err(|at| source.syntax(at, "$EndElements should stand here"))?;
        if low == 0 && source.version == Version::V41 {
            return Err(source.error(FilePlace::File, MeshFault::Syntax("element number 0 is reserved".to_owned())));
        }
        if let Some(part) = names.parts.iter().find(|part| !surfaces.contains(part)) {
            return Err(source.error(FilePlace::File, MeshFault::Split { surface: *part }));
        }
        Ok(announced)
    }

    /// The elements of version 2.2, which name their group themselves: one that belongs to several stands there as often, with
    /// other numbers.
    fn one_by_one(&mut self, names: &mut Groups) -> Result<u64, MeshError> {
        let source = self.source;
        let (mut cursor, announced) = source.begin_list("Elements", "elements")?;
        self.tags.reserve(source.at_most(announced));
        // A binary file says number of tags and shape once for several elements.
        let (mut kind, mut labels, mut left) = (0, 0, 0);
        for i in 1..=announced {
            let wrong = |at| source.syntax(at, &format!("element definition ({i} of {announced})"));
            let mut tag = None;
            if !source.binary {
                tag = Some(source.tag(&mut cursor).map_err(wrong)?);
            }
            if left == 0 {
                kind = cursor.int().map_err(wrong)?;
                left = if source.binary { cursor.int().map_err(wrong)? } else { 1 };
                labels = cursor.int().map_err(wrong)?;
            }
            left -= 1;
            let tag = tag.map_or_else(|| source.tag(&mut cursor), Ok).map_err(wrong)?;
            let kind = shape(kind).ok_or_else(|| wrong(cursor.at()))?;
            let mut physical = 0;
            for label in 0..labels {
                let value = cursor.int().map_err(wrong)?;
                physical = if label == 0 { value } else { physical };
            }
            let dim = dimension(kind.1);
            let set = names.of_physical(source, dim, physical)?;
            self.take(&mut cursor, tag, kind, Holder { dim, groups: set }, names, wrong)?;
        }
        cursor.end("$EndElements").map_err(|at| source.syntax(at, "$EndElements should stand here"))?;
        join(&mut self.raw.points, names);
        join(&mut self.raw.edges, names);
        join(&mut self.raw.cells, names);
        Ok(announced)
    }

    /// Reads the nodes of an element, and keeps it where it belongs to a group.
    fn take(
        &mut self,
        cursor: &mut Cursor<'_>,
        tag: u64,
        (_, kind, count): (i32, &str, usize),
        Holder { dim, groups }: Holder,
        names: &Groups,
        wrong: impl Fn(usize) -> MeshError + Copy,
    ) -> Result<(), MeshError> {
        let mut all = [0; MOST_NODES];
        let nodes = &mut all[..count];
        for node in &mut *nodes {
            *node = self.source.tag(cursor).map_err(wrong)?;
        }
        self.tags.push(tag);
        if groups == Groups::NONE {
            self.left_out += usize::from(dim == 2);
            return Ok(());
        }
        match (dim, kind) {
            (0, "Pnt") => {
                let nodes = self.corners(tag, nodes)?;
                self.raw.points.push(Element { tag, nodes, groups });
            }
            (1, "Lin2" | "Lin3") => {
                let nodes = self.corners(tag, nodes)?;
                self.raw.edges.push(Element { tag, nodes, groups });
            }
            (2, "Qua4" | "Qua8" | "Qua9" | "Tri3" | "Tri6") => {
                let corners: Corners<u32> = match kind {
                    "Tri3" | "Tri6" => self.corners::<3>(tag, nodes)?.into(),
                    _ => self.corners::<4>(tag, nodes)?.into(),
                };
                self.raw.cells.push(Element { tag, nodes: corners, groups });
                if nodes.len() > corners.len() {
                    let middles = corners.sides().zip(&nodes[corners.len()..]);
                    let middles: Result<Vec<_>, _> =
                        middles.map(|(_, middle)| self.lookup(tag, *middle).map(Some)).collect();
                    self.raw.middles_of(tag, corners, middles?.into_iter());
                }
            }
            (_, kind) => {
                let fault = MeshFault::Kind {
                    element: tag,
                    group: names.lists()[groups as usize].join(", "),
                    kind: kind.to_owned(),
                };
                return Err(self.source.error_at(Some(Item::Element(tag)), fault));
            }
        }
        Ok(())
    }

    /// The first `N` nodes of an element.
    fn corners<const N: usize>(&self, tag: u64, nodes: &[u64]) -> Result<[u32; N], MeshError> {
        let mut found = [0; N];
        for (index, node) in found.iter_mut().zip(nodes) {
            *index = self.lookup(tag, *node)?;
        }
        Ok(found)
    }

    fn lookup(&self, element: u64, node: u64) -> Result<u32, MeshError> {
        let unknown = || self.source.error_at(Some(Item::Element(element)), MeshFault::UnknownNode { element, node });
        self.raw.nodes.index(node).ok_or_else(unknown)
    }
}

/// Elements that follow each other on the same nodes are one, in the groups of both.
fn join<N: PartialEq>(elements: &mut Vec<Element<N>>, groups: &mut Groups) {
    elements.dedup_by(|next, first| {
        let again = next.nodes == first.nodes && next.groups != first.groups;
        if again {
            first.groups = groups.joined(first.groups, next.groups);
        }
        again
    });
}

fn shape(number: i32) -> Option<(i32, &'static str, usize)> {
    KINDS.into_iter().find(|known| known.0 == number)
}

/// Dimension of a shape.
fn dimension(name: &str) -> i32 {
    match &name[..3] {
        "Pnt" => 0,
        "Lin" => 1,
        "Tri" | "Qua" => 2,
        _ => 3,
    }
}
