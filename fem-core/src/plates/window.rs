//! Averaging windows: what a stress is the mean of.
//!
//! A mean over the cell itself falls with the cell, and with it every onset time; over a window of fixed size it does
//! not. Nor does one that is centred at a place of the plate, and not of its cells.

use crate::plates::mesh::PlaneMesh;
use crate::words::domain::Corners;

/// Whose strains are taken: those of a cell, or at one of its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Source {
    /// The cell.
    pub quad: usize,
    /// Which of [`Domain::samples`](crate::words::domain::Domain::samples); the mean over the whole cell without.
    pub sample: Option<usize>,
}

/// Where a window lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Centre {
    /// The cell that holds it.
    pub quad: usize,
    /// Its position, m.
    pub at: [f64; 2],
}

/// A mean of strains.
#[derive(Debug, Clone, PartialEq)]
pub struct Mean {
    /// Where it lies.
    pub centre: Centre,
    /// What is averaged, with shares that add up to 1.
    pub shares: Vec<(Source, f64)>,
}

/// Overlap with a cell that is no more than rounding, and share of a cell's area that is all of it but rounding.
const NOTHING: f64 = 1e-12;

/// How near a cell must be to hold a point, of the side.
const NEAR: f64 = 1e-6;

/// Windows of a mesh: squares of side `side` whose sides lie along two directions. At an edge a window is cut off with the plate,
/// where regions of different plies meet with the region of the cell that holds its centre.
#[derive(Debug)]
pub struct Windows<R> {
    /// The cells as seen in axes along the sides.
    cells: Vec<Corners<[f64; 2]>>,
    /// Cosine and sine of the angle of these axes.
    axes: [f64; 2],
    side: f64,
    region: R,
    low: [f64; 2],
    /// As large as window or cell, whichever is larger, so that either touches few of them.
    pitch: f64,
    /// Cells by the bins that their bounding boxes touch.
    bins: Vec<([i64; 2], usize)>,
}

