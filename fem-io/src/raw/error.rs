//! What is wrong with a mesh file, where, and the way out.

use std::fmt;

/// Why a mesh file was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{file}{place}: {fault}")]
#[non_exhaustive]
pub struct MeshError {
    /// Name of the file.
    pub file: String,
    /// Where in the file.
    pub place: FilePlace,
    /// What is wrong there.
    pub fault: MeshFault,
}

/// A place in a mesh file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilePlace {
    /// The file as a whole, or no place that can be told.
    File,
    /// A line of an ASCII file, counted from 1.
    Line(usize),
    /// An offset in a binary file, counted from 0.
    Byte(usize),
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line) => write!(f, ":{line}"),
            Self::Byte(byte) => write!(f, ", byte {byte}"),
        }
    }
}

/// Where cells do not meet as they should.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlawPlace {
    /// The place, m.
    pub at: [f64; 2],
    /// How many such places there are.
    pub all: usize,
}

impl fmt::Display for FlawPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.at.map(|x| x * 1e3);
        write!(f, "at ({x:.4}, {y:.4}) mm (")?;
        match self.all {
            1 => f.write_str("`fem mesh --picture` shows the place)"),
            n => write!(f, "one of {n} such places, which `fem mesh --picture` shows)"),
        }
    }
}

