//! `$Nodes`.

use super::error::{FilePlace, MeshError, MeshFault};
use super::source::{Item, Source};

/// A node of the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub(super) tag: u64,
    pub(super) x: [f64; 3],
}

/// Nodes in ascending order of their tags.
#[derive(Debug)]
pub(super) struct NodeTable(pub(super) Vec<Node>);

impl NodeTable {
    pub(super) fn read(source: &Source<'_>) -> Result<Self, MeshError> {
        let (mut cursor, [blocks, announced, low, high]) = source.begin("Nodes", "node")?;
        let mut table = Vec::with_capacity(source.at_most(announced));
        for block in 1..=blocks {
            let wrong = |what: &'static str| {
                move |at| source.syntax(at, &format!("{what}, in node entity block ({block} of {blocks})"))
            };
            let dim = cursor.int().map_err(wrong("entity dimension"))?;
            cursor.int().map_err(wrong("entity tag"))?;
            let parameters = match cursor.int().map_err(wrong("whether nodes are parametric"))? {
                0 => 0,
                _ => dim.clamp(0, 3),
            };
            let count = cursor.size().map_err(wrong("number of nodes"))?;
            let first = table.len();
            for _ in 0..count {
                let tag = cursor.size().map_err(wrong("node tags"))?;
                table.push(Node { tag, x: [0.0; 3] });
            }
            for node in &mut table[first..] {
                for x in &mut node.x {
                    *x = cursor.double().map_err(wrong("node coordinates"))?;
                }
                for _ in 0..parameters {
                    cursor.double().map_err(wrong("parametric node coordinates"))?;
                }
            }
        }
        cursor.end("$EndNodes").map_err(|at| source.syntax(at, "$EndNodes should stand here"))?;
        let table = Self::checked(source, table, announced)?;
        let range = high.checked_sub(low).and_then(|n| n.checked_add(1)).unwrap_or(0);
        if low == 0 || range < announced {
            let why =
                "the range of node numbers in the header of $Nodes is too small for its nodes, or holds 0".to_owned();
            return Err(source.error(FilePlace::File, MeshFault::Syntax(why)));
        }
        Ok(table)
    }

    fn checked(source: &Source<'_>, mut table: Vec<Node>, announced: u64) -> Result<Self, MeshError> {
        let found = table.len();
        if found as u64 != announced {
            return Err(source.error(FilePlace::File, MeshFault::Count { section: "Nodes", announced, found }));
        }
        if u32::try_from(found).is_err() {
            return Err(source.error(FilePlace::File, MeshFault::TooManyNodes(found)));
        }
        table.sort_unstable_by_key(|node| node.tag);
        if let Some(pair) = table.windows(2).find(|pair| pair[0].tag == pair[1].tag) {
            let fault = MeshFault::RepeatedTag(format!("the file has node {}", pair[0].tag));
            return Err(source.error(source.find(Item::Node(pair[0].tag)), fault));
        }
        for node in &table {
            if let Some(value) = node.x.into_iter().find(|x| !x.is_finite()) {
                let fault = MeshFault::Coordinate { node: node.tag, value };
                return Err(source.error(source.find(Item::Coordinates(node.tag)), fault));
            }
        }
        Ok(Self(table))
    }

    pub(super) fn index(&self, tag: u64) -> Option<u32> {
        let (first, last) = (self.0.first()?.tag, self.0.last()?.tag);
        let near = usize::try_from(tag.checked_sub(first)?).ok()?;
        let contiguous = last - first == self.0.len() as u64 - 1;
        let index = if contiguous { near } else { self.0.binary_search_by_key(&tag, |node| node.tag).ok()? };
        (index < self.0.len()).then_some(index as u32)
    }

    pub(super) fn tag(&self, index: u32) -> u64 {
        self.0[index as usize].tag
    }

    pub(super) fn plane(&self, index: u32) -> [f64; 2] {
        let [x, y, _] = self.0[index as usize].x;
        [x, y]
    }
}
