//! Coarse models: displacements that a few unknowns describe well enough to start from.

use crate::constraint::Constraints;
use crate::plate::Plate;
use crate::structure::Structure;

/// A structure on fewer unknowns, u = P y: PᵀKP and PᵀMP.
#[derive(Debug)]
pub struct Coarse {
    /// The coarse structure.
    pub structure: Box<dyn Structure>,
    /// P.
    pub prolongation: Prolongation,
}

/// P of u = P y, by rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Prolongation {
    starts: Vec<usize>,
    terms: Vec<(usize, f64)>,
    /// First coarse unknown of each node column, and their number at the end.
    blocks: Vec<usize>,
}

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

    /// Number of coarse unknowns.
    pub fn columns(&self) -> usize {
        self.blocks[self.blocks.len() - 1]
    }

    /// First coarse unknowns of the node columns, and the number of all at the end.
    pub fn blocks(&self) -> &[usize] {
        &self.blocks
    }

    /// Coarse unknowns in fine unknown `i`, with their factors.
    pub fn row(&self, i: usize) -> &[(usize, f64)] {
        &self.terms[self.starts[i]..self.starts[i + 1]]
    }

    /// U = P Y, column by column.
    pub fn expand(&self, y: &[f64]) -> Vec<f64> {
        let (n, m) = (self.starts.len() - 1, self.columns().max(1));
        let mut all = vec![0.0; n * (y.len() / m)];
        for (y, u) in y.chunks_exact(m).zip(all.chunks_exact_mut(n.max(1))) {
            for (u, row) in u.iter_mut().zip(self.starts.windows(2)) {
                for (j, p) in &self.terms[row[0]..row[1]] {
                    *u += p * y[*j];
                }
            }
        }
        all
    }

    /// Y = Pᵀ U, column by column.
    pub fn restrict(&self, u: &[f64]) -> Vec<f64> {
        let n = self.starts.len() - 1;
        let mut all = Vec::new();
        for u in u.chunks_exact(n.max(1)) {
            let mut y = vec![0.0; self.columns()];
            for (i, u) in u.iter().enumerate() {
                self.row(i).iter().for_each(|(j, p)| y[*j] += p * u);
            }
            all.append(&mut y);
        }
        all
    }
}
