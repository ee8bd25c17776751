//! The 20-node hexahedron against polynomials, beam theory and exact elasticity.

use crate::dense::*;
use fem_core::element::{Cell, Element, ElementInfo};
use fem_core::material::Elastic;
use fem_core::plugin::{Params, Plugin, Value};
use fem_core::tensor::{Matrix6, rotate_stiffness};
use fem_elements::Hex20;
use nalgebra::{DMatrix, DVector, Matrix6 as Square6};

const PARALLELOGRAM: [[f64; 2]; 4] = [[0.0, 0.0], [2.0, 0.5], [2.7, 1.9], [0.7, 1.4]];

fn hex20() -> Hex20 {
    Hex20::new(Hex20::IN_PLANE_ORDER).unwrap()
}

#[test]
fn overrides_agree_with_the_provided_methods() {
    for plies in [vec![(30.0, 1.0)], vec![(0.0, 1.0), (90.0, 2.0), (-45.0, 0.5), (20.0, 1.0)]] {
        let stack = stack(&carbon(), &plies);
        check_overrides(&hex20(), &Cell { corners: CROOKED.into(), z: [-0.4e-3, 0.9e-3], stack: &stack });
    }
}

#[test]
fn only_rigid_motions_are_without_energy() {
    for plies in [vec![(30.0, 1.0)], vec![(0.0, 1.0), (90.0, 2.0), (-45.0, 0.5)]] {
        let stack = stack(&carbon(), &plies);
        check_rigid_motions(&hex20(), &Cell { corners: CROOKED.into(), z: [-0.4e-3, 0.9e-3], stack: &stack });
    }
}

/// The element at two Gauss points a direction in the plane.
#[derive(Debug, Clone)]
struct Coarse(Hex20, ElementInfo);
impl Element for Coarse {
    fn info(&self) -> &ElementInfo {
        &self.1
    }
    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        self.0.strain_operator(cell, slice, xi, b)
    }
    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.0.shape(cell, xi, n)
    }
}

#[test]
fn order_two_would_leave_two_zero_energy_modes() {
    let coarse = Coarse(hex20(), ElementInfo { in_plane_order: 2, ..*hex20().info() });
    let stack = even(&carbon(), &[30.0, 0.0]);
    let k = stiffness(&coarse, &Cell { corners: CROOKED.into(), z: [-0.4e-3, 0.9e-3], stack: &stack });
    let spectrum = scaled_spectrum(&k);
    assert!(spectrum[7] < 1e-12 && spectrum[8] > 1e-3, "{:?}", &spectrum[..9]);
}

#[test]
fn order_two_and_other_nonsense_are_refused_with_the_reason() {
    assert!(Hex20::new(2).unwrap_err().0.contains("zero-energy"));
    assert!(Hex20::new(33).is_err());
    let built = |order: f64| Hex20::build(&Params::default().with("in_plane_order", Value::Number(order)));
    assert!(built(2.0).unwrap_err().to_string().contains("a whole number from 3 to 32"));
    assert!(built(2.5).is_err());
    assert!(built(4.0).is_ok());
    let stack = even(&carbon(), &[0.0]);
    for (corners, z) in [
        (CROOKED, [0.0, 0.0]),
        (CROOKED, [1e-3, 0.0]),
        ([CROOKED[0], CROOKED[2], CROOKED[1], CROOKED[3]], [0.0, 1e-3]),
        ([CROOKED[0], [f64::NAN, 0.0], CROOKED[2], CROOKED[3]], [0.0, 1e-3]),
    ] {
        let cell = Cell { corners: corners.into(), z, stack: &stack };
        let (mut scratch, mut k) = (Default::default(), vec![0.0; 3600]);
        assert!(hex20().stiffness(&cell, &mut scratch, &mut k).is_err());
        assert!(hex20().mass(&cell, &mut scratch, &mut k).is_err());
    }
}

