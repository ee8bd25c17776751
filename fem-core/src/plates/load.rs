//! Loads as consistent nodal forces, f = ∫ Nᵀ p dA: one per unknown, before elimination of constraints.

use crate::contracts::element::{Element, ElementError, Scratch, form};
use crate::plates::error::PlateError;
use crate::plates::plate::Plate;
use crate::words::dof::Dof;
use crate::words::domain::Point;
use crate::words::functional::Functional;
use crate::words::quadrature::gauss_legendre;
use std::collections::HashSet;

/// Gauss points per direction: exact for cubic functions under a pressure of degree 12.
const ORDER: usize = 8;

/// A face of the plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Face {
    Bottom,
    Top,
}

impl Face {
    /// Its cell over a quad, its q there, and the sign of the force of what presses on it along z.
    pub(super) fn place(self, plate: &Plate, quad: usize) -> (usize, f64, f64) {
        let cells = plate.cells_over(quad);
        match self {
            Self::Bottom => (cells.start, -1.0, self.sign()),
            Self::Top => (cells.end - 1, 1.0, self.sign()),
        }
    }

    /// Sign of the force of what presses on it along z.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Bottom => 1.0,
            Self::Top => -1.0,
        }
    }

    /// The same of the surface that lies `depth` thicknesses of the plate below it, 0 to 1. Of a shell all are one.
    pub(super) fn below(self, plate: &Plate, quad: usize, depth: f64) -> (usize, f64, f64) {
        let (outer, q, sign) = self.place(plate, quad);
        if depth == 0.0 {
            return (outer, q, sign);
        }
        let cells = plate.cells_over(quad);
        let (bottom, top) = (plate.faces_of(cells.start)[0], plate.faces_of(cells.end - 1)[1]);
        let z = match self {
            Self::Bottom => bottom + depth * (top - bottom),
            Self::Top => top - depth * (top - bottom),
        };
        let last = cells.end - 1;
        let cell = cells.into_iter().find(|cell| plate.faces_of(*cell)[1] >= z).unwrap_or(last);
        let [low, high] = plate.faces_of(cell);
        (cell, (2.0 * (z - low) / (high - low) - 1.0).clamp(-1.0, 1.0), sign)
    }
}

/// Adds the forces of a pressure `p`(x, y), Pa, that presses on `face` of `quads`: downwards on the top, upwards on the
/// bottom.
pub fn pressure(
    plate: &Plate,
    element: &dyn Element,
    face: Face,
    quads: impl IntoIterator<Item = usize>,
    p: impl Fn([f64; 2]) -> f64,
    f: &mut [f64],
) {
    let (mut shape, mut dofs) = (Vec::new(), Vec::new());
    for quad in quads {
        let (number, q, sign) = face.place(plate, quad);
        let cell = plate.cell(number);
        plate.cell_dofs(number, &mut dofs);
        let element = form(element, cell.corners.domain());
        shape.resize(3 * dofs.len(), 0.0);
        for &Point { at: [r, s], factors } in cell.corners.domain().points(ORDER) {
            element.shape(&cell, [r, s, q], &mut shape);
            let [x, y, _] = cell.position([r, s, q]);
            let force = sign * p([x, y]) * cell.plane(r, s).det * factors[0] * factors[1];
            for (dof, n) in dofs.iter().zip(shape.chunks_exact(3)) {
                f[*dof] += force * n[2];
            }
        }
    }
}

/// Intervals of a cell's side between the places at which [`peak`] looks.
const LOOKS: usize = 4;

/// Times as large as at all points of the integration that a pressure between them is lost.
const LOST: f64 = 10.0;

/// Where |p| is largest over `quads`, and how large: of their corners and places between, the first of them.
pub fn peak(plate: &Plate, quads: &[usize], p: impl Fn([f64; 2]) -> f64) -> Option<([f64; 2], f64)> {
    let places = quads.iter().flat_map(|quad| {
        let cell = plate.cell(plate.cell_over(*quad, 0));
        let domain = cell.corners.domain();
        let (first, second, last) =
            (domain.corners()[0], domain.corners()[1], domain.corners()[domain.corners().len() - 1]);
        let at = move |[i, j]: [usize; 2]| {
            let [i, j] = [i, j].map(|k| k as f64 / LOOKS as f64);
            let local = [0, 1].map(|d| first[d] + i * (second[d] - first[d]) + j * (last[d] - first[d]));
            let [x, y, _] = cell.position([local[0], local[1], 0.0]);
            [x, y]
        };
        domain.lattice(LOOKS).into_iter().map(at)
    });
    let sized = places.map(|at| (at, p(at).abs())).filter(|(_, size)| *size > 0.0);
    sized.reduce(|largest, next| if next.1 > largest.1 { next } else { largest })
}

