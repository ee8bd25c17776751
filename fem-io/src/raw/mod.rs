//! Nodes, elements and groups as a file has them, and the one way from there to a mesh of a plate, with all that must hold of it.

mod assemble;
mod checks;
mod error;
mod gathered;
mod includes;
mod nodes;
mod sets;
mod tiling;

use fem_core::domain::Corners;
use fem_core::mesh::PlaneMesh;

pub use error::{FilePlace, FlawPlace, MeshError, MeshFault};
pub use tiling::Examined;

pub(crate) use gathered::{Card, Gathered, Members, Mention, Place};
pub(crate) use includes::{Includes, read as read_file};
pub(crate) use nodes::{Node, NodeTable};

/// A mesh and what its reader thinks the user should know.
#[derive(Debug, Clone, PartialEq)]
pub struct FileMesh {
    /// The mesh, metres.
    pub mesh: PlaneMesh,
    /// One sentence each.
    pub warnings: Vec<String>,
}

/// A thing in a file, by its number there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Item {
    Node(u64),
    Coordinates(u64),
    Element(u64),
}

/// Where things stand in a file.
pub(crate) trait Places {
    /// An error about a thing, or about the file as a whole.
    fn error_at(&self, item: Option<Item>, fault: MeshFault) -> MeshError;
}

/// An element with its corners, numbered as in the node table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Element<N> {
    pub(crate) tag: u64,
    pub(crate) nodes: N,
    /// Which of [`Raw::groups`] it belongs to.
    pub(crate) groups: u32,
}

/// A node in the middle of a side of a cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Middle {
    /// Corners at its ends, the lower one first.
    pub(crate) side: [u32; 2],
    pub(crate) node: u32,
    /// Number of the cell.
    pub(crate) cell: u64,
}

/// What a file says of a plate.
#[derive(Debug)]
pub(crate) struct Raw {
    pub(crate) nodes: NodeTable,
    /// Sets of names; elements of one set belong to the same groups.
    pub(crate) groups: Vec<Vec<String>>,
    pub(crate) points: Vec<Element<[u32; 1]>>,
    pub(crate) edges: Vec<Element<[u32; 2]>>,
    pub(crate) cells: Vec<Element<Corners<u32>>>,
    /// Nodes in the middles of sides.
    pub(crate) middles: Vec<Middle>,
    /// What its reader has to say.
    pub(crate) warnings: Vec<String>,
}

impl Raw {
    pub(crate) fn new(nodes: NodeTable) -> Self {
        Self {
            nodes,
            groups: Vec::new(),
            points: Vec::new(),
            edges: Vec::new(),
            cells: Vec::new(),
            middles: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// The nodes in the middles of the sides of a cell.
    pub(crate) fn middles_of(&mut self, cell: u64, corners: Corners<u32>, middles: impl Iterator<Item = Option<u32>>) {
        let sides = corners.sides().zip(middles);
        let found = sides.filter_map(|([a, b], node)| Some(Middle { side: [a.min(b), a.max(b)], node: node?, cell }));
        self.middles.extend(found);
    }

    /// The mesh with all that is wrong with its tiling, along the groups `cuts` on purpose.
    ///
    /// # Errors
    /// What makes it no flat mesh of convex cells.
    pub(crate) fn examined(
        mut self,
        places: &dyn Places,
        unit_metres: f64,
        cuts: &[String],
    ) -> Result<Examined, MeshError> {
        if self.cells.is_empty() {
            return Err(places.error_at(None, MeshFault::NoCells));
        }
        self.points.sort_unstable_by_key(|e| e.tag);
        self.edges.sort_unstable_by_key(|e| e.tag);
        self.cells.sort_unstable_by_key(|e| e.tag);
        let turned = checks::orient(places, &self.nodes, &mut self.cells)?;
        self.middles.sort_by_key(|middle| middle.side);
        let mut mesh = assemble::mesh(places, &self, unit_metres)?;
        let straightened = checks::straighten(&mut mesh);
        let warnings = self.warnings(mesh.quads.len(), &turned, &straightened);
        let examined = Examined::new(places, FileMesh { mesh, warnings }, cuts);
        if examined.flaws.is_empty() {
            checks::check_edges(places, &self, &examined.read.mesh)?;
        }
        Ok(examined)
    }

    /// What the user should know of a mesh that was accepted.
    fn warnings(&self, cells: usize, turned: &[u64], straightened: &[u64]) -> Vec<String> {
        let mut warnings = Vec::new();
        if let Some(first) = turned.first() {
            let (n, verb) = (turned.len(), if turned.len() == 1 { "was" } else { "were" });
            warnings.push(format!("{n} of {cells} cells {verb} clockwise (the first is {first}) and turned round"));
        }
        if let Some(first) = straightened.first() {
            warnings.push(format!(
                "{} of {cells} cells would fold with the bent sides that the nodes in their middles give them (the first is {first}): \
                 these sides stay straight; refine there, or let no cell have two sides on one curve",
                straightened.len()
            ));
        }
        warnings.extend(self.warnings.iter().cloned());
        warnings
    }
}