/// Displacement and strain of u = Σ over terms (i, j, k) of c xⁱ yʲ zᵏ, by the rules of differentiation.
fn polynomial(terms: &[[i32; 3]], p: [f64; 3]) -> ([f64; 3], [f64; 6]) {
    let mut u = [0.0; 3];
    let mut gradient = [[0.0; 3]; 3];
    for (t, powers) in terms.iter().enumerate() {
        for n in 0..3 {
            let c = (1.0 + 7.0 * t as f64 + 3.0 * n as f64).sin();
            let factor = |d: usize, by: bool| match (powers[d], by) {
                (0, true) => 0.0,
                (e, true) => f64::from(e) * p[d].powi(e - 1),
                (e, false) => p[d].powi(e),
            };
            u[n] += c * factor(0, false) * factor(1, false) * factor(2, false);
            for (m, g) in gradient[n].iter_mut().enumerate() {
                *g += c * factor(0, m == 0) * factor(1, m == 1) * factor(2, m == 2);
            }
        }
    }
    let g = gradient;
    let shear = |i: usize, j: usize| g[i][j] + g[j][i];
    (u, [g[0][0], g[1][1], g[2][2], shear(0, 1), shear(1, 2), shear(2, 0)])
}

#[test]
fn polynomials_of_the_promised_space_have_their_exact_strains() {
    let up_to = |degree: i32| move |t: &[i32; 3]| t.iter().sum::<i32>() <= degree;
    let all = || (0..27).map(|i| [i % 3, i / 3 % 3, i / 9]);
    let quadratics: Vec<_> = all().filter(up_to(2)).collect();
    let prisms: Vec<_> = all().filter(|t| t[0] + t[1] <= 1).collect();
    assert_eq!((quadratics.len(), prisms.len()), (10, 9));
    let general = [[0.1, -0.2], [2.3, 0.3], [1.9, 1.8], [-0.3, 1.4]];
    let stack = even(&carbon(), &[0.0]);
    let element = hex20();
    let error = |corners: [[f64; 2]; 4], terms: &[[i32; 3]]| {
        let cell = Cell { corners: corners.into(), z: [-0.3, 0.6], stack: &stack };
        let nodes = element.info().nodes.iter();
        let u = DVector::from_vec(nodes.flat_map(|n| polynomial(terms, cell.position(*n)).0).collect());
        let mut worst = 0.0_f64;
        for xi in [[0.3, -0.7, 0.2], [-0.9, 0.1, -0.6], [0.0, 0.0, 1.0]] {
            let mut b = DMatrix::zeros(6, 60);
            element.strain_operator(&cell, 0, xi, b.as_mut_slice());
            let want = polynomial(terms, cell.position(xi)).1;
            worst = worst.max((b * &u - DVector::from_row_slice(&want)).amax());
        }
        worst
    };
    assert!(error(PARALLELOGRAM, &quadratics) < 1e-13);
    assert!(error(PARALLELOGRAM, &prisms) < 1e-13);
    assert!(error(general, &prisms) < 1e-13);
    // The limit that the documentation states.
    assert!(error(general, &quadratics) > 1e-3);
}

/// Exact displacement of a bar of one material under σ₁₁ = z, from its compliance.
fn pure_bending(s: &Square6<f64>, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let (s1, s2, s3, s4) = (s[(0, 0)], s[(1, 0)], s[(2, 0)], s[(3, 0)]);
    [
        s1 * x * z + 0.5 * s4 * y * z,
        s2 * y * z + 0.5 * s4 * x * z,
        -0.5 * (s1 * x * x + s2 * y * y + s4 * x * y) + 0.5 * s3 * z * z,
    ]
}

fn matrix(c: &Matrix6) -> Square6<f64> {
    Square6::from_fn(|i, j| c[i][j])
}

