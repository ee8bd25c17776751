//! Means that laws want over their plies in a cell.

use super::{CellAnswer, LawfulPly, MOST_LEVELS, Through, lagrange};
use crate::contracts::element::Slice;
use crate::words::tensor::{Ply, Strain6};
use std::ops::Range;

/// Both faces of plies that break as one.
#[derive(Debug, Clone)]
pub(super) struct Faces {
    /// Their slices.
    pub(super) group: Range<usize>,
    /// What each level has in a polynomial at the bottom and at the top.
    pub(super) shares: [[f64; MOST_LEVELS]; 2],
    /// First state of the Gauss points next to them, among those of an in-plane point.
    near: [usize; 2],
}

/// The faces at which laws want means.
pub(super) fn faces(levels: &[(f64, f64)], slices: &[Slice], plies: &[Option<LawfulPly>]) -> Vec<Faces> {
    let (mut found, mut states) = (Vec::new(), 0);
    for (slice, ply) in plies.iter().enumerate() {
        let Some(LawfulPly { law, group, .. }) = ply else { continue };
        let count = law.info().state.len();
        let next = states + count * levels.len();
        if law.faces() && slice == group.start {
            let shares = [slices[slice].q[0], slices[group.end - 1].q[1]].map(|q| lagrange(levels, q));
            // Plies that are alike have one law.
            let near = [states, states + count * (levels.len() * group.len() - 1)];
            found.push(Faces { group: group.clone(), shares, near });
        }
        states = next;
    }
    found
}

/// How many means the law of a ply is given.
pub(super) fn wanted(ply: &LawfulPly) -> usize {
    ply.law.means() * if ply.law.faces() { 2 } else { 1 }
}

impl CellAnswer {
    /// Forms the means that laws want over their plies; `states` are those of the cell.
    pub(super) fn share(&mut self, plies: &[Option<LawfulPly>], weights: &[f64], length: f64, states: &[f64]) {
        let mut shared = std::mem::take(&mut self.shared);
        shared.clear();
        let most = plies.iter().flatten().map(wanted).max().unwrap_or(0);
        if most > 0 {
            let row = most + 1;
            // Behind those of the plies: of the tops of plies that break as one, and of a point.
            shared.resize(row * (plies.len() + self.faces.len() + 1), 0.0);
            let (means, rest) = shared.split_at_mut(row * plies.len());
            let (tops, here) = rest.split_at_mut(row * self.faces.len());
            let mut add = |ply: &LawfulPly, strain: &Strain6<Ply>, old: &[f64], weight: f64, sums: &mut [f64]| {
                let here = &mut here[..ply.law.means()];
                here.fill(0.0);
                ply.law.quantities(&ply.point(length), strain, old, here);
                sums.iter_mut().zip(here).for_each(|(sum, q)| *sum += weight * *q);
            };
            let (mut strains, mut on_faces) = (self.own.iter(), self.on_faces.iter());
            let each = states.len() / weights.len();
            for (dv, number) in weights.iter().zip(0..) {
                let mut at = each * number;
                for Through { slice, weight, .. } in &self.through {
                    let (Some(ply), Some(strain)) = (&plies[*slice], strains.next()) else { continue };
                    let old = &states[at..at + ply.law.info().state.len()];
                    at += old.len();
                    let sums = &mut means[slice * row..][..row];
                    sums[most] += dv * weight;
                    add(ply, strain, old, dv * weight, sums);
                }
                for (Faces { group, near, .. }, top) in self.faces.iter().zip(tops.chunks_exact_mut(row)) {
                    let Some(ply) = &plies[group.start] else { continue };
                    let (count, own) = (ply.law.info().state.len(), ply.law.means());
                    for (near, sums) in
                        near.iter().zip([&mut means[group.start * row..][own..most], &mut top[own..most]])
                    {
                        let Some(strain) = on_faces.next() else { continue };
                        add(ply, strain, &states[each * number + near..][..count], *dv, sums);
                    }
                }
            }
            let area: f64 = weights.iter().sum();
            for (Faces { group, .. }, top) in self.faces.iter().zip(tops.chunks_exact(row)) {
                let (first, others) = means[group.start * row..group.end * row].split_at_mut(row);
                let own = plies[group.start].as_ref().map_or(0, |ply| ply.law.means());
                for (bottom, top) in first[own..most].iter_mut().zip(&top[own..most]) {
                    *bottom = bottom.max(*top) / area;
                }
                for other in others.chunks_exact(row) {
                    (0..own).chain([most]).for_each(|k| first[k] += other[k]);
                }
                others.chunks_exact_mut(row).for_each(|other| other.copy_from_slice(first));
            }
            for (all, ply) in means.chunks_exact_mut(row).zip(plies) {
                let (own, volume) = (ply.as_ref().map_or(0, |ply| ply.law.means()), all[most]);
                all[..own].iter_mut().for_each(|sum| *sum /= volume);
            }
            shared.truncate(row * plies.len());
        }
        self.shared = shared;
    }
}
