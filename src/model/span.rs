//! How far a plate spans.

use super::builder::Held;
use fem_core::dof::Dof;
use fem_core::plate::Plate;
use std::collections::BTreeSet;

/// Twice the farthest that a node lies from one whose deflection is held or sprung, m: the shorter side of a plate that is held all
/// around, the length of a strip that is held at its ends. The shorter side of one that nothing holds, or that lies on a bed.
pub(super) fn of(plate: &Plate, held: &Held<'_>) -> f64 {
    let (low, high) = plate.plane.bounds();
    let shorter = (high[0] - low[0]).min(high[1] - low[1]);
    let deflection = Dof::SOLID[8];
    let column = |unknown: usize| Some(plate.locate(unknown)).filter(|at| at.2 == deflection).map(|at| at.0);
    let fixed = (0..plate.ndof()).filter(|unknown| held.constraints.row(*unknown).0.is_empty()).filter_map(column);
    let sprung = held.springs.all.iter().flat_map(|spring| &spring.at.0).filter_map(|(unknown, _)| column(*unknown));
    let places: Vec<[f64; 2]> =
        fixed.chain(sprung).collect::<BTreeSet<_>>().into_iter().map(|column| plate.columns[column]).collect();
    if 2 * places.len() > plate.columns.len() {
        return shorter;
    }
    let square = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
    let nearest = |p: [f64; 2]| places.iter().map(|q| square(p, *q)).fold(f64::INFINITY, f64::min);
    let farthest = plate.plane.points.iter().map(|p| nearest(*p)).filter(|far| far.is_finite()).fold(0.0, f64::max);
    if farthest > 0.0 { 2.0 * farthest.sqrt() } else { shorter }
}
