//! What has delaminated, and when.

use crate::model::{Model, Separation};
use fem_core::assembly::{LawPlate, SeparableParts};
use fem_core::interface_law::Sinks;
use fem_core::interfaces::Interfaces;

/// Delaminations as an impact leaves them, or loads at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Delaminated {
    /// Of each interface that may open, from the bottom up.
    pub interfaces: Vec<DelaminatedInterface>,
    /// Area of the plate under which some interface has delaminated, m².
    pub projected: f64,
    /// What the interfaces have dissipated, J.
    pub dissipated: Sinks,
    /// Cells of the interfaces that are damaged; of those that a symmetry maps onto each other one.
    pub cells: Vec<DelaminatedCell>,
    /// Whether damage has come to the border of where interfaces may open.
    pub at_border: bool,
}

/// An interface of a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DelaminatedInterface {
    /// Number of plies below it.
    pub below: usize,
    /// Delaminated area, m².
    pub area: f64,
    /// When it first was, s; 0 where it was so at the start.
    pub since: Option<f64>,
}

/// A cell of an interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DelaminatedCell {
    /// The quad.
    pub quad: usize,
    /// Number of plies below the interface.
    pub below: usize,
    /// Share of its area that has delaminated.
    pub share: f64,
    /// Mean share of its cohesion that it has lost.
    pub damage: f64,
    /// When its first point was delaminated, s.
    pub since: Option<f64>,
}

/// What a plate is made of whose interfaces are `separation`.
pub(super) fn separable_parts(model: &Model, separation: &Separation) -> SeparableParts {
    let Model { plate, element, constraints, .. } = model;
    SeparableParts {
        plate: plate.clone(),
        element: element.clone(),
        supports: separation.supports.clone(),
        constraints: constraints.clone(),
        springs: model.springs.clone(),
        interfaces: separation.interfaces.clone(),
        growth: separation.growth,
        plies: model.laws.as_ref().map(|laws| LawPlate::new(plate, element.clone(), constraints, laws.clone())),
        motions: model.motions.clone(),
    }
}

/// When each cell of the interfaces was first delaminated at a point, s; infinite where it is not.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Onsets(Vec<f64>);

impl Onsets {
    /// Of so many cells, none of which is.
    pub(super) fn new(cells: usize) -> Self {
        Self(vec![f64::INFINITY; cells])
    }

    /// Whether they are those of so many cells.
    pub(super) fn is_sound(&self, cells: usize) -> bool {
        self.0.len() == cells
    }

    /// Sees the states of the interfaces at time `t`.
    pub(super) fn take(&mut self, t: f64, separation: &Separation, states: &[f64]) {
        let interfaces = &separation.interfaces;
        let first = separation.first();
        for (number, since) in self.0.iter_mut().enumerate().filter(|(_, since)| since.is_infinite()) {
            let own = &states[first[number]..first[number + 1]];
            let broken = |(_, damage): (f64, f64)| damage > Interfaces::BROKEN;
            if Interfaces::is_open(own) && interfaces.damage(number, own).any(broken) {
                *since = t;
            }
        }
    }

    /// What the march leaves.
    pub(super) fn finish(self, separation: &Separation, states: &[f64]) -> Delaminated {
        let (interfaces, first) = (&separation.interfaces, separation.first());
        let areas = interfaces.lost_area(states, Interfaces::BROKEN);
        let mut cells = Vec::new();
        let mut at_border = false;
        for (number, cell) in interfaces.cells().iter().enumerate() {
            let own = &states[first[number]..first[number + 1]];
            let (mut area, mut broken, mut lost) = (0.0, 0.0, 0.0);
            for (a, damage) in interfaces.damage(number, own) {
                area += a;
                lost += a * damage;
                broken += if damage > Interfaces::BROKEN { a } else { 0.0 };
            }
            if lost > 0.0 {
                at_border |= separation.border.contains(&cell.quad);
                let below = separation.below(cell.face);
                let since = Some(self.0[number]).filter(|t| t.is_finite());
                let (share, damage) = (broken / area, lost / area);
                cells.push(DelaminatedCell { quad: cell.quad, below, share, damage, since });
            }
        }
        let of = |(face, below): &(usize, usize)| {
            let times = interfaces.cells().iter().zip(&self.0).filter(|(cell, _)| cell.face == *face);
            let since = times.map(|(_, t)| *t).fold(f64::INFINITY, f64::min);
            let area = areas.get(face).copied().unwrap_or_default();
            DelaminatedInterface { below: *below, area, since: Some(since).filter(|t| t.is_finite()) }
        };
        Delaminated {
            interfaces: separation.faces.iter().map(of).collect(),
            projected: interfaces.projected_area(states, Interfaces::BROKEN),
            dissipated: interfaces.dissipated(states),
            cells,
            at_border,
        }
    }
}
