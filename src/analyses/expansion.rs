//! The way back from what is marched or solved for to the displacements of the plate.

use crate::model::Model;
use fem_core::assembly::Condensation;
use fem_core::recovery::Tension;
use fem_core::structure::Structure;
use fem_dynamics::reduce::{Companions, Reduced, Share, TensionPatterns};
use std::sync::Arc;

/// From the coordinates of a march to the unknowns of the plate, before elimination of constraints.
#[derive(Debug)]
pub(super) struct Expansion<'a> {
    pub(super) model: &'a Model,
    /// The coordinates of a reduced plate; those of the structure where there is none.
    pub(super) reduced: Option<Arc<Reduced>>,
    /// What large deflections add to the modes.
    pub(super) companions: Option<Companions>,
    /// What the stretching of a full plate adds to its displacements.
    pub(super) share: Option<Arc<Share>>,
    /// Where the unknowns of the structure are masters alone.
    pub(super) condensation: Option<Arc<Condensation>>,
}

/// What stresses follow from: displacements whose strains are small, and the amounts of tensions, in the unknowns of the plate before
/// elimination of constraints.
#[derive(Debug, Clone)]
pub(crate) struct Stressed {
    pub(crate) u: Vec<f64>,
    tensions: Option<Tensions>,
    /// Field by field.
    amounts: Vec<f64>,
}

/// Tensions, and the deflections that they are made of in the unknowns of the plate.
#[derive(Debug, Clone)]
struct Tensions {
    of: Arc<TensionPatterns>,
    deflections: Vec<f64>,
}

impl Stressed {
    /// Of displacements `u` without tensions.
    pub(crate) fn of(u: Vec<f64>) -> Self {
        Self { u, tensions: None, amounts: Vec::new() }
    }

    /// The tensions of `count` fields from the `first` on.
    pub(crate) fn tension(&self, first: usize, count: usize) -> Option<Tension<'_>> {
        let Tensions { of, deflections } = self.tensions.as_ref()?;
        let terms = of.follow().terms();
        let amounts = &self.amounts[first * terms..(first + count) * terms];
        Some(Tension { deflections, combinations: of.combinations(), amounts })
    }

    /// These and `other` fields of the same plate.
    pub(crate) fn extend(&mut self, other: &Self) {
        self.u.extend_from_slice(&other.u);
        self.amounts.extend_from_slice(&other.amounts);
    }
}

impl Expansion<'_> {
    /// The vectors of a reduction over the unknowns of the structure, and how many they are.
    pub(super) fn basis(&self) -> Option<(&[f64], usize)> {
        self.reduced.as_ref().map(|reduced| (reduced.basis.as_slice(), reduced.modal.ndof()))
    }

    /// `count` fields in the unknowns of the plate, of as many in coordinates of the march.
    pub(super) fn displacements(&self, coordinates: &[f64], count: usize) -> Vec<f64> {
        let Some(reduced) = &self.reduced else {
            let Some(share) = &self.share else { return self.nodal(coordinates) };
            let mut u = coordinates.to_vec();
            u.chunks_exact_mut(coordinates.len() / count).for_each(|u| share.complete(u));
            return self.nodal(&u);
        };
        let width = coordinates.len() / count;
        let n = reduced.basis.len() / width;
        let mut u = vec![0.0; n * count];
        reduced.expand(coordinates, &mut u);
        if let Some(companions) = &self.companions {
            companions.complete(width, coordinates, &mut u);
        }
        self.nodal(&u)
    }

    /// What the membrane stresses are made of, where few patterns of them hold all that the march knows of stretching.
    pub(super) fn tensions(&self) -> Option<&Arc<TensionPatterns>> {
        self.companions.as_ref().map(Companions::patterns).or(self.share.as_deref().map(Share::patterns))
    }

    /// What the stresses of `count` fields follow from, of as many in coordinates of the march.
    pub(super) fn stressed(&self, coordinates: &[f64], count: usize) -> Stressed {
        let Some(tensions) = self.tensions() else {
            return Stressed { u: self.displacements(coordinates, count), tensions: None, amounts: Vec::new() };
        };
        let (follow, width) = (tensions.follow(), coordinates.len() / count.max(1));
        let (mut u, mut amounts) = (Vec::new(), Vec::new());
        for q in coordinates.chunks_exact(width.max(1)) {
            let (mut field, share) = match (&self.reduced, &self.share) {
                (Some(reduced), _) => {
                    let mut field = vec![0.0; reduced.basis.len() / width];
                    reduced.expand(q, &mut field);
                    (field, q.to_vec())
                }
                (None, Some(share)) => (q.to_vec(), share.coordinates(q)),
                (None, None) => (q.to_vec(), Vec::new()),
            };
            follow.complete(share.len(), &share, &mut field);
            amounts.extend(follow.amounts(&share));
            u.extend(field);
        }
        let tensions = Tensions { deflections: self.nodal(tensions.deflections()), of: Arc::clone(tensions) };
        Stressed { u: self.nodal(&u), tensions: Some(tensions), amounts }
    }

    /// Velocities in the unknowns of the plate, of coordinates and their rates.
    pub(super) fn velocities(&self, coordinates: &[f64], rates: &[f64]) -> Vec<f64> {
        // With u(q) linear or quadratic, ∂u/∂q q̇ = ½ (u(q + q̇) − u(q − q̇)).
        let moved = |sign: f64| coordinates.iter().zip(rates).map(move |(q, rate)| q + sign * rate);
        let both: Vec<f64> = moved(1.0).chain(moved(-1.0)).collect();
        let both = self.displacements(&both, 2);
        let (ahead, behind) = both.split_at(both.len() / 2);
        ahead.iter().zip(behind).map(|(a, b)| 0.5 * (a - b)).collect()
    }

    /// Fields in the unknowns of the plate, of as many in those of the structure.
    pub(super) fn nodal(&self, fields: &[f64]) -> Vec<f64> {
        let Model { plate, constraints, .. } = self.model;
        let expanded = self.condensation.as_ref().map(|condensation| condensation.expand(fields));
        let fields = expanded.as_deref().unwrap_or(fields);
        let mut u = vec![0.0; plate.ndof() * fields.len() / constraints.ndof()];
        for (field, u) in fields.chunks_exact(constraints.ndof()).zip(u.chunks_exact_mut(plate.ndof())) {
            constraints.expand(field, u);
        }
        u
    }
}
