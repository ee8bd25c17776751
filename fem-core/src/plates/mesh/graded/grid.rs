//! Rectangles as grids of lines along the axes.

use super::{MAX_CELLS, PlaneMesh, edges, node};
use crate::contracts::plugin::ParamError;

/// Length of a cell over that of its neighbour nearer to the impact.
const GROWTH: f64 = 1.2;

/// Ascending lines across a side about 0, one of them at the impact, with cells of `size` beside it.
pub(super) fn lines(side: f64, impact: f64, size: f64, edge_size: f64) -> Result<Vec<f64>, ParamError> {
    let half = 0.5 * side;
    let mut lines: Vec<f64> = parts(half + impact, size, edge_size)?.into_iter().rev().map(|d| impact - d).collect();
    lines.push(impact);
    lines.extend(parts(half - impact, size, edge_size)?.into_iter().map(|d| impact + d));
    // The ends are those of the plate, whatever the last bit of a sum says.
    lines[0] = -half;
    if let Some(last) = lines.last_mut() {
        *last = half;
    }
    Ok(lines)
}

/// Distances of lines from the impact, up to `length`.
fn parts(length: f64, size: f64, edge_size: f64) -> Result<Vec<f64>, ParamError> {
    if !(length / edge_size <= MAX_CELLS as f64) {
        return Err(ParamError::new(
            "edge_size",
            format!("makes more than {MAX_CELLS} cells along a side: enlarge it"),
        ));
    }
    let (mut distances, mut distance, mut cell) = (Vec::new(), 0.0, size);
    while distance < length * (1.0 - 1e-9) {
        distance += cell;
        distances.push(distance);
        cell = (GROWTH * cell).min(edge_size);
    }
    distances.iter_mut().for_each(|d| *d *= length / distance);
    Ok(distances)
}

pub(super) fn mesh(x: &[f64], y: &[f64], impact: [f64; 2]) -> PlaneMesh {
    let mut mesh = PlaneMesh::rectangle(x, y);
    let sides = ["x-min", "x-max", "y-min", "y-max"].iter().filter_map(|side| mesh.groups.get(*side));
    let edge = edges(sides.flat_map(|group| group.edges.iter().copied()).collect());
    let at = |lines: &[f64], value: f64| lines.partition_point(|line| *line < value);
    let struck = node((at(y, impact[1]) * x.len() + at(x, impact[0])) as u32);
    mesh.groups.extend([("edge".to_owned(), edge), ("impact".to_owned(), struck)]);
    mesh
}