/// ∫ |p| dA over `quads`, N, by twice as many points as [`pressure`] takes.
pub fn size(plate: &Plate, quads: &[usize], p: impl Fn([f64; 2]) -> f64) -> f64 {
    quads.iter().map(|quad| over_cell(plate, *quad, 2 * ORDER, &p)[1]).sum()
}

/// ∫ p dA and ∫ |p| dA over a quad by points of an order.
fn over_cell(plate: &Plate, quad: usize, order: usize, mut p: impl FnMut([f64; 2]) -> f64) -> [f64; 2] {
    let cell = plate.cell(plate.cell_over(quad, 0));
    let each = cell.corners.domain().points(order).iter().map(|Point { at: [r, s], factors }| {
        let [x, y, _] = cell.position([*r, *s, 0.0]);
        p([x, y]) * cell.plane(*r, *s).det * factors[0] * factors[1]
    });
    each.fold([0.0, 0.0], |[sum, size], value| [sum + value, size + value.abs()])
}

/// What the integration of [`pressure`] loses of one that changes within cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unresolved {
    /// Σ |∫ p dA − the same by twice as many points| over the cells, as a share of ∫ |p| dA by these.
    Share(f64),
    /// Its [`peak`], which lies between the points: some times as large as at any of them.
    Peak,
}

/// What [`pressure`] loses of `p` over `quads`. A peak that is not finite belongs to no point, and may well be integrated.
pub fn unresolved(plate: &Plate, quads: &[usize], p: impl Fn([f64; 2]) -> f64) -> Unresolved {
    let (mut missed, mut whole, mut largest) = (0.0, 0.0, 0.0);
    for quad in quads {
        let [[coarse, _], [fine, size]] = [ORDER, 2 * ORDER].map(|order| {
            over_cell(plate, *quad, order, |at| {
                let value = p(at);
                largest = f64::max(largest, value.abs());
                value
            })
        });
        missed += f64::abs(coarse - fine);
        whole += size;
    }
    match peak(plate, quads, &p) {
        Some((_, peak)) if peak.is_finite() && peak > LOST * largest => Unresolved::Peak,
        _ if whole > 0.0 => Unresolved::Share(missed / whole),
        _ => Unresolved::Share(0.0),
    }
}

/// The deflection u₃ at the points of the integration over `face`, and the area that each stands for, m²: what springs under a
/// plate are pressed by. Of cells that a symmetry maps onto each other one stands for all.
pub fn deflections(plate: &Plate, element: &dyn Element, face: Face) -> Vec<(Functional, f64)> {
    let (mut shape, mut dofs, mut found) = (Vec::new(), Vec::new(), Vec::new());
    for (quad, weight) in plate.symmetry().quads() {
        let (number, q, _) = face.place(plate, quad);
        let cell = plate.cell(number);
        plate.cell_dofs(number, &mut dofs);
        let element = form(element, cell.corners.domain());
        shape.resize(3 * dofs.len(), 0.0);
        for &Point { at: [r, s], factors } in cell.corners.domain().points(ORDER) {
            element.shape(&cell, [r, s, q], &mut shape);
            let along = dofs.iter().zip(shape.chunks_exact(3)).map(|(dof, n)| (*dof, n[2])).filter(|(_, n)| *n != 0.0);
            found.push((Functional(along.collect()), weight * cell.plane(r, s).det * factors[0] * factors[1]));
        }
    }
    found
}

/// Adds the forces of `per_length` (x, y, z), N/m, along `edges` of the plane mesh, spread evenly through the thickness.
pub fn edge(plate: &Plate, element: &dyn Element, edges: &[[u32; 2]], per_length: [f64; 3], f: &mut [f64]) {
    tractions(plate, element, edges, |_| per_length, f);
}

