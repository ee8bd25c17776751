//! Linear constraints, eliminated exactly.
//!
//! ```
//! use fem_core::constraint::{Constraints, Equation};
//!
//! // Of three unknowns the first is held, and the last is twice the second.
//! let tie = Equation { terms: vec![(2, 1.0), (1, -2.0)], value: 0.0, origin: "tie".into(), holds: false };
//! let constraints = Constraints::eliminate(&[0, 1, 2], &[Equation::fix(0, "support"), tie])?;
//! assert_eq!(constraints.ndof(), 1);
//! let mut u = [0.0; 3];
//! constraints.expand(&[5.0], &mut u);
//! assert!(u[0] == 0.0 && (u[2] - 2.0 * u[1]).abs() < 1e-12 && u[1] != 0.0);
//! # Ok::<(), fem_core::constraint::ConstraintError>(())
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// `Σ cᵢ uᵢ = value`. The first term is made dependent on the others where its factor allows.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// Unknown and factor.
    pub terms: Vec<(usize, f64)>,
    /// Right-hand side.
    pub value: f64,
    /// Where it comes from, for messages.
    pub origin: String,
    /// A support, which may well hold an unknown at zero; of ties between unknowns that is an error.
    pub holds: bool,
}

impl Equation {
    /// `u = 0`.
    pub fn fix(dof: usize, origin: impl Into<String>) -> Self {
        Self { terms: vec![(dof, 1.0)], value: 0.0, origin: origin.into(), holds: true }
    }
}

/// Why constraints cannot hold together.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ConstraintError {
    /// They demand two values of one thing.
    Conflict {
        /// The equation at which it showed.
        origin: String,
        /// Those that it meets.
        others: Vec<String>,
        /// By how much they disagree.
        difference: f64,
    },
    /// Equations run in a circle whose only solution is zero.
    Cycle {
        /// The equation that closed it.
        origin: String,
        /// The others on it.
        others: Vec<String>,
    },
    /// A factor or value is not finite, or an equation has no terms.
    Malformed {
        /// The equation.
        origin: String,
    },
}

impl ConstraintError {
    /// [`Equation::origin`] of the equation at which it showed.
    pub fn origin(&self) -> &str {
        match self {
            Self::Conflict { origin, .. } | Self::Cycle { origin, .. } | Self::Malformed { origin } => origin,
        }
    }
}

impl fmt::Display for ConstraintError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Conflict { origin, others, difference } => write!(
                f,
                "{origin} contradicts {}: they differ by {difference:.3e}; remove one of them",
                others.join(", ")
            ),
            Self::Cycle { origin, others } => write!(
                f,
                "{origin} and {} form a cycle that only zero satisfies; if that is meant, fix the unknown instead",
                others.join(", ")
            ),
            Self::Malformed { origin } => write!(f, "{origin}: an equation needs finite factors, not all zero"),
        }
    }
}
impl std::error::Error for ConstraintError {}

/// Factors below this fraction of what they are beside are rounding errors.
const NOTHING: f64 = 1e-12;

/// All unknowns in terms of the independent ones: u = C ũ + g.
///
/// Independent unknowns keep the order that [`Constraints::eliminate`] was given.
#[derive(Debug, Clone, PartialEq)]
pub struct Constraints {
    starts: Vec<usize>,
    terms: Vec<(usize, f64)>,
    offset: Vec<f64>,
    independent: Vec<usize>,
    /// Origins of equations that others already imply.
    pub redundant: Vec<String>,
}

struct Row {
    terms: BTreeMap<usize, f64>,
    value: f64,
    equation: usize,
    ties: bool,
}

