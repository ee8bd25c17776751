//! The laminated shell against hand integration, plate theory and exact elasticity.

use crate::dense::*;
use fem_core::dof::Dof;
use fem_core::element::{Cell, Element, Stack};
use fem_core::material::Elastic;
use fem_core::mesh::PlaneMesh;
use fem_core::tensor::Matrix6;
use fem_core::testkit::Provided;
use fem_elements::Mitc4;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Matrix3x2, SMatrix, Vector2, Vector6};
use std::f64::consts::PI;

const N: usize = 20;

fn mitc4() -> Mitc4 {
    Mitc4::default()
}

/// Stiffness in the plane 11 22 12 under σ₃₃ = 0: the inverse of the in-plane part of the compliance.
fn reduced(c: &Matrix6) -> Matrix3<f64> {
    let s = SMatrix::<f64, 6, 6>::from_fn(|i, j| c[i][j]).try_inverse().unwrap();
    Matrix3::from_fn(|i, j| s[([0, 1, 3][i], [0, 1, 3][j])]).try_inverse().unwrap()
}

/// D of a stack of height 1, symmetric about its middle.
fn bending(stack: &Stack) -> Matrix3<f64> {
    let terms = stack.slices.iter().map(|s| reduced(&s.c) * ((s.q[1].powi(3) - s.q[0].powi(3)) / 24.0));
    terms.fold(Matrix3::zeros(), |sum, d| sum + d)
}

/// Unknowns of a cell that has the section strains `e` throughout: ε⁰ (3), κ (3), γ₃₁ γ₂₃.
fn section_state(e: &[f64; 8], [x, y, _]: [f64; 3]) -> [f64; 5] {
    let (a, b) = (e[3] * x + 0.5 * e[5] * y, e[4] * y + 0.5 * e[5] * x);
    [
        e[0] * x + 0.5 * e[2] * y,
        e[1] * y + 0.5 * e[2] * x,
        e[6] * x + e[7] * y - 0.5 * (e[3] * x * x + e[4] * y * y + e[5] * x * y),
        a,
        b,
    ]
}

fn cell_state(cell: &Cell<'_>, e: &[f64; 8]) -> DVector<f64> {
    let nodes = mitc4().info().nodes.iter();
    DVector::from_vec(nodes.flat_map(|n| section_state(e, cell.position(*n))).collect())
}

fn area(corners: [[f64; 2]; 4]) -> f64 {
    PlaneMesh { points: corners.to_vec(), quads: vec![[0, 1, 2, 3].into()], ..Default::default() }.area()
}

/// Twice the energy of two states per area: a term of the section stiffness.
fn section(stack: &Stack, z: [f64; 2], i: usize, j: usize) -> f64 {
    let cell = Cell { corners: CROOKED.into(), z, stack };
    let unit = |k: usize| cell_state(&cell, &std::array::from_fn(|l| f64::from(u8::from(k == l))));
    unit(i).dot(&(stiffness(&mitc4(), &cell) * unit(j))) / area(CROOKED)
}

fn shear_stiffness(stack: &Stack, z: [f64; 2]) -> Matrix2<f64> {
    Matrix2::from_fn(|i, j| section(stack, z, 6 + i, 6 + j))
}

/// Stress in the ply `slice` at q under the mean transverse shears `gamma`.
fn shear_state(stack: &Stack, z: [f64; 2], gamma: [f64; 2], slice: usize, q: f64) -> Vector6<f64> {
    let cell = Cell { corners: CROOKED.into(), z, stack };
    let mut b = SMatrix::<f64, 6, N>::zeros();
    mitc4().strain_operator(&cell, slice, [0.3, -0.6, q], b.as_mut_slice());
    let c = SMatrix::<f64, 6, 6>::from_fn(|i, j| stack.slices[slice].c[i][j]);
    let strain = b * cell_state(&cell, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, gamma[0], gamma[1]]);
    c * strain
}

#[test]
fn overrides_agree_with_the_provided_methods() {
    for plies in [vec![(30.0, 1.0)], vec![(0.0, 1.0), (90.0, 2.0), (-45.0, 0.5), (20.0, 1.0)]] {
        let stack = stack(&carbon(), &plies);
        check_overrides(&mitc4(), &Cell { corners: CROOKED.into(), z: [-0.4e-3, 0.9e-3], stack: &stack });
    }
}