#[test]
fn patches_keep_constant_strain_and_pure_bending() {
    let elastic = Elastic::transversely_isotropic(13.0, 1.0, 0.35, 0.4, 0.6);
    let compliance = matrix(&rotate_stiffness(&elastic.stiffness(), 30_f64.to_radians())).try_inverse().unwrap();
    let linear: Vec<_> =
        (0..8).map(|i| [i % 2, i / 2 % 2, i / 4]).filter(|t: &[i32; 3]| t.iter().sum::<i32>() < 2).collect();
    let skew = grid(2, 2, |x, y| [x + 0.4 * y, y - 0.2 * x]);
    type Field<'a> = &'a dyn Fn([f64; 3]) -> [f64; 3];
    let constant_strain: Field = &|p| polynomial(&linear, p).0;
    let bending: Field = &|p| pure_bending(&compliance, p);
    for (mesh, field) in [(patch(), constant_strain), (skew, bending)] {
        let layer = even(&elastic, &[30.0, 30.0]);
        let model = Model::new(&hex20(), mesh, vec![-0.3, 0.1, 0.3], vec![layer.clone(), layer]);
        let inner = |[x, y, z]: [f64; 3]| {
            let outer = |v: f64| !(1e-9..1.0 - 1e-9).contains(&v);
            // Back to the unit square in the skew mesh: its inner columns are those away from the edges there.
            let det = 1.0 + 0.4 * 0.2;
            let back = [(x - 0.4 * y) / det, (y + 0.2 * x) / det];
            let square = if model.plate.plane.quads.len() == 4 { back } else { [x, y] };
            !outer(square[0]) && !outer(square[1]) && z.abs() < 0.29
        };
        let unknowns = model.unknowns();
        assert!(unknowns.iter().filter(|u| inner(u.1)).count() > 20);
        let load = DVector::zeros(unknowns.len());
        let exact = |dof: fem_core::dof::Dof, p: [f64; 3]| field(p)[dof.n() - 1];
        let u = model.solve(&load, |dof, p| (!inner(p)).then(|| exact(dof, p)));
        for (u, (dof, p)) in u.iter().zip(unknowns) {
            assert!((u - exact(dof, p)).abs() < 1e-13, "{dof} {p:?}: {u} {}", exact(dof, p));
        }
    }
}

#[test]
fn a_cantilever_bends_by_beam_theory() {
    // No transverse contraction, so that the clamped end disturbs nothing but the warping of the section.
    let (e, length, width, height) = (210.0, 20.0, 0.7, 1.0);
    let stack = even(&Elastic::isotropic(e, 0.0), &[0.0]);
    // Mean deflection of the end face under a unit force that is uniform over it: of each cell's 8-node face the corners
    // carry −1/12, the middles of the edges 1/3.
    let deflection = |cells: usize, layers: usize| {
        let mesh = grid(cells, 1, |x, y| [length * x, width * y]);
        let faces: Vec<f64> = (0..=layers).map(|i| height * (i as f64 / layers as f64 - 0.5)).collect();
        let model = Model::new(&hex20(), mesh, faces.clone(), vec![stack.clone(); layers]);
        let unknowns = model.unknowns();
        let mut load = DVector::<f64>::zeros(unknowns.len());
        for face in faces.windows(2) {
            for (y, z) in (0..9).filter(|i| *i != 4).map(|i| (i % 3, i / 3)) {
                let place = [length, 0.5 * y as f64 * width, face[0] + 0.5 * z as f64 * (face[1] - face[0])];
                let near = |p: [f64; 3]| p.iter().zip(place).all(|(a, b)| (a - b).abs() < 1e-9);
                let unknown = unknowns.iter().position(|(dof, p)| dof.n() == 3 && near(*p)).unwrap();
                load[unknown] += if y == 1 || z == 1 { 1.0 / 3.0 } else { -1.0 / 12.0 } / layers as f64;
            }
        }
        assert!((load.sum() - 1.0).abs() < 1e-14);
        model.solve(&load, |_, p| (p[0] == 0.0).then_some(0.0)).dot(&load)
    };
    let inertia = width * height.powi(3) / 12.0;
    let shear = 5.0 / 6.0 * 0.5 * e * width * height;
    let want = length.powi(3) / (3.0 * e * inertia) + length / shear;
    for (cells, layers, tolerance) in [(10, 1, 1e-3), (20, 2, 1e-4)] {
        let got = deflection(cells, layers);
        assert!((got / want - 1.0).abs() < tolerance, "{cells} cells, {layers} layers: {got} {want}");
    }
}