impl Constraints {
    /// Solves `equations` by Gaussian elimination, pivoting on the largest factor (the first term on a tie).
    ///
    /// `order` lists all unknowns; the independent ones are numbered in it.
    ///
    /// # Errors
    /// Equations that contradict each other or run in a circle.
    pub fn eliminate(order: &[usize], equations: &[Equation]) -> Result<Self, ConstraintError> {
        let n = order.len();
        let mut row_of: Vec<u32> = vec![u32::MAX; n];
        let mut rows: Vec<Row> = Vec::new();
        let mut pivots = Vec::new();
        let mut redundant = Vec::new();
        for (number, equation) in equations.iter().enumerate() {
            let scale = equation.terms.iter().fold(0.0_f64, |m, t| m.max(t.1.abs()));
            let finite = equation.terms.iter().all(|t| t.1.is_finite() && t.0 < n) && equation.value.is_finite();
            if !(finite && scale > 0.0) {
                return Err(ConstraintError::Malformed { origin: equation.origin.clone() });
            }
            let mut row =
                Row { terms: BTreeMap::new(), value: equation.value, equation: number, ties: !equation.holds };
            for (dof, c) in &equation.terms {
                *row.terms.entry(*dof).or_insert(0.0) += c;
            }
            row.terms.retain(|_, c| c.abs() > NOTHING * scale);
            let (used, sizes) = substitute(&mut row, &rows, &row_of);
            // What is left of a sum is nothing beside its parts, not beside other terms: along a chain of ties factors may
            // differ by any power.
            row.terms.retain(|dof, c| c.abs() > NOTHING * sizes.get(dof).copied().unwrap_or(0.0));
            let origins = || -> Vec<String> {
                let named: BTreeSet<_> = used.iter().map(|r| &equations[rows[*r].equation].origin).collect();
                named.into_iter().cloned().collect()
            };
            if row.terms.is_empty() {
                // The scale of the values in play decides what is a rounding error.
                let size = used.iter().fold(equation.value.abs(), |m, r| m.max(rows[*r].value.abs()));
                if row.value.abs() > 1e-10 * size.max(f64::MIN_POSITIVE) {
                    return Err(ConstraintError::Conflict {
                        origin: equation.origin.clone(),
                        others: origins(),
                        difference: row.value.abs(),
                    });
                }
                redundant.push(equation.origin.clone());
                continue;
            }
            let closes_cycle = row.ties && row.terms.len() == 1 && row.value == 0.0 && !used.is_empty();
            if closes_cycle && used.iter().all(|r| rows[*r].ties) {
                return Err(ConstraintError::Cycle { origin: equation.origin.clone(), others: origins() });
            }
            let largest = row.terms.values().fold(0.0_f64, |m, c| m.max(c.abs()));
            let fits = |d: &usize| row.terms.get(d).is_some_and(|c| c.abs() >= largest * (1.0 - 1e-12));
            let first = equation.terms.iter().map(|t| t.0).find(|d| fits(d));
            let Some(pivot) = first.or_else(|| row.terms.keys().copied().find(|d| fits(d))) else {
                return Err(ConstraintError::Malformed { origin: equation.origin.clone() });
            };
            let factor = row.terms.remove(&pivot).unwrap_or(1.0);
            for c in row.terms.values_mut() {
                *c /= -factor;
            }
            row.value /= factor;
            row_of[pivot] = rows.len() as u32;
            pivots.push(pivot);
            rows.push(row);
        }
        Ok(Self { redundant, ..Self::resolve(order, rows, &row_of) })
    }

    /// All unknowns where some follow others as stated: `relations` are unknowns with the terms that each is the sum of.
    ///
    /// An unknown follows by the first relation that is stated of it; terms may follow others by relations before or after, but
    /// not in a circle. `order` as in [`Constraints::eliminate`].
    ///
    /// # Errors
    /// An unknown that follows itself.
    pub fn following<'a>(
        order: &[usize],
        relations: impl IntoIterator<Item = (usize, &'a [(usize, f64)])>,
    ) -> Result<Self, ConstraintError> {
        let (mut row_of, mut rows) = (vec![u32::MAX; order.len()], Vec::new());
        for (number, (dof, terms)) in relations.into_iter().enumerate() {
            let mut row = Row { terms: BTreeMap::new(), value: 0.0, equation: number, ties: true };
            terms.iter().for_each(|(other, c)| *row.terms.entry(*other).or_insert(0.0) += c);
            substitute(&mut row, &rows, &row_of);
            if row.terms.contains_key(&dof) {
                let origin = format!("unknown {}", dof + 1);
                return Err(ConstraintError::Cycle { origin, others: vec!["those that it follows".into()] });
            }
            if row_of[dof] == u32::MAX {
                row_of[dof] = rows.len() as u32;
                rows.push(row);
            }
        }
        Ok(Self::resolve(order, rows, &row_of))
    }

