//! `$Elements`, as far as they belong to physical groups.

use fem_core::domain::Corners;
use std::collections::BTreeSet;

use super::cursor::Cursor;
use super::error::{FilePlace, MeshError, MeshFault};
use super::groups::Groups;
use super::nodes::NodeTable;
use super::source::{Item, Source};

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

/// An element with its corners, numbered as in the node table, and the groups it belongs to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element<'g, N> {
    pub(super) tag: u64,
    pub(super) nodes: N,
    pub(super) groups: &'g [String],
}

/// Elements that belong to a group, in ascending order of their tags.
#[derive(Debug, Default)]
pub(super) struct Grouped<'g> {
    pub(super) points: Vec<Element<'g, [u32; 1]>>,
    pub(super) edges: Vec<Element<'g, [u32; 2]>>,
    pub(super) cells: Vec<Element<'g, Corners<u32>>>,
    /// Surfaces that hold elements.
    surfaces: BTreeSet<i32>,
    /// Number of surface elements in no group.
    pub(super) left_out: usize,
    /// Number of cells of second order, and how far their mid-side nodes lie off the middle of the straight edge at
    /// most, as a fraction of the edge.
    pub(super) second_order: (usize, f64),
}

/// Elements of one shape on one entity, being read.
struct Block<'s> {
    source: &'s Source<'s>,
    nodes: &'s NodeTable,
    /// Its number, and how many there are.
    number: [u64; 2],
    count: u64,
    /// Nodes of an element.
    each: usize,
}

impl<'g> Grouped<'g> {
    pub(super) fn read(source: &Source<'_>, nodes: &NodeTable, groups: &'g Groups) -> Result<Self, MeshError> {
        let (mut cursor, [blocks, announced, low, _]) = source.begin("Elements", "element")?;
        let mut grouped = Self::default();
        let mut tags = Vec::with_capacity(source.at_most(announced));
        for block in 1..=blocks {
            grouped.take(source, nodes, groups, [block, blocks], &mut cursor, &mut tags)?;
        }
        cursor.end("$EndElements").map_err(|at| source.syntax(at, "$EndElements should stand here"))?;
        if low == 0 {
            return Err(source.error(FilePlace::File, MeshFault::Syntax("element number 0 is reserved".to_owned())));
        }
        if tags.len() as u64 != announced {
            let fault = MeshFault::Count { section: "Elements", announced, found: tags.len() };
            return Err(source.error(FilePlace::File, fault));
        }
        tags.sort_unstable();
        if let Some(pair) = tags.windows(2).find(|pair| pair[0] == pair[1]) {
            let fault = MeshFault::RepeatedTag(format!("the file has element {}", pair[0]));
            return Err(source.error(source.find(Item::Element(pair[0])), fault));
        }
        if let Some(part) = groups.parts.iter().find(|part| !grouped.surfaces.contains(part)) {
            return Err(source.error(FilePlace::File, MeshFault::Split { surface: *part }));
        }
        grouped.points.sort_unstable_by_key(|e| e.tag);
        grouped.edges.sort_unstable_by_key(|e| e.tag);
        grouped.cells.sort_unstable_by_key(|e| e.tag);
        Ok(grouped)
    }

