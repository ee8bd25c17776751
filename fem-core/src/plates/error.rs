//! What a plate refuses.

use crate::contracts::plugin::Dimension;
use std::fmt;

/// Why a plate cannot be made, folded, held or loaded as asked.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum PlateError {
    /// An element with a node off the corners, edges and middles of its cell.
    NodeOffGrid,
    /// A shell in several layers of cells.
    LayersOfShell,
    /// A region with plies for other layers than its faces say.
    LayersOfRegion {
        /// Layers between its faces.
        layers: usize,
        /// Those that there are plies for.
        of_region: usize,
    },
    /// A region whose layers are cut by faces of another.
    CutLayer {
        /// Its number.
        region: usize,
    },
    /// More regions than can be counted.
    TooManyRegions,
    /// A cell of a shape that the element does not stand on.
    OtherShape {
        /// What the element stands on.
        of_element: &'static str,
        /// The cell.
        quad_tag: u64,
        /// What it is.
        of_cell: &'static str,
    },
    /// A section on a mesh that is not a strip of rectangles along x.
    NoStrip {
        /// A cell that is not part of one.
        quad_tag: u64,
    },
    /// A mesh that a symmetry does not map onto itself.
    Asymmetric {
        /// Name of the symmetry.
        symmetry: &'static str,
        /// Its centre, m.
        centre: [f64; 2],
        /// Where it fails.
        at: Asymmetry,
    },
    /// No level at the mid-plane.
    NoMidPlane,
    /// Rigid motions that the unknowns of the element cannot stop.
    Unrestrained {
        /// The motions.
        motions: String,
    },
    /// A contact patch that reaches over the edge.
    PatchOverEdge {
        /// `radius` or `side`.
        of: &'static str,
        /// Its length, m.
        size: f64,
        /// Centre of the patch, m.
        centre: [f64; 2],
    },
    /// A contact patch that reaches over a step of the face.
    PatchOverStep {
        /// `radius` or `side`.
        of: &'static str,
        /// Its length, m.
        size: f64,
        /// Centre of the patch, m.
        centre: [f64; 2],
        /// Height of the step, m.
        step: f64,
    },
    /// A force along an axis along which the node cannot move.
    NoDisplacement {
        /// The node.
        node: String,
        /// x, y or z.
        axis: char,
    },
}

/// What has no image under a symmetry; places in m.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum Asymmetry {
    /// No node lies where that of a node would be.
    Node { name: String, at: [f64; 2] },
    /// The node there has other unknowns.
    Unknowns { image: String, image_at: [f64; 2], name: String, at: [f64; 2] },
    /// No cell lies where that of a cell would be.
    Cell { quad_tag: u64, at: [f64; 2] },
}

impl fmt::Display for PlateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NodeOffGrid => f.write_str("the natural coordinates of an element's nodes are -1, 0 or 1"),
            Self::LayersOfShell => {
                f.write_str("a shell holds the whole laminate in one layer of cells: give `layers = 1`")
            }
            Self::LayersOfRegion { layers, of_region } => {
                write!(f, "a region has plies for {of_region} layers of cells, and faces for {layers}")
            }
            Self::CutLayer { region } => {
                write!(f, "faces of other regions lie inside the layers of cells of region {}", region + 1)
            }
            Self::TooManyRegions => write!(f, "a plate has at most {} regions", u16::MAX),
            Self::OtherShape { of_element, quad_tag, of_cell } => {
                write!(f, "the element stands on {of_element}, and cell {quad_tag} is a {of_cell}")
            }
            Self::NoStrip { quad_tag } => write!(
                f,
                "a section needs a strip of rectangles along x, one cell across: cell {quad_tag} is not part of one"
            ),
            Self::Asymmetric { symmetry, centre, at } => {
                let [x, y] = centre.map(|c| c * 1e3);
                write!(f, "the mesh has no symmetry `{symmetry}` about ({x:.6}, {y:.6}) mm: {at}")
            }
            Self::NoMidPlane => f.write_str(
                "no face between layers lies at the mid-plane: choose `layers` that meet there, or another `at`",
            ),
            Self::Unrestrained { motions } => write!(
                f,
                "the unknowns of this element cannot restrain {motions}: fix unknowns at nodes of your choice"
            ),
            Self::PatchOverEdge { of, size, centre } => {
                let (size, centre) = (Dimension::LENGTH.of(*size), Dimension::LENGTH.list(centre));
                write!(f, "the contact patch of {of} {size} around x, y = {centre} extends beyond the plate")
            }
            Self::PatchOverStep { of, size, centre, step } => {
                let (size, centre, step) =
                    (Dimension::LENGTH.of(*size), Dimension::LENGTH.list(centre), Dimension::LENGTH.of(*step));
                write!(
                    f,
                    "the contact patch of {of} {size} around x, y = {centre} reaches over a step of {step} in the face"
                )
            }
            Self::NoDisplacement { node, axis } => write!(f, "{node} has no displacement along {axis}"),
        }
    }
}
impl std::error::Error for PlateError {}

impl fmt::Display for Asymmetry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = |[x, y]: [f64; 2]| format!("at ({:.6}, {:.6}) mm", x * 1e3, y * 1e3);
        match self {
            Self::Node { name, at } => write!(f, "{name} {} has no image", place(*at)),
            Self::Unknowns { image, image_at, name, at } => {
                write!(f, "{image} {} has other unknowns than {name} {}", place(*image_at), place(*at))
            }
            Self::Cell { quad_tag, at } => write!(f, "cell {quad_tag} {} has no image", place(*at)),
        }
    }
}
