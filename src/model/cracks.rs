//! How far a crack goes through the cells of a plate.

use fem_core::plate::Plate;
use std::collections::BTreeSet;

/// Side of a square over that of an equilateral triangle of the same area.
const OF_TRIANGLE: f64 = 0.658;

/// How far a crack goes through a cell, m: of a section along x, elsewhere the side of a square as large.
pub(super) fn cell_length(plate: &Plate, quad: usize) -> f64 {
    if plate.info().is_section() {
        let [low, high] = extremes(plate, quad);
        return high[0] - low[0];
    }
    plate.plane.quality(quad).area.sqrt()
}

/// Edge of a square as large as a cell is on average, m; of a section, a cell's mean length.
pub(crate) fn mean_cell(plate: &Plate) -> f64 {
    let (plane, cells) = (&plate.plane, plate.plane.quads.len() as f64);
    let (low, high) = plane.bounds();
    if plate.info().is_section() { (high[0] - low[0]) / cells } else { (plane.area() / cells).sqrt() }
}

/// Least and greatest x and y of a cell, m.
pub(super) fn extremes(plate: &Plate, quad: usize) -> [[f64; 2]; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in plate.plane.corners(quad) {
        low = [0, 1].map(|d| low[d].min(p[d]));
        high = [0, 1].map(|d| high[d].max(p[d]));
    }
    [low, high]
}

/// How far a crack may go through a cell that is longer than it is wide.
pub(super) struct CrackRuns<'a> {
    plate: &'a Plate,
    /// Sides at which the plate ends.
    ends: BTreeSet<[u32; 2]>,
}

impl<'a> CrackRuns<'a> {
    pub(super) fn new(plate: &'a Plate) -> Self {
        Self { plate, ends: plate.plane.boundary().into_iter().map(undirected).collect() }
    }

    /// The longer way through a cell, m, but none from one edge of the plate to the other: no front runs across a strip that is one
    /// cell wide.
    pub(super) fn through(&self, quad: usize) -> f64 {
        let plane = &self.plate.plane;
        let corners = plane.corners(quad);
        if self.plate.info().is_section() {
            return cell_length(self.plate, quad);
        }
        if corners.len() != 4 {
            return OF_TRIANGLE * corners.sides().map(apart).fold(0.0, f64::max);
        }
        let sides: Vec<[u32; 2]> = plane.quads[quad].sides().map(undirected).collect();
        let middles: Vec<[f64; 2]> = corners.sides().map(|[p, q]| [0, 1].map(|d| 0.5 * (p[d] + q[d]))).collect();
        let is_free = |k: &usize| !(self.ends.contains(&sides[*k]) && self.ends.contains(&sides[*k + 2]));
        let ways = [0, 1].into_iter().filter(is_free).map(|k| apart([middles[k], middles[k + 2]]));
        ways.reduce(f64::max).unwrap_or_else(|| cell_length(self.plate, quad))
    }
}

fn undirected([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn apart([p, q]: [[f64; 2]; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}
