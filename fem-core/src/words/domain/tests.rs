use super::{Corners, Domain, PlaneCell};

const BOTH: [Domain; 2] = [Domain::Quadrilateral, Domain::Triangle];

/// ∫ rᵃ sᵇ over the triangle r, s ≥ −1, r + s ≤ 0, by the moments a! b! / (a + b + 2)! of the unit triangle: whole numbers over
/// (a + b + 2)!, because the signs of the sum alternate.
fn on_triangle(a: u32, b: u32) -> f64 {
    let factorial = |n: u32| (1..=i128::from(n)).product::<i128>();
    let binomial = |n: u32, k: u32| factorial(n) / factorial(k) / factorial(n - k);
    let all = factorial(a + b + 2);
    // r = 2x − 1, s = 2y − 1
    let mut sum = 0;
    for i in 0..=a {
        for j in 0..=b {
            let sign = if (a - i + b - j).is_multiple_of(2) { 1 } else { -1 };
            let moment = factorial(i) * factorial(j) * (all / factorial(i + j + 2));
            sum += sign * binomial(a, i) * binomial(b, j) * 2_i128.pow(i + j) * moment;
        }
    }
    4.0 * (sum as f64 / all as f64)
}

#[test]
fn rules_are_exact_to_their_degree() {
    for order in 1..=6_u32 {
        let integral = |domain: Domain, a: u32, b: u32| -> f64 {
            let points = domain.points(order as usize).iter();
            points.map(|p| p.weight() * p.at[0].powi(a as i32) * p.at[1].powi(b as i32)).sum()
        };
        for a in 0..2 * order {
            for b in 0..2 * order {
                let along = |n: u32| if n.is_multiple_of(2) { 2.0 / f64::from(n + 1) } else { 0.0 };
                let error = integral(Domain::Quadrilateral, a, b) - along(a) * along(b);
                assert!(error.abs() < 1e-14, "order {order}, r^{a} s^{b}: {error:e}");
                if a + b < 2 * order {
                    let error = integral(Domain::Triangle, a, b) - on_triangle(a, b);
                    assert!(error.abs() < 1e-14, "triangle, order {order}, r^{a} s^{b}: {error:e}");
                }
            }
        }
        let inside = |p: [f64; 2]| p[0] > -1.0 && p[1] > -1.0 && p[0] + p[1] < 0.0;
        assert!(Domain::Triangle.points(order as usize).iter().all(|p| inside(p.at) && p.weight() > 0.0));
    }
    // The rule of order 2 is of degree 4, that of order 3 of degree 5 and no more.
    let fourth: f64 = Domain::Triangle.points(2).iter().map(|p| p.weight() * (p.at[0] * p.at[1]).powi(2)).sum();
    assert!((fourth - on_triangle(2, 2)).abs() < 1e-14);
    let sixth: f64 = Domain::Triangle.points(3).iter().map(|p| p.weight() * p.at[0].powi(6)).sum();
    assert!((sixth - on_triangle(6, 0)).abs() > 1e-6);
}