#[test]
fn frequencies_of_a_thick_laminate_are_those_of_exact_elasticity() {
    // Simply supported square plate [0/90/0], a/h = 10: ω h sqrt(ρ/E2) of mode (1,1) by series and transfer matrices.
    const EXACT: f64 = 0.114573496283;
    let layer = even(&pagano(), &[0.0]);
    let turned = even(&pagano(), &[90.0]);
    let faces = [-3.0, -1.0, 1.0, 3.0].map(|z| z / 6.0);
    let mesh = grid(3, 3, |x, y| [5.0 * x, 5.0 * y]);
    let model = Model::new(&hex20(), mesh, faces.to_vec(), vec![layer.clone(), turned, layer]);
    let omega = model.lowest_frequency(quarter_support([10.0, 10.0]));
    assert!((omega / EXACT - 1.0).abs() < 1e-3, "{omega} {EXACT}");
}

#[test]
fn mass_is_the_cells_in_every_direction() {
    let stack = stack(&carbon(), &[(0.0, 1.0), (90.0, 2.0)]);
    let cell = Cell { corners: CROOKED.into(), z: [-0.4e-3, 0.9e-3], stack: &stack };
    let m = mass(&hex20(), &cell);
    let quad =
        fem_core::mesh::PlaneMesh { points: CROOKED.to_vec(), quads: vec![[0, 1, 2, 3].into()], ..Default::default() };
    // Densities 1 and 1.5 in a third and two thirds of the height.
    let total = quad.area() * 1.3e-3 * (1.0 + 3.0) / 3.0;
    for n in 0..3 {
        for n2 in 0..3 {
            let u = |n: usize| DVector::from_fn(60, |i, _| f64::from(u8::from(i % 3 == n)));
            let got = u(n).dot(&(&m * u(n2)));
            let want = if n == n2 { total } else { 0.0 };
            assert!((got - want).abs() < 1e-13 * total, "{n} {n2}: {got} {want}");
        }
    }
    assert_eq!(m, m.transpose());
}

#[test]
fn stiffness_turns_with_the_cell_and_with_its_numbering() {
    let plies = [(0.0, 1.0), (90.0, 2.0), (-45.0, 0.5)];
    let turned_by = |angle: f64| {
        let (s, c) = angle.to_radians().sin_cos();
        let stack = stack(&carbon(), &plies.map(|(a, t)| (a + angle, t)));
        let corners = CROOKED.map(|[x, y]| [c * x - s * y, s * x + c * y]);
        stiffness(&hex20(), &Cell { corners: corners.into(), z: [0.0, 1e-3], stack: &stack })
    };
    let angle = 37.0_f64;
    let (s, c) = angle.to_radians().sin_cos();
    let rotation = DMatrix::from_fn(60, 60, |i, j| match (i / 3 == j / 3, i % 3, j % 3) {
        (false, ..) => 0.0,
        (_, 0, 0) | (_, 1, 1) => c,
        (_, 0, 1) => -s,
        (_, 1, 0) => s,
        (_, 2, 2) => 1.0,
        _ => 0.0,
    });
    let straight = turned_by(0.0);
    let expected = &rotation * &straight * rotation.transpose();
    assert!(difference(&turned_by(angle), &expected) < 1e-12);

    let stack = stack(&carbon(), &plies);
    let corners = [1, 2, 3, 0].map(|i| CROOKED[i]);
    let renumbered = stiffness(&hex20(), &Cell { corners: corners.into(), z: [0.0, 1e-3], stack: &stack });
    // The point (r, s) of the new numbering is (−s, r) of the old.
    let element = hex20();
    let nodes = element.info().nodes;
    let old: Vec<usize> =
        nodes.iter().map(|[r, s, q]| nodes.iter().position(|n| *n == [-s, *r, *q]).unwrap()).collect();
    let unknowns: Vec<usize> = old.iter().flat_map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect();
    let expected = straight.select_rows(&unknowns).select_columns(&unknowns);
    assert!(difference(&renumbered, &expected) < 1e-12);
}