    /// Numbers the independent unknowns and has all others follow these alone.
    fn resolve(order: &[usize], mut rows: Vec<Row>, row_of: &[u32]) -> Self {
        let n = order.len();
        // A row holds only unknowns that were free when it was made; later rows may have bound some of them since.
        for r in (0..rows.len()).rev() {
            let mut row = Row {
                terms: std::mem::take(&mut rows[r].terms),
                value: 0.0,
                equation: rows[r].equation,
                ties: rows[r].ties,
            };
            substitute(&mut row, &rows, row_of);
            rows[r].terms = row.terms;
            rows[r].value -= row.value;
        }
        let mut position = vec![usize::MAX; n];
        let mut independent = Vec::with_capacity(n - rows.len());
        for &dof in order {
            if row_of[dof] == u32::MAX {
                position[dof] = independent.len();
                independent.push(dof);
            }
        }
        let mut starts = Vec::with_capacity(n + 1);
        let mut terms = Vec::with_capacity(n);
        let mut offset = vec![0.0; n];
        starts.push(0);
        for dof in 0..n {
            match rows.get(row_of[dof] as usize) {
                None => terms.push((position[dof], 1.0)),
                Some(row) => {
                    terms.extend(row.terms.iter().map(|(d, c)| (position[*d], *c)));
                    offset[dof] = row.value;
                }
            }
            starts.push(terms.len());
        }
        Self { starts, terms, offset, independent, redundant: Vec::new() }
    }

    /// Number of independent unknowns.
    pub fn ndof(&self) -> usize {
        self.independent.len()
    }

    /// Number of unknowns before elimination.
    pub fn all(&self) -> usize {
        self.offset.len()
    }

    /// Unknown (before elimination) that independent number `i` stands for.
    pub fn original(&self, i: usize) -> usize {
        self.independent[i]
    }

    /// `dof = Σ factor · independent + offset`.
    pub fn row(&self, dof: usize) -> (&[(usize, f64)], f64) {
        (&self.terms[self.starts[dof]..self.starts[dof + 1]], self.offset[dof])
    }

    /// Independent number of `dof`, if it is independent.
    pub fn position(&self, dof: usize) -> Option<usize> {
        match self.row(dof).0 {
            [(i, _)] if self.independent[*i] == dof => Some(*i),
            _ => None,
        }
    }

    /// A functional of all unknowns as one of the independent ones: Cᵀ w.
    pub fn restrict(&self, w: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let mut sum = BTreeMap::new();
        for (dof, factor) in w {
            for (i, c) in self.row(*dof).0 {
                *sum.entry(*i).or_insert(0.0) += factor * c;
            }
        }
        sum.into_iter().filter(|(_, w)| *w != 0.0).collect()
    }

    /// Whether the equations make Σ cᵢ uᵢ zero: what is left of each sum is nothing beside its parts, as
    /// [`Constraints::eliminate`] judges it.
    pub fn implies(&self, terms: &[(usize, f64)]) -> bool {
        let mut sums: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for (dof, factor) in terms {
            for (i, c) in self.row(*dof).0 {
                let [sum, size] = sums.entry(*i).or_default();
                *sum += factor * c;
                *size = size.max((factor * c).abs());
            }
        }
        sums.values().all(|[sum, size]| sum.abs() <= NOTHING * size)
    }

    /// All unknowns from the independent ones.
    pub fn expand(&self, independent: &[f64], all: &mut [f64]) {
        for (dof, u) in all.iter_mut().enumerate() {
            let (terms, offset) = self.row(dof);
            *u = offset + terms.iter().map(|(i, c)| c * independent[*i]).sum::<f64>();
        }
    }
}

/// Parts of a plate, as substructures are.
#[cfg(feature = "assembly")]
impl Constraints {
    /// No equations: all unknowns are independent, numbered in `order`.
    pub(crate) fn none(order: &[usize]) -> Self {
        let mut terms = vec![(0, 1.0); order.len()];
        order.iter().enumerate().for_each(|(i, dof)| terms[*dof].0 = i);
        let (starts, offset) = ((0..=order.len()).collect(), vec![0.0; order.len()]);
        Self { starts, terms, offset, independent: order.to_vec(), redundant: Vec::new() }
    }

