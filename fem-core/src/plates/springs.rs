//! Springs that hold deflections: elastic supports, and those that only push.

use crate::contracts::element::{Element, form};
use crate::plates::load::Face;
use crate::plates::plate::Plate;
use crate::plates::support::{ColumnLevels, Levels};
use crate::words::dof::Dof;
use crate::words::domain::Point;
use crate::words::functional::Functional;
use crate::words::quadrature::gauss_legendre;
use std::collections::HashSet;
use std::f64::consts::TAU;

/// Gauss points per direction of an edge or a cell: exact for the energy of a quadratic deflection.
const ORDER: usize = 3;

/// Rings and spokes of a disc: exact for the energy of a deflection that is linear in x and y.
const RINGS: usize = 2;
const SPOKES: usize = 6;

/// Weights of two springs that are one and the same, relative: rounding of a symmetry's images.
const SAME: f64 = 1e-9;

/// A spring between the plate and its support: force −k w along w, none where it is one-sided and w > 0.
#[derive(Debug, Clone, PartialEq)]
pub struct SupportSpring {
    /// The deflection w away from the support, m.
    pub at: Functional,
    /// k, N/m.
    pub stiffness: f64,
    /// Whether it only pushes.
    pub one_sided: bool,
}

impl SupportSpring {
    /// How far it has let go under displacements `u`, m; `None` where it holds.
    pub fn lift(&self, u: &[f64]) -> Option<f64> {
        Some(self.at.of(u)).filter(|w| self.one_sided && *w > 0.0)
    }
}

/// Where springs are that are spread along edges, over cells or a disc: the deflection at each away from the support, and the
/// length or area that it stands for.
pub type Spread = Vec<(Functional, f64)>;

/// A surface of the plate that springs hold.
#[derive(Debug, Clone, Copy)]
pub struct Surface {
    face: Face,
    /// Below the face, in thicknesses of the plate.
    depth: f64,
}

impl Surface {
    /// The surface at `levels`; none at all of them.
    pub fn at(levels: Levels) -> Option<Self> {
        let (face, depth) = match levels {
            Levels::Bottom => (Face::Bottom, 0.0),
            Levels::MidPlane => (Face::Bottom, 0.5),
            Levels::Top => (Face::Top, 0.0),
            Levels::All => return None,
        };
        Some(Self { face, depth })
    }

    /// Along z, away from the support: one at the top presses from above, all others from below.
    fn away(&self) -> f64 {
        match self.face {
            Face::Top => -1.0,
            Face::Bottom => 1.0,
        }
    }

    /// The deflection away from the support at a point of a quad.
    fn deflection(&self, plate: &Plate, element: &dyn Element, quad: usize, [r, s]: [f64; 2]) -> Functional {
        let (number, q, _) = self.face.below(plate, quad, self.depth);
        let cell = plate.cell(number);
        let element = form(element, plate.plane.quads[quad].domain());
        let (mut shape, mut dofs) = (vec![0.0; 3 * element.info().ndof()], Vec::new());
        element.shape(&cell, [r, s, q], &mut shape);
        plate.cell_dofs(number, &mut dofs);
        let each = dofs.iter().zip(shape.chunks_exact(3)).filter(|(_, n)| n[2] != 0.0);
        Functional(each.map(|(dof, n)| (*dof, self.away() * n[2])).collect())
    }

    /// Springs along `edges` of the plane mesh.
    pub fn along(&self, plate: &Plate, element: &dyn Element, edges: &[[u32; 2]]) -> Spread {
        let mut open: HashSet<[u32; 2]> = edges.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
        let mut found = Vec::new();
        for (quad, corners) in plate.plane.quads.iter().enumerate() {
            for (side, [a, b]) in corners.sides().enumerate() {
                if !open.remove(&[a.min(b), a.max(b)]) {
                    continue;
                }
                let [p, q] = [a, b].map(|v| plate.plane.points[v as usize]);
                let half = 0.5 * (q[0] - p[0]).hypot(q[1] - p[1]);
                found.extend(gauss_legendre(ORDER).iter().map(|(t, weight)| {
                    let at = corners.domain().on_side(side, *t);
                    (self.deflection(plate, element, quad, at), half * weight)
                }));
            }
        }
        found
    }

    /// Springs under `quads`.
    pub fn under(&self, plate: &Plate, element: &dyn Element, quads: &[u32]) -> Spread {
        let each = quads.iter().flat_map(|quad| {
            let quad = *quad as usize;
            let cell = plate.cell(self.face.below(plate, quad, self.depth).0);
            let point = move |Point { at: [r, s], factors }: &Point| {
                let area = cell.plane(*r, *s).det * factors[0] * factors[1];
                (self.deflection(plate, element, quad, [*r, *s]), area)
            };
            plate.plane.quads[quad].domain().points(ORDER).iter().map(point)
        });
        each.collect()
    }

    /// Springs over a disc; `None` where it leaves the plate.
    pub fn within(&self, plate: &Plate, element: &dyn Element, centre: [f64; 2], radius: f64) -> Option<Spread> {
        let area = std::f64::consts::PI * radius * radius;
        let points = gauss_legendre(RINGS).iter().flat_map(|(g, weight)| {
            let rho = radius * (0.5 * (1.0 + g)).sqrt();
            (0..SPOKES).map(move |spoke| {
                let (sin, cos) = (TAU * spoke as f64 / SPOKES as f64).sin_cos();
                ([centre[0] + rho * cos, centre[1] + rho * sin], 0.5 * weight * area / SPOKES as f64)
            })
        });
        let quads = 0..plate.plane.quads.len();
        let place = |(point, area): ([f64; 2], f64)| {
            let (quad, at) = quads.clone().find_map(|q| Some((q, plate.plane.corners(q).locate(point)?)))?;
            Some((self.deflection(plate, element, quad, at), area))
        };
        points.map(place).collect()
    }

    /// A spring at each of some nodes.
    pub fn at_nodes(&self, plate: &Plate, nodes: &[ColumnLevels]) -> Spread {
        let nodes = nodes.iter().flat_map(|(columns, levels)| {
            columns.iter().flat_map(move |column| levels.iter().map(move |level| (*column as usize, *level)))
        });
        let deflection = |(column, level)| plate.dofs_at(column, level, Dof::SOLID[8]).next();
        nodes.filter_map(deflection).map(|dof| (Functional(vec![(dof, self.away())]), 1.0)).collect()
    }
}

/// Springs that act on one and the same displacement as one.
pub fn merged(springs: Vec<SupportSpring>) -> Vec<SupportSpring> {
    let mut merged: Vec<SupportSpring> = Vec::new();
    for spring in springs {
        let same = |other: &&mut SupportSpring| {
            let (a, b) = (&spring.at.0, &other.at.0);
            let size = a.iter().fold(0.0_f64, |m, (_, w)| m.max(w.abs()));
            spring.one_sided == other.one_sided
                && a.len() == b.len()
                && a.iter().zip(b).all(|((i, v), (j, w))| i == j && (v - w).abs() <= SAME * size)
        };
        match merged.iter_mut().find(same) {
            Some(one) => one.stiffness += spring.stiffness,
            None => merged.push(spring),
        }
    }
    merged
}