impl<R: Fn(usize) -> usize> Windows<R> {
    /// Squares of `side` (m) on `mesh`, turned by `angle` (radians, from x towards y); cells lie in regions by number.
    pub fn new(mesh: &PlaneMesh, (side, angle): (f64, f64), region: R) -> Self {
        let axes = [angle.cos(), angle.sin()];
        let quads = 0..mesh.quads.len();
        let cells: Vec<_> = quads.map(|quad| mesh.corners(quad).map(|p| seen(axes, p))).collect();
        let area: f64 = cells.iter().map(Corners::area).sum();
        let corners = cells.iter().flat_map(|cell| cell.iter());
        let low = corners.fold([f64::INFINITY; 2], |low, p| [low[0].min(p[0]), low[1].min(p[1])]);
        let pitch = side.max((area / cells.len() as f64).sqrt());
        let mut windows = Self { cells, axes, side, region, low, pitch, bins: Vec::new() };
        for (quad, p) in windows.cells.iter().enumerate() {
            let corner = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 2] {
                std::array::from_fn(|d| p.iter().fold(start, |m, p| pick(m, p[d])))
            };
            let (from, to) =
                (windows.bin(corner(f64::min, f64::INFINITY)), windows.bin(corner(f64::max, f64::NEG_INFINITY)));
            for i in from[0]..=to[0] {
                for j in from[1]..=to[1] {
                    windows.bins.push(([i, j], quad));
                }
            }
        }
        windows.bins.sort_unstable();
        windows
    }

    fn bin(&self, p: [f64; 2]) -> [i64; 2] {
        std::array::from_fn(|d| ((p[d] - self.low[d]) / self.pitch).floor() as i64)
    }

    /// Cells that may reach into the square |x − c| ≤ half, ascending.
    fn near(&self, c: [f64; 2], half: f64) -> Vec<usize> {
        let (from, to) = (self.bin([c[0] - half, c[1] - half]), self.bin([c[0] + half, c[1] + half]));
        let mut near = Vec::new();
        for i in from[0]..=to[0] {
            for j in from[1]..=to[1] {
                let first = self.bins.partition_point(|b| b.0 < [i, j]);
                near.extend(self.bins[first..].iter().take_while(|b| b.0 == [i, j]).map(|b| b.1));
            }
        }
        near.sort_unstable();
        near.dedup();
        near
    }

    /// The window around the centre of a cell, of whole cells weighted with the areas of the overlap. A cell larger than the window
    /// is its own mean.
    pub fn of_cell(&self, quad: usize) -> Mean {
        let corners = &self.cells[quad];
        let at = corners.centroid();
        if corners.area() >= self.side * self.side {
            return Mean { centre: self.centre(quad, at), shares: vec![(Source { quad, sample: None }, 1.0)] };
        }
        self.over(quad, at, |quad, half| vec![(Source { quad, sample: None }, self.cells[quad].overlap(at, half))])
    }

    /// The window around any place: of cells that lie within it as a whole, and of the samples of others, linear between these. What
    /// it says does not hang on how it lies to the cells.
    pub fn around(&self, centre: Centre) -> Mean {
        let at = seen(self.axes, centre.at);
        self.over(centre.quad, at, |quad, half| {
            let corners = &self.cells[quad];
            let samples = corners.overlap_of_samples(at, half);
            let overlap: f64 = samples.iter().sum();
            if overlap > (1.0 - NOTHING) * corners.area() {
                return vec![(Source { quad, sample: None }, overlap)];
            }
            let each = samples.iter().enumerate();
            each.map(|(k, area)| (Source { quad, sample: Some(k) }, *area)).collect()
        })
    }

    fn centre(&self, quad: usize, at: [f64; 2]) -> Centre {
        Centre { quad, at: seen([self.axes[0], -self.axes[1]], at) }
    }

    /// The mean over a window around `at`, which cell `quad` holds; its shares in each cell are areas.
    fn over(&self, quad: usize, at: [f64; 2], areas: impl Fn(usize, f64) -> Vec<(Source, f64)>) -> Mean {
        let (half, own) = (0.5 * self.side, (self.region)(quad));
        let cells = self.near(at, half).into_iter().filter(|quad| (self.region)(*quad) == own);
        let mut shares: Vec<(Source, f64)> = cells.flat_map(|quad| areas(quad, half)).collect();
        let total: f64 = shares.iter().map(|s| s.1).sum();
        shares.retain(|s| s.1.abs() > NOTHING * total);
        shares.iter_mut().for_each(|s| s.1 /= total);
        Mean { centre: self.centre(quad, at), shares }
    }

    /// Centres around a place that hang on nothing but it: on a square lattice of a quarter of the side within a side of `place`, of
    /// half of it within `reach` sides; each with all cells that hold it. Those in none of the cells that are `kept` are left out, and a
    /// centre names the first of these.
    pub fn lattice(&self, place: [f64; 2], reach: f64, kept: impl Fn(usize) -> bool) -> Vec<(Centre, Vec<usize>)> {
        let pitch = 0.25 * self.side;
        let n = (4.0 * reach) as i64;
        let all = (-n..=n).flat_map(|i| (-n..=n).map(move |j| [i, j]));
        let chosen = all.filter(|[i, j]| {
            let distance = (*i as f64).hypot(*j as f64);
            distance <= 4.0 || (distance <= 4.0 * reach && i % 2 == 0 && j % 2 == 0)
        });
        let place = seen(self.axes, place);
        let at = |[i, j]: [i64; 2]| [place[0] + i as f64 * pitch, place[1] + j as f64 * pitch];
        let hold = |at: [f64; 2]| {
            let mut holding = self.near(at, NEAR * self.side);
            holding.retain(|quad| self.cells[*quad].locate(at).is_some());
            holding.iter().copied().find(|quad| kept(*quad)).map(|quad| (self.centre(quad, at), holding))
        };
        chosen.map(at).filter_map(hold).collect()
    }
}

/// A position in axes of this cosine and sine.
fn seen([c, s]: [f64; 2], [x, y]: [f64; 2]) -> [f64; 2] {
    [c * x + s * y, c * y - s * x]
}

