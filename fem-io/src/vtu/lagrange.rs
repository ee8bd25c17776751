//! The order of the points of a Lagrange hexahedron.

/// Points (i, j, k) of a hexahedron of order `n`, each 0 to n along x, y and z, as VTK counts them from files of
/// version 2.2 on: corners, edges, faces, inside.
///
/// Corners and the four upright edges go round: (0, 0), (n, 0), (n, n), (0, n). Edges of a face begin at its corner
/// (0, 0): along x, y at x = n, x at y = n, y at x = 0. Faces are those of x, of y and of z, the lower one of each
/// first; what lies inside an edge, a face or the cell counts x first, then y, then z.
pub fn lagrange_hexahedron(n: usize) -> Vec<[usize; 3]> {
    const ROUND: [[bool; 2]; 4] = [[false, false], [true, false], [true, true], [false, true]];
    let end = |far: bool| if far { n } else { 0 };
    let inner = || 1..n;
    let mut points = Vec::with_capacity((n + 1).pow(3));
    for k in [0, n] {
        points.extend(ROUND.map(|[i, j]| [end(i), end(j), k]));
    }
    for k in [0, n] {
        points.extend(inner().map(|i| [i, 0, k]));
        points.extend(inner().map(|j| [n, j, k]));
        points.extend(inner().map(|i| [i, n, k]));
        points.extend(inner().map(|j| [0, j, k]));
    }
    for [i, j] in ROUND {
        points.extend(inner().map(|k| [end(i), end(j), k]));
    }
    let plane = || inner().flat_map(move |b| (1..n).map(move |a| [a, b]));
    for i in [0, n] {
        points.extend(plane().map(|[j, k]| [i, j, k]));
    }
    for j in [0, n] {
        points.extend(plane().map(|[i, k]| [i, j, k]));
    }
    for k in [0, n] {
        points.extend(plane().map(|[i, j]| [i, j, k]));
    }
    points.extend(inner().flat_map(|k| plane().map(move |[i, j]| [i, j, k])));
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_point_stands_once() {
        for n in 1..5 {
            let points = lagrange_hexahedron(n);
            assert_eq!(points.len(), (n + 1).pow(3));
            assert_eq!(points.iter().collect::<BTreeSet<_>>().len(), points.len());
        }
    }

    /// Of order 1 it is the linear hexahedron; of order 2 the points that VTK gives for its triquadratic one, in
    /// whose numbering the faces are those of x, y and z as well.
    #[test]
    fn low_orders_are_the_hexahedra_that_everyone_knows() {
        let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
        assert_eq!(lagrange_hexahedron(1), corners);
        let quadratic = lagrange_hexahedron(2);
        assert_eq!(quadratic[8..12], [[1, 0, 0], [2, 1, 0], [1, 2, 0], [0, 1, 0]]);
        assert_eq!(quadratic[12..16], [[1, 0, 2], [2, 1, 2], [1, 2, 2], [0, 1, 2]]);
        assert_eq!(quadratic[16..20], [[0, 0, 1], [2, 0, 1], [2, 2, 1], [0, 2, 1]]);
        assert_eq!(quadratic[20..], [[0, 1, 1], [2, 1, 1], [1, 0, 1], [1, 2, 1], [1, 1, 0], [1, 1, 2], [1, 1, 1]]);
    }
}
