//! Points of a plate, and displacements there.

use crate::model::Model;
use fem_core::domain::{Corners, Domain};
use fem_core::element::form;
use std::collections::HashMap;

/// A height in the thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Height {
    /// Layer of cells, counted from the bottom of the region.
    pub(super) layer: usize,
    /// Natural coordinate in its cells.
    pub(super) q: f64,
}

/// Points over quads, columns of them at the heights of a region; quads that meet share theirs where their heights are the same.
#[derive(Debug)]
pub(super) struct Lattice<'a> {
    model: &'a Model,
    intervals: usize,
    columns: Vec<Column>,
    /// Of each region; its points in a column are those of the first region with the same.
    heights: Vec<Vec<Height>>,
    /// Number of points.
    points: usize,
    /// Columns of each quad, one after the other, in the order of the domain's lattice.
    of_quads: Vec<u32>,
    /// Shape of each quad, and where its columns begin.
    starts: Vec<(Domain, usize)>,
    /// Shape functions at all points, unless there are too many.
    kept: Option<Rows>,
}

/// Points one above the other.
#[derive(Debug, Clone, Copy)]
struct Column {
    quad: usize,
    /// Natural coordinates in it.
    place: [f64; 2],
    /// Number of the lowest point.
    first: usize,
}

/// Most bytes of shape functions that are kept; beyond it they are found anew for every frame.
const LIMIT: usize = 128 << 20;

/// Three rows for each of some points: the unknowns of the plate that a component of the displacement hangs on, with
/// their factors.
#[derive(Debug, Default)]
struct Rows {
    entries: Vec<(u32, f64)>,
    ends: Vec<usize>,
}

impl Rows {
    fn clear(&mut self) {
        self.entries.clear();
        self.ends.clear();
    }

    /// Row by row for all fields, because the rows are what memory is slow to give.
    fn apply(&self, fields: &[&[f64]], all: &mut [Vec<f64>]) {
        let mut start = 0;
        for end in &self.ends {
            let row = &self.entries[start..*end];
            for (field, out) in fields.iter().zip(&mut *all) {
                out.push(row.iter().map(|(dof, n)| n * field[*dof as usize]).sum());
            }
            start = *end;
        }
    }
}

impl<'a> Lattice<'a> {
    /// The points at the ends of `intervals` equal parts of the sides of `quads`, at heights that hang on the region.
    pub(super) fn new(
        model: &'a Model,
        quads: &[usize],
        intervals: usize,
        heights: impl Fn(usize) -> Vec<Height>,
    ) -> Self {
        let (n, plane, plate) = (intervals, &model.plate.plane, &model.plate);
        let heights: Vec<Vec<Height>> = (0..plate.regions()).map(heights).collect();
        // Points of the plate are shared as well only where they are at one place.
        let alike = |a: usize, b: usize| heights[a] == heights[b] && plate.same_heights(a, b);
        let kinds: Vec<usize> = (0..heights.len())
            .map(|region| (0..region).find(|other| alike(region, *other)).unwrap_or(region))
            .collect();
        let points = [Domain::Quadrilateral, Domain::Triangle].map(|domain| domain.lattice(n));
        let mut numbers: HashMap<(usize, [u32; 3]), u32> = HashMap::new();
        let (mut columns, mut of_quads, mut starts) = (Vec::new(), Vec::new(), Vec::new());
        let mut points_so_far = 0;
        for quad in quads {
            let kind = kinds[plate.region(*quad)];
            let domain = plane.quads[*quad].domain();
            starts.push((domain, of_quads.len()));
            for point in &points[usize::from(domain == Domain::Triangle)] {
                let place = point.map(|i| 2.0 * i as f64 / n as f64 - 1.0);
                let mut new = |columns: &mut Vec<_>| {
                    columns.push(Column { quad: *quad, place, first: points_so_far });
                    points_so_far += heights[kind].len();
                    columns.len() as u32 - 1
                };
                of_quads.push(match shared(plane.quads[*quad], *point, n) {
                    Some(key) => *numbers.entry((kind, key)).or_insert_with(|| new(&mut columns)),
                    None => new(&mut columns),
                });
            }
        }
        let points = points_so_far;
        let mut lattice = Self { model, intervals, columns, heights, points, of_quads, starts, kept: None };
        if lattice.len() * model.plate.info().ndof() * size_of::<(u32, f64)>() <= LIMIT {
            let mut rows = Rows::default();
            (0..lattice.columns.len()).for_each(|column| lattice.shapes(column, &mut rows));
            lattice.kept = Some(rows);
        }
        lattice
    }

