//! Linear functionals of displacements.

use std::collections::{BTreeMap, BTreeSet};

/// A linear functional of the displacements, `d = Σ wᵢ uᵢ`: one dof, or the weighted mean over a contact patch.
///
/// ```
/// use fem_core::functional::Functional;
///
/// // The deflection under a patch that covers two unknowns, and the load of 10 N on that patch: their work agrees.
/// let patch = Functional(vec![(1, 0.25), (2, 0.75)]);
/// let (u, mut load) = ([0.0, 4e-3, 8e-3], [0.0; 3]);
/// patch.add_to(10.0, &mut load);
/// let work: f64 = load.iter().zip(&u).map(|(f, u)| f * u).sum();
/// assert!((patch.of(&u) - 7e-3).abs() < 1e-15 && (work - 10.0 * patch.of(&u)).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Functional(pub Vec<(usize, f64)>);

impl Functional {
    /// A single dof.
    pub fn dof(i: usize) -> Self {
        Self(vec![(i, 1.0)])
    }

    /// The functional's value at `u`.
    pub fn of(&self, u: &[f64]) -> f64 {
        self.0.iter().map(|&(i, w)| w * u[i]).sum()
    }

    /// `y ← y + scale · w`.
    pub fn add_to(&self, scale: f64, y: &mut [f64]) {
        for &(i, w) in &self.0 {
            y[i] += scale * w;
        }
    }
}

/// Share of a functional's size below which what is left of it without others is rounding.
const DEPENDENT: f64 = 1e-9;

/// Functionals that span what `all` span and have no unknown in common or are orthogonal, Σ wᵢ w′ᵢ = 0: each without its parts
/// along those before it, and none where nothing is left. Meant for many functionals of few unknowns each.
pub fn orthogonalise(all: Vec<Functional>) -> Vec<Functional> {
    let mut kept: Vec<Functional> = Vec::new();
    let mut of_unknown: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for functional in all {
        let mut left: BTreeMap<usize, f64> = BTreeMap::new();
        functional.0.iter().for_each(|(i, w)| *left.entry(*i).or_default() += w);
        let square = |left: &BTreeMap<usize, f64>| left.values().map(|w| w * w).sum::<f64>();
        let whole = square(&left);
        let shared: BTreeSet<usize> = left.keys().filter_map(|i| of_unknown.get(i)).flatten().copied().collect();
        for other in shared.iter().map(|k| &kept[*k].0) {
            let along: f64 = other.iter().map(|(i, w)| w * left.get(i).unwrap_or(&0.0)).sum();
            let share = along / other.iter().map(|(_, w)| w * w).sum::<f64>();
            other.iter().for_each(|(i, w)| *left.entry(*i).or_default() -= share * w);
        }
        if square(&left) > DEPENDENT * DEPENDENT * whole {
            left.keys().for_each(|i| of_unknown.entry(*i).or_default().push(kept.len()));
            kept.push(Functional(left.into_iter().collect()));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_orthogonal_spans_the_same() {
        let all =
            [vec![(0, 1.0), (1, 1.0)], vec![(1, 2.0), (2, 1.0)], vec![(0, 1.0), (1, 3.0), (2, 1.0)], vec![(4, 1.0)]];
        let found = orthogonalise(all.clone().map(Functional).to_vec());
        assert_eq!(found.len(), 3, "{found:?}");
        let dense =
            |f: &Functional| (0..5).map(|i| f.0.iter().filter(|t| t.0 == i).map(|t| t.1).sum()).collect::<Vec<f64>>();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let basis: Vec<_> = found.iter().map(dense).collect();
        assert!(dot(&basis[0], &basis[1]).abs() < 1e-15);
        for one in all.map(Functional).iter().map(dense) {
            let inside: f64 = basis.iter().map(|b| dot(&one, b).powi(2) / dot(b, b)).sum();
            assert!((inside / dot(&one, &one) - 1.0).abs() < 1e-14);
        }
    }
}