#[test]
fn only_rigid_motions_are_without_energy() {
    for plies in [vec![(30.0, 1.0)], vec![(0.0, 1.0), (90.0, 2.0), (-45.0, 0.5)]] {
        let stack = stack(&carbon(), &plies);
        check_rigid_motions(&mitc4(), &Cell { corners: CROOKED.into(), z: [-0.4e-3, 0.9e-3], stack: &stack });
    }
}

#[test]
fn bad_cells_are_refused() {
    let good = even(&carbon(), &[0.0]);
    let mut slack = good.slices.clone();
    slack[0].c = [[0.0; 6]; 6];
    let slack = Stack::new(slack);
    for (corners, z, stack) in [
        (CROOKED, [0.0, 0.0], &good),
        (CROOKED, [1e-3, 0.0], &good),
        ([CROOKED[0], CROOKED[2], CROOKED[1], CROOKED[3]], [0.0, 1e-3], &good),
        ([CROOKED[0], [f64::NAN, 0.0], CROOKED[2], CROOKED[3]], [0.0, 1e-3], &good),
        (CROOKED, [0.0, 1e-3], &slack),
    ] {
        let cell = Cell { corners: corners.into(), z, stack };
        let (mut scratch, mut k) = (Default::default(), vec![0.0; N * N]);
        assert!(mitc4().stiffness(&cell, &mut scratch, &mut k).is_err());
        assert!(Provided(&mitc4()).stiffness(&cell, &mut scratch, &mut k).is_err());
        assert_eq!(mitc4().mass(&cell, &mut scratch, &mut k).is_err(), std::ptr::eq(stack, &good));
    }
}

#[test]
fn section_stiffness_is_that_of_laminate_theory() {
    let angles = [30.0, -45.0, 0.0, 90.0];
    let stack = even(&carbon(), &angles);
    let (height, z) = (1.2e-3, [-0.3e-3, 0.9e-3]);
    let mut want = SMatrix::<f64, 6, 6>::zeros();
    for (ply, slice) in stack.slices.iter().enumerate() {
        let [low, high] = [ply, ply + 1].map(|i| height * (i as f64 / 4.0 - 0.5));
        let q = reduced(&slice.c);
        for i in 0..6 {
            for j in 0..6 {
                let power = 1 + (i / 3 + j / 3) as i32;
                want[(i, j)] += q[(i % 3, j % 3)] * (high.powi(power) - low.powi(power)) / f64::from(power);
            }
        }
    }
    for i in 0..6 {
        for j in 0..6 {
            let scale = (want[(i, i)] * want[(j, j)]).sqrt();
            let got = section(&stack, z, i, j);
            assert!((got - want[(i, j)]).abs() < 1e-12 * scale, "{i} {j}: {got} {}", want[(i, j)]);
        }
        for j in 6..8 {
            assert!(section(&stack, z, i, j).abs() < 1e-12 * (want[(i, i)] * 1e9 * height).sqrt());
        }
    }
}

#[test]
fn a_plate_of_one_material_has_five_sixths() {
    let (height, z) = (0.8e-3, [0.0, 0.8e-3]);
    for angles in [vec![25.0], vec![25.0; 5]] {
        let stack = even(&carbon(), &angles);
        let c = &stack.slices[0].c;
        let want = Matrix2::new(c[5][5], c[5][4], c[4][5], c[4][4]) * (5.0 / 6.0 * height);
        let got = shear_stiffness(&stack, z);
        assert!((got - want).amax() < 1e-12 * want.amax(), "{got} {want}");
        // Parabola through the thickness: τ = 3/2 (1 − q²) Q / h.
        let gamma = [0.7, -0.4];
        let force = want * Vector2::from(gamma);
        for (slice, s) in stack.slices.iter().enumerate() {
            for q in [s.q[0], 0.5 * (s.q[0] + s.q[1]), s.q[1]] {
                let stress = shear_state(&stack, z, gamma, slice, q);
                for (row, force) in [(5, force[0]), (4, force[1])] {
                    let want = 1.5 * (1.0 - q * q) * force / height;
                    assert!((stress[row] - want).abs() < 1e-12 * force.abs() / height);
                }
            }
        }
    }
}

