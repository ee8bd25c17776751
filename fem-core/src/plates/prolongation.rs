//! Displacements of a plate that a few unknowns describe well enough to start from.

use super::constraint::Constraints;
use super::plate::Plate;
use crate::words::prolongation::Prolongation;

/// Fields of a node column: three components, with the value and its derivatives along x and y, constant or linear in z.
const FIELDS: usize = 18;

impl Prolongation {
    /// Displacements of `plate` that are linear in z: u = a + z b with a of three components and b along the plane, each
    /// with the derivatives along x and y that the element has. What a fixed unknown takes part in is left out.
    ///
    /// Unknowns are numbered in the order of the independent ones.
    pub fn linear_in_z(plate: &Plate, constraints: &Constraints) -> Self {
        let terms = |dof: usize| {
            let (column, level, name) = plate.locate(dof);
            let (n, m, z) = (name.n(), name.m(), plate.levels[level]);
            let field = move |m: usize, power: usize| FIELDS * column + 6 * (n - 1) + 2 * m + power;
            let constant = (m < 3).then(|| (field(m, 0), 1.0));
            let linear = if m < 3 { (field(m, 1), z) } else { (field(0, 1), 1.0) };
            constant.into_iter().chain((n < 3 && linear.1 != 0.0).then_some(linear))
        };
        let mut free = vec![true; FIELDS * plate.columns.len()];
        for dof in (0..plate.ndof()).filter(|dof| constraints.row(*dof).0.is_empty()) {
            terms(dof).for_each(|(field, _)| free[field] = false);
        }
        let mut number = vec![usize::MAX; free.len()];
        let mut p = Self { starts: vec![0], terms: Vec::new(), blocks: vec![0] };
        let (mut count, mut last) = (0, None);
        for i in 0..constraints.ndof() {
            let column = plate.locate(constraints.original(i)).0;
            if last.is_some_and(|last| last != column) && p.blocks.last() != Some(&count) {
                p.blocks.push(count);
            }
            last = Some(column);
            for (field, factor) in terms(constraints.original(i)).filter(|(field, _)| free[*field]) {
                if number[field] == usize::MAX {
                    number[field] = count;
                    count += 1;
                }
                p.terms.push((number[field], factor));
            }
            p.starts.push(p.terms.len());
        }
        p.blocks.push(count);
        p
    }
}
