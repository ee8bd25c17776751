//! Nodes by their numbers in the file.

use super::error::{MeshError, MeshFault};
use super::{Item, Places};

/// A node of the file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) tag: u64,
    pub(crate) x: [f64; 3],
}

/// Nodes in ascending order of their tags.
#[derive(Debug)]
pub(crate) struct NodeTable(pub(super) Vec<Node>);

impl NodeTable {
    /// # Errors
    /// A number given twice, a coordinate that is not finite, more nodes than can be numbered.
    pub(crate) fn checked(places: &dyn Places, mut table: Vec<Node>) -> Result<Self, MeshError> {
        if u32::try_from(table.len()).is_err() {
            return Err(places.error_at(None, MeshFault::TooManyNodes(table.len())));
        }
        table.sort_unstable_by_key(|node| node.tag);
        if let Some(pair) = table.windows(2).find(|pair| pair[0].tag == pair[1].tag) {
            let fault = MeshFault::RepeatedTag(format!("the file has node {}", pair[0].tag));
            return Err(places.error_at(Some(Item::Node(pair[0].tag)), fault));
        }
        for node in &table {
            if let Some(value) = node.x.into_iter().find(|x| !x.is_finite()) {
                let fault = MeshFault::Coordinate { node: node.tag, value };
                return Err(places.error_at(Some(Item::Coordinates(node.tag)), fault));
            }
        }
        Ok(Self(table))
    }

    pub(crate) fn index(&self, tag: u64) -> Option<u32> {
        let (first, last) = (self.0.first()?.tag, self.0.last()?.tag);
        let near = usize::try_from(tag.checked_sub(first)?).ok()?;
        let contiguous = last - first == self.0.len() as u64 - 1;
        let index = if contiguous { near } else { self.0.binary_search_by_key(&tag, |node| node.tag).ok()? };
        (index < self.0.len()).then_some(index as u32)
    }

    pub(crate) fn tag(&self, index: u32) -> u64 {
        self.0[index as usize].tag
    }

    pub(crate) fn plane(&self, index: u32) -> [f64; 2] {
        let [x, y, _] = self.0[index as usize].x;
        [x, y]
    }
}