#[test]
fn shear_of_a_cross_ply_is_that_of_hand_integration() {
    let elastic = pagano();
    let stack = even(&elastic, &[0.0, 90.0, 0.0]);
    let (z1, h2): (f64, f64) = (0.5 / 3.0, 0.5);
    let nu21 = elastic.nu12 * elastic.e2 / elastic.e1;
    let [along, across] = [elastic.e1, elastic.e2].map(|e| e / (1.0 - elastic.nu12 * nu21));
    let mixed = elastic.nu12 * across;
    // ∫ z² over the inner and the two outer plies.
    let (inner, outer) = (2.0 / 3.0 * z1.powi(3), 2.0 / 3.0 * (h2.powi(3) - z1.powi(3)));
    let (d11, d22) = (along * outer + across * inner, across * outer + along * inner);
    let d12 = mixed * (inner + outer);
    let det = d11 * d22 - d12 * d12;
    for (axis, [q_outer, q_inner], [g_outer, g_inner], [own, other]) in [
        (0, [along, across], [elastic.g13, elastic.g23], [d22 / det, -d12 / det]),
        (1, [across, along], [elastic.g23, elastic.g13], [d11 / det, -d12 / det]),
    ] {
        // Stress s z of a unit moment, hence τ = c − s z²/2 of a unit shear force.
        let [s_outer, s_inner] = [q_outer, q_inner].map(|q| q * own + mixed * other);
        let c_outer = 0.5 * s_outer * h2 * h2;
        let c_inner = c_outer - 0.5 * s_outer * z1 * z1 + 0.5 * s_inner * z1 * z1;
        let square = |c: f64, s: f64, z: f64| c * c * z - c * s * z.powi(3) / 3.0 + s * s * z.powi(5) / 20.0;
        let compliance = 2.0 * square(c_inner, s_inner, z1) / g_inner
            + 2.0 * (square(c_outer, s_outer, h2) - square(c_outer, s_outer, z1)) / g_outer;
        let got = shear_stiffness(&stack, [-0.5, 0.5]);
        assert!((got[(axis, axis)] * compliance - 1.0).abs() < 1e-12, "{axis}: {got} {}", 1.0 / compliance);
        assert!(got[(0, 1)].abs() < 1e-14);
        let mut gamma = [0.0; 2];
        gamma[axis] = 1.0;
        for (slice, z, c, s) in [
            (0, -0.5, c_outer, s_outer),
            (0, -0.4, c_outer, s_outer),
            (0, -z1, c_outer, s_outer),
            (1, -z1, c_inner, s_inner),
            (1, 0.1, c_inner, s_inner),
            (2, z1, c_outer, s_outer),
            (2, 0.5, c_outer, s_outer),
        ] {
            let stress = shear_state(&stack, [-0.5, 0.5], gamma, slice, 2.0 * z);
            let want = (c - 0.5 * s * z * z) / compliance;
            assert!((stress[5 - axis] - want).abs() < 1e-12, "{axis} {slice} {z}: {} {want}", stress[5 - axis]);
            assert!(stress[4 + axis].abs() < 1e-14 && stress[2].abs() < 1e-14);
        }
    }
}

