//! Solids on cells with bent sides: linear displacements, areas, and neighbours that move as one along a bent side.

use crate::common::{eight_plies, mass, stiffness, zero_modes};
use fem_core::domain::{Corners, Domain, PlaneCell};
use fem_core::element::{self, Cell, Element};
use fem_elements::{HermitePrism, Hex20, Mass, TransverseStresses};

const QUADRILATERAL: [[f64; 2]; 4] = [[0.1, -0.2], [2.3, 0.3], [2.0, 1.8], [-0.2, 1.5]];
const TRIANGLE: [[f64; 2]; 3] = [[0.1, -0.2], [2.3, 0.3], [0.7, -1.8]];
/// Of the side that both have in common, from (0.1, -0.2) to (2.3, 0.3).
const SHARED: [f64; 2] = [0.08, -0.17];

fn elements() -> [Box<dyn Element>; 2] {
    let prism = HermitePrism::new(Mass::Cubic, 6).unwrap().with_transverse_stresses(TransverseStresses::OfStrains);
    [Box::new(prism), Box::new(Hex20::new(4).unwrap())]
}

/// Two cells on either side of a bent side: the quadrilateral begins with it, the triangle, clockwise from it, ends with it.
fn cells() -> [PlaneCell; 2] {
    let quadrilateral = [SHARED, [0.2, 0.05], [-0.03, 0.1], [0.0, 0.0]];
    let [a, b, c] = TRIANGLE;
    let triangle = [[-0.1, 0.05], [0.04, 0.06], SHARED];
    [
        PlaneCell::bent(QUADRILATERAL.into(), quadrilateral.into()),
        PlaneCell::bent(Corners::from([a, c, b]), triangle.into()),
    ]
}

/// Values at the unknowns of a displacement whose value and gradient are known.
fn interpolated(
    element: &dyn Element,
    cell: &Cell<'_>,
    of: impl Fn([f64; 3]) -> ([f64; 3], [[f64; 3]; 3]),
) -> Vec<f64> {
    let info = element.info();
    let at_node = |at: &[f64; 3]| {
        let (value, gradient) = of(cell.position(*at));
        let unknown = |dof: &fem_core::dof::Dof| match dof.m() {
            0 => value[dof.n() - 1],
            m => gradient[dof.n() - 1][m - 1],
        };
        info.dofs.iter().map(unknown).collect::<Vec<_>>()
    };
    info.nodes.iter().flat_map(at_node).collect()
}

/// Displacement at a natural point.
fn displacement(element: &dyn Element, cell: &Cell<'_>, u: &[f64], at: [f64; 3]) -> [f64; 3] {
    let mut shape = vec![0.0; 3 * u.len()];
    element.shape(cell, at, &mut shape);
    [0, 1, 2].map(|n| shape.chunks_exact(3).zip(u).map(|(column, u)| column[n] * u).sum())
}

#[test]
fn linear_displacements_are_exact_and_nothing_else_is_free() {
    let stack = eight_plies();
    let gradient = [[0.3, -0.2, 0.5], [0.7, 0.1, -0.4], [-0.6, 0.8, 0.2]];
    let linear = |x: [f64; 3]| (gradient.map(|g| 0.1 + g.iter().zip(x).map(|(g, x)| g * x).sum::<f64>()), gradient);
    let strains = [0.3, 0.1, 0.2, 0.5, 0.4, -0.1];
    for solid in elements() {
        for plane in cells() {
            let form = element::form(&*solid, plane.domain());
            assert!(form.takes_bent_sides());
            let cell = Cell { corners: plane, z: [-0.3, 0.6], stack: &stack };
            let u = interpolated(form, &cell, linear);
            let mut b = vec![0.0; 6 * u.len()];
            for at in [[-0.3, -0.5, 0.2], [-0.9, 0.1, -1.0], [0.2, -0.9, 0.8]] {
                form.strain_operator(&cell, 0, at, &mut b);
                for (i, strain) in strains.iter().enumerate() {
                    let got: f64 = b.chunks_exact(6).zip(&u).map(|(b, u)| b[i] * u).sum();
                    assert!((got - strain).abs() < 1e-12, "{:?}: {got} instead of {strain}", plane.domain());
                }
            }
            assert_eq!(zero_modes(form, &cell), 6);
            // A rigid motion takes no energy, and carries all mass: that of the bent area.
            let moved = interpolated(form, &cell, |_| ([1.0, 0.0, 0.0], [[0.0; 3]; 3]));
            let quadratic = |matrix: &[f64]| -> f64 {
                let n = moved.len();
                (0..n * n).map(|k| matrix[k] * moved[k % n] * moved[k / n]).sum()
            };
            assert!(quadratic(&stiffness(form, &cell)).abs() < 1e-9 * stiffness(form, &cell)[0]);
            let whole = 0.9 * plane.area() * stack.slices[0].density;
            assert!((quadratic(&mass(form, &cell)) / whole - 1.0).abs() < 1e-12);
        }
    }
}

/// Values and slopes at the ends of the side say all that happens along it, in both cells the same.
#[test]
fn neighbours_move_as_one_along_a_bent_side() {
    let stack = eight_plies();
    let any = |x: [f64; 3]| {
        let f = |n: usize| (1.3 * x[0] + 0.7 * x[1] * n as f64 + 2.0 * x[2]).sin();
        let (value, slope) = ([f(1), f(2), f(3)], [0.9 * f(3), -0.4 * f(1), 0.3 * f(2)]);
        (value, [slope, slope.map(|s| 1.0 - s), slope.map(|s| 0.5 * s)])
    };
    for solid in elements() {
        let [quad, triangle] = cells().map(|corners| Cell { corners, z: [-0.3, 0.6], stack: &stack });
        let forms = [element::form(&*solid, Domain::Quadrilateral), element::form(&*solid, Domain::Triangle)];
        // Corners and unknowns elsewhere do not matter.
        let on_side = |cell: &Cell<'_>, at: [f64; 3]| {
            let [x, y, _] = cell.position(at);
            let middle = [0, 1].map(|d| 0.5 * (TRIANGLE[0][d] + TRIANGLE[1][d]) + SHARED[d]);
            [TRIANGLE[0], TRIANGLE[1], middle].iter().any(|p| (p[0] - x).hypot(p[1] - y) < 1e-9)
        };
        let [u, v] = [(&quad, forms[0]), (&triangle, forms[1])].map(|(cell, form)| {
            let mut u = interpolated(form, cell, any);
            let each = form.info().dofs.len();
            for (node, at) in form.info().nodes.iter().enumerate().filter(|(_, at)| !on_side(cell, **at)) {
                u[node * each..(node + 1) * each].iter_mut().for_each(|u| *u = node as f64 + at[0]);
            }
            u
        });
        for (t, q) in (0..=10).map(|i| (f64::from(i) / 5.0 - 1.0, f64::from(i % 3) - 1.0)) {
            // From (0.1, −0.2): along r at s = −1 of the one, along s at r = −1 of the other.
            let (a, b) = ([t, -1.0, q], [-1.0, t, q]);
            let [p, o] = [quad.position(a), triangle.position(b)];
            assert!((0..3).all(|d| (p[d] - o[d]).abs() < 1e-14), "{p:?} {o:?}");
            let (here, there) = (displacement(forms[0], &quad, &u, a), displacement(forms[1], &triangle, &v, b));
            assert!((0..3).all(|d| (here[d] - there[d]).abs() < 1e-12), "{here:?} {there:?}");
        }
    }
}
