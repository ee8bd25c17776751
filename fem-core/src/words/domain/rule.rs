//! Quadrature in the plane.

use super::{Corners, Domain, Point};
use crate::words::quadrature::{MAX_POINTS, gauss_legendre};
use std::sync::LazyLock;

type Points = Vec<Point>;
type Rules = LazyLock<Vec<Points>>;

pub(super) fn points(domain: Domain, order: usize) -> &'static [Point] {
    static QUADRILATERAL: Rules = LazyLock::new(|| (0..=MAX_POINTS).map(|n| product(n, n)).collect());
    static TRIANGLE: Rules = LazyLock::new(|| (0..=MAX_POINTS).map(triangle).collect());
    let rules = match domain {
        Domain::Quadrilateral => &QUADRILATERAL,
        Domain::Triangle => &TRIANGLE,
    };
    &rules[order.min(MAX_POINTS)]
}

pub(super) fn section_points(order: usize) -> &'static [Point] {
    static SECTION: Rules = LazyLock::new(|| (0..=MAX_POINTS).map(|n| product(n, 1)).collect());
    &SECTION[order.min(MAX_POINTS)]
}

fn product(along: usize, across: usize) -> Points {
    let (along, across) = (gauss_legendre(along), gauss_legendre(across));
    along
        .iter()
        .flat_map(move |&(r, wr)| across.iter().map(move |&(s, ws)| Point { at: [r, s], factors: [wr, ws] }))
        .collect()
}

/// Rules of 1, 6 and 7 points (degrees 1, 4, 5) in closed form (Strang and Fix 1973; Radon 1948) and of 16 (degree 8; Dunavant
/// 1985, its equations solved to the last digit); beyond, Gauss points in the three quadrilaterals between the centroid and the
/// middles of the sides, any degree, same symmetry.
fn triangle(order: usize) -> Points {
    // Points with area coordinates (1 − 2a, a, a) and its turns, share `w` of the area each.
    let orbit = |a: f64, w: f64| [[a, a], [1.0 - 2.0 * a, a], [a, 1.0 - 2.0 * a]].map(|p| point(p, w));
    match order {
        0 => Points::new(),
        1 => vec![point([1.0 / 3.0; 2], 1.0)],
        2 => {
            let root = (38.0 - 44.0 * 0.4_f64.sqrt()).sqrt();
            let weight = (213_125.0 - 53_320.0 * 10.0_f64.sqrt()).sqrt();
            let a = |sign: f64| (8.0 - 10.0_f64.sqrt() + sign * root) / 18.0;
            [(a(1.0), (620.0 + weight) / 3720.0), (a(-1.0), (620.0 - weight) / 3720.0)]
                .into_iter()
                .flat_map(|(a, w)| orbit(a, w))
                .collect()
        }
        3 => {
            let root = 15.0_f64.sqrt();
            let orbits = [(6.0 + root, 155.0 + root), (6.0 - root, 155.0 - root)];
            let orbits = orbits.into_iter().flat_map(|(a, w)| orbit(a / 21.0, w / 1200.0));
            std::iter::once(point([1.0 / 3.0; 2], 9.0 / 40.0)).chain(orbits).collect()
        }
        4 => {
            const ORBITS: [(f64, f64); 3] = [
                (0.459_292_588_292_723_2, 0.095_091_634_267_284_63),
                (0.170_569_307_751_760_2, 0.103_217_370_534_718_25),
                (0.050_547_228_317_030_98, 0.032_458_497_623_198_08),
            ];
            const SIX: [f64; 2] = [0.008_394_777_409_957_605, 0.263_112_829_634_638_1];
            let [a, b] = SIX;
            let c = 1.0 - a - b;
            let pairs = [[a, b], [b, a], [a, c], [c, a], [b, c], [c, b]];
            let six = pairs.into_iter().map(|pair| point(pair, 0.027_230_314_174_434_995));
            let orbits = ORBITS.into_iter().flat_map(|(a, w)| orbit(a, w));
            std::iter::once(point([1.0 / 3.0; 2], 0.144_315_607_677_787_17)).chain(orbits).chain(six).collect()
        }
        _ => thirds(order + 1),
    }
}

/// A point by its last two area coordinates and its share of the area, which is 2.
fn point([b, c]: [f64; 2], share: f64) -> Point {
    Point { at: [2.0 * b - 1.0, 2.0 * c - 1.0], factors: [2.0 * share, 1.0] }
}

fn thirds(n: usize) -> Points {
    let [middle, half] = [[-1.0 / 3.0; 2], [0.0; 2]];
    let [a, b, c] = super::TRIANGLE;
    let thirds =
        [[a, [0.0, -1.0], middle, [-1.0, 0.0]], [b, half, middle, [0.0, -1.0]], [c, [-1.0, 0.0], middle, half]];
    let of = |third: [[f64; 2]; 4]| {
        let corners = Corners::from(third);
        product(n, n).into_iter().map(move |point| {
            let [r, s] = point.at;
            Point { at: corners.position(point.at), factors: [point.weight(), corners.plane_map(r, s).det] }
        })
    };
    thirds.into_iter().flat_map(of).collect()
}