/// What can be wrong with a mesh file. Nodes, elements and entities have their numbers in the file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// The operating system refused.
    #[error("cannot read the file: {0}")]
    Unreadable(String),
    /// The unit that the caller gave is not a length.
    #[error("the length unit of the file is given as {0} m; it must be positive and finite, 0.001 for mm")]
    Unit(f64),
    /// Not a mesh of a known format at all.
    #[error(
        "not a mesh of gmsh, Abaqus or Nastran: it begins with no $MeshFormat, keyword or card; write it with `gmsh FILE.geo -2 \
         -format msh41`"
    )]
    NotAMesh,
    /// Something in a file of lines, in words that hold the remedy.
    #[error("{0}")]
    NotUnderstood(String),
    /// A file of lines without cells.
    #[error(
        "the file has no shell, membrane or plane element: cells are triangles and quadrilaterals (S3, S4R, CPS4, S8R ... of \
         Abaqus; CTRIA3, CQUAD4, CQUAD8 ... of Nastran); export the mid-surface of the plate, whose plies come from the scene"
    )]
    NoPlaneElements,
    /// Another version of the format.
    #[error("MSH version {0}; 2.2, 4.0 and 4.1 are read: set Mesh.MshFileVersion = 4.1 and save again")]
    Version(String),
    /// A header line that is not a header of MSH.
    #[error("unusable header {0:?}: expected a version and `0 8` (ASCII) or `1 8` with little-endian numbers (binary)")]
    Header(String),
    /// Not readable as MSH.
    #[error("not valid MSH: {0}; the file is damaged or cut short, save it again from gmsh")]
    Syntax(String),
    /// A section that must be there is not, or holds nothing.
    #[error(
        "the section ${0} is missing or empty: mesh the surfaces before saving (gmsh option -2), or get the file anew if it \
         was cut short"
    )]
    Missing(&'static str),
    /// A section occurs more than once.
    #[error("a second section ${0}: files cannot be joined by appending, merge them in gmsh and save once")]
    Repeated(&'static str),
    /// A section holds another number of things than it announces.
    #[error("the section ${section} announces {announced} entries and holds {found}; save the file again from gmsh")]
    Count {
        /// Name of the section.
        section: &'static str,
        /// Number in the section's header.
        announced: u64,
        /// Number found.
        found: usize,
    },
    /// One of the files of a mesh whose partitions were saved in a file each.
    #[error(
        "surface {surface} of the partitioned mesh has no elements: this is one of several files; set \
         Mesh.PartitionSplitMeshFiles = 0 and save again"
    )]
    Split {
        /// Number of the surface.
        surface: i32,
    },
    /// More nodes than the numbering can hold.
    #[error("{0} nodes are more than can be numbered: coarsen the mesh")]
    TooManyNodes(usize),
    /// A coordinate that is not a number.
    #[error("node {node} has the coordinate {value}: coordinates must be finite; save the file again")]
    Coordinate {
        /// Node.
        node: u64,
        /// The coordinate.
        value: f64,
    },
    /// A number given twice.
    #[error(
        "{0} twice: number nodes and elements anew (in gmsh renumberNodes() and renumberElements()) and save the file again"
    )]
    RepeatedTag(String),
    /// An element with a node that is not in the file.
    #[error("element {element} refers to node {node}, which the file does not have; save it again")]
    UnknownNode {
        /// Element.
        element: u64,
        /// Node.
        node: u64,
    },
    /// Elements of a geometric entity that is not in the file.
    #[error(
        "element {element} lies on entity {entity} of dimension {dim}, which is not in $Entities; \
         save the file again from gmsh"
    )]
    UnknownEntity {
        /// First element of the block.
        element: u64,
        /// Dimension of the entity.
        dim: i32,
        /// Number of the entity.
        entity: i32,
    },
    /// One name for groups of different dimension.
    #[error(
        "the physical group {name:?} occurs with dimension {} and {}: give each group its own name, \
         as in Physical Curve(\"support\") = {{...}};", dims[0], dims[1]
    )]
    GroupDimensions {
        /// Name of the group.
        name: String,
        /// The dimensions.
        dims: [i32; 2],
    },
    /// No cells in any group.
    #[error(
        "no physical group holds a cell: name the surface of the plate, as in Physical Surface(\"plate\") = {{1}};, \
         and mesh it before saving"
    )]
    NoCells,
    /// An element that has no place in a flat mesh.
    #[error(
        "element {element} of group {group:?} has the type {kind}; only flat meshes of quadrilaterals and triangles up to \
         second order are read: set Mesh.ElementOrder = 1, and save no volumes: name the surface of the plate, whose plies \
         come from the scene"
    )]
    Kind {
        /// Element.
        element: u64,
        /// Group.
        group: String,
        /// Shape and number of nodes.
        kind: String,
    },
    /// A node off the plane of the others.
    #[error(
        "node {node} lies at z = {z}, node {other} at z = {other_z} (file units): the mesh must be flat in x and y"
    )]
    NotFlat {
        /// Node.
        node: u64,
        /// Its z.
        z: f64,
        /// Node to compare with.
        other: u64,
        /// Its z.
        other_z: f64,
    },
    /// A cell that is not convex.
    #[error(
        "cell {cell} is folded, flattened or has an inner angle of 180 degrees or more at node {node}: \
         mesh with transfinite surfaces or Mesh.Smoothing = 10, or refine there"
    )]
    Folded {
        /// Cell.
        cell: u64,
        /// Node at its worst corner.
        node: u64,
    },
    /// A cell that is convex, but only just.
    #[error(
        "cell {cell} has an inner angle of {degrees:.2} degrees at node {node}, more than 175, and is all but a triangle: \
         mesh with transfinite surfaces or Mesh.Smoothing = 10, or refine there"
    )]
    Blunt {
        /// Cell.
        cell: u64,
        /// Node at the blunt corner.
        node: u64,
        /// Angle there.
        degrees: f64,
    },
    /// Two cells that say different things of the side between them.
    #[error(
        "the side from node {} to node {} has node {} in its middle in one cell and node {} elsewhere in the other, so that the cells \
         do not meet there: save the mesh again, all cells of one order", side[0], side[1], nodes[0], nodes[1]
    )]
    Middles {
        /// Ends of the side.
        side: [u64; 2],
        /// The nodes in its middle.
        nodes: [u64; 2],
    },
    /// Two cells on one side of an edge.
    #[error(
        "cells {} and {} lie on the same side of the edge between nodes {} and {}, {spot}: they overlap; \
         remove doubled surfaces (Coherence;) and mesh again", cells[0], cells[1], nodes[0], nodes[1]
    )]
    SameSide {
        /// The cells.
        cells: [u64; 2],
        /// Nodes of their common edge.
        nodes: [u64; 2],
        /// Where.
        spot: FlawPlace,
    },
    /// Two cells over the same place.
    #[error(
        "cells {} and {} lie over each other {spot}: cut one surface out of the other (BooleanFragments or \
         BooleanDifference) or leave one of them out of the physical groups, and mesh again", cells[0], cells[1]
    )]
    Overlap {
        /// The cells.
        cells: [u64; 2],
        /// Where.
        spot: FlawPlace,
    },
    /// A node on a side of a cell that is not a corner of it.
    #[error(
        "node {node} lies on the side of cell {cell} from node {} to node {} {spot} and is not a corner of it, so that the \
         cells there are not joined: let both surfaces share one curve (Coherence; or BooleanFragments), which is then \
         divided once, and mesh again; removeDuplicateNodes() cannot join them", side[0], side[1]
    )]
    Hanging {
        /// The node.
        node: u64,
        /// The cell.
        cell: u64,
        /// Nodes of its side.
        side: [u64; 2],
        /// Where.
        spot: FlawPlace,
    },
    /// Two nodes at the same place.
    #[error(
        "nodes {} and {} lie at the same point {spot}, so that the cells there are not joined: let the surfaces share \
         their curves (Coherence; or BooleanFragments) and mesh again, or call gmsh.model.mesh.removeDuplicateNodes(); \
         where a cut is meant, name its physical curve in `mesh.cuts` of the scene", nodes[0], nodes[1]
    )]
    NotJoined {
        /// The nodes.
        nodes: [u64; 2],
        /// Where.
        spot: FlawPlace,
    },
    /// Cells with no more than a node in common.
    #[error(
        "cells are joined by node {node} alone {spot}, which makes a hinge: let the surfaces have a curve in common or none \
         at all; where a cut ends at an edge, name that end as OpenBoundaryPhysicalGroup of gmsh's Plugin(Crack)"
    )]
    Pinched {
        /// The node.
        node: u64,
        /// Where.
        spot: FlawPlace,
    },
    /// Two elements of a group on the same two nodes.
    #[error("elements {} and {} of group {group:?} are the same edge; remove doubled curves (Coherence;)", elements[0], elements[1])]
    RepeatedEdge {
        /// The elements.
        elements: [u64; 2],
        /// Group.
        group: String,
    },
    /// A group of edges with something that is not an edge of a cell.
    #[error(
        "element {element} of group {group:?}, from node {} to node {}, is not an edge of a cell: mesh curve and \
         surface together and put the surface into a physical group", nodes[0], nodes[1]
    )]
    NotAnEdge {
        /// Element.
        element: u64,
        /// Group.
        group: String,
        /// Its nodes.
        nodes: [u64; 2],
    },
    /// A group of nodes with a node that no cell has.
    #[error(
        "node {node} of group {group:?} is not a corner of a cell: embed the point (Point {{1}} In Surface {{1}};) or \
         make it a corner of the surfaces"
    )]
    NotACorner {
        /// Node.
        node: u64,
        /// Group.
        group: String,
    },
}
