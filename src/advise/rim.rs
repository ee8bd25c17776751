//! The edge that supports a plate around an impact.

use super::held::Held;
use crate::model::Model;
use fem_core::dof::Dof;
use fem_core::hold::Hold;
use fem_core::mesh::PlaneMesh;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

/// Weights of an equation below which it holds a displacement.
const NOTHING: f64 = 1e-9;

/// Distance from a line, over the length of an edge on it, and sine of an angle, that are rounding.
const STRAIGHT: f64 = 1e-6;

/// Weight of a node in the deflection of a spring from which on it is held by it.
const SHARE: f64 = 0.05;

/// The part of a plate inside its supports, and how it is held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    /// Area inside, m².
    pub area: f64,
    /// How the edge is held; `None` where the supports, and their images in edges that are held as planes of symmetry, lie all to one
    /// side of the place, as that of a cantilever.
    pub held: Option<Held>,
}

impl Rim {
    /// Around `centre`: the cells that are reached from there without crossing an edge whose ends are both held against
    /// deflection.
    ///
    /// Slope and displacement in the plane count as held where they are along more than half of the length of these edges,
    /// across each edge, at some height. Springs under the place, as those of a bed, are no edge. `None` of a section, which has no plane.
    pub fn around(model: &Model, centre: [f64; 2]) -> Option<Self> {
        let plate = &model.plate;
        let mesh = &plate.plane;
        if plate.info().is_section() {
            return None;
        }
        let start = (0..mesh.quads.len()).find(|q| mesh.corners(*q).locate(centre).is_some())?;
        let sprung: Vec<bool> = (0..mesh.points.len()).map(|column| sprung(model, column)).collect();
        let bed = bed(mesh, start, &sprung);
        let by_springs = |column: usize| sprung[column] && !bed.contains(&(column as u32));
        let is_held: Vec<bool> =
            (0..mesh.points.len()).map(|column| by_springs(column) || deflection_held(model, column)).collect();
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
        let free = |edge: &[u32; 2]| beside[edge].len() == 1 && !bars(edge);
        let sides: BTreeSet<[u32; 2]> = inside.iter().flat_map(|quad| edges_of(*quad)).filter(free).collect();
        let mut places: Vec<[f64; 2]> = supports.iter().map(|column| mesh.points[*column as usize]).collect();
        for (p, n) in planes_of_symmetry(model, &sides) {
            let image = |at: &[f64; 2]| {
                let beyond = 2.0 * ((at[0] - p[0]) * n[0] + (at[1] - p[1]) * n[1]);
                [at[0] - beyond * n[0], at[1] - beyond * n[1]]
            };
            places.extend(places.iter().map(image).collect::<Vec<_>>());
        }
        let directions = places.iter().map(|p| (p[1] - centre[1]).atan2(p[0] - centre[0]));
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

/// The columns of the cells that springs hold in all corners, and that are reached from `start` through such cells.
fn bed(mesh: &PlaneMesh, start: usize, sprung: &[bool]) -> BTreeSet<u32> {
    let bedded = |quad: usize| mesh.quads[quad].iter().all(|column| sprung[*column as usize]);
    let mut columns = BTreeSet::new();
    if !bedded(start) {
        return columns;
    }
    let mut rest: Vec<usize> = (0..mesh.quads.len()).filter(|quad| bedded(*quad)).collect();
    columns.extend(mesh.quads[start].iter().copied());
    loop {
        let meets = |quad: &usize| mesh.quads[*quad].iter().any(|column| columns.contains(column));
        let (reached, beyond): (Vec<usize>, Vec<usize>) = rest.iter().partition(|quad| meets(quad));
        if reached.is_empty() {
            return columns;
        }
        columns.extend(reached.iter().flat_map(|quad| mesh.quads[*quad].iter().copied()));
        rest = beyond;
    }
}

/// A point and the normal of each line of `edges` along which slope and displacement across it are held and the deflection is not: one
/// line, or two that are perpendicular; none where there are others.
fn planes_of_symmetry(model: &Model, edges: &BTreeSet<[u32; 2]>) -> Vec<([f64; 2], [f64; 2])> {
    let points = &model.plate.plane.points;
    let mut planes: Vec<([f64; 2], [f64; 2])> = Vec::new();
    for ends in edges {
        let [a, b] = ends.map(|column| points[column as usize]);
        let size = (b[0] - a[0]).hypot(b[1] - a[1]);
        let n = [(b[1] - a[1]) / size, (a[0] - b[0]) / size];
        let all = |held: fn(&Model, usize, [f64; 2]) -> bool| ends.iter().all(|c| held(model, *c as usize, n));
        if !(all(in_plane_held) && all(slope_held)) {
            continue;
        }
        let on = |(p, m): &([f64; 2], [f64; 2])| {
            let off = |at: [f64; 2]| ((at[0] - p[0]) * m[0] + (at[1] - p[1]) * m[1]).abs();
            off(a).max(off(b)) < STRAIGHT * size
        };
        if !planes.iter().any(on) {
            planes.push((a, n));
        }
    }
    match planes[..] {
        [_] => planes,
        [(_, m), (_, n)] if (m[0] * n[0] + m[1] * n[1]).abs() < STRAIGHT => planes,
        _ => Vec::new(),
    }
}

fn levels(model: &Model, column: usize) -> impl Iterator<Item = usize> + use<> {
    let [low, high] = model.plate.outer_levels(column);
    low..=high
}

/// Whether Σ factor · unknown is zero for one set of the unknowns called so at a node.
fn zero(model: &Model, column: usize, level: usize, terms: &[(Option<Dof>, f64)]) -> bool {
    let at_level = terms.iter().map(|(dof, factor)| (level, *dof, *factor));
    sum_is_zero(model, column, at_level.collect())
}

/// The same of unknowns at several levels.
fn sum_is_zero(model: &Model, column: usize, terms: Vec<(usize, Option<Dof>, f64)>) -> bool {
    let mut sum = Vec::new();
    for (level, dof, factor) in terms.into_iter().filter(|(.., factor)| factor.abs() > NOTHING) {
        let Some(found) = dof.and_then(|dof| model.plate.dofs_at(column, level, dof).next()) else { return false };
        sum.push((found, factor));
    }
    model.constraints.restrict(&sum).iter().all(|(_, weight)| weight.abs() < NOTHING)
}

/// Whether the deflection is zero at a level, or in the middle of the plate, on the line between the two about it.
fn deflection_held(model: &Model, column: usize) -> bool {
    let w = Dof::new(3, 0);
    let all: Vec<usize> = levels(model, column).collect();
    let middle = Hold::middle(&model.plate, column, &all).into_iter().map(|(level, share)| (level, w, share)).collect();
    all.iter().any(|level| zero(model, column, *level, &[(w, 1.0)])) || sum_is_zero(model, column, middle)
}

/// Whether springs hold the deflection of a node.
fn sprung(model: &Model, column: usize) -> bool {
    let w = Dof::new(3, 0);
    let of_level = |level| {
        let own = w.and_then(|w| model.plate.dofs_at(column, level, w).next());
        own.map_or(Vec::new(), |own| model.constraints.restrict(&[(own, 1.0)]))
    };
    let own: Vec<(usize, f64)> = levels(model, column).flat_map(of_level).collect();
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