/// The mean over a cell itself.
pub fn own(mesh: &PlaneMesh, quad: usize) -> Mean {
    let centre = Centre { quad, at: mesh.corners(quad).centroid() };
    Mean { centre, shares: vec![(Source { quad, sample: None }, 1.0)] }
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

    fn square(mesh: &PlaneMesh, side: f64, region: impl Fn(usize) -> usize) -> Vec<Vec<(usize, f64)>> {
        let windows = Windows::new(mesh, (side, 0.0), region);
        let cells = |window: Mean| window.shares.into_iter().map(|(source, share)| (source.quad, share)).collect();
        (0..mesh.quads.len()).map(|q| cells(windows.of_cell(q))).collect()
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
            let own: Vec<_> = (0..81).map(|q| vec![(q, 1.0)]).collect();
            assert_eq!(square(&mesh, side, |_| 0), own, "{side}");
        }
        for side in [20.0, 1e7, 1e300] {
            let windows = square(&mesh, side, |_| 0);
            for window in windows {
                assert_eq!(window.len(), 81, "{side}");
                assert!(window.iter().all(|(_, share)| (share - 1.0 / 81.0).abs() < 1e-12), "{side}: {window:?}");
            }
        }
    }

    /// The mean of a field that is known where windows look.
    fn mean(mesh: &PlaneMesh, window: &Mean, f: impl Fn([f64; 2]) -> f64) -> f64 {
        let value = |source: &Source| {
            let corners = mesh.corners(source.quad);
            let domain = corners.domain();
            match source.sample {
                Some(k) => f(corners.position(domain.samples()[k].at)),
                None => {
                    let points = domain.points(3).iter();
                    let det = |p: [f64; 2]| corners.plane_map(p[0], p[1]).det;
                    points.map(|p| p.weight() * det(p.at) * f(corners.position(p.at))).sum::<f64>() / corners.area()
                }
            }
        };
        window.shares.iter().map(|(source, share)| share * value(source)).sum()
    }

    #[test]
    fn windows_around_places_do_not_see_the_cells() {
        // Cells larger and smaller than the window, squeezed quadrilaterals, and triangles.
        for (n, turn, triangles) in
            [(3, 0.0, false), (20, 0.0, false), (4, 0.2, false), (5, 0.1, true), (17, 0.3, true)]
        {
            let mut mesh = grid(n, 9.0 / n as f64);
            let middle = [4.5; 2];
            for p in &mut mesh.points {
                let r2 = (p[0] - middle[0]).powi(2) + (p[1] - middle[1]).powi(2);
                let angle = turn * (1.0 - r2 / 40.5);
                let [x, y] = [p[0] - middle[0], p[1] - middle[1]];
                *p = [middle[0] + angle.cos() * x - angle.sin() * y, middle[1] + angle.sin() * x + angle.cos() * y];
            }
            if triangles {
                let halves = |q: &Corners<u32>| [[q[0], q[1], q[2]].into(), [q[0], q[2], q[3]].into()];
                mesh.quads = mesh.quads.iter().flat_map(halves).collect();
            }
            let windows = Windows::new(&mesh, (2.0, 0.0), |_| 0);
            let centres = windows.lattice([4.1, 4.6], 1.0, |_| true);
            assert_eq!(centres.len(), 49, "{n}");
            for (centre, _) in centres {
                let window = windows.around(centre);
                let [x, y] = centre.at;
                let linear = mean(&mesh, &window, |p| 3.0 + 2.0 * p[0] - p[1]);
                assert!((linear - (3.0 + 2.0 * x - y)).abs() < 1e-12, "{n} {turn} {triangles}: {linear} at {x}, {y}");
                // The mean of (p - x)^2 is a twelfth of the side squared; samples of a cell h wide miss h^2/12 of it at most.
                let square = mean(&mesh, &window, |p| (p[0] - x).powi(2));
                let h = 9.0 / n as f64;
                assert!((square - 4.0 / 12.0).abs() < 1.2 * h * h / 12.0, "{n} {turn} {triangles}: {square}");
            }
        }
    }

    #[test]
    fn lattices_are_those_of_kept_cells() {
        let mesh = grid(9, 1.0);
        let windows = Windows::new(&mesh, (2.0, 0.0), |_| 0);
        let centres = windows.lattice([4.0, 4.0], 2.0, |quad| quad % 9 < 4);
        assert!(centres.iter().all(|(c, _)| c.at[0] <= 4.0 + 1e-9 && mesh.corners(c.quad).locate(c.at).is_some()));
        let cells = |at: [f64; 2]| centres.iter().find(|(c, _)| c.at == at).map(|(c, cells)| (c.quad, cells.clone()));
        assert_eq!(cells([4.0, 4.0]), Some((30, vec![30, 31, 39, 40])));
        assert_eq!(cells([0.0, 4.0]), Some((27, vec![27, 36])));
        assert!(windows.lattice([-20.0, 4.0], 2.0, |_| true).is_empty());
    }
}
