//! Cells of the elements with what their nodes do.

use super::lattice::{Height, Lattice};
use super::{Frame, State};
use crate::error::Error;
use crate::model::{FieldPlan, Model};
use fem_core::domain::Domain;
use fem_io::scene::{FieldCells, FieldSeries};
use fem_io::vtu::{Array, Contents, Grid, Shape, lagrange_hexahedron, quadratic_wedge};

/// Cells of a file over one of the plate, each by its points (i, j, k).
type Cells = (Shape, Vec<Vec<[usize; 3]>>);

/// Parts of a side of a cell: what no displacement of an element exceeds along it; where all cells are triangles, curved ones are of
/// second order.
fn order_of(quads: impl Iterator<Item = Domain>) -> usize {
    if quads.into_iter().all(|domain| domain == Domain::Triangle) { 2 } else { 3 }
}

fn cells_of(domain: Domain, order: usize, cells: FieldCells) -> Cells {
    match (domain, cells) {
        (Domain::Quadrilateral, FieldCells::Lagrange) => (Shape::Lagrange(order), vec![lagrange_hexahedron(order)]),
        (Domain::Quadrilateral, FieldCells::Subdivided) => (Shape::Hexahedron, linear(domain, order)),
        (Domain::Triangle, FieldCells::Lagrange) if order == 2 => (Shape::QuadraticWedge, vec![quadratic_wedge()]),
        (Domain::Triangle, _) => (Shape::Wedge, linear(domain, order)),
    }
}

/// The series `plate`.
#[derive(Debug)]
pub(super) struct Plate<'a> {
    lattice: Lattice<'a>,
    pub(super) grid: Grid,
    pub(super) fixed: [Array; 2],
}

impl<'a> Plate<'a> {
    pub(super) fn new(model: &'a Model, plan: &FieldPlan) -> Self {
        let order = order_of(plan.quads.iter().map(|quad| model.plate.plane.quads[*quad].domain()));
        let of = [Domain::Quadrilateral, Domain::Triangle].map(|domain| cells_of(domain, order, plan.cells));
        let heights = |region: usize| {
            let stacks = model.plate.stacks(region);
            let height = |level: usize| {
                let layer = level.saturating_sub(1) / order;
                let q = 2.0 * (level - order * layer) as f64 / order as f64 - 1.0;
                let [low, high] = stacks[layer].extent();
                Height { layer, q: 0.5 * (low + high) + 0.5 * (high - low) * q }
            };
            (0..=order * stacks.len()).map(height).collect()
        };
        let lattice = Lattice::new(model, &plan.quads, order, heights);
        let layers = |quad: usize| model.plate.layers_over(plan.quads[quad]);
        let of_plate = || (0..plan.quads.len()).flat_map(|quad| (0..layers(quad)).map(move |layer| (quad, layer)));
        let cells = |quad: usize| &of[usize::from(lattice.domain(quad) == Domain::Triangle)];
        let point = |quad: usize, layer: usize, [i, j, k]: [usize; 3]| lattice.point(quad, [i, j], order * layer + k);
        let (mut points, mut shapes) = (Vec::new(), Vec::new());
        for (quad, layer) in of_plate() {
            let (shape, cells) = cells(quad);
            shapes.extend(cells.iter().map(|_| *shape));
            points.extend(cells.iter().flatten().map(|ijk| point(quad, layer, *ijk)));
        }
        let each = |value: &dyn Fn(usize, usize) -> i64| -> Vec<i64> {
            of_plate()
                .flat_map(|(quad, layer)| cells(quad).1.iter().map(move |_| (quad, layer)))
                .map(|(q, l)| value(q, l))
                .collect()
        };
        let tags = each(&|quad, _| model.plate.plane.quad_tags[plan.quads[quad]] as i64);
        let numbers = each(&|_, layer| layer as i64 + 1);
        let fixed =
            [("cell", tags), ("layer", numbers)].map(|(name, values)| Array::integers(name, values.into_iter()));
        Self { grid: Grid::new(&lattice.positions(), &shapes, &points), lattice, fixed }
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

/// Linear cells between the points of a cell.
fn linear(domain: Domain, order: usize) -> Vec<Vec<[usize; 3]>> {
    let mut all = Vec::new();
    for k in 0..order {
        for cell in domain.lattice_cells(order) {
            let face = |k: usize| cell.into_iter().map(move |[i, j]| [i, j, k]);
            all.push(face(k).chain(face(k + 1)).collect());
        }
    }
    all
}