#[test]
fn shear_of_a_coupled_laminate_is_that_of_summation() {
    let stack = stack(&carbon(), &[(30.0, 1.0), (-45.0, 2.0), (0.0, 1.0), (90.0, 0.5)]);
    let height = 1.5e-3;
    let z = [-0.6e-3, 0.9e-3];
    // Thin sheets: a multiple of 9, so that plies end where sheets do.
    let sheets = 9 * 400;
    let slice_at = |q: f64| stack.slices.iter().position(|s| q < s.q[1]).unwrap();
    let middles = || (0..sheets).map(|i| 2.0 * (i as f64 + 0.5) / sheets as f64 - 1.0);
    let (dz, half) = (height / sheets as f64, 0.5 * height);
    let mut abd = SMatrix::<f64, 6, 6>::zeros();
    for q in middles() {
        let stiff = reduced(&stack.slices[slice_at(q)].c);
        let z = q * half;
        for i in 0..6 {
            for j in 0..6 {
                abd[(i, j)] += stiff[(i % 3, j % 3)] * z.powi((i / 3 + j / 3) as i32) * dz;
            }
        }
    }
    let inverse = abd.try_inverse().unwrap();
    let (strain, curvature) = (inverse.fixed_view::<3, 2>(0, 3), inverse.fixed_view::<3, 2>(3, 3));
    // τ at the faces of the sheets: minus the membrane forces below, per unit M₁₁,₁ and M₂₂,₂.
    let mut below = Matrix3x2::zeros();
    let mut courses = vec![Matrix2::zeros()];
    for q in middles() {
        below += reduced(&stack.slices[slice_at(q)].c) * (strain + curvature * (q * half)) * dz;
        courses.push(-Matrix2::new(below[(0, 0)], below[(2, 1)], below[(2, 0)], below[(1, 1)]));
    }
    let mut compliance = Matrix2::zeros();
    let mut resultant = Matrix2::zeros();
    for (q, pair) in middles().zip(courses.windows(2)) {
        let c = &stack.slices[slice_at(q)].c;
        let g = Matrix2::new(c[5][5], c[5][4], c[4][5], c[4][4]).try_inverse().unwrap();
        let f = 0.5 * (pair[0] + pair[1]);
        compliance += f.transpose() * g * f * dz;
        resultant += f * dz;
    }
    assert!((resultant - Matrix2::identity()).amax() < 1e-6, "{resultant}");
    let want = compliance.try_inverse().unwrap();
    let got = shear_stiffness(&stack, z);
    assert!((got - want).amax() < 1e-6 * want.amax(), "{got} {want}");
    let gamma = Vector2::new(0.7, -0.4);
    let scale = (want * gamma).norm() / height;
    for (i, course) in courses.iter().enumerate().step_by(sheets / 9) {
        let q = 2.0 * i as f64 / sheets as f64 - 1.0;
        let want = course * want * gamma;
        // From both sides of an interface.
        for (slice, s) in stack.slices.iter().enumerate().filter(|(_, s)| s.q[0] - 1e-12 < q && q < s.q[1] + 1e-12) {
            let stress = shear_state(&stack, z, gamma.into(), slice, q);
            for (row, want) in [(5, want[0]), (4, want[1])] {
                assert!((stress[row] - want).abs() < 1e-6 * scale, "ply {slice} {:?}: {} {want}", s.q, stress[row]);
            }
        }
    }
}

#[test]
fn patches_keep_constant_section_strains() {
    let stack = even(&Elastic::transversely_isotropic(13.0, 1.0, 0.35, 0.4, 0.6), &[30.0, -45.0, 0.0]);
    let model = Model::new(&mitc4(), patch(), vec![-0.05, 0.05], vec![stack]);
    let unknowns = model.unknowns();
    let load = DVector::zeros(unknowns.len());
    let inner = |p: [f64; 3]| p[..2].iter().all(|c| *c > 1e-9 && *c < 1.0 - 1e-9);
    // Bending and membrane strains together. Constant shear is a patch of its own: its moments would vary.
    for e in [[1.0, -0.5, 0.3, 0.2, 0.7, -0.6, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, -0.7]] {
        let exact = |dof: Dof, p: [f64; 3]| section_state(&e, p)[if dof.m() == 0 { dof.n() - 1 } else { dof.n() + 2 }];
        let u = model.solve(&load, |dof, p| (!inner(p) || (e[6] != 0.0 && dof.m() > 0)).then(|| exact(dof, p)));
        for (u, (dof, p)) in u.iter().zip(&unknowns) {
            assert!((u - exact(*dof, *p)).abs() < 1e-11, "{dof} {p:?}: {u} {}", exact(*dof, *p));
        }
    }
}

