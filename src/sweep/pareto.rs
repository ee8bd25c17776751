//! Cases that no other one beats in two quantities.

use super::Sweep;
use super::quantity::{CaseQuantity, Known};
use super::runner::CaseRow;
use crate::error::Error;

/// What cases are to have as much or as little of as can be.
#[derive(Debug, Clone)]
pub struct Objective {
    /// Of what.
    pub quantity: CaseQuantity,
    /// Whether the most is the best.
    pub most: bool,
}

/// The two that are weighed against each other.
pub type Objectives = [Objective; 2];

/// Reads `least FORMULA, most FORMULA`.
///
/// # Errors
/// Not two of them, or no formulas.
pub(super) fn parse(text: &str, known: &Known) -> Result<Objectives, Error> {
    let objective = |text: &str| {
        let (word, formula) = text.trim().split_once(' ')?;
        let most = [("least", false), ("most", true)].into_iter().find(|(name, _)| *name == word)?.1;
        Some(known.quantity(formula).map(|quantity| Objective { quantity, most }))
    };
    let parts: Option<Vec<_>> = text.split(',').map(objective).collect();
    let refuse = || Error::Sweep {
        message: format!("`{text}` does not say two quantities with which of their ends is good"),
        help: "write it as in `least deflection, most damage_force`".into(),
    };
    <[_; 2]>::try_from(parts.ok_or_else(refuse)?).map_err(|_| refuse()).and_then(|[a, b]| Ok([a?, b?]))
}

impl Sweep<'_> {
    /// Of each row, where its case has both objectives, their values and whether it is on the front: no other case is better in one
    /// and at least as good in the other.
    pub(super) fn front(&self, rows: &[CaseRow]) -> Vec<Option<([f64; 2], bool)>> {
        let Some(objectives) = &self.objectives else { return vec![None; rows.len()] };
        let of_row = |row: &CaseRow| {
            let (values, found) = (self.design.case(row.case - 1), row.result.as_ref().ok()?);
            let [a, b] = objectives.each_ref().map(|of| of.quantity.value(&values, found));
            Some([a?, b?])
        };
        let points: Vec<Option<[f64; 2]>> = rows.iter().map(of_row).collect();
        let signs = objectives.each_ref().map(|of| if of.most { -1.0 } else { 1.0 });
        let costs: Vec<Option<[f64; 2]>> =
            points.iter().map(|point| point.map(|point| [0, 1].map(|k| signs[k] * point[k]))).collect();
        points.into_iter().zip(unbeaten(&costs)).map(|(point, best)| Some((point?, best))).collect()
    }
}

/// Which of the points that there are no other one undercuts in one number without exceeding it in the other.
fn unbeaten(points: &[Option<[f64; 2]>]) -> Vec<bool> {
    let mut order: Vec<(usize, [f64; 2])> = (0..).zip(points).filter_map(|(k, point)| Some((k, (*point)?))).collect();
    order.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut best = vec![false; points.len()];
    let mut least = f64::INFINITY;
    for equal in order.chunk_by(|(_, a), (_, b)| a[0] == b[0]) {
        // Zeros of both signs are equal, though one is sorted before the other.
        let lowest = equal.iter().map(|(_, point)| point[1]).fold(f64::INFINITY, f64::min);
        if lowest < least {
            equal.iter().filter(|(_, point)| point[1] == lowest).for_each(|(k, _)| best[*k] = true);
            least = lowest;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the definition, on points of which many are equal in one number or both.
    #[test]
    fn a_front_is_what_no_other_beats() {
        let mut points: Vec<Option<[f64; 2]>> =
            (0..200_u32).map(|k| (k % 17 != 3).then(|| [f64::from(k * 37 % 11), f64::from(k * k % 13)])).collect();
        points.extend([Some([-0.0, 1.0]), Some([0.0, -1.0])]);
        let beats = |a: [f64; 2], b: [f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
        let found = unbeaten(&points);
        for (point, found) in points.iter().zip(found) {
            let want = point.is_some_and(|point| !points.iter().flatten().any(|other| beats(*other, point)));
            assert_eq!(found, want, "{point:?}");
        }
    }
}
