//! Where a contact acts on a face: one node, the Hertz pressure on a circle, or a uniform pressure on a square. The same means of the
//! deflection are taken below the face: at a `depth` in thicknesses of the plate, 0 at the face and 1 at the opposite one.

use crate::contracts::element::{Element, form};
use crate::plates::error::PlateError;
use crate::plates::load::Face;
use crate::plates::plate::Plate;
use crate::words::dof::Dof;
use crate::words::functional::Functional;
use crate::words::quadrature::gauss_legendre;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Rings and points per ring of the integration over the circle.
const RINGS: usize = 24;
const SPOKES: usize = 96;

/// Gauss points across a ring.
const RING_POINTS: usize = 4;

/// Panels a side of the integration over a square, and Gauss points a side of each.
const PANELS: usize = 8;
const PANEL_POINTS: usize = 6;

/// Deflection away from an impactor at `face`: −U30 of the top node of `column`, U30 of the bottom one.
pub fn node(plate: &Plate, face: Face, column: usize) -> Option<Functional> {
    let level = plate.outer_levels(column)[usize::from(face == Face::Top)];
    let dof = plate.dofs_at(column, level, Dof::new(3, 0)?).next()?;
    Some(Functional(vec![(dof, face.sign())]))
}

/// Mean deflection under the Hertz pressure p(ρ) = 3/(2πa²) √(1 − ρ²/a²) on the circle of radius `a` around `centre` of `face`:
/// w = ∫ ∓u₃ p dA, positive away from what presses. As a load vector it is the consistent load of a unit force, as a displacement its conjugate.
///
/// In rings c = √(1 − ρ²/a²) the pressure is the polynomial weight 3c² dc, which Gauss points integrate exactly.
///
/// # Errors
/// A circle that leaves the plate, or reaches over a step of the face.
pub fn hertz(
    plate: &Plate,
    element: &dyn Element,
    (face, depth): (Face, f64),
    centre: [f64; 2],
    a: f64,
) -> Result<Functional, PlateError> {
    let points = gauss_legendre(RINGS).iter().flat_map(|&(g, w)| {
        let c = 0.5 * (1.0 + g);
        let rho = a * (1.0 - c * c).sqrt();
        (0..SPOKES).map(move |spoke| {
            let (sin, cos) = (TAU * (spoke as f64 + 0.5) / SPOKES as f64).sin_cos();
            ([centre[0] + rho * cos, centre[1] + rho * sin], 3.0 * c * c * 0.5 * w / SPOKES as f64)
        })
    });
    mean(plate, element, (face, depth), Area { of: "radius", size: a, centre, reach: a }, points)
}

/// Mean deflection over the ring around `centre` of `face` with these inner and outer radii.
///
/// # Errors
/// A ring that leaves the plate, or reaches over a step of the face.
pub fn ring(
    plate: &Plate,
    element: &dyn Element,
    (face, depth): (Face, f64),
    centre: [f64; 2],
    [inner, outer]: [f64; 2],
) -> Result<Functional, PlateError> {
    let points = gauss_legendre(RING_POINTS).iter().flat_map(|&(g, w)| {
        let rho = (inner * inner + 0.5 * (1.0 + g) * (outer * outer - inner * inner)).sqrt();
        (0..SPOKES).map(move |spoke| {
            let (sin, cos) = (TAU * (spoke as f64 + 0.5) / SPOKES as f64).sin_cos();
            ([centre[0] + rho * cos, centre[1] + rho * sin], 0.5 * w / SPOKES as f64)
        })
    });
    mean(plate, element, (face, depth), Area { of: "radius", size: outer, centre, reach: outer }, points)
}

/// Hertz' pressure of a unit force at `point`, Pa.
pub fn hertz_pressure(centre: [f64; 2], a: f64, point: [f64; 2]) -> f64 {
    let share = (point[0] - centre[0]).hypot(point[1] - centre[1]) / a;
    1.5 / (PI * a * a) * (1.0 - share * share).max(0.0).sqrt()
}

/// Mean deflection under a uniform pressure on the square of side `side` around `centre` of `face`, parallel to the axes.
///
/// # Errors
/// A square that leaves the plate, or reaches over a step of the face.
pub fn square(
    plate: &Plate,
    element: &dyn Element,
    (face, depth): (Face, f64),
    centre: [f64; 2],
    side: f64,
) -> Result<Functional, PlateError> {
    let half = 0.5 * side / PANELS as f64;
    let along = |d: usize| {
        (0..PANELS).flat_map(move |i| {
            let middle = centre[d] - 0.5 * side + (2 * i + 1) as f64 * half;
            gauss_legendre(PANEL_POINTS).iter().map(move |(g, w)| (middle + half * g, 0.5 * w / PANELS as f64))
        })
    };
    let points = along(0).flat_map(|(x, wx)| along(1).map(move |(y, wy)| ([x, y], wx * wy)));
    mean(plate, element, (face, depth), Area { of: "side", size: side, centre, reach: 0.5 * side }, points)
}

/// A part of a face around `centre`, as errors call it, no farther than `reach` from there along each axis.
struct Area {
    of: &'static str,
    size: f64,
    centre: [f64; 2],
    reach: f64,
}

/// Weighted mean of the deflection away from what presses over points below `face` in an area.
fn mean(
    plate: &Plate,
    element: &dyn Element,
    (face, depth): (Face, f64),
    Area { of, size, centre, reach }: Area,
    points: impl Iterator<Item = ([f64; 2], f64)>,
) -> Result<Functional, PlateError> {
    let mut shape = Vec::new();
    let mut dofs = Vec::new();
    let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
    let near: Vec<usize> = (0..plate.plane.quads.len())
        .filter(|q| {
            let p = plate.plane.corners(*q);
            (0..2).all(|d| {
                let (low, high) =
                    p.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[d]), h.max(p[d])));
                low - reach <= centre[d] && centre[d] <= high + reach
            })
        })
        .collect();
    let height = |quad: usize| plate.faces_over(quad)[usize::from(face == Face::Top)];
    let mut struck: Option<f64> = None;
    for (p, weight) in points {
        let found = near.iter().find_map(|q| Some((*q, plate.plane.cell(*q).locate(p)?)));
        let (quad, [r, s]) = found.ok_or(PlateError::PatchOverEdge { of, size, centre })?;
        let (first, here) = (*struck.get_or_insert_with(|| height(quad)), height(quad));
        if !plate.same_height(first, here) {
            return Err(PlateError::PatchOverStep { of, size, centre, step: (first - here).abs() });
        }
        let (cell, q, sign) = face.below(plate, quad, depth);
        let element = form(element, plate.plane.quads[quad].domain());
        shape.resize(3 * element.info().ndof(), 0.0);
        element.shape(&plate.cell(cell), [r, s, q], &mut shape);
        plate.cell_dofs(cell, &mut dofs);
        for (dof, n) in dofs.iter().zip(shape.chunks_exact(3)) {
            if n[2] != 0.0 {
                *sum.entry(*dof).or_insert(0.0) += sign * weight * n[2];
            }
        }
    }
    Ok(Functional(sum.into_iter().collect()))
}
