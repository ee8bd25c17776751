//! How far a plate spans.

use super::builder::Held;
use fem_core::dof::Dof;
use fem_core::plate::Plate;
use std::collections::BTreeSet;

/// Twice the farthest that a node lies from one whose deflection is held, m, or sprung where none is: the shorter side of a plate that is
/// held all around, the length of a strip that is held at its ends. The shorter side of one that nothing holds, or that lies on a bed.
pub(super) fn of(plate: &Plate, held: &Held<'_>) -> f64 {
    let (low, high) = plate.plane.bounds();
    let shorter = (high[0] - low[0]).min(high[1] - low[1]);
    let deflection = Dof::SOLID[8];
    let column = |unknown: usize| Some(plate.locate(unknown)).filter(|at| at.2 == deflection).map(|at| at.0);
    let fixed = (0..plate.ndof()).filter(|unknown| held.constraints.row(*unknown).0.is_empty());
    let mut columns: BTreeSet<usize> = fixed.filter_map(column).collect();
    if columns.is_empty() {
        let sprung =
            held.springs.all.iter().flat_map(|spring| &spring.at.0).filter_map(|(unknown, _)| column(*unknown));
        columns.extend(sprung);
    }
    if 2 * columns.len() > plate.columns.len() {
        return shorter;
    }
    // The nearest one lies on the rim of what is held.
    let is_held = |column: &u32| columns.contains(&(*column as usize));
    let on_rim = |quad: &usize| !plate.columns_of_quad(*quad).iter().all(is_held);
    let rim: BTreeSet<u32> = (0..plate.plane.quads.len())
        .filter(on_rim)
        .flat_map(|quad| plate.columns_of_quad(quad).iter().copied().filter(is_held))
        .collect();
    let square = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
    let free = (0..plate.columns.len() as u32).filter(|column| !is_held(column)).map(|c| plate.columns[c as usize]);
    let nearest = |p: [f64; 2]| rim.iter().map(|q| square(p, plate.columns[*q as usize])).fold(f64::INFINITY, f64::min);
    let farthest = free.map(nearest).filter(|far| far.is_finite()).fold(0.0, f64::max);
    if farthest > 0.0 { 2.0 * farthest.sqrt() } else { shorter }
}
