//! The order of the points of cells of higher order.

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

/// Points (i, j, k) of a quadratic wedge, each 0 to 2 along x, y and z, as VTK counts them: corners of the lower face
/// anticlockwise, of the upper face; middles of the sides of the lower face, of the upper face, of the upright edges.
pub fn quadratic_wedge() -> Vec<[usize; 3]> {
    let (corners, middles) = ([[0, 0], [2, 0], [0, 2]], [[1, 0], [1, 1], [0, 1]]);
    let places = [(corners, [0, 2]), (middles, [0, 2])].into_iter().flat_map(|(at, heights)| heights.map(|k| (at, k)));
    places.chain([(corners, 1)]).flat_map(|(at, k)| at.map(|[i, j]| [i, j, k])).collect()
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

    #[test]
    fn a_quadratic_wedge_has_its_corners_first_and_no_middles_of_faces() {
        let points = quadratic_wedge();
        assert_eq!(points[..6], [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [0, 2, 2]]);
        // Every other point is the middle of two corners: 6-7, 7-8 and 8-6 of the VTK documentation, above them, upright.
        let ends = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]];
        for (point, [a, b]) in points[6..].iter().zip(ends) {
            assert_eq!([0, 1, 2].map(|d| 2 * point[d]), [0, 1, 2].map(|d| points[a][d] + points[b][d]));
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