    /// The same with the independent unknowns `kept` alone, numbered in their order; the others count as zero.
    pub(crate) fn only(&self, kept: &[usize]) -> Self {
        let mut number = vec![None; self.ndof()];
        kept.iter().enumerate().for_each(|(new, i)| number[*i] = Some(new));
        let term = |(i, c): &(usize, f64)| Some((number[*i]?, *c));
        let all: Vec<usize> = (0..self.offset.len()).collect();
        let independent = kept.iter().map(|i| self.independent[*i]).collect();
        Self { independent, ..self.select(&all, term) }
    }

    /// The same for some of the unknowns, which are called by their place in `unknowns`.
    pub(crate) fn of(&self, unknowns: &[usize]) -> Self {
        let mut place = vec![usize::MAX; self.offset.len()];
        unknowns.iter().enumerate().for_each(|(at, dof)| place[*dof] = at);
        let independent = self.independent.iter().map(|dof| place[*dof]).collect();
        Self { independent, ..self.select(unknowns, |term| Some(*term)) }
    }

    fn select(&self, unknowns: &[usize], term: impl Fn(&(usize, f64)) -> Option<(usize, f64)>) -> Self {
        let (mut starts, mut terms) = (vec![0], Vec::new());
        for dof in unknowns {
            terms.extend(self.row(*dof).0.iter().filter_map(&term));
            starts.push(terms.len());
        }
        let offset = unknowns.iter().map(|dof| self.offset[*dof]).collect();
        Self { starts, terms, offset, independent: Vec::new(), redundant: Vec::new() }
    }
}