#[test]
fn mass_has_the_inertia_of_translation_and_rotation() {
    let stack = stack(&carbon(), &[(0.0, 1.0), (90.0, 2.0)]);
    let height = 1.3e-3;
    let m = mass(&mitc4(), &Cell { corners: CROOKED.into(), z: [-0.4e-3, 0.9e-3], stack: &stack });
    // Densities 1 and 1.5 below and above z = −h/6.
    let moment = |p: i32| {
        let primitive = |z: f64| (z * height).powi(p) / f64::from(p);
        primitive(-1.0 / 6.0) - primitive(-0.5) + 1.5 * (primitive(0.5) - primitive(-1.0 / 6.0))
    };
    let [m0, m1, m2] = [1, 2, 3].map(|p| moment(p) * area(CROOKED));
    for i in 0..5 {
        for j in 0..5 {
            let u = |k: usize| DVector::from_fn(N, |row, _| f64::from(u8::from(row % 5 == k)));
            let want = match (i.min(j), i.max(j)) {
                (0, 0) | (1, 1) | (2, 2) => m0,
                (0, 3) | (1, 4) => m1,
                (3, 3) | (4, 4) => m2,
                _ => 0.0,
            };
            let got = u(i).dot(&(&m * u(j)));
            assert!((got - want).abs() < 1e-13 * m0, "{i} {j}: {got} {want}");
            assert!(want == 0.0 || (got / want - 1.0).abs() < 1e-12, "{i} {j}: {got} {want}");
        }
    }
}

#[test]
fn stiffness_turns_with_the_cell_and_with_its_numbering() {
    let turned_by = |angle: f64, plies: &[f64]| {
        let (s, c) = angle.to_radians().sin_cos();
        let stack = even(&carbon(), &plies.iter().map(|a| a + angle).collect::<Vec<_>>());
        let corners = CROOKED.map(|[x, y]| [c * x - s * y, s * x + c * y]);
        stiffness(&mitc4(), &Cell { corners: corners.into(), z: [0.0, 1e-3], stack: &stack })
    };
    // Laminates turn by right angles, plates of one material by any.
    for (angle, plies) in [(37.0, vec![20.0; 3]), (90.0, vec![0.0, 90.0, -45.0])] {
        let (s, c) = f64::to_radians(angle).sin_cos();
        let rotation = DMatrix::from_fn(N, N, |i, j| match (i / 5 == j / 5, i % 5, j % 5) {
            (false, ..) => 0.0,
            (_, 0, 0) | (_, 1, 1) | (_, 3, 3) | (_, 4, 4) => c,
            (_, 0, 1) | (_, 3, 4) => -s,
            (_, 1, 0) | (_, 4, 3) => s,
            (_, 2, 2) => 1.0,
            _ => 0.0,
        });
        let expected = &rotation * turned_by(0.0, &plies) * rotation.transpose();
        let error = difference(&turned_by(angle, &plies), &expected);
        assert!(error < 1e-12, "{angle}: {error:e}");
    }
    let plies = [0.0, 90.0, -45.0];
    let stack = even(&carbon(), &plies);
    let corners = [1, 2, 3, 0].map(|i| CROOKED[i]);
    let renumbered = stiffness(&mitc4(), &Cell { corners: corners.into(), z: [0.0, 1e-3], stack: &stack });
    let unknowns: Vec<usize> = (0..N).map(|i| (i + 5) % N).collect();
    let expected = turned_by(0.0, &plies).select_rows(&unknowns).select_columns(&unknowns);
    assert!(difference(&renumbered, &expected) < 1e-12);
}