    /// Number of quads.
    pub(super) fn quads(&self) -> usize {
        self.starts.len()
    }

    /// Shape of the `quad`-th quad.
    pub(super) fn domain(&self, quad: usize) -> Domain {
        self.starts[quad].0
    }

    /// Parts of a side of a quad.
    pub(super) fn intervals(&self) -> usize {
        self.intervals
    }

    /// Number of points.
    pub(super) fn len(&self) -> usize {
        self.points
    }

    /// The point of the lattice on the `quad`-th quad and at a height.
    pub(super) fn point(&self, quad: usize, point: [usize; 2], height: usize) -> u32 {
        let (domain, start) = self.starts[quad];
        let column = self.of_quads[start + domain.lattice_number(self.intervals, point)] as usize;
        (self.columns[column].first + height) as u32
    }

    /// Positions, m.
    pub(super) fn positions(&self) -> Vec<[f64; 3]> {
        let plate = &self.model.plate;
        let at = |&Column { quad, place: [r, s], .. }: &Column, height: &Height| {
            plate.cell(plate.cell_over(quad, height.layer)).position([r, s, height.q])
        };
        let over = |column| self.heights_of(column).iter().map(move |height| at(column, height));
        self.columns.iter().flat_map(over).collect()
    }

    fn heights_of(&self, column: &Column) -> &[Height] {
        &self.heights[self.model.plate.region(column.quad)]
    }

    /// Three components of each of `fields`, given in the unknowns of the plate, at every point.
    pub(super) fn values(&self, fields: &[&[f64]]) -> Vec<Vec<f64>> {
        let mut all: Vec<Vec<f64>> = fields.iter().map(|_| Vec::with_capacity(3 * self.len())).collect();
        match &self.kept {
            Some(rows) => rows.apply(fields, &mut all),
            None => {
                let mut rows = Rows::default();
                for column in 0..self.columns.len() {
                    rows.clear();
                    self.shapes(column, &mut rows);
                    rows.apply(fields, &mut all);
                }
            }
        }
        all
    }

    /// Adds the rows of the points of a column.
    fn shapes(&self, column: usize, rows: &mut Rows) {
        let Model { plate, element, .. } = self.model;
        let Column { quad, place: [r, s], .. } = self.columns[column];
        let element = form(&**element, plate.plane.quads[quad].domain());
        let (mut dofs, mut shape) = (Vec::new(), vec![0.0; 3 * element.info().ndof()]);
        for of_layer in self.heights_of(&self.columns[column]).chunk_by(|a, b| a.layer == b.layer) {
            let number = plate.cell_over(quad, of_layer[0].layer);
            let cell = plate.cell(number);
            plate.cell_dofs(number, &mut dofs);
            for height in of_layer {
                element.shape(&cell, [r, s, height.q], &mut shape);
                for component in 0..3 {
                    let row = dofs.iter().zip(shape.chunks_exact(3)).map(|(dof, n)| (*dof as u32, n[component]));
                    rows.entries.extend(row.filter(|(_, n)| *n != 0.0));
                    rows.ends.push(rows.entries.len());
                }
            }
        }
    }
}

/// What names a point that a quad shares with others: its vertex, or the ends of its side and how far it is from the
/// first.
fn shared(quad: Corners<u32>, point: [usize; 2], n: usize) -> Option<[u32; 3]> {
    let ([a, b], from_a) = quad.domain().lattice_side(n, point)?;
    let (a, b, from_a, from_b) = (quad[a], quad[b], from_a as u32, (n - from_a) as u32);
    Some(match (from_a, from_b) {
        (0, _) => [a, a, 0],
        (_, 0) => [b, b, 0],
        _ if a < b => [a, b, from_a],
        _ => [b, a, from_b],
    })
}
