//! Supports as equations, and the rigid motions that they leave.

use crate::plates::constraint::{Constraints, Equation};
use crate::plates::error::PlateError;
use crate::plates::plate::Plate;
use crate::words::dof::Dof;
use nalgebra::{DMatrix, DVector, Matrix6, SymmetricEigen, Vector6};

/// Columns, and the levels at each of them.
pub type ColumnLevels = (Vec<u32>, Vec<usize>);

/// Levels of a plate that a support acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Levels {
    Bottom,
    MidPlane,
    Top,
    All,
}

impl Levels {
    /// The level numbers at a column.
    ///
    /// # Errors
    /// No level at the mid-plane.
    pub fn of(self, plate: &Plate, column: usize) -> Result<Vec<usize>, PlateError> {
        let [bottom, top] = plate.outer_levels(column);
        let middle = || plate.mid_level().filter(|level| (bottom..=top).contains(level));
        match self {
            Self::Bottom => Ok(vec![bottom]),
            Self::Top => Ok(vec![top]),
            Self::All => Ok((bottom..=top).collect()),
            Self::MidPlane => middle().map(|l| vec![l]).ok_or(PlateError::NoMidPlane),
        }
    }

    /// `columns` with the level numbers at them, those of equal levels together.
    ///
    /// # Errors
    /// No level at the mid-plane.
    pub fn at(self, plate: &Plate, columns: &[u32]) -> Result<Vec<ColumnLevels>, PlateError> {
        let mut all: Vec<ColumnLevels> = Vec::new();
        for column in columns {
            let levels = self.of(plate, *column as usize)?;
            match all.iter_mut().find(|(_, known)| *known == levels) {
                Some((columns, _)) => columns.push(*column),
                None => all.push((vec![*column], levels)),
            }
        }
        Ok(all)
    }
}