    fn take(
        &mut self,
        source: &Source<'_>,
        nodes: &NodeTable,
        groups: &'g Groups,
        number: [u64; 2],
        cursor: &mut Cursor<'_>,
        tags: &mut Vec<u64>,
    ) -> Result<(), MeshError> {
        let wrong = |what: &'static str| {
            move |at| source.syntax(at, &format!("{what}, in element entity block ({} of {})", number[0], number[1]))
        };
        let dim = cursor.int().map_err(wrong("entity dimension"))?;
        let entity = cursor.int().map_err(wrong("entity tag"))?;
        let kind = cursor.int().map_err(wrong("element type"))?;
        let Some(kind) = KINDS.iter().find(|known| known.0 == kind) else {
            return Err(wrong("an element type that is not known")(cursor.at()));
        };
        let count = cursor.size().map_err(wrong("number of elements"))?;
        if count == 0 {
            return Ok(());
        }
        let block = Block { source, nodes, number, count, each: kind.2 };
        let mut ahead = *cursor;
        let element = ahead.size().map_err(|at| block.wrong(1, at))?;
        let fail = |fault| Err(source.error(source.find(Item::Element(element)), fault));
        let Some(groups) = groups.of(dim, entity) else {
            return fail(MeshFault::UnknownEntity { element, dim, entity });
        };
        if dim == 2 {
            self.surfaces.insert(entity);
        }
        let Some(group) = groups.first() else {
            self.left_out += if dim == 2 { count as usize } else { 0 };
            return block.each(cursor, tags, |_, _| Ok(()));
        };
        match (dim, kind.1) {
            (0, "Pnt") => block.each(cursor, tags, |tag, nodes| {
                self.points.push(Element { tag, nodes: block.corners(tag, nodes)?, groups });
                Ok(())
            }),
            (1, "Lin2" | "Lin3") => block.each(cursor, tags, |tag, nodes| {
                self.edges.push(Element { tag, nodes: block.corners(tag, nodes)?, groups });
                Ok(())
            }),
            (2, "Qua4" | "Qua8" | "Qua9" | "Tri3" | "Tri6") => block.each(cursor, tags, |tag, nodes| {
                let corners: Corners<u32> = match kind.1 {
                    "Tri3" | "Tri6" => block.corners::<3>(tag, nodes)?.into(),
                    _ => block.corners::<4>(tag, nodes)?.into(),
                };
                self.cells.push(Element { tag, nodes: corners, groups });
                if nodes.len() > corners.len() {
                    self.second_order.0 += 1;
                    self.second_order.1 = self.second_order.1.max(block.bulge(tag, corners, nodes)?);
                }
                Ok(())
            }),
            (_, kind) => fail(MeshFault::Kind { element, group: group.clone(), kind: kind.to_owned() }),
        }
    }
}

impl Block<'_> {
    /// Passes number and nodes of each element to `take`.
    fn each(
        &self,
        cursor: &mut Cursor<'_>,
        tags: &mut Vec<u64>,
        mut take: impl FnMut(u64, &[u64]) -> Result<(), MeshError>,
    ) -> Result<(), MeshError> {
        let mut nodes = vec![0; self.each];
        for i in 1..=self.count {
            let tag = cursor.size().map_err(|at| self.wrong(i, at))?;
            for node in &mut nodes {
                *node = cursor.size().map_err(|at| self.wrong(i, at))?;
            }
            tags.push(tag);
            take(tag, &nodes)?;
        }
        Ok(())
    }

    fn wrong(&self, element: u64, at: usize) -> MeshError {
        let [block, blocks] = self.number;
        let what =
            format!("element definition ({element} of {}), in element entity block ({block} of {blocks})", self.count);
        self.source.syntax(at, &what)
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
        let unknown = || {
            let place = self.source.find(Item::Element(element));
            self.source.error(place, MeshFault::UnknownNode { element, node })
        };
        self.nodes.index(node).ok_or_else(unknown)
    }

    /// Largest distance of a mid-side node from the middle of its edge, as a fraction of the edge.
    fn bulge(&self, tag: u64, corners: Corners<u32>, nodes: &[u64]) -> Result<f64, MeshError> {
        let mut largest = 0.0_f64;
        for (side, middle) in corners.sides().zip(&nodes[corners.len()..]) {
            let ([a, b], middle) = (side.map(|n| self.nodes.plane(n)), self.nodes.plane(self.lookup(tag, *middle)?));
            let off = (middle[0] - 0.5 * (a[0] + b[0])).hypot(middle[1] - 0.5 * (a[1] + b[1]));
            largest = largest.max(off / (b[0] - a[0]).hypot(b[1] - a[1]));
        }
        Ok(largest)
    }
}
