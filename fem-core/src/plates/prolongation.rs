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
    /// The unknowns of a column are numbered together, columns in the order of `columns`, which names all of them.
    pub fn linear_in_z(plate: &Plate, constraints: &Constraints, columns: &[u32]) -> Self {
        let terms = |dof: usize| {
            let (column, level, name) = plate.locate(dof);
            let (n, m, z) = (name.n(), name.m(), plate.levels[level]);
            let field = move |m: usize, power: usize| FIELDS * column + 6 * (n - 1) + 2 * m + power;
            let constant = (m < 3).then(|| (field(m, 0), 1.0));
            let linear = if m < 3 { (field(m, 1), z) } else { (field(0, 1), 1.0) };
            constant.into_iter().chain((n < 3 && linear.1 != 0.0).then_some(linear))
        };
        let of_independent = |i: usize| terms(constraints.original(i));
        let mut taken = vec![false; FIELDS * plate.columns.len()];
        (0..constraints.ndof()).flat_map(of_independent).for_each(|(field, _)| taken[field] = true);
        for dof in (0..plate.ndof()).filter(|dof| constraints.row(*dof).0.is_empty()) {
            terms(dof).for_each(|(field, _)| taken[field] = false);
        }
        let mut p = Self { starts: vec![0], terms: Vec::new(), blocks: vec![0] };
        let (mut count, mut number) = (0, vec![0; taken.len()]);
        for column in columns.iter().map(|column| *column as usize) {
            let first = count;
            for field in (FIELDS * column..FIELDS * (column + 1)).filter(|field| taken[*field]) {
                number[field] = count;
                count += 1;
            }
            if count > first {
                p.blocks.push(count);
            }
        }
        for i in 0..constraints.ndof() {
            let own = of_independent(i).filter(|(field, _)| taken[*field]);
            p.terms.extend(own.map(|(field, factor)| (number[field], factor)));
            p.starts.push(p.terms.len());
        }
        p
    }
}
