//! Delaunay triangulations of random points.

use fem_core::domain::Corners;
use fem_core::mesh::PlaneMesh;

/// Least distance between points, and of those inside to the sides.
const APART: f64 = 0.12;

/// Numbers between −1 and 1 that a seed gives.
pub(crate) fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as f64 / u64::MAX as f64 * 2.0 - 1.0
    }
}

/// Random points on and in the unit square with all triangles whose circumscribed circle holds no other point, found by trying each:
/// Delaunay's own definition.
pub(crate) fn delaunay(seed: u64) -> PlaneMesh {
    let mut next = random(seed);
    let mut points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let far = |points: &[[f64; 2]], p: [f64; 2]| points.iter().all(|q| (p[0] - q[0]).hypot(p[1] - q[1]) > APART);
    for attempt in 0..40 {
        let [x, y] = [0.5 + 0.5 * next(), 0.5 + 0.5 * next()];
        let p = match attempt % 8 {
            0 => [x, 0.0],
            1 => [1.0, y],
            2 => [x, 1.0],
            3 => [0.0, y],
            _ => [x, y].map(|v| APART + (1.0 - 2.0 * APART) * v),
        };
        if far(&points, p) {
            points.push(p);
        }
    }
    let n = points.len();
    let turn = |[a, b, c]: [usize; 3]| {
        let [a, b, c] = [a, b, c].map(|i| points[i]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    // The determinant of three points seen from a fourth is positive where that lies in their circle.
    let holds = |corners: [usize; 3], d: usize| {
        let row = |i: usize| {
            let [x, y] = [points[i][0] - points[d][0], points[i][1] - points[d][1]];
            [x, y, x * x + y * y]
        };
        nalgebra::Matrix3::from_fn(|i, j| row(corners[i])[j]).determinant() > 0.0
    };
    let mut quads = Vec::new();
    for a in 0..n {
        for (b, c) in (a + 1..n).flat_map(|b| (b + 1..n).map(move |c| (b, c))) {
            let corners = if turn([a, b, c]) > 0.0 { [a, b, c] } else { [a, c, b] };
            if turn(corners) > 1e-12 && !(0..n).any(|d| !corners.contains(&d) && holds(corners, d)) {
                quads.push(Corners::from(corners.map(|i| i as u32)));
            }
        }
    }
    let mesh = PlaneMesh {
        node_tags: (1..=n as u64).collect(),
        quad_tags: (1..=quads.len() as u64).collect(),
        points,
        quads,
        ..PlaneMesh::default()
    };
    assert!((mesh.area() - 1.0).abs() < 1e-12, "seed {seed}: {}", mesh.area());
    mesh
}
