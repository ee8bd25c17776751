//! What is said where cells do not tile a plate.

use fem_core::mesh::{Flaw, FlawKind, PlaneMesh};

use super::error::{FlawPlace, MeshError, MeshFault};
use super::{FileMesh, Item, Places};

/// A mesh file and where its cells do not tile a plate.
#[derive(Debug, Clone, PartialEq)]
pub struct Examined {
    /// What was read.
    pub read: FileMesh,
    /// What is wrong with it, the worst first.
    pub flaws: Vec<Flaw>,
    /// What [`Examined::sound`] says of the first of them.
    refusal: Option<MeshError>,
}

impl Examined {
    pub(super) fn new(places: &dyn Places, read: FileMesh, cuts: &[String]) -> Self {
        let flaws = read.mesh.flaws(cuts);
        let of_first = |first: &Flaw| {
            let alike = |flaw: &&Flaw| std::mem::discriminant(&flaw.kind) == std::mem::discriminant(&first.kind);
            let spot = FlawPlace { at: first.at, all: flaws.iter().filter(alike).count() };
            let (item, fault) = told(&read.mesh, first.kind, spot);
            places.error_at(Some(item), fault)
        };
        let refusal = flaws.first().map(of_first);
        Self { read, flaws, refusal }
    }

    /// A mesh that was built, and not read, without flaws.
    pub fn built(mesh: PlaneMesh) -> Self {
        Self { read: FileMesh { mesh, warnings: Vec::new() }, flaws: Vec::new(), refusal: None }
    }

    /// The mesh, if its cells tile a plate.
    ///
    /// # Errors
    /// The first flaw.
    pub fn sound(self) -> Result<FileMesh, MeshError> {
        self.refusal.map_or(Ok(self.read), Err)
    }
}

/// What a flaw is for people, and what of the file it stands at.
fn told(mesh: &PlaneMesh, kind: FlawKind, spot: FlawPlace) -> (Item, MeshFault) {
    let cell = |cell: u32| mesh.quad_tags[cell as usize];
    let node = |node: u32| mesh.node_tags[node as usize];
    match kind {
        FlawKind::SameSide { cells, nodes } => {
            let cells = cells.map(cell);
            (Item::Element(cells[1]), MeshFault::SameSide { cells, nodes: nodes.map(node), spot })
        }
        FlawKind::Overlap { cells } => {
            let cells = cells.map(cell);
            (Item::Element(cells[1]), MeshFault::Overlap { cells, spot })
        }
        FlawKind::Hanging { node: at, cell: of, side } => {
            let fault = MeshFault::Hanging { node: node(at), cell: cell(of), side: side.map(node), spot };
            (Item::Node(node(at)), fault)
        }
        FlawKind::Doubled { nodes } => {
            let nodes = nodes.map(node);
            (Item::Node(nodes[1]), MeshFault::NotJoined { nodes, spot })
        }
        FlawKind::Pinched { node: at } => (Item::Node(node(at)), MeshFault::Pinched { node: node(at), spot }),
    }
}
