//! The 15-node wedge on random triangles against polynomials and exact elasticity.

use crate::delaunay::delaunay;
use crate::dense::*;
use fem_core::domain::Corners;
use fem_core::element::{Cell, Element};
use fem_core::material::Elastic;
use fem_core::mesh::PlaneMesh;
use fem_elements::Wedge15;
use nalgebra::{DMatrix, DVector};

/// The cells of a mesh of quadrilaterals, each cut along one of its diagonals.
fn cut(mut mesh: PlaneMesh, second: impl Fn(usize) -> bool) -> PlaneMesh {
    let halves = |(i, quad): (usize, &Corners<u32>)| {
        let [a, b, c, d] = quad.four();
        let pair = if second(i) { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
        pair.map(Corners::from)
    };
    mesh.quads = mesh.quads.iter().enumerate().flat_map(halves).collect();
    mesh
}

/// Triangles of all shapes on the unit square: the nodes inside are moved by up to a third of a cell.
fn random(n: usize) -> PlaneMesh {
    let noise = |seed: f64| ((seed * 12.9898).sin() * 43_758.545_3).fract() / 3.0 / n as f64;
    let inner = |v: f64| v > 1e-9 && v < 1.0 - 1e-9;
    let mesh = grid(n, n, |x, y| {
        let moves = if inner(x) && inner(y) { [noise(x + 7.0 * y), noise(3.0 * x - y + 0.5)] } else { [0.0; 2] };
        [x + moves[0], y + moves[1]]
    });
    cut(mesh, |i| (i * 7919) % 5 < 2)
}

#[test]
fn quadratics_have_their_exact_strains_on_every_triangle() {
    let stack = even(&carbon(), &[0.0]);
    let element = Wedge15::default();
    let corners = [[0.1, -0.2], [2.3, 0.3], [0.7, 1.8]];
    let cell = Cell { corners: corners.into(), z: [-0.3, 0.6], stack: &stack };
    let nodes = element.info().nodes;
    for (i, j, k) in (0..27).map(|t| (t % 3, t / 3 % 3, t / 9)).filter(|(i, j, k)| i + j + k <= 2) {
        let field = |[x, y, z]: [f64; 3]| x.powi(i) * y.powi(j) * z.powi(k);
        let by = |d: usize, p: [f64; 3]| {
            let h = 1e-5;
            let at = |sign: f64| field(std::array::from_fn(|e| if e == d { p[e] + sign * h } else { p[e] }));
            (at(1.0) - at(-1.0)) / (2.0 * h)
        };
        let u = DVector::from_iterator(45, nodes.iter().flat_map(|n| [field(cell.position(*n)), 0.0, 0.0]));
        for xi in [[0.3, -0.7, 0.2], [-0.9, 0.1, -0.6], [-1.0 / 3.0, -1.0 / 3.0, 1.0]] {
            let mut b = DMatrix::zeros(6, 45);
            element.strain_operator(&cell, 0, xi, b.as_mut_slice());
            let (strain, p) = (b * &u, cell.position(xi));
            for (row, d) in [(0, 0), (3, 1), (5, 2)] {
                assert!((strain[row] - by(d, p)).abs() < 1e-9, "x^{i} y^{j} z^{k}, by {d}: {}", strain[row]);
            }
        }
    }
}

#[test]
fn patches_of_random_triangles_keep_constant_strain() {
    let elastic = Elastic::transversely_isotropic(13.0, 1.0, 0.35, 0.4, 0.6);
    let layer = even(&elastic, &[30.0, 30.0]);
    let field = |[x, y, z]: [f64; 3]| {
        [0.3 * x - 0.2 * y + 0.5 * z + 0.1, 0.7 * x + 0.1 * y - 0.4 * z, -0.6 * x + 0.8 * y + 0.2 * z - 0.3]
    };
    let inner = |[x, y, z]: [f64; 3]| [x, y].iter().all(|v| (1e-9..1.0 - 1e-9).contains(v)) && z.abs() < 0.29;
    let two_layers = (random(3), vec![-0.3, 0.1, 0.3]);
    for (mesh, faces) in std::iter::once(two_layers).chain((1..=200).map(|seed| (delaunay(seed), vec![-0.3, 0.3]))) {
        let stacks = vec![layer.clone(); faces.len() - 1];
        let model = Model::new(&Wedge15::default(), mesh, faces, stacks);
        let unknowns = model.unknowns();
        assert!(unknowns.iter().filter(|u| inner(u.1)).count() > 20);
        let u = model.solve(&DVector::zeros(unknowns.len()), |dof, p| (!inner(p)).then(|| field(p)[dof.n() - 1]));
        for (u, (dof, p)) in u.iter().zip(unknowns) {
            assert!((u - field(p)[dof.n() - 1]).abs() < 1e-10, "{dof} {p:?}: {u}");
        }
    }
}

#[test]
fn frequencies_of_a_thick_laminate_converge_to_those_of_exact_elasticity() {
    // Simply supported square plate [0/90/0], a/h = 10: ω h sqrt(ρ/E2) of mode (1,1) by series and transfer matrices.
    const EXACT: f64 = 0.114573496283;
    let layer = even(&pagano(), &[0.0]);
    let turned = even(&pagano(), &[90.0]);
    // Two layers of cells a ply: with one, these leave 6e-4 however fine the mesh is in its plane.
    let faces = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0].map(|z| z / 6.0);
    let error = |n: usize| {
        let mesh = cut(grid(n, n, |x, y| [5.0 * x, 5.0 * y]), |i| i % 2 == 0);
        let stacks = [&layer, &layer, &turned, &turned, &layer, &layer].map(Clone::clone).to_vec();
        let model = Model::new(&Wedge15::default(), mesh, faces.to_vec(), stacks);
        model.lowest_frequency(quarter_support([10.0, 10.0])) / EXACT - 1.0
    };
    let [coarse, fine] = [2, 4].map(error);
    assert!(fine > 0.0 && fine < 1e-3 && coarse / fine > 8.0, "{coarse:e} {fine:e}");
}