#[test]
fn vertex_functions_and_sides_agree_with_the_corners() {
    for domain in BOTH {
        let corners = domain.corners();
        for (i, corner) in corners.iter().enumerate() {
            let functions = domain.vertex_functions(*corner);
            assert!(functions.iter().enumerate().all(|(j, n)| *n == f64::from(u8::from(i == j))));
            assert_eq!(domain.corners_around(*corner), [i]);
            let next = (i + 1) % corners.len();
            assert_eq!((domain.on_side(i, -1.0), domain.on_side(i, 1.0)), (*corner, corners[next]));
            let mut ends = domain.corners_around(domain.on_side(i, 0.0));
            ends.sort_by_key(|end| *end != i);
            assert_eq!(ends, [i, next]);
        }
        let mean = |d: usize| corners.iter().map(|c| c[d]).sum::<f64>() / corners.len() as f64;
        assert_eq!(domain.centre(), [mean(0), mean(1)]);
        assert_eq!(domain.lattice(1).len(), corners.len());
    }
    for (domain, n) in [(Domain::Quadrilateral, 3), (Domain::Triangle, 3), (Domain::Triangle, 1)] {
        let lattice = domain.lattice(n);
        assert!(lattice.iter().enumerate().all(|(k, point)| domain.lattice_number(n, *point) == k));
        // The cells fill the domain, whose own corners are those of the lattice with n = 1.
        let cells = domain.lattice_cells(n);
        let area = |cell: &Corners<[usize; 2]>| cell.map(|p| p.map(|k| k as f64)).area();
        assert!(cells.iter().all(|cell| cell.domain() == domain && area(cell) > 0.0));
        let whole = domain.lattice_cells(1)[0];
        assert!((cells.iter().map(area).sum::<f64>() - area(&whole) * (n * n) as f64).abs() < 1e-12);
        let natural = |point: [usize; 2]| point.map(|k| 2.0 * k as f64 / n as f64 - 1.0);
        for point in lattice {
            let around = domain.vertex_functions(natural(point)).iter().filter(|v| v.abs() > 1e-12).count();
            assert_eq!(domain.lattice_side(n, point).is_some(), around < 3);
            if let Some((ends, from_first)) = domain.lattice_side(n, point) {
                let at = domain.vertex_functions(natural(point));
                assert!((at[ends[1]] - from_first as f64 / n as f64).abs() < 1e-12);
                assert!((at[ends[0]] + at[ends[1]] - 1.0).abs() < 1e-12);
            }
        }
    }
    assert_eq!(Domain::Triangle.lattice(2), [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [0, 2]]);
}

#[test]
fn points_are_found_where_the_map_puts_them() {
    let cells: [Corners<[f64; 2]>; 2] =
        [[[0.1, 0.2], [2.0, 0.4], [2.5, 1.7], [-0.1, 1.9]].into(), [[0.1, 0.2], [2.0, 0.4], [-0.1, 1.9]].into()];
    for cell in cells {
        let n = 7;
        for [i, j] in cell.domain().lattice(n) {
            let at = [i, j].map(|k| 2.0 * k as f64 / n as f64 - 1.0);
            let found = cell.locate(cell.position(at)).unwrap();
            assert!((0..2).all(|d| (found[d] - at[d]).abs() < 1e-12), "{at:?}: {found:?}");
            let (map, h) = (cell.plane_map(at[0], at[1]), 1e-6);
            for d in 0..2 {
                let by_r = (cell.position([at[0] + h, at[1]])[d] - cell.position([at[0] - h, at[1]])[d]) / (2.0 * h);
                let by_s = (cell.position([at[0], at[1] + h])[d] - cell.position([at[0], at[1] - h])[d]) / (2.0 * h);
                assert!((map.jacobian[0][d] - by_r).abs() < 1e-9 && (map.jacobian[1][d] - by_s).abs() < 1e-9);
            }
        }
        for (i, [a, b]) in cell.sides().enumerate() {
            // Just outside the middle of each side.
            let outwards = [b[1] - a[1], a[0] - b[0]];
            let outside = [0, 1].map(|d| 0.5 * (a[d] + b[d]) + 1e-6 * outwards[d]);
            assert_eq!(cell.locate(outside), None, "side {i}");
        }
        let area: f64 = cell.domain().points(2).iter().map(|p| p.weight() * cell.plane_map(p.at[0], p.at[1]).det).sum();
        assert!((area - cell.area()).abs() < 1e-14);
        assert!((cell.overlap([0.0; 2], 10.0) - area).abs() < 1e-13);
        let quarters = cell.quarters(cell.map_sides(|[a, b]| [0, 1].map(|d| 0.5 * (a[d] + b[d]))), || [1.0, 1.0]);
        let parts: f64 = quarters.iter().map(|quarter| quarter.area()).sum();
        assert!((parts - area).abs() < 1e-14 && quarters.iter().all(|quarter| quarter.area() > 0.0));
        assert!((0..cell.len()).all(|i| quarters[i][i] == cell[i]));
    }
}

