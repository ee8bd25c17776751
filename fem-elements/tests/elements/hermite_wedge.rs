//! The prism's form on triangles, alone and beside it: polynomials, patches and exact elasticity.

use crate::common::{interpolation_error, monomials, zero_modes};
use crate::delaunay::{delaunay, random};
use crate::dense::*;
use fem_core::dof::Dof;
use fem_core::domain::{Corners, Domain};
use fem_core::element::{self, Cell, Stack};
use fem_core::material::Elastic;
use fem_core::mesh::PlaneMesh;
use fem_core::plate::ZDerivatives;
use fem_elements::{HermitePrism, Mass};
use nalgebra::{DVector, Matrix3, Vector3};

/// Triangles and quadrilaterals of all shapes on the unit square.
fn mixed(n: usize, seed: u64) -> PlaneMesh {
    let mut next = random(seed);
    let inner = |v: f64| v > 1e-9 && v < 1.0 - 1e-9;
    let mut mesh = grid(n, n, |x, y| {
        let mut moved = |v: f64| v + next() / 4.0 / n as f64;
        if inner(x) && inner(y) { [moved(x), moved(y)] } else { [x, y] }
    });
    mesh.quads = (mesh.quads.iter())
        .flat_map(|quad| {
            let [a, b, c, d] = quad.four();
            match next() {
                ..-0.3 => vec![Corners::from([a, b, c]), [a, c, d].into()],
                ..0.4 => vec![[a, b, d].into(), [b, c, d].into()],
                _ => vec![*quad],
            }
        })
        .collect();
    mesh
}

#[test]
fn polynomials_on_every_triangle() {
    let element = HermitePrism::new(Mass::Cubic, 4).unwrap();
    let stack = even(&carbon(), &[0.0]);
    let corners = Corners::from([[0.1, -0.2], [2.3, 0.3], [0.7, 1.8]]);
    let cell = Cell { corners: corners.into(), z: [-0.3, 0.6], stack: &stack };
    let wedge = element::form(&element, Domain::Triangle);
    let within = |[i, j, k]: [i32; 3]| i + j <= 2 && k <= 1 || i + j <= 1 && k <= 3;
    for powers in monomials([3, 3, 4], 7) {
        let error = (0..3).map(|n| interpolation_error(wedge, &cell, n, powers)).fold(0.0, f64::max);
        assert_eq!(error < 1e-12, within(powers), "{powers:?}: {error:e}");
    }
    assert_eq!(zero_modes(wedge, &cell), 6);
}

/// Gradient of a displacement that leaves both faces of a plate free of stress, with these strains in the plane.
fn free_faces(stack: &Stack) -> [[f64; 3]; 3] {
    let mut gradient = [[0.3, -0.2, 0.0], [0.7, 0.1, 0.0], [-0.6, 0.8, 0.0]];
    let c = &stack.slices[0].c;
    let (plane, across) = ([(0, 0.3), (1, 0.1), (3, 0.5)], [2, 4, 5]);
    let stress = Vector3::from_fn(|i, _| -plane.iter().map(|(j, strain)| c[across[i]][*j] * strain).sum::<f64>());
    let strain = Matrix3::from_fn(|i, j| c[across[i]][across[j]]).lu().solve(&stress).unwrap();
    gradient[2][2] = strain[0];
    gradient[1][2] = strain[1] - gradient[2][1];
    gradient[0][2] = strain[2] - gradient[2][0];
    gradient
}

#[test]
fn patches_of_both_shapes_keep_constant_strain() {
    let elastic = Elastic::transversely_isotropic(13.0, 1.0, 0.35, 0.4, 0.6);
    let layer = even(&elastic, &[30.0, 30.0]);
    let element = HermitePrism::new(Mass::Cubic, 4).unwrap();
    let gradient = free_faces(&layer);
    let field = |dof: Dof, p: [f64; 3]| match dof.m() {
        0 => (0..3).map(|d| gradient[dof.n() - 1][d] * p[d]).sum(),
        m => gradient[dof.n() - 1][m - 1],
    };
    let inner = |[x, y, _]: [f64; 3]| [x, y].iter().all(|v| (1e-9..1.0 - 1e-9).contains(v));
    let mut shapes = [0, 0];
    // One of ten in two layers.
    let of_both = (1..=200).map(|seed| match seed % 10 {
        0 => (seed, mixed(2, seed), vec![-0.3, 0.1, 0.3]),
        _ => (seed, mixed(3, seed), vec![-0.3, 0.3]),
    });
    let of_triangles = (1..=200).map(|seed| (seed, delaunay(seed), vec![-0.3, 0.3]));
    for (seed, mesh, faces) in of_both.chain(of_triangles) {
        mesh.quads.iter().for_each(|cell| shapes[usize::from(cell.domain() == Domain::Triangle)] += 1);
        let stacks = vec![layer.clone(); faces.len() - 1];
        let model = Model::new(&element, mesh, faces, stacks);
        let unknowns = model.unknowns();
        let u = model.solve(&DVector::zeros(unknowns.len()), |dof, p| (!inner(p)).then(|| field(dof, p)));
        for (u, (dof, p)) in u.iter().zip(unknowns) {
            let error = u - field(dof, p);
            assert!(error.abs() < 1e-10, "seed {seed}, {dof} {p:?}: {error:e}");
        }
    }
    assert!(shapes.iter().all(|count| *count > 300), "{shapes:?}");
}

/// As [`quarter_support`], of displacements and what follows from them alone.
fn held(dof: Dof, p: [f64; 3]) -> bool {
    let along = |d: usize| [2, 3].contains(&dof.m()) && d == 0 || [1, 3].contains(&dof.m()) && d == 1;
    let (end, start) = (|d: usize| (p[d] - 5.0).abs() < 1e-9, |d: usize| p[d] == 0.0);
    // Lines x = const and y = const on which the component is zero.
    let lines = match dof.n() {
        1 => [start(0), end(1)],
        2 => [end(0), start(1)],
        _ => [end(0), end(1)],
    };
    (0..2).any(|d| lines[d] && (dof.m() == 0 || along(d)))
}

#[test]
fn frequencies_of_a_thick_laminate_converge_to_those_of_exact_elasticity() {
    // Simply supported square plate [0/90/0], a/h = 10: ω h sqrt(ρ/E2) of mode (1,1) by series and transfer matrices.
    const EXACT: f64 = 0.114573496283;
    let [layer, turned] = [0.0, 90.0].map(|angle| even(&pagano(), &[angle]));
    let faces = [-3.0, -1.0, 1.0, 3.0].map(|z| z / 6.0);
    let element = HermitePrism::new(Mass::Cubic, 4).unwrap();
    let error = |n: usize, seed: u64| {
        let mut mesh = mixed(n, seed);
        mesh.points.iter_mut().flatten().for_each(|x| *x *= 5.0);
        let stacks = [&layer, &turned, &layer].map(Clone::clone).to_vec();
        let model = Model::with(&element, mesh, (faces.to_vec(), stacks), ZDerivatives::LayerWise);
        model.lowest_frequency(held) / EXACT - 1.0
    };
    let [coarse, fine] = [2, 4].map(|n| error(n, 7));
    assert!(fine > 0.0 && fine < 1e-3 && coarse / fine > 6.0, "{coarse:e} {fine:e}");
}
