//! A piece of LAMCEL or LAMSUB: from its deck to matrices on its masters.

use super::element::element;
use super::reduced::{Block, Way, reduce};
use fem_core::element::{Cell, Element, ElementError, Scratch, Stack};
use fem_core::laminate::Laminate;
use fem_io::deck::{DeckError, DeckSource, Fault, Generation, PieceKind};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// What the elements of a piece are made of.
#[derive(Debug)]
pub(super) struct Parts<'a> {
    deck: &'a Generation,
    pub(super) element: Box<dyn Element>,
    /// Heights of the ply boundaries.
    heights: Vec<f64>,
    /// By the plies that they hold: elements beside each other share theirs.
    stacks: BTreeMap<[usize; 2], Stack>,
}

impl<'a> Parts<'a> {
    /// # Errors
    /// An order that the element does not know.
    pub(super) fn new(source: &DeckSource, deck: &'a Generation) -> Result<Self, DeckError> {
        let refuse = |why: String| source.error(0..0, Fault::Geometry, why, "");
        let mut stacks = BTreeMap::new();
        for card in &deck.piece.elements {
            let Entry::Vacant(place) = stacks.entry([card.plies.start, card.plies.end]) else { continue };
            let plies = deck.laminate.plies[card.plies.clone()].to_vec();
            let laminate = Laminate { layers: vec![plies.len()], plies, middle: 0.0 };
            let mut made = laminate.stacks(&deck.laminate.materials).map_err(|why| refuse(why.to_string()))?;
            place.insert(made.remove(0));
        }
        Ok(Self {
            deck,
            element: element(deck.kind, deck.order).map_err(|why| refuse(why.to_string()))?,
            heights: deck.laminate.heights(),
            stacks,
        })
    }

    /// Element `number`, from 0.
    pub(super) fn cell(&self, number: usize) -> Cell<'_> {
        let card = &self.deck.piece.elements[number];
        let z = [self.heights[card.plies.start], self.heights[card.plies.end]];
        Cell { corners: card.plane.into(), z, stack: &self.stacks[&[card.plies.start, card.plies.end]] }
    }

    /// Degrees of freedom of an element, node by node.
    fn dofs(&self, number: usize) -> Vec<usize> {
        let per_node = self.deck.freedom.directions.len();
        let nodes = self.deck.piece.elements[number].nodes.iter();
        nodes.flat_map(|node| node * per_node..(node + 1) * per_node).collect()
    }

    /// Displacements of an element in the plate's axes, of those of the piece, which are in the axes of its nodes.
    pub(super) fn displacements(&self, number: usize, u: &[f64]) -> Vec<f64> {
        let own: Vec<f64> = self.dofs(number).into_iter().map(|dof| u[dof]).collect();
        match self.turn(number) {
            Some(turn) => (turn * DVector::from_vec(own)).as_slice().to_vec(),
            None => own,
        }
    }

    /// T of u = T u', u' in the axes of the nodes of an element; `None` where all are those of the plate.
    fn turn(&self, number: usize) -> Option<DMatrix<f64>> {
        let nodes = &self.deck.piece.elements[number].nodes;
        let betas: Vec<f64> = nodes.iter().map(|node| self.deck.piece.nodes[*node].beta).collect();
        if self.deck.kind != PieceKind::Solid || betas.iter().all(|beta| *beta == 0.0) {
            return None;
        }
        let mut t = DMatrix::zeros(12 * nodes.len(), 12 * nodes.len());
        for (i, beta) in betas.iter().enumerate() {
            let mut block = t.view_mut((12 * i, 12 * i), (12, 12));
            block.copy_from(&turn_of_node(beta.to_radians()));
        }
        Some(t)
    }

    /// K and M of an element in the axes of its nodes.
    fn matrices(&self, number: usize, scratch: &mut Scratch) -> Result<[Vec<f64>; 2], ElementError> {
        let n = self.element.info().ndof();
        let [mut k, mut m] = [vec![0.0; n * n], vec![0.0; n * n]];
        self.element.stiffness(&self.cell(number), scratch, &mut k)?;
        self.element.mass(&self.cell(number), scratch, &mut m)?;
        let Some(t) = self.turn(number) else { return Ok([k, m]) };
        Ok([k, m].map(|a| {
            let turned = t.tr_mul(&(DMatrix::from_column_slice(n, n, &a) * &t));
            ((&turned + turned.transpose()) * 0.5).as_slice().to_vec()
        }))
    }
}

/// The unknowns of a node whose axes are turned by `beta` about +Z: u = Q u', H = Q H' Qᵀ with H_nm = ∂u_n/∂x_m.
fn turn_of_node(beta: f64) -> DMatrix<f64> {
    let q: Matrix3<f64> = *Rotation3::from_axis_angle(&Vector3::z_axis(), beta).matrix();
    DMatrix::from_fn(12, 12, |row, column| {
        let ((n, m), (k, l)) = ((row / 4, row % 4), (column / 4, column % 4));
        match (m, l) {
            (0, 0) => q[(n, k)],
            (1.., 1..) => q[(n, k)] * q[(m - 1, l - 1)],
            _ => 0.0,
        }
    })
}

/// The piece on its masters.
///
/// # Errors
/// A cell that the element refuses, slaves that move without strain.
pub(super) fn generate(source: &DeckSource, deck: &Generation) -> Result<Way, DeckError> {
    let parts = Parts::new(source, deck)?;
    let mut scratch = Scratch::default();
    let mut blocks = Vec::new();
    for number in 0..deck.piece.elements.len() {
        let matrices = parts.matrices(number, &mut scratch).map_err(|why| {
            let found = format!("element {}: {why}", number + 1);
            source.error(0..0, Fault::Geometry, found, "look at the corners of the element")
        })?;
        blocks.push((parts.dofs(number), matrices));
    }
    let blocks: Vec<Block<'_>> = blocks.iter().map(|(dofs, [k, m])| Block { dofs, k, m }).collect();
    reduce(source, &deck.freedom, &blocks)
}