/// The same of a force per length that follows from the normal of each edge, which points out of the plate.
pub fn tractions(
    plate: &Plate,
    element: &dyn Element,
    edges: &[[u32; 2]],
    per_length: impl Fn([f64; 2]) -> [f64; 3],
    f: &mut [f64],
) {
    let mut open: HashSet<[u32; 2]> = edges.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
    let (mut shape, mut dofs) = (Vec::new(), Vec::new());
    let rule = gauss_legendre(ORDER);
    for (quad, corners) in plate.plane.quads.iter().enumerate() {
        for (side, [a, b]) in corners.sides().enumerate() {
            if !open.remove(&[a.min(b), a.max(b)]) {
                continue;
            }
            let [p, q] = [a, b].map(|v| plate.plane.points[v as usize]);
            let length = (q[0] - p[0]).hypot(q[1] - p[1]);
            let along_chord = per_length([(q[1] - p[1]) / length, (p[0] - q[0]) / length]);
            let bend = plate.plane.bends.get(&[a.min(b), a.max(b)]);
            // Length per t, and force per length there.
            let at = |t: f64| match bend {
                None => (0.5 * length, along_chord),
                Some(bend) => {
                    let [x, y] = [0, 1].map(|d| 0.5 * (q[d] - p[d]) - 2.0 * t * bend[d]);
                    let by_t = x.hypot(y);
                    (by_t, per_length([y / by_t, -x / by_t]))
                }
            };
            let cells = plate.cells_over(quad);
            let thickness = plate.faces_of(cells.end - 1)[1] - plate.faces_of(cells.start)[0];
            for number in cells {
                let cell = plate.cell(number);
                plate.cell_dofs(number, &mut dofs);
                let [low, high] = cell.stack.extent();
                let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
                let element = form(element, corners.domain());
                shape.resize(3 * dofs.len(), 0.0);
                for &(t, wt) in rule {
                    let [r, s] = corners.domain().on_side(side, t);
                    let (by_t, per_length) = at(t);
                    for &(q, wq) in rule {
                        element.shape(&cell, [r, s, middle + half * q], &mut shape);
                        let share = by_t * wt * wq * cell.half_height() / thickness;
                        for (dof, n) in dofs.iter().zip(shape.chunks_exact(3)) {
                            f[*dof] += share * (0..3).map(|d| per_length[d] * n[d]).sum::<f64>();
                        }
                    }
                }
            }
        }
    }
}

/// Adds a force (x, y, z), N, at the node of `column` and `level`.
///
/// A force at a node of a solid is singular: its own displacement grows without bound as cells shrink.
///
/// # Errors
/// A component along which the node cannot move.
pub fn point(plate: &Plate, column: usize, level: usize, force: [f64; 3], f: &mut [f64]) -> Result<(), PlateError> {
    for (n, force) in force.into_iter().enumerate().filter(|(_, force)| *force != 0.0) {
        let dof = Dof::new(n as u8 + 1, 0).and_then(|dof| plate.dofs_at(column, level, dof).next());
        *dof.map(|dof| &mut f[dof]).ok_or_else(|| PlateError::NoDisplacement {
            node: plate.describe_column(column),
            axis: ['x', 'y', 'z'][n],
        })? += force;
    }
    Ok(())
}

/// Adds the forces of a uniform `acceleration` (x, y, z), m/s², of all masses: f = M a.
///
/// # Errors
/// A cell that the element refuses.
pub fn gravity(
    plate: &Plate,
    element: &dyn Element,
    acceleration: [f64; 3],
    f: &mut [f64],
) -> Result<(), ElementError> {
    let (mut mass, mut scratch, mut dofs) = (Vec::new(), Scratch::default(), Vec::new());
    for number in plate.cell_numbers() {
        let cell = plate.cell(number);
        let element = form(element, cell.corners.domain());
        let n = element.info().ndof();
        mass.resize(n * n, 0.0);
        element.mass(&cell, &mut scratch, &mut mass)?;
        plate.cell_dofs(number, &mut dofs);
        for (column, name) in mass.chunks_exact(n).zip(element.info().dofs.iter().cycle()) {
            let a = if name.m() == 0 { acceleration[name.n() - 1] } else { 0.0 };
            dofs.iter().zip(column).for_each(|(dof, m)| f[*dof] += m * a);
        }
    }
    Ok(())
}