/// Axes turned by `angle` (radians) about z, as rows.
pub(super) fn axes_at(angle: f64) -> [[f64; 3]; 3] {
    let (s, c) = angle.sin_cos();
    // At quarter turns one of them is zero: what rounding leaves of it would hold unknowns that no one named.
    let [s, c] = [s, c].map(|x| if x.abs() < f64::EPSILON { 0.0 } else { x });
    [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
}

/// `dof` of a node in axes turned by `angle` (radians) about z, as a sum of its own unknowns; twice where layers have z-derivatives
/// of their own or laminates beside each other those along x and y, not at all where the element has none of them.
///
/// In turned axes U′ₙ₀ = Σ Rₙᵢ Uᵢ₀ and U′ₙₘ = Σ Rₙᵢ Rₘⱼ Uᵢⱼ.
pub fn turned(plate: &Plate, column: usize, level: usize, dof: Dof, angle: f64) -> Vec<Vec<(usize, f64)>> {
    if angle == 0.0 {
        return plate.dofs_at(column, level, dof).map(|i| vec![(i, 1.0)]).collect();
    }
    let r = axes_at(angle);
    let side = |side: usize| {
        let mut terms = Vec::new();
        for i in 0..3 {
            for j in if dof.m() == 0 { 0..1 } else { 1..4 } {
                let factor = r[dof.n() - 1][i] * if dof.m() == 0 { 1.0 } else { r[dof.m() - 1][j - 1] };
                let Some(name) = Dof::new(i as u8 + 1, j as u8).filter(|_| factor != 0.0) else { continue };
                let mut both = plate.dofs_at(column, level, name);
                let first = both.next();
                let chosen = if side == 1 { both.next().or(first) } else { first };
                terms.extend(chosen.map(|d| (d, factor)));
            }
        }
        terms
    };
    let mut sides = vec![side(0), side(1)];
    sides.dedup();
    sides.retain(|terms| !terms.is_empty());
    sides
}

/// `dofs` have one common value over the nodes (column, level), in axes turned by `angle` ([`turned`]).
pub fn couple(plate: &Plate, nodes: &[(u32, usize)], dofs: &[Dof], angle: f64, origin: &str) -> Vec<Equation> {
    let mut equations = Vec::new();
    for dof in dofs {
        let at = |(column, level): &(u32, usize)| turned(plate, *column as usize, *level, *dof, angle);
        let all: Vec<_> = nodes.iter().flat_map(at).collect();
        if let Some((first, rest)) = all.split_first() {
            equations.extend(rest.iter().map(|terms| Equation {
                terms: terms.iter().copied().chain(first.iter().map(|(i, factor)| (*i, -factor))).collect(),
                value: 0.0,
                origin: format!("{origin}: {dof}"),
                holds: false,
            }));
        }
    }
    equations
}

/// Rigid motions that `equations` leave free.
#[derive(Debug, Clone)]
pub struct FreeMotions {
    centre: [f64; 3],
    length: f64,
    /// Motions (translation x, y, z, rotation x, y, z), in reduced row echelon form.
    basis: Vec<Vector6<f64>>,
}

/// Singular values of the supports below this fraction of the largest count as zero.
pub(super) const RANK: f64 = 1e-7;

/// Work of loads on a motion, over the sum of what each does where it moves most, below which they are in balance: rounding
/// of their quadrature.
const BALANCED: f64 = 1e-6;

impl FreeMotions {
    /// Finds them.
    pub fn of(plate: &Plate, equations: &[Equation]) -> Self {
        let (low, high) = plate.plane.bounds();
        let centre = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.0];
        let length = 0.5 * (high[0] - low[0]).hypot(high[1] - low[1]);
        let mut free = Self { centre, length, basis: Vec::new() };
        // What moves no unknown is not a motion: a section knows nothing of y.
        let mut moves = Vector6::<f64>::zeros();
        for dof in 0..plate.ndof() {
            moves += Vector6::from(plate.rigid_motions(dof, centre, length)).abs();
        }
        let mut gram = Matrix6::from_diagonal(&moves.map(|m| f64::from(u8::from(m <= RANK))));
        for equation in equations {
            let row = free.row(plate, equation);
            gram += row * row.transpose();
        }
        free.basis = null_space(gram);
        free
    }

    /// True when the supports hold the plate.
    pub fn is_empty(&self) -> bool {
        self.basis.is_empty()
    }

    /// How the equation sees the six motions, scaled to at most about one.
    fn row(&self, plate: &Plate, equation: &Equation) -> Vector6<f64> {
        let (mut row, mut norm) = (Vector6::zeros(), 0.0);
        for (dof, factor) in &equation.terms {
            let unit = if plate.locate(*dof).2.m() == 0 { 1.0 } else { 1.0 / self.length };
            row += Vector6::from(plate.rigid_motions(*dof, self.centre, self.length)) * *factor;
            norm += (factor * unit).powi(2);
        }
        row / norm.sqrt().max(f64::MIN_POSITIVE)
    }

    /// These motions of the independent unknowns, `ndof × motions`, column-major.
    pub fn of_unknowns(&self, plate: &Plate, constraints: &Constraints) -> Vec<f64> {
        let moves = |i: usize| Vector6::from(plate.rigid_motions(constraints.original(i), self.centre, self.length));
        let each = self.basis.iter().flat_map(|motion| (0..constraints.ndof()).map(move |i| moves(i).dot(motion)));
        each.collect()
    }

    /// Names of those that do work under `forces`, one per unknown before elimination of constraints.
    pub fn pushed(&self, plate: &Plate, forces: &[f64]) -> Option<String> {
        let (mut works, mut size) = (vec![0.0; self.basis.len()], 0.0);
        for (dof, force) in forces.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            let moves = Vector6::from(plate.rigid_motions(dof, self.centre, self.length));
            works.iter_mut().zip(&self.basis).for_each(|(work, motion)| *work += force * moves.dot(motion));
            size += force.abs() * moves.amax();
        }
        let pushed = works.iter().zip(&self.basis).filter(|(work, _)| work.abs() > BALANCED * size);
        let basis: Vec<_> = pushed.map(|(_, motion)| *motion).collect();
        (!basis.is_empty()).then(|| Self { basis, ..*self }.names())
    }

    /// Whether one of them does all that `equations` ask, and they ask for something.
    pub fn follow(&self, plate: &Plate, equations: &[Equation]) -> bool {
        let asked = DVector::from_iterator(equations.len(), equations.iter().map(|equation| equation.value));
        if self.basis.is_empty() || asked.amax() == 0.0 {
            return false;
        }
        let moved = |equation: &Equation, motion: &Vector6<f64>| -> f64 {
            let moves = |dof: usize| Vector6::from(plate.rigid_motions(dof, self.centre, self.length)).dot(motion);
            equation.terms.iter().map(|(dof, factor)| factor * moves(*dof)).sum()
        };
        let of = DMatrix::from_fn(equations.len(), self.basis.len(), |i, k| moved(&equations[i], &self.basis[k]));
        let Ok(amounts) = of.clone().svd(true, true).solve(&asked, BALANCED) else { return false };
        (of * amounts - &asked).amax() <= BALANCED * asked.amax()
    }

    /// Their names: "translation along x, rotation about z".
    pub fn names(&self) -> String {
        const NAMES: [&str; 6] = [
            "translation along x",
            "translation along y",
            "translation along z",
            "rotation about x",
            "rotation about y",
            "rotation about z",
        ];
        let each: Vec<String> = self
            .basis
            .iter()
            .map(|motion| {
                let parts: Vec<String> = (0..6)
                    .filter(|i| motion[*i].abs() > 1e-6)
                    .map(|i| {
                        let share = motion[i];
                        if (share - 1.0).abs() < 1e-6 {
                            NAMES[i].to_owned()
                        } else {
                            format!("{share:.3} x {}", NAMES[i])
                        }
                    })
                    .collect();
                parts.join(" with ")
            })
            .collect();
        each.join(", ")
    }

    /// Statically determinate equations that stop these motions and nothing else: the translations and the antisymmetric
    /// part of the derivatives of the node nearest to the centre, or, where the element lacks those derivatives, the
    /// translations of the node farthest from it and of the one farthest from the line through both. Under loads that
    /// balance the stopped motions they carry no force.
    ///
    /// # Errors
    /// An element whose unknowns do not stop them at these three nodes.
    pub fn restrain(&self, plate: &Plate) -> Result<Vec<Equation>, PlateError> {
        let distance = |c: &usize| (0..2).map(|d| (plate.columns[*c][d] - self.centre[d]).powi(2)).sum::<f64>();
        let column = (0..plate.columns.len())
            .filter(|c| !plate.dofs_of_column(*c).is_empty())
            .min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
        let Some(column) = column else { return Ok(Vec::new()) };
        let farthest = |from: &dyn Fn(&usize) -> f64| {
            let columns = (0..plate.columns.len()).filter(|c| !plate.dofs_of_column(*c).is_empty());
            columns.max_by(|a, b| from(a).total_cmp(&from(b)).then(b.cmp(a)))
        };
        let far = farthest(&distance);
        let side = far.and_then(|far| {
            let from = |c: usize, d: usize| plate.columns[c][d] - plate.columns[column][d];
            farthest(&|c: &usize| (from(far, 0) * from(*c, 1) - from(far, 1) * from(*c, 0)).abs())
        });
        let unknown = |column: usize, n: u8, m: u8| {
            Dof::new(n, m).and_then(|d| plate.dofs_at(column, plate.reference_level(column), d).next())
        };
        let mut chosen: Vec<Equation> = Vec::new();
        let mut left = self.basis.clone();
        // At the centre u, v, w, then w,y − v,z and so on; at the far node and beside both u, v, w.
        let mut terms: Vec<Vec<(usize, f64)>> = Vec::new();
        terms.extend((1..=3).filter_map(|n| Some(vec![(unknown(column, n, 0)?, 1.0)])));
        for (n, m) in [(3, 2), (1, 3), (2, 1)] {
            let pair = unknown(column, n, m).zip(unknown(column, m, n));
            terms.extend(pair.map(|(a, b)| vec![(a, 1.0), (b, -1.0)]));
        }
        terms.extend(
            far.into_iter()
                .chain(side)
                .flat_map(|at| (1..=3).filter_map(move |n| Some(vec![(unknown(at, n, 0)?, 1.0)]))),
        );
        for terms in terms {
            let equation = Equation { terms, value: 0.0, origin: "restraint of rigid motions".into(), holds: true };
            let row = self.row(plate, &equation);
            // Keep the equation if some motion still free is seen by it; that motion is then spent.
            let seen = |b: &Vector6<f64>| b.dot(&row);
            let best = (0..left.len()).max_by(|a, b| seen(&left[*a]).abs().total_cmp(&seen(&left[*b]).abs()));
            let Some(best) = best.filter(|i| seen(&left[*i]).abs() > 1e-6) else { continue };
            let spent = left.swap_remove(best);
            for other in &mut left {
                *other -= spent * (seen(other) / seen(&spent));
            }
            chosen.push(equation);
        }
        if left.is_empty() { Ok(chosen) } else { Err(PlateError::Unrestrained { motions: self.names() }) }
    }
}

/// Null space of a Gram matrix, in reduced row echelon form so that plain motions come out plain.
fn null_space(gram: Matrix6<f64>) -> Vec<Vector6<f64>> {
    let eigen = SymmetricEigen::new(gram);
    let largest = eigen.eigenvalues.max();
    let threshold = RANK * RANK * largest.max(f64::MIN_POSITIVE);
    let mut basis: Vec<Vector6<f64>> = (0..6)
        .filter(|i| eigen.eigenvalues[*i] <= threshold)
        .map(|i| eigen.eigenvectors.column(i).into_owned())
        .collect();
    let mut done = 0;
    for axis in 0..6 {
        let best = (done..basis.len()).max_by(|a, b| basis[*a][axis].abs().total_cmp(&basis[*b][axis].abs()));
        let Some(best) = best.filter(|b| basis[*b][axis].abs() > 1e-6) else { continue };
        basis.swap(done, best);
        let pivot = basis[done] / basis[done][axis];
        basis[done] = pivot;
        for (i, row) in basis.iter_mut().enumerate() {
            if i != done {
                *row -= pivot * row[axis];
            }
        }
        done += 1;
    }
    basis
}
