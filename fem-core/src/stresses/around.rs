//! The cells around a point, from whose stresses derivatives are taken.

use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;
use crate::plates::symmetry::SymmetryGroup;
use crate::words::dof::Dof;
use crate::words::domain::Domain;
use std::collections::HashSet;

/// Cells around a point whose stresses are differentiated: four deep from an edge, and all there are in a small mesh. Of triangles
/// three times as many, for the errors in their centres do not lie in rows that a fit sees through.
const AROUND: usize = 30;
const TRIANGLES_FOR_ONE: usize = 3;
const AROUND_SECTION: usize = 6;

/// Edges x = const and y = const along which supports are those of a plane of symmetry: stresses go on behind them as their
/// own mirror image.
///
/// Such an edge lies on the bounds of the plate. All along it displacements normal to it are held, with their derivatives along
/// the edge and along z; deflections and displacements along it are not, or it is a clamped edge. Plies are their own image.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mirrors([Vec<f64>; 2]);

/// A cell, or its image in a mirror.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Neighbour {
    pub(super) quad: usize,
    /// Its centre, from the point.
    pub(super) centre: [f64; 2],
    /// Factor on σ₁₂, −1 for an image in one mirror.
    pub(super) turned: f64,
}

impl Mirrors {
    /// Those of a plate that is held by `constraints`.
    pub fn of(plate: &Plate, constraints: &Constraints) -> Self {
        let (low, high) = plate.plane.bounds();
        let directions = if plate.info().is_section() { 1 } else { 2 };
        let mut planes = [Vec::new(), Vec::new()];
        for (d, planes) in planes.iter_mut().enumerate().take(directions) {
            let keeps = [SymmetryGroup::MirrorX, SymmetryGroup::MirrorY][d].operations().iter().all(|mirror| {
                let slices = (0..plate.regions()).flat_map(|region| plate.stacks(region)).flat_map(|s| &s.slices);
                slices.into_iter().all(|slice| mirror.keeps_stiffness(&slice.c))
            });
            planes.extend([low[d], high[d]].into_iter().filter(|at| keeps && is_mirror(plate, constraints, d, *at)));
        }
        Self(planes)
    }

    /// Whether one of them is nearer to `point` than `reach`, m.
    pub fn are_near(&self, point: [f64; 2], reach: f64) -> bool {
        self.0.iter().zip(point).any(|(planes, x)| planes.iter().any(|at| (at - x).abs() < reach))
    }
}

/// Whether the supports along the edge where coordinate `d` is `at` are those of a plane of symmetry.
fn is_mirror(plate: &Plate, constraints: &Constraints, d: usize, at: f64) -> bool {
    let reach = plate.plane.reach();
    let columns: Vec<usize> = (0..plate.columns.len()).filter(|c| (plate.columns[*c][d] - at).abs() <= reach).collect();
    let held = |column: usize, n: usize, m: usize| {
        let dof = Dof::new(n as u8, m as u8);
        let mut dofs = (0..plate.levels.len())
            .flat_map(|level| dof.into_iter().flat_map(move |dof| plate.dofs_at(column, level, dof)));
        dofs.all(|dof| constraints.implies(&[(dof, 1.0)]))
    };
    let (across, along) = (d + 1, 2 - d);
    let normal = |column: &usize| [0, along, 3].into_iter().all(|m| held(*column, across, m));
    let free = |n: usize| plate.info().is_section() && n == 2 || columns.iter().any(|column| !held(*column, n, 0));
    columns.iter().all(normal) && free(along) && free(3)
}

/// Cells of the region of `start` around a point, which lies in the cells `start`, with the images that lie as near.
pub(super) fn neighbours(plate: &Plate, mirrors: &Mirrors, point: [f64; 2], start: Vec<usize>) -> Vec<Neighbour> {
    let quads = &plate.plane.quads;
    let wanted = if plate.info().is_section() { AROUND_SECTION } else { AROUND };
    let region = start.first().map_or(0, |quad| plate.region(*quad));
    let mut ring = start;
    loop {
        let all = with_images(plate, mirrors, point, &ring);
        let triangles = all.iter().filter(|neighbour| quads[neighbour.quad].domain() == Domain::Triangle).count();
        if TRIANGLES_FOR_ONE * (all.len() - triangles) + triangles >= TRIANGLES_FOR_ONE * wanted {
            return all;
        }
        let vertices: HashSet<u32> = ring.iter().flat_map(|q| quads[*q]).collect();
        let own = (0..quads.len()).filter(|q| plate.region(*q) == region);
        let next: Vec<usize> = own.filter(|q| quads[*q].iter().any(|v| vertices.contains(v))).collect();
        if next.len() == ring.len() {
            return all;
        }
        ring = next;
    }
}

fn with_images(plate: &Plate, Mirrors(planes): &Mirrors, point: [f64; 2], ring: &[usize]) -> Vec<Neighbour> {
    let centre = |quad: &usize| {
        let [x, y, _] = plate.cell(plate.cell_over(*quad, 0)).position(plate.info_of(*quad).centre());
        [x, y]
    };
    let from = |p: [f64; 2]| [p[0] - point[0], p[1] - point[1]];
    let extent = |c: [f64; 2]| c[0].abs().max(c[1].abs());
    let size = ring.iter().map(|quad| extent(from(centre(quad)))).fold(0.0, f64::max);
    let mut all: Vec<Neighbour> =
        ring.iter().map(|quad| Neighbour { quad: *quad, centre: from(centre(quad)), turned: 1.0 }).collect();
    let options = |d: usize| std::iter::once(None).chain(planes[d].iter().copied().map(Some));
    for mirrors in options(0).flat_map(|x| options(1).map(move |y| [x, y])) {
        let turned: f64 = mirrors.iter().flatten().map(|_| -1.0).product();
        if mirrors == [None; 2] {
            continue;
        }
        let image = |quad: &usize| {
            let c = centre(quad);
            let c = from(std::array::from_fn(|d| mirrors[d].map_or(c[d], |plane| 2.0 * plane - c[d])));
            Neighbour { quad: *quad, centre: c, turned }
        };
        all.extend(ring.iter().map(image).filter(|image| extent(image.centre) <= size * (1.0 + 1e-9)));
    }
    all
}
