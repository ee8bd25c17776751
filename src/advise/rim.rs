//! The edge that supports a plate around an impact.

use super::held::Held;
use crate::model::Model;
use fem_core::dof::Dof;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

/// Weights of an equation below which it holds a displacement.
const NOTHING: f64 = 1e-9;

/// Weight of a node in the deflection of a spring from which on it is held by it.
const SHARE: f64 = 0.05;

/// The part of a plate inside its supports, and how it is held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    /// Area inside, m².
    pub area: f64,
    /// How the edge is held; `None` where the supports lie all to one side of the place, as that of a cantilever.
    pub held: Option<Held>,
}

impl Rim {
    /// Around `centre`: the cells that are reached from there without crossing an edge whose ends are both held against
    /// deflection.
    ///
    /// Slope and displacement in the plane count as held where they are along more than half of the length of these edges,
    /// across each edge, at some height. `None` of a section, which has no plane.
    pub fn around(model: &Model, centre: [f64; 2]) -> Option<Self> {
        let plate = &model.plate;
        let mesh = &plate.plane;
        if plate.info().is_section() {
            return None;
        }
        let start = (0..mesh.quads.len()).find(|q| mesh.corners(*q).locate(centre).is_some())?;
        let is_held: Vec<bool> = (0..mesh.points.len()).map(|column| deflection_held(model, column)).collect();
        let edges_of = |quad: usize| mesh.quads[quad].sides().map(|[a, b]| [a.min(b), a.max(b)]);
        let mut beside: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for quad in 0..mesh.quads.len() {
            edges_of(quad).for_each(|edge| beside.entry(edge).or_default().push(quad));
        }
        let bars = |edge: &[u32; 2]| edge.iter().all(|column| is_held[*column as usize]);
        let (mut inside, mut open, mut rim) = (BTreeSet::from([start]), vec![start], BTreeSet::new());
        while let Some(quad) = open.pop() {
            for edge in edges_of(quad) {
                if bars(&edge) {
                    rim.insert(edge);
                    continue;
                }
                open.extend(beside[&edge].iter().filter(|next| inside.insert(**next)));
            }
        }
        let area = inside.iter().map(|quad| mesh.quality(*quad).area).sum();
        let supports: BTreeSet<u32> =
            inside.iter().flat_map(|quad| mesh.quads[*quad]).filter(|column| is_held[*column as usize]).collect();
        let directions = supports.iter().map(|column| {
            let p = mesh.points[*column as usize];
            (p[1] - centre[1]).atan2(p[0] - centre[0])
        });
        let held = surrounded(directions.collect()).then(|| hold(model, &rim));
        Some(Self { area, held })
    }

    /// Radius of the circle of the same area, m.
    pub fn radius(&self) -> f64 {
        (self.area / PI).sqrt()
    }
}

/// Whether no half-plane is free of `directions`, its border included: a place on a free edge is between the ends of that edge.
fn surrounded(mut directions: Vec<f64>) -> bool {
    directions.sort_by(f64::total_cmp);
    let Some(first) = directions.first() else { return false };
    let next = directions[1..].iter().copied().chain([first + TAU]);
    directions.iter().zip(next).all(|(a, b)| b - a < PI * (1.0 + NOTHING))
}

fn levels(model: &Model, column: usize) -> impl Iterator<Item = usize> + use<> {
    let [low, high] = model.plate.outer_levels(column);
    low..=high
}

/// Whether Σ factor · unknown is zero for one set of the unknowns called so at a node.
fn zero(model: &Model, column: usize, level: usize, terms: &[(Option<Dof>, f64)]) -> bool {
    let mut sum = Vec::new();
    for (dof, factor) in terms.iter().filter(|(_, factor)| factor.abs() > NOTHING) {
        let Some(found) = dof.and_then(|dof| model.plate.dofs_at(column, level, dof).next()) else { return false };
        sum.push((found, *factor));
    }
    model.constraints.restrict(&sum).iter().all(|(_, weight)| weight.abs() < NOTHING)
}

fn deflection_held(model: &Model, column: usize) -> bool {
    levels(model, column)
        .any(|level| zero(model, column, level, &[(Dof::new(3, 0), 1.0)]) || sprung(model, column, level))
}

/// Whether springs hold the deflection of a node.
fn sprung(model: &Model, column: usize, level: usize) -> bool {
    let Some(dof) = Dof::new(3, 0).and_then(|w| model.plate.dofs_at(column, level, w).next()) else { return false };
    let own = model.constraints.restrict(&[(dof, 1.0)]);
    let weighs = |(i, weight): &(usize, f64)| weight.abs() > SHARE && own.iter().any(|(own, _)| own == i);
    model.springs.iter().any(|spring| spring.at.0.iter().any(weighs))
}

/// How most of the edges `rim` are held.
fn hold(model: &Model, rim: &BTreeSet<[u32; 2]>) -> Held {
    let points = &model.plate.plane.points;
    let (mut length, mut slope, mut in_plane) = (0.0, 0.0, 0.0);
    for ends in rim {
        let [a, b] = ends.map(|column| points[column as usize]);
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let size = x.hypot(y);
        let normal = [y / size, -x / size];
        length += size;
        let all = |held: fn(&Model, usize, [f64; 2]) -> bool| ends.iter().all(|c| held(model, *c as usize, normal));
        slope += if all(slope_held) { size } else { 0.0 };
        in_plane += if all(in_plane_held) { size } else { 0.0 };
    }
    Held { slope: slope > 0.5 * length, in_plane: in_plane > 0.5 * length }
}

/// Uₙ₀ across the edge, at how many levels it is zero.
fn levels_held(model: &Model, column: usize, [x, y]: [f64; 2]) -> usize {
    let across = [(Dof::new(1, 0), x), (Dof::new(2, 0), y)];
    levels(model, column).filter(|level| zero(model, column, *level, &across)).count()
}

fn in_plane_held(model: &Model, column: usize, normal: [f64; 2]) -> bool {
    levels_held(model, column, normal) > 0
}

/// ∂w/∂n or ∂uₙ/∂z is zero, or uₙ at two heights.
fn slope_held(model: &Model, column: usize, [x, y]: [f64; 2]) -> bool {
    let deflection = [(Dof::new(3, 1), x), (Dof::new(3, 2), y)];
    let turn = [(Dof::new(1, 3), x), (Dof::new(2, 3), y)];
    levels(model, column).any(|l| zero(model, column, l, &deflection) || zero(model, column, l, &turn))
        || levels_held(model, column, [x, y]) > 1
}
