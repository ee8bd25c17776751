//! Layers of a plate that may separate.

use super::{Plate, ZDerivatives};
use crate::plates::constraint::Equation;
use crate::words::dof::Dof;
use std::collections::BTreeMap;

/// Unknowns of the displacements on the two sides of a face between layers, over a quad; where a node cannot separate both are the
/// same.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FaceUnknowns {
    /// Of the layer below, node by node, those of [`Plate::face_slots`].
    pub below: Vec<usize>,
    /// Of the layer above, in the same order.
    pub above: Vec<usize>,
}

impl Plate {
    /// Gives the nodes between the layers `face − 1` and `face` a second set of all unknowns for the layer above, where all quads
    /// around them are among `quads` and the edge of the plate or other such quads lie beyond. Until [`Plate::ties`] hold them
    /// together, the layers have nothing in common there.
    ///
    /// To be done before anything else is made of the plate. Of a shell, or at its faces, nothing separates.
    pub fn separate(&mut self, face: usize, quads: &[u32]) {
        if face == 0 || face >= self.layers() {
            return;
        }
        let mut inside = vec![false; self.plane.quads.len()];
        quads.iter().for_each(|quad| inside[*quad as usize] = true);
        let mut separable = vec![true; self.columns.len()];
        for quad in (0..inside.len()).filter(|quad| !inside[*quad]) {
            self.columns_of_quad(quad).iter().for_each(|column| separable[*column as usize] = false);
        }
        if self.separable.is_empty() {
            self.separable = vec![false; self.columns.len() * self.levels.len()];
        }
        for column in (0..separable.len()).filter(|column| separable[*column]) {
            let node = self.node(column, face * self.pitch);
            self.separable[node] = true;
        }
        self.number();
    }

    pub(super) fn is_separable(&self, node: usize) -> bool {
        self.separable.get(node).is_some_and(|separable| *separable)
    }

    /// Names of the second set of unknowns of a node between layers.
    pub(super) fn second_set(&self, node: usize) -> impl Iterator<Item = &'static Dof> + use<> {
        let whole = self.is_separable(node);
        self.info().dofs.iter().filter(move |dof| whole || dof.m() == 3)
    }

    /// Level of a face between layers.
    pub fn face_level(&self, face: usize) -> usize {
        face * self.pitch
    }

    /// Unknowns of a cell, in its own count, that the displacements on its upper face depend on: those of the nodes there but
    /// their z-derivatives. Without a `quad`, those of the shape with most corners.
    pub fn face_slots(&self, quad: Option<usize>) -> impl Iterator<Item = (usize, Dof)> + '_ {
        let nd = self.info().dofs.len();
        let slots = &quad.map_or(&self.layouts[0], |quad| self.layout(quad)).slots;
        let top = (0..slots.len()).filter(|i| slots[*i].1 == self.pitch);
        top.flat_map(move |i| {
            self.info().dofs.iter().enumerate().filter(|(_, d)| d.m() != 3).map(move |(k, d)| (i * nd + k, *d))
        })
    }

    /// Unknowns of the two sides of the face between the layers `face − 1` and `face` over a quad.
    pub fn face_unknowns(&self, quad: usize, face: usize) -> FaceUnknowns {
        let nd = self.info().dofs.len();
        let mut found = FaceUnknowns::default();
        for (i, (place, up)) in self.layout(quad).slots.iter().enumerate() {
            if *up != self.pitch {
                continue;
            }
            let node = self.node(self.columns_of_quad(quad)[*place] as usize, face * self.pitch);
            debug_assert_eq!(node, self.cell_node(self.cell_over(quad, face - 1), i));
            let first = self.offsets[node];
            let above = if self.is_separable(node) { first + nd } else { first };
            for (k, _) in self.info().dofs.iter().enumerate().filter(|(_, dof)| dof.m() != 3) {
                found.below.push(first + k);
                found.above.push(above + k);
            }
        }
        found
    }

    /// Columns of the nodes that may separate, each with its face.
    pub fn separable_nodes(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let levels = self.levels.len();
        let nodes = self.separable.iter().enumerate().filter(|(_, separable)| **separable);
        nodes.map(move |(node, _)| (node / levels, node % levels / self.pitch))
    }

    /// Pairs of unknowns above and below that are one as long as the layers hold together at a node that may separate: all but
    /// the z-derivatives that layers have of their own.
    pub fn pairs(&self, column: usize, face: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
        let node = self.node(column, face * self.pitch);
        let (first, nd) = (self.offsets[node], self.info().dofs.len());
        let shared = self.z_derivatives == ZDerivatives::Shared;
        let names = self.info().dofs.iter().enumerate().filter(move |(_, dof)| shared || dof.m() != 3);
        names.map(move |(k, _)| [first + nd + k, first + k])
    }

    /// What holds the layers together at those nodes (column, face) that may separate and are `closed`.
    pub fn ties(&self, mut closed: impl FnMut(usize, usize) -> bool) -> Vec<Equation> {
        let mut ties = Vec::new();
        for (column, face) in self.separable_nodes() {
            if closed(column, face) {
                ties.extend(self.pairs(column, face).map(|[above, below]| Equation {
                    terms: vec![(above, 1.0), (below, -1.0)],
                    value: 0.0,
                    origin: CLOSED.into(),
                    holds: false,
                }));
            }
        }
        ties
    }
}

/// Origin of the equations of [`Plate::ties`].
pub const CLOSED: &str = "the closed interface";

impl Plate {
    /// Columns with nodes at the corners of a quad; a section has its nodes between two corners, which share them.
    pub fn corner_columns(&self, quad: usize) -> impl Iterator<Item = u32> + '_ {
        let middle = if self.info().is_section() { 0.0 } else { 1.0 };
        let layout = self.layout(quad);
        let at = move |[r, s]: &[f64; 2]| layout.places.iter().position(|place| *place == [*r, middle * s]);
        let places = layout.info.domain.corners().iter().filter_map(at);
        places.map(move |place| self.columns_of_quad(quad)[place])
    }

    /// Columns with nodes that are no corners, by the corner columns of their cells, and how far those move with a corner in a motion
    /// that is linear along each side: half as far in the middle of one.
    pub fn columns_beside(&self) -> BTreeMap<usize, Vec<(usize, f64)>> {
        let mut shares: BTreeMap<[u32; 2], f64> = BTreeMap::new();
        for quad in 0..self.plane.quads.len() {
            let layout = self.layout(quad);
            let corners: Vec<u32> = self.corner_columns(quad).collect();
            let of_corners = layout.info.domain.corners().len();
            if corners.len() < of_corners || layout.places.len() == of_corners {
                continue;
            }
            for (place, column) in layout.places.iter().zip(self.columns_of_quad(quad)) {
                let others = corners.iter().zip(layout.info.domain.vertex_functions(*place));
                let others = others.filter(|(corner, share)| *corner != column && *share > 0.0);
                shares.extend(others.map(|(corner, share)| ([*corner, *column], share)));
            }
        }
        let mut of_corner: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
        for ([corner, column], share) in shares {
            of_corner.entry(corner as usize).or_default().push((column as usize, share));
        }
        of_corner
    }

    /// The displacement along axis `n`, counted from 1, of the layer above a node that may separate.
    pub fn above(&self, column: usize, face: usize, n: u8) -> Option<usize> {
        let dof = Dof::new(n, 0)?;
        let node = self.node(column, face * self.pitch);
        self.dofs_at(column, face * self.pitch, dof).nth(1).filter(|_| self.is_separable(node))
    }
}
