//! Averaging windows: what a cell's stress is the mean of.
//!
//! A mean over the cell itself falls with the cell, and with it every onset time; over a window of fixed size it does
//! not.

use crate::plates::mesh::PlaneMesh;

/// The cells that a square window of side `side`, centred on each cell and parallel to the axes, overlaps, with their
/// shares of the overlapped area. At an edge the window is cut off with the plate, where regions of different plies meet with
/// the cell's own `region`.
///
/// A cell larger than the window is its own mean.
pub fn square(mesh: &PlaneMesh, side: f64, region: impl Fn(usize) -> usize) -> Vec<Vec<(usize, f64)>> {
    let n = mesh.quads.len();
    let centres: Vec<[f64; 2]> = (0..n).map(|q| mesh.corners(q).centroid()).collect();
    let (low, _) = mesh.bounds();
    // Bins about as large as window or cell, whichever is larger, so that either touches few of them.
    let pitch = side.max((mesh.area() / n as f64).sqrt());
    let bin = |p: [f64; 2]| -> [i64; 2] { std::array::from_fn(|d| ((p[d] - low[d]) / pitch).floor() as i64) };
    // Cells by the bins that their bounding boxes touch.
    let mut bins: Vec<([i64; 2], usize)> = Vec::new();
    for q in 0..n {
        let p = mesh.corners(q);
        let corner = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 2] {
            std::array::from_fn(|d| p.iter().fold(start, |m, p| pick(m, p[d])))
        };
        let (from, to) = (bin(corner(f64::min, f64::INFINITY)), bin(corner(f64::max, f64::NEG_INFINITY)));
        for i in from[0]..=to[0] {
            for j in from[1]..=to[1] {
                bins.push(([i, j], q));
            }
        }
    }
    bins.sort_unstable();
    let mut near = Vec::new();
    (0..n)
        .map(|q| {
            if mesh.quality(q).area >= side * side {
                return vec![(q, 1.0)];
            }
            let c = centres[q];
            let half = 0.5 * side;
            let (from, to) = (bin([c[0] - half, c[1] - half]), bin([c[0] + half, c[1] + half]));
            near.clear();
            for i in from[0]..=to[0] {
                for j in from[1]..=to[1] {
                    let first = bins.partition_point(|b| b.0 < [i, j]);
                    near.extend(bins[first..].iter().take_while(|b| b.0 == [i, j]).map(|b| b.1));
                }
            }
            near.retain(|other| region(*other) == region(q));
            near.sort_unstable();
            near.dedup();
            let mut shares: Vec<(usize, f64)> = near.iter().map(|o| (*o, mesh.corners(*o).overlap(c, half))).collect();
            let total: f64 = shares.iter().map(|s| s.1).sum();
            shares.retain(|s| s.1 > 1e-12 * total);
            shares.iter_mut().for_each(|s| s.1 /= total);
            shares
        })
        .collect()
}

/// Each cell is its own mean.
pub fn own(mesh: &PlaneMesh) -> Vec<Vec<(usize, f64)>> {
    (0..mesh.quads.len()).map(|q| vec![(q, 1.0)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize, h: f64) -> PlaneMesh {
        let mut mesh = PlaneMesh::default();
        for j in 0..=n {
            for i in 0..=n {
                mesh.points.push([i as f64 * h, j as f64 * h]);
            }
        }
        for j in 0..n {
            for i in 0..n {
                let a = (j * (n + 1) + i) as u32;
                mesh.quads.push([a, a + 1, a + n as u32 + 2, a + n as u32 + 1].into());
            }
        }
        mesh
    }

    #[test]
    fn shares_are_areas() {
        let windows = square(&grid(9, 1.0), 2.0, |_| 0);
        // Centre cell whole, four sides half, four corners a quarter, of four.
        let middle = &windows[4 * 9 + 4];
        assert_eq!(middle.len(), 9);
        for (q, share) in middle {
            let (i, j) = ((q % 9) as i64 - 4, (q / 9) as i64 - 4);
            let want = [1.0, 0.5, 0.25][(i.abs() + j.abs()) as usize] / 4.0;
            assert!((share - want).abs() < 1e-14);
        }
        // A corner cell: the window is cut off with the plate.
        assert_eq!(windows[0].len(), 4);
        assert!((windows[0].iter().map(|s| s.1).sum::<f64>() - 1.0).abs() < 1e-14);
        assert_eq!(square(&grid(3, 1.0), 0.5, |_| 0)[4], vec![(4, 1.0)]);
    }

    #[test]
    fn windows_end_where_regions_meet() {
        // Two columns of cells on the left are a region: of the cell beside the border the window keeps its own side.
        let windows = square(&grid(4, 1.0), 3.0, |q| usize::from(q % 4 < 2));
        let cells: Vec<usize> = windows[5].iter().map(|share| share.0).collect();
        assert_eq!(cells, [0, 1, 4, 5, 8, 9]);
        assert!(windows[5].iter().all(|(_, share)| (share - 1.0 / 6.0).abs() < 1e-14));
    }

    #[test]
    fn windows_of_any_size() {
        let mesh = grid(9, 1.0);
        for side in [1e-300, 1e-9, 0.01] {
            assert_eq!(square(&mesh, side, |_| 0), own(&mesh), "{side}");
        }
        for side in [20.0, 1e7, 1e300] {
            let windows = square(&mesh, side, |_| 0);
            for window in windows {
                assert_eq!(window.len(), 81, "{side}");
                assert!(window.iter().all(|(_, share)| (share - 1.0 / 81.0).abs() < 1e-12), "{side}: {window:?}");
            }
        }
    }
}