/// Replaces bound unknowns of `row` until none is left; returns the rows used, and of each unknown the largest factor that
/// went into its sum.
fn substitute(row: &mut Row, rows: &[Row], row_of: &[u32]) -> (BTreeSet<usize>, BTreeMap<usize, f64>) {
    let mut used = BTreeSet::new();
    let mut sizes: BTreeMap<usize, f64> = row.terms.iter().map(|(dof, c)| (*dof, c.abs())).collect();
    let mut open: Vec<usize> = row.terms.keys().copied().collect();
    while let Some(dof) = open.pop() {
        let Some(other) = rows.get(row_of[dof] as usize) else { continue };
        let Some(factor) = row.terms.remove(&dof) else { continue };
        used.insert(row_of[dof] as usize);
        row.value -= factor * other.value;
        for (d, c) in &other.terms {
            *row.terms.entry(*d).or_insert(0.0) += factor * c;
            let size = sizes.entry(*d).or_insert(0.0);
            *size = size.max((factor * c).abs());
            open.push(*d);
        }
    }
    (used, sizes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn equation(terms: &[(usize, f64)], value: f64) -> Equation {
        Equation { terms: terms.to_vec(), value, origin: format!("{terms:?}"), holds: false }
    }

    fn solve(n: usize, equations: &[Equation]) -> Result<Constraints, ConstraintError> {
        Constraints::eliminate(&(0..n).collect::<Vec<_>>(), equations)
    }

    #[test]
    fn what_is_stated_to_follow_follows() {
        // 0 = 1, then 1 = 2·2 + 0.5·3, and 4 is fixed: of 4 = 0 after that nothing is heard.
        let relations: [(usize, &[(usize, f64)]); 4] =
            [(0, &[(1, 1.0)]), (1, &[(2, 2.0), (3, 0.5)]), (4, &[]), (4, &[(2, 1.0)])];
        let c = Constraints::following(&[3, 2, 1, 0, 4], relations).unwrap();
        assert_eq!((c.ndof(), c.original(0), c.original(1)), (2, 3, 2));
        let mut u = [0.0; 5];
        c.expand(&[4.0, 10.0], &mut u);
        assert_eq!(u, [22.0, 22.0, 10.0, 4.0, 0.0]);
        let circle: [(usize, &[(usize, f64)]); 2] = [(0, &[(1, 1.0)]), (1, &[(0, 1.0)])];
        assert!(Constraints::following(&[0, 1], circle).is_err());
    }

    #[test]
    fn chains_of_a_hundred_resolve_and_hold() {
        let mut equations: Vec<_> = (0..100).map(|i| equation(&[(i, 1.0), (i + 1, -0.9), (150, 0.1)], 0.01)).collect();
        equations.push(Equation::fix(100, "end"));
        equations.reverse();
        equations.swap(3, 70);
        let c = solve(160, &equations).unwrap();
        assert_eq!(c.ndof(), 160 - 101);
        let free: Vec<f64> = (0..c.ndof()).map(|i| (i as f64).sin()).collect();
        let mut u = vec![0.0; 160];
        c.expand(&free, &mut u);
        for e in &equations {
            let sum: f64 = e.terms.iter().map(|(d, f)| f * u[*d]).sum();
            assert!((sum - e.value).abs() < 1e-13, "{}: {sum}", e.origin);
        }
    }

    #[test]
    fn factors_of_a_chain_multiply_in_any_order() {
        let (n, ratio) = (100, 2.0_f64);
        let forward: Vec<_> = (0..n).map(|i| equation(&[(i + 1, 1.0), (i, -ratio)], 0.0)).collect();
        let backward = forward.iter().rev().cloned().collect();
        for equations in [forward, backward] {
            let c = solve(n + 1, &equations).unwrap();
            let mut u = vec![0.0; n + 1];
            c.expand(&[1.0], &mut u);
            assert!((u[0] / u[n] * ratio.powi(n as i32) - 1.0).abs() < 1e-12, "{u:?}");
        }
    }

    #[test]
    fn redundant_is_dropped_conflict_and_cycle_are_errors() {
        let tie = |a, b| equation(&[(a, 1.0), (b, -1.0)], 0.0);
        let c = solve(3, &[tie(0, 1), tie(1, 2), tie(2, 0)]).unwrap();
        assert_eq!((c.ndof(), c.redundant.len()), (1, 1));
        let conflict = solve(2, &[equation(&[(0, 1.0)], 0.0), equation(&[(0, 1.0)], 1e-3)]).unwrap_err();
        assert!(matches!(conflict, ConstraintError::Conflict { .. }), "{conflict}");
        let cycle = solve(2, &[tie(0, 1), equation(&[(0, 1.0), (1, -2.0)], 0.0)]).unwrap_err();
        assert!(matches!(cycle, ConstraintError::Cycle { .. }), "{cycle}");
        // Two fixed neighbours and a tie between them is merely redundant.
        let fine = solve(2, &[Equation::fix(0, "a"), Equation::fix(1, "b"), tie(0, 1)]).unwrap();
        assert_eq!(fine.ndof(), 0);
        let one = solve(2, &[Equation::fix(0, "a"), tie(0, 1)]).unwrap();
        assert_eq!(one.ndof(), 0);
        assert!(solve(2, &[equation(&[(0, f64::NAN)], 0.0)]).is_err());
        assert!(solve(2, &[equation(&[], 0.0)]).is_err());
    }

    #[cfg(feature = "assembly")]
    #[test]
    fn part_of_the_unknowns_and_of_the_independent_ones() {
        let c = Constraints::eliminate(&[3, 2, 1, 0, 4], &[equation(&[(1, 4.0), (2, -2.0), (4, -1.0)], 0.0)]).unwrap();
        assert_eq!((c.row(1).0, c.original(1)), (&[(1, 0.5), (3, 0.25)][..], 2));
        let only = c.only(&[3, 0]);
        assert_eq!((only.ndof(), only.row(1).0, only.row(2).0), (2, &[(0, 0.25)][..], &[][..]));
        assert_eq!((only.position(4), only.position(3), only.position(2)), (Some(0), Some(1), None));
        let part = c.of(&[4, 1]);
        assert_eq!((part.row(1), part.position(0)), ((&[(1, 0.5), (3, 0.25)][..], 0.0), Some(3)));
        assert_eq!(Constraints::none(&[2, 0, 1]), Constraints::eliminate(&[2, 0, 1], &[]).unwrap());
    }
}