#[test]
fn thin_plates_do_not_lock() {
    // Simply supported square, uniform pressure, a/h = 10⁴, against Navier's series of classical laminate theory.
    let stack = even(&pagano(), &[0.0, 90.0, 0.0]);
    let (a, cells) = (1e4, 16);
    let d = bending(&stack);
    let odd = || (0..100).map(|i| f64::from(2 * i + 1));
    let term = |m: f64, n: f64| {
        let bending =
            d[(0, 0)] * m.powi(4) + 2.0 * (d[(0, 1)] + 2.0 * d[(2, 2)]) * (m * n).powi(2) + d[(1, 1)] * n.powi(4);
        16.0 * a * a * a * a * ((m + n) * PI / 2.0 - PI / 2.0).sin() / (PI.powi(6) * m * n * bending)
    };
    let series: f64 = odd().map(|m| odd().map(|n| term(m, n)).sum::<f64>()).sum();
    // A regular mesh and one with its lines bent.
    for (bend, tolerance) in [(0.0, 5e-3), (0.15, 5e-3)] {
        let map = |x: f64, y: f64| {
            let bulge = bend * (PI * x).sin() * (PI * y).sin();
            [0.5 * a * (x + bulge), 0.5 * a * (y - bulge)]
        };
        let model = Model::new(&mitc4(), grid(cells, cells, map), vec![-0.5, 0.5], vec![stack.clone()]);
        // A pressure of 1 from the mass of translation: density 1, height 1.
        let up = |dof: Dof| f64::from(u8::from(dof.n() == 3 && dof.m() == 0));
        let unknowns = model.unknowns();
        let load = &model.m * DVector::from_iterator(unknowns.len(), unknowns.iter().map(|u| up(u.0)));
        let support = quarter_support([a, a]);
        let u = model.solve(&load, |dof, p| support(dof, p).then_some(0.0));
        let centre = unknowns.iter().position(|(dof, p)| up(*dof) > 0.0 && p[0] == 0.0 && p[1] == 0.0).unwrap();
        assert!((u[centre] / series - 1.0).abs() < tolerance, "bend {bend}: {} {series}", u[centre]);
    }
}

/// Lowest ω of mode (1,1) of a simply supported square plate of height and density 1 by first-order shear theory with
/// rotary inertia, Navier's solution: w = W sin sin, a = A cos sin, b = B sin cos.
fn first_order_frequency(stack: &Stack, side: f64) -> f64 {
    let (d, h, p) = (bending(stack), shear_stiffness(stack, [-0.5, 0.5]), PI / side);
    let mixed = (d[(0, 1)] + d[(2, 2)]) * p * p;
    let k = Matrix3::new(
        (h[(0, 0)] + h[(1, 1)]) * p * p,
        h[(0, 0)] * p,
        h[(1, 1)] * p,
        h[(0, 0)] * p,
        (d[(0, 0)] + d[(2, 2)]) * p * p + h[(0, 0)],
        mixed,
        h[(1, 1)] * p,
        mixed,
        (d[(1, 1)] + d[(2, 2)]) * p * p + h[(1, 1)],
    );
    let scale = Matrix3::from_diagonal(&[1.0, 12_f64.sqrt(), 12_f64.sqrt()].into());
    (scale * k * scale).symmetric_eigenvalues().min().sqrt()
}

#[test]
fn frequencies_converge_to_first_order_theory_and_that_is_near_exact_elasticity() {
    // Simply supported square, a/h = 10: ω h sqrt(ρ/E2) of mode (1,1) by series and transfer matrices.
    let steel = Elastic::isotropic(1.0, 0.3);
    for (elastic, angles, exact, theory) in [
        (steel, vec![0.0], 0.057769128211, 2e-3),
        (pagano(), vec![0.0, 90.0, 0.0], 0.114573496283, 1e-2),
        (pagano(), vec![0.0, 90.0, 90.0, 0.0], 0.115853342845, 1e-2),
    ] {
        let stack = even(&elastic, &angles);
        let want = first_order_frequency(&stack, 10.0);
        let error = |cells: usize| {
            let mesh = grid(cells, cells, |x, y| [5.0 * x, 5.0 * y]);
            let model = Model::new(&mitc4(), mesh, vec![-0.5, 0.5], vec![stack.clone()]);
            model.lowest_frequency(quarter_support([10.0, 10.0])) / want - 1.0
        };
        let (coarse, fine) = (error(4), error(8));
        // Second order: a quarter of the error on half the cells, to a part in fifty.
        assert!((4.0 * fine - coarse).abs() < 0.02 * coarse, "{angles:?}: {coarse:e} {fine:e}");
        assert!(fine < 5e-3, "{angles:?}: {fine:e}");
        assert!((want / exact - 1.0).abs() < theory, "{angles:?}: {want} {exact}");
    }
}
