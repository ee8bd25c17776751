//! Plates whose cells form several pieces.

use crate::plates::constraint::Equation;
use crate::plates::plate::Plate;
use crate::plates::support::RANK;
use nalgebra::{DMatrix, SymmetricEigen};

/// Cells of a plate that are joined by sides.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Number of its cells in the plane.
    pub cells: usize,
    /// Middle of its bounds, m.
    pub centre: [f64; 2],
    /// Half the diagonal of its bounds, m.
    length: f64,
}

/// The pieces of a plate, in the order of their first cells.
pub fn pieces(plate: &Plate) -> Vec<Piece> {
    let of_quads = plate.plane.pieces();
    let count = of_quads.iter().max().map_or(0, |last| last + 1) as usize;
    let mut bounds = vec![([f64::INFINITY; 2], [f64::NEG_INFINITY; 2], 0); count];
    for (quad, piece) in of_quads.iter().enumerate() {
        let (low, high, cells) = &mut bounds[*piece as usize];
        *cells += 1;
        for p in plate.plane.corners(quad) {
            *low = [0, 1].map(|d| low[d].min(p[d]));
            *high = [0, 1].map(|d| high[d].max(p[d]));
        }
    }
    let piece = |(low, high, cells): ([f64; 2], [f64; 2], usize)| Piece {
        cells,
        centre: [0, 1].map(|d| 0.5 * (low[d] + high[d])),
        length: 0.5 * (high[0] - low[0]).hypot(high[1] - low[1]),
    };
    bounds.into_iter().map(piece).collect()
}

/// A piece that can move against the others though `equations` hold: the smallest of those that do so alone, or the smallest
/// of all where several move together.
///
/// The motions are those of rigid bodies, six per piece. A motion of all pieces as one body is none against each other.
/// Takes time with the third power of their number.
pub fn loose(plate: &Plate, equations: &[Equation]) -> Option<Piece> {
    let pieces = pieces(plate);
    if pieces.len() < 2 {
        return None;
    }
    let seen = seen_motions(plate, &pieces, equations);
    let whole = as_one(&pieces);
    if nullity(&seen) == nullity(&(whole.transpose() * &seen * whole)) {
        return None;
    }
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by_key(|k| pieces[*k].cells);
    let alone = |k: &&usize| nullity(&seen.view((6 * **k, 6 * **k), (6, 6)).into_owned()) > 0;
    order.iter().find(alone).or(order.first()).map(|k| pieces[*k].clone())
}

/// Σ r rᵀ over the rows r with which the equations see the motions of the pieces, each row of about the length one.
fn seen_motions(plate: &Plate, pieces: &[Piece], equations: &[Equation]) -> DMatrix<f64> {
    let mut of_columns = vec![0; plate.columns.len()];
    for (quad, piece) in plate.plane.pieces().into_iter().enumerate() {
        plate.columns_of_quad(quad).iter().for_each(|column| of_columns[*column as usize] = piece as usize);
    }
    let motions = |dof: usize| {
        let k = of_columns[plate.locate(dof).0];
        let Piece { centre: [x, y], length, .. } = pieces[k];
        (k, plate.rigid_motions(dof, [x, y, 0.0], length))
    };
    let mut sum = DMatrix::zeros(6 * pieces.len(), 6 * pieces.len());
    // What moves no unknown is not a motion.
    let mut moves = vec![0.0; 6 * pieces.len()];
    for dof in 0..plate.ndof() {
        let (k, values) = motions(dof);
        values.iter().zip(&mut moves[6 * k..]).for_each(|(value, sum)| *sum += value.abs());
    }
    moves.iter().enumerate().filter(|(_, m)| **m <= RANK).for_each(|(i, _)| sum[(i, i)] = 1.0);
    for equation in equations {
        let mut row: Vec<(usize, f64)> = Vec::new();
        let mut norm = 0.0;
        for (dof, factor) in &equation.terms {
            let (k, values) = motions(*dof);
            let unit = if plate.locate(*dof).2.m() == 0 { 1.0 } else { 1.0 / pieces[k].length };
            norm += (factor * unit).powi(2);
            row.extend(values.iter().enumerate().map(|(i, value)| (6 * k + i, factor * value)));
        }
        for (i, a) in &row {
            for (j, b) in &row {
                sum[(*i, *j)] += a * b / norm.max(f64::MIN_POSITIVE);
            }
        }
    }
    sum
}

/// The six motions of all pieces as one body, in those of each piece.
fn as_one(pieces: &[Piece]) -> DMatrix<f64> {
    let length = pieces.iter().map(|piece| piece.length).fold(0.0, f64::max);
    let origin = pieces[0].centre;
    let mut motions = DMatrix::zeros(6 * pieces.len(), 6);
    for (k, piece) in pieces.iter().enumerate() {
        let arm = [piece.centre[0] - origin[0], piece.centre[1] - origin[1], 0.0];
        for axis in 0..3 {
            let (j, l) = ((axis + 1) % 3, (axis + 2) % 3);
            motions[(6 * k + axis, axis)] = 1.0;
            motions[(6 * k + 3 + axis, 3 + axis)] = piece.length / length;
            motions[(6 * k + j, 3 + axis)] = -arm[l] / length;
            motions[(6 * k + l, 3 + axis)] = arm[j] / length;
        }
    }
    motions
}

fn nullity(gram: &DMatrix<f64>) -> usize {
    let eigenvalues = SymmetricEigen::new(gram.clone()).eigenvalues;
    let least = RANK * RANK * eigenvalues.max().max(f64::MIN_POSITIVE);
    eigenvalues.iter().filter(|value| **value <= least).count()
}
