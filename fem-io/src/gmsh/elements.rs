//! Nodes, and the elements of physical groups.

use mshio::{ElementBlock, ElementType, Elements, Nodes};

use super::error::{MeshError, MeshFault, Place};
use super::groups::Groups;
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
    pub(super) fn new(source: &Source<'_>, nodes: Nodes<u64, i32, f64>) -> Result<Self, MeshError> {
        let found = nodes.node_blocks.iter().map(|b| b.nodes.len()).sum();
        if u64::try_from(found) != Ok(source.announced_nodes) {
            let fault = MeshFault::Count { section: "Nodes", announced: source.announced_nodes, found };
            return Err(source.error(Place::File, fault));
        }
        if u32::try_from(found).is_err() {
            return Err(source.error(Place::File, MeshFault::TooManyNodes(found)));
        }
        let mut table = Vec::with_capacity(found);
        for block in nodes.node_blocks {
            let Some(tags) = block.node_tags else {
                let why = "the range of node numbers in the header of $Nodes is too small for its nodes".to_owned();
                return Err(source.error(Place::File, MeshFault::Syntax(why)));
            };
            if tags.len() < block.nodes.len() {
                let what = format!("entity {} of dimension {} has a node", block.entity_tag, block.entity_dim);
                return Err(source.error(Place::File, MeshFault::RepeatedTag(what)));
            }
            table.extend(tags.into_iter().map(|(tag, i)| {
                let node = &block.nodes[i];
                Node { tag, x: [node.x, node.y, node.z] }
            }));
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

    fn index(&self, tag: u64) -> Option<u32> {
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

/// An element with `N` corners, numbered as in the node table, and the groups it belongs to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element<'g, const N: usize> {
    pub(super) tag: u64,
    pub(super) nodes: [u32; N],
    pub(super) groups: &'g [String],
}

/// Elements that belong to a group, in ascending order of their tags.
#[derive(Debug, Default)]
pub(super) struct Grouped<'g> {
    pub(super) points: Vec<Element<'g, 1>>,
    pub(super) edges: Vec<Element<'g, 2>>,
    pub(super) cells: Vec<Element<'g, 4>>,
    /// Number of surface elements in no group.
    pub(super) left_out: usize,
    /// Number of cells of second order, and how far their mid-side nodes lie off the middle of the straight edge at
    /// most, as a fraction of the edge.
    pub(super) second_order: (usize, f64),
}

impl<'g> Grouped<'g> {
    pub(super) fn new(
        source: &Source<'_>,
        nodes: &NodeTable,
        groups: &'g Groups,
        elements: &Elements<u64, i32>,
    ) -> Result<Self, MeshError> {
        let all = || elements.element_blocks.iter().flat_map(|block| &block.elements);
        let mut tags: Vec<u64> = all().map(|e| e.element_tag).collect();
        if u64::try_from(tags.len()) != Ok(elements.num_elements) {
            let fault = MeshFault::Count { section: "Elements", announced: elements.num_elements, found: tags.len() };
            return Err(source.error(Place::File, fault));
        }
        tags.sort_unstable();
        if let Some(pair) = tags.windows(2).find(|pair| pair[0] == pair[1]) {
            let fault = MeshFault::RepeatedTag(format!("the file has element {}", pair[0]));
            return Err(source.error(source.find(Item::Element(pair[0])), fault));
        }
        let mut grouped = Self::default();
        for block in &elements.element_blocks {
            grouped.take(nodes, groups, block).map_err(|(element, fault)| source.error(source.find(element), fault))?;
        }
        grouped.points.sort_unstable_by_key(|e| e.tag);
        grouped.edges.sort_unstable_by_key(|e| e.tag);
        grouped.cells.sort_unstable_by_key(|e| e.tag);
        Ok(grouped)
    }

    fn take(
        &mut self,
        nodes: &NodeTable,
        groups: &'g Groups,
        block: &ElementBlock<u64, i32>,
    ) -> Result<(), (Item, MeshFault)> {
        let Some(first) = block.elements.first() else {
            return Ok(());
        };
        let (dim, entity, element) = (block.entity_dim, block.entity_tag, first.element_tag);
        let groups = groups
            .of(dim, entity)
            .ok_or((Item::Element(element), MeshFault::UnknownEntity { element, dim, entity }))?;
        let Some(group) = groups.first() else {
            self.left_out += if dim == 2 { block.elements.len() } else { 0 };
            return Ok(());
        };
        match (dim, block.element_type) {
            (0, ElementType::Pnt) => self.points.append(&mut corners(nodes, groups, block)?),
            (1, ElementType::Lin2 | ElementType::Lin3) => self.edges.append(&mut corners(nodes, groups, block)?),
            (2, ElementType::Qua4) => self.cells.append(&mut corners(nodes, groups, block)?),
            (2, ElementType::Qua8 | ElementType::Qua9) => {
                self.cells.append(&mut corners(nodes, groups, block)?);
                self.second_order.0 += block.elements.len();
                self.second_order.1 = self.second_order.1.max(bulge(nodes, block)?);
            }
            (2, ElementType::Tri3 | ElementType::Tri6) => {
                let group = group.clone();
                return Err((Item::Element(element), MeshFault::Triangle { element, group }));
            }
            (_, kind) => {
                let (group, kind) = (group.clone(), format!("{kind:?}"));
                return Err((Item::Element(element), MeshFault::Kind { element, group, kind }));
            }
        }
        Ok(())
    }
}

fn lookup(nodes: &NodeTable, element: u64, node: u64) -> Result<u32, (Item, MeshFault)> {
    nodes.index(node).ok_or((Item::Element(element), MeshFault::UnknownNode { element, node }))
}

fn corners<'g, const N: usize>(
    nodes: &NodeTable,
    groups: &'g [String],
    block: &ElementBlock<u64, i32>,
) -> Result<Vec<Element<'g, N>>, (Item, MeshFault)> {
    let corner = |e: &mshio::Element<u64>| {
        let mut found = [0; N];
        for (index, node) in found.iter_mut().zip(&e.nodes) {
            *index = lookup(nodes, e.element_tag, *node)?;
        }
        Ok(Element { tag: e.element_tag, nodes: found, groups })
    };
    block.elements.iter().map(corner).collect()
}

/// Largest distance of a mid-side node from the middle of its edge, as a fraction of the edge.
fn bulge(nodes: &NodeTable, block: &ElementBlock<u64, i32>) -> Result<f64, (Item, MeshFault)> {
    let mut largest = 0.0_f64;
    for e in &block.elements {
        for side in 0..4 {
            let at = |i: usize| lookup(nodes, e.element_tag, e.nodes[i]).map(|n| nodes.plane(n));
            let (a, b, middle) = (at(side)?, at((side + 1) % 4)?, at(side + 4)?);
            let off = (middle[0] - 0.5 * (a[0] + b[0])).hypot(middle[1] - 0.5 * (a[1] + b[1]));
            largest = largest.max(off / (b[0] - a[0]).hypot(b[1] - a[1]));
        }
    }
    Ok(largest)
}
