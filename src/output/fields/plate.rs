//! Cells of the elements with what their nodes do.

use super::lattice::{Height, Lattice};
use super::{Frame, State};
use crate::error::Error;
use crate::model::{FieldPlan, Model};
use fem_io::scene::{FieldCells, FieldSeries};
use fem_io::vtu::{Array, Contents, Grid, Shape, lagrange_hexahedron};

/// Order of the cells: displacements of no element are of a higher degree in a natural coordinate.
const ORDER: usize = 3;

const CORNERS: [[usize; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];

/// The series `plate`.
#[derive(Debug)]
pub(super) struct Plate<'a> {
    lattice: Lattice<'a>,
    pub(super) grid: Grid,
    pub(super) fixed: [Array; 2],
}

impl<'a> Plate<'a> {
    pub(super) fn new(model: &'a Model, plan: &FieldPlan) -> Self {
        let layers = model.plate.layers();
        let heights = (0..=ORDER * layers).map(|level| {
            let layer = level.saturating_sub(1) / ORDER;
            Height { layer, q: 2.0 * (level - ORDER * layer) as f64 / ORDER as f64 - 1.0 }
        });
        let lattice = Lattice::new(model, &plan.quads, ORDER, heights.collect());
        // Points (i, j, k) of each cell of the file within one of the plate.
        let (shape, cells) = match plan.cells {
            FieldCells::Lagrange => (Shape::Lagrange(ORDER), vec![lagrange_hexahedron(ORDER)]),
            FieldCells::Subdivided => (Shape::Hexahedron, hexahedra()),
        };
        let of_plate = || (0..plan.quads.len()).flat_map(|quad| (0..layers).map(move |layer| (quad, layer)));
        let point = |quad: usize, layer: usize, [i, j, k]: [usize; 3]| lattice.point(quad, [i, j], ORDER * layer + k);
        let mut points = Vec::new();
        for (quad, layer) in of_plate() {
            points.extend(cells.iter().flatten().map(|ijk| point(quad, layer, *ijk)));
        }
        let each = |value: &dyn Fn(usize, usize) -> i64| -> Vec<i64> {
            of_plate()
                .flat_map(|(quad, layer)| cells.iter().map(move |_| (quad, layer)))
                .map(|(q, l)| value(q, l))
                .collect()
        };
        let tags = each(&|quad, _| model.plate.plane.quad_tags[plan.quads[quad]] as i64);
        let numbers = each(&|_, layer| layer as i64 + 1);
        let fixed =
            [("cell", tags), ("layer", numbers)].map(|(name, values)| Array::integers(name, values.into_iter()));
        Self { grid: Grid::new(&lattice.positions(), shape, &points), lattice, fixed }
    }

    /// What the values of a frame take, bytes.
    pub(super) fn bytes_of_frame(&self) -> usize {
        2 * 3 * self.lattice.len() * size_of::<f64>()
    }

    pub(super) fn write(&self, frames: &[Frame<'_>]) -> Result<(), Error> {
        let fields_of = |frame: &Frame<'_>| frame.state.velocities.map_or(1, |_| 2);
        let fields: Vec<&[f64]> = frames
            .iter()
            .flat_map(|Frame { state: State { displacements, velocities, .. }, .. }| {
                [*displacements].into_iter().chain(*velocities)
            })
            .collect();
        let values = self.lattice.values(&fields);
        let mut values = values.iter();
        for frame in frames {
            let named = ["displacement", "velocity"].into_iter().zip(values.by_ref().take(fields_of(frame)));
            let points: Vec<Array> = named.map(|(name, values)| Array::reals(name, 3, values)).collect();
            let contents = Contents { points: &points, fixed: &self.fixed, ..Contents::default() };
            frame.write(FieldSeries::Plate, &self.grid, contents)?;
        }
        Ok(())
    }
}

/// Linear hexahedra between the points of a cell.
fn hexahedra() -> Vec<Vec<[usize; 3]>> {
    let mut all = Vec::new();
    for k in 0..ORDER {
        for j in 0..ORDER {
            for i in 0..ORDER {
                let face = |k: usize| CORNERS.map(|[a, b]| [i + a, j + b, k]);
                all.push([face(k), face(k + 1)].concat());
            }
        }
    }
    all
}
