//! What holds and what strikes a plate, as lines in plan.

use crate::analyses::statics::dof_of;
use crate::model::{Model, Plan};
use fem_io::plot::MapOutline;
use fem_io::scene::ContactLoad;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Lines in plan of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanOutline {
    /// Of what: `support`, where the deflection is held at some height, or `contact patch`.
    pub what: String,
    /// Their points, m.
    pub lines_m: Vec<Vec<[f64; 2]>>,
}

/// Straight parts of a circle.
const PARTS: usize = 48;

/// Share of the width of a plate by which a node that is held alone is marked.
const MARK: f64 = 0.01;

/// Supports and contact patches of a model; of each kind none where there is nothing to draw.
pub(super) fn outlines(model: &Model) -> Vec<PlanOutline> {
    let kinds = [("support", supports(model)), ("contact patch", patches(model))];
    let kinds = kinds.into_iter().filter(|(_, lines)| !lines.is_empty());
    kinds.map(|(what, lines_m)| PlanOutline { what: what.to_owned(), lines_m }).collect()
}

/// The same as a map draws them, in mm.
pub(super) fn drawn(outlines: &[PlanOutline]) -> Vec<MapOutline> {
    let mm = |line: &Vec<[f64; 2]>| line.iter().map(|p| p.map(|v| v * 1e3)).collect();
    let one = |outline: &PlanOutline| MapOutline {
        name: outline.what.clone(),
        lines: outline.lines_m.iter().map(mm).collect(),
        dashed: outline.what == "support",
    };
    outlines.iter().map(one).collect()
}

/// Sides of cells along which the deflection is held, those inside of an area that is held left out; a diamond for each
/// node that is held alone.
fn supports(model: &Model) -> Vec<Vec<[f64; 2]>> {
    let plate = &model.plate;
    let zero = |dof: usize| {
        let (terms, value) = model.constraints.row(dof);
        terms.is_empty() && value == 0.0
    };
    let at = |node: usize, level: usize| plate.dofs_at(node, level, dof_of(3)).any(zero);
    let mesh = &plate.plane;
    let held: Vec<bool> =
        (0..mesh.points.len()).map(|node| (0..plate.levels.len()).any(|level| at(node, level))).collect();
    // Sides whose ends are held, and of how many cells that are held all round they are.
    let mut sides: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for quad in &mesh.quads {
        let all = quad.iter().all(|node| held[*node as usize]);
        for [a, b] in quad.sides() {
            if held[a as usize] && held[b as usize] {
                *sides.entry([a.min(b), a.max(b)]).or_default() += usize::from(all);
            }
        }
    }
    let mut alone = held;
    sides.keys().flatten().for_each(|node| alone[*node as usize] = false);
    let lines = sides.iter().filter(|(_, cells)| **cells < 2).map(|(side, _)| mesh.along(*side));
    let (low, high) = mesh.bounds();
    let r = MARK * (high[0] - low[0]).max(high[1] - low[1]);
    let diamond = |[x, y]: [f64; 2]| vec![[x - r, y], [x, y - r], [x + r, y], [x, y + r], [x - r, y]];
    let alone = mesh.points.iter().zip(alone).filter(|(_, alone)| *alone).map(|(p, _)| diamond(*p));
    lines.chain(alone).collect()
}

/// The outlines of what impactors press on.
fn patches(model: &Model) -> Vec<Vec<[f64; 2]>> {
    let Plan::Impact(impact) = &model.plan else { return Vec::new() };
    let of = |(spec, strike): (&fem_io::scene::ImpactorSpec, &crate::model::Strike)| {
        let [x, y] = strike.centre;
        let circle = |radius: f64| {
            let point = |k: usize| (TAU * k as f64 / PARTS as f64).sin_cos();
            Some((0..=PARTS).map(point).map(|(sin, cos)| [x + radius * cos, y + radius * sin]).collect())
        };
        match spec.load.value {
            ContactLoad::Node => None,
            ContactLoad::Patch { radius } => circle(radius),
            ContactLoad::Tip { radius } => circle(ContactLoad::OF_TIP * radius),
            ContactLoad::Square { side } => {
                let h = 0.5 * side;
                Some(vec![[x - h, y - h], [x + h, y - h], [x + h, y + h], [x - h, y + h], [x - h, y - h]])
            }
        }
    };
    impact.spec.impactors.iter().zip(&impact.strikes).filter_map(of).collect()
}