#[test]
fn quality_of_known_triangles() {
    let equilateral = Corners::from([[0.0, 0.0], [2.0, 0.0], [1.0, 3.0_f64.sqrt()]]).quality();
    assert!((equilateral.area - 3.0_f64.sqrt()).abs() < 1e-14 && (equilateral.scaled_jacobian - 1.0).abs() < 1e-14);
    assert!((equilateral.largest_angle.to_degrees() - 60.0).abs() < 1e-12 && (equilateral.aspect - 1.0).abs() < 1e-14);
    let right = Corners::from([[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]]);
    assert_eq!((right.quality().area, right.centroid()), (6.0, [1.0, 4.0 / 3.0]));
    assert!((right.quality().aspect - 5.0 / 3.0).abs() < 1e-14);
    assert!(Corners::from([[0.0, 0.0], [0.0, 4.0], [3.0, 0.0]]).quality().scaled_jacobian < 0.0);
}

/// Circular sectors: a quadrilateral and a triangle with one side on a circle.
fn bent() -> [PlaneCell; 2] {
    let at = |radius: f64, angle: f64| [radius * angle.cos(), radius * angle.sin()];
    let (low, high) = (0.2, 0.6);
    let bend = |radius: f64| {
        let (on, chord) = (at(radius, 0.4), [0, 1].map(|d| 0.5 * (at(radius, low)[d] + at(radius, high)[d])));
        [0, 1].map(|d| on[d] - chord[d])
    };
    let ring = Corners::from([at(1.0, low), at(2.0, low), at(2.0, high), at(1.0, high)]);
    let sector = Corners::from([[0.0, 0.0], at(2.0, low), at(2.0, high)]);
    [
        PlaneCell::bent(ring, [[0.0; 2], bend(2.0), [0.0; 2], bend(1.0)].into()),
        PlaneCell::bent(sector, [[0.0; 2], bend(2.0), [0.0; 2]].into()),
    ]
}

#[test]
fn bent_cells_have_the_area_of_their_map_and_find_their_points() {
    for cell in bent() {
        let sum: f64 = cell.domain().points(6).iter().map(|p| p.weight() * cell.plane_map(p.at[0], p.at[1]).det).sum();
        assert!((sum / cell.area() - 1.0).abs() < 1e-14, "{sum} {}", cell.area());
        // Of the sectors 0.4 wide: parabolas instead of arcs.
        let exact = if cell.len() == 4 { 0.2 * 3.0 } else { 0.2 * 4.0 };
        assert!((cell.area() / exact - 1.0).abs() < 1e-4);
        assert!(((*cell).area() / exact - 1.0).abs() > 1e-2);
        assert!(cell.is_regular() && cell.quality().scaled_jacobian > 0.1);
        for point in cell.domain().points(5) {
            let found = cell.locate(cell.position(point.at)).unwrap();
            assert!((0..2).all(|d| (found[d] - point.at[d]).abs() < 1e-12), "{found:?} {:?}", point.at);
            let (map, d) = (cell.plane_map(point.at[0], point.at[1]), 1e-6);
            for k in 0..2 {
                let step = |sign: f64| cell.position([0, 1].map(|i| point.at[i] + if i == k { sign * d } else { 0.0 }));
                let slope = [0, 1].map(|i| (step(1.0)[i] - step(-1.0)[i]) / (2.0 * d));
                assert!((0..2).all(|i| (slope[i] - map.jacobian[k][i]).abs() < 1e-8));
            }
        }
        // Between the chord and the arc, and beyond the arc.
        assert!(cell.locate([1.99 * 0.4_f64.cos(), 1.99 * 0.4_f64.sin()]).is_some());
        assert!(cell.locate([2.01 * 0.4_f64.cos(), 2.01 * 0.4_f64.sin()]).is_none());
    }
    let straight = PlaneCell::bent(Corners::from([[0.0; 2], [1.0, 0.0], [0.0, 1.0]]), [[0.0; 2]; 3].into());
    assert_eq!(straight.bends(), None);
    // A side that reaches beyond the one across.
    let folded = PlaneCell::bent(*bent()[0], [[0.0; 2], [-1.3, -0.5], [0.0; 2], [0.0; 2]].into());
    assert!(!folded.is_regular());
}
