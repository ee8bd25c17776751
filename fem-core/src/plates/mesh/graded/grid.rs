//! Rectangles as grids of lines along the axes.

use super::{MAX_CELLS, PlaneMesh, edges, node};
use crate::contracts::plugin::ParamError;

/// Length of a cell over that of its neighbour nearer to the impact.
const GROWTH: f64 = 1.2;

/// Ascending lines across a side about 0, one of them at the impact and one at each side of a window, with cells of the first of `sizes`
/// beside the impact and of at most the second along the edge.
pub(super) fn lines(side: f64, window: Option<f64>, impact: f64, sizes: [f64; 2]) -> Result<Vec<f64>, ParamError> {
    let half = 0.5 * side;
    let ends = |sign: f64| {
        let ends =
            window.into_iter().map(|window| 0.5 * window).chain([half]).chain(window.map(|window| -0.5 * window));
        let mut ends: Vec<f64> = ends.map(|end| end - sign * impact).filter(|end| *end > 0.0).collect();
        ends.sort_by(f64::total_cmp);
        ends
    };
    let mut lines: Vec<f64> = parts(&ends(-1.0), sizes)?.into_iter().rev().map(|d| impact - d).collect();
    lines.push(impact);
    lines.extend(parts(&ends(1.0), sizes)?.into_iter().map(|d| impact + d));
    // Ends and window are where they should be, whatever the last bit of a sum says.
    for wanted in [-half, half].into_iter().chain(window.into_iter().flat_map(|w| [-0.5 * w, 0.5 * w])) {
        if let Some(line) = lines.iter_mut().find(|line| (**line - wanted).abs() < SAME * side) {
            *line = wanted;
        }
    }
    Ok(lines)
}

/// Distance of two lines that are one, over the side.
const SAME: f64 = 1e-9;

/// Distances of lines from the impact up to the last of `ends`, ascending, all of which are among them.
fn parts(ends: &[f64], [size, edge_size]: [f64; 2]) -> Result<Vec<f64>, ParamError> {
    let (mut distances, mut from, mut cell) = (Vec::new(), 0.0, size);
    for end in ends {
        let length = end - from;
        if !(length / edge_size <= MAX_CELLS as f64) {
            return Err(ParamError::new(
                "edge_size",
                format!("makes more than {MAX_CELLS} cells along a side: enlarge it"),
            ));
        }
        let (first, mut distance) = (distances.len(), 0.0);
        while distance < length * (1.0 - SAME) {
            distance += cell;
            distances.push(distance);
            cell = (GROWTH * cell).min(edge_size);
        }
        distances[first..].iter_mut().for_each(|d| *d = from + *d * (length / distance));
        from = *end;
    }
    Ok(distances)
}

pub(super) fn mesh(x: &[f64], y: &[f64], impact: [f64; 2], window: Option<[f64; 2]>) -> PlaneMesh {
    let mut mesh = PlaneMesh::rectangle(x, y);
    let sides = ["x-min", "x-max", "y-min", "y-max"].iter().filter_map(|side| mesh.groups.get(*side));
    let edge = edges(sides.flat_map(|group| group.edges.iter().copied()).collect());
    let at = |lines: &[f64], value: f64| lines.partition_point(|line| *line < value);
    let struck = node((at(y, impact[1]) * x.len() + at(x, impact[0])) as u32);
    if let Some(window) = window {
        let ends = |lines: &[f64], length: f64| [at(lines, -0.5 * length), at(lines, 0.5 * length)];
        let (i, j) = (ends(x, window[0]), ends(y, window[1]));
        let node = |i: usize, j: usize| (j * x.len() + i) as u32;
        let along = (i[0]..i[1]).flat_map(|k| j.map(|j| [node(k, j), node(k + 1, j)]));
        let across = (j[0]..j[1]).flat_map(|k| i.map(|i| [node(i, k), node(i, k + 1)]));
        mesh.groups.insert("window".to_owned(), edges(along.chain(across).collect()));
    }
    mesh.groups.extend([("edge".to_owned(), edge), ("impact".to_owned(), struck)]);
    mesh
}
