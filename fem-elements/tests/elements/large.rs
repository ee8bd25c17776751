//! Large deflections: forces and tangents against differences, motions whose strains are known.

use crate::dense::*;
use fem_core::element::{Cell, Element, Part, Point, Scratch, Slice, Stack};
use fem_core::large::{LargeDeflection, green_lagrange};
use fem_core::quadrature::gauss_legendre;
use fem_elements::{HermiteHex, HermitePrism, Hex20, Mass, Mitc4, PlaneState, TransverseStresses, WebsterBeam};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3, Vector6};

const PARALLELOGRAM: [[f64; 2]; 4] = [[0.0, 0.0], [2.0e-3, 0.5e-3], [2.7e-3, 1.9e-3], [0.7e-3, 1.4e-3]];

fn plies() -> Stack {
    stack(&carbon(), &[(0.0, 1.0), (90.0, 2.0), (-45.0, 0.5), (20.0, 1.0)])
}

/// The same with free strains, as different from ply to ply as they can be.
fn hot_plies() -> Stack {
    let mut slices = plies().slices;
    for (i, slice) in slices.iter_mut().enumerate() {
        slice.free = std::array::from_fn(|k| if k == 4 || k == 5 { 0.0 } else { 0.01 * ((3 * i + k) as f64).cos() });
    }
    Stack::new(slices)
}

fn smooth() -> HermitePrism {
    HermitePrism::new(Mass::Cubic, 4).unwrap()
}

/// Whose strains are those of their displacements.
fn plain() -> [Box<dyn Element>; 3] {
    [
        Box::new(smooth().with_transverse_stresses(TransverseStresses::OfStrains)),
        Box::new(HermiteHex::new(Mass::Cubic)),
        Box::new(Hex20::new(3).unwrap()),
    ]
}

fn solids() -> impl Iterator<Item = Box<dyn Element>> {
    plain().into_iter().chain([Box::new(smooth()) as Box<dyn Element>])
}

fn shares(element: &dyn Element) -> bool {
    format!("{element:?}").contains("stresses: Smooth")
}

fn sections() -> [Box<dyn Element>; 2] {
    [PlaneState::Stress, PlaneState::Strain]
        .map(|state| -> Box<dyn Element> { Box::new(WebsterBeam::new(state, Mass::Cubic, 4).unwrap()) })
}

fn all() -> impl Iterator<Item = Box<dyn Element>> {
    solids().chain(sections()).chain([Box::new(Mitc4::default()) as Box<dyn Element>])
}

/// A cell that the element takes, 0.8 mm high.
fn cell<'a>(element: &dyn Element, stack: &'a Stack) -> Cell<'a> {
    let corners = if element.info().is_section() {
        [[0.0, -0.5e-3], [2.0e-3, -0.5e-3], [2.0e-3, 1.0e-3], [0.0, 1.0e-3]]
    } else {
        PARALLELOGRAM
    };
    Cell { corners: corners.into(), z: [-0.3e-3, 0.5e-3], stack }
}

/// Energy, force and tangent at `u`.
fn internal(element: &dyn Element, cell: &Cell<'_>, u: &DVector<f64>) -> (f64, DVector<f64>, DMatrix<f64>) {
    let n = u.len();
    let (mut force, mut tangent) = (DVector::repeat(n, f64::NAN), DMatrix::repeat(n, n, f64::NAN));
    let large = element.large_deflections().unwrap();
    let energy =
        large.internal(cell, u.as_slice(), &mut Scratch::default(), force.as_mut_slice(), Some(tangent.as_mut_slice()));
    (energy.unwrap(), force, tangent)
}

/// Unknowns of the displacement u(X) = `a` + `h` X + part of an arbitrary field; derivatives follow.
fn motion(element: &dyn Element, cell: &Cell<'_>, h: &Matrix3<f64>, wild: f64) -> DVector<f64> {
    let info = element.info();
    let mut u = Vec::new();
    for (i, node) in info.nodes.iter().enumerate() {
        let x = Vector3::from(cell.position(*node));
        for (k, dof) in info.dofs.iter().enumerate() {
            let (n, m) = (dof.n() - 1, dof.m());
            let noise = wild * ((7 * i + 13 * k) as f64).sin();
            u.push(if m == 0 { (h * x)[n] + 1e-3 * noise } else { h[(n, m - 1)] + noise });
        }
    }
    DVector::from_vec(u)
}

#[test]
fn without_displacements_there_is_no_force_and_the_tangent_is_the_stiffness() {
    let stack = plies();
    for element in all() {
        let u = DVector::zeros(element.info().ndof());
        let (energy, force, tangent) = internal(&*element, &cell(&*element, &stack), &u);
        assert_eq!((energy, force.amax()), (0.0, 0.0));
        let error = difference(&tangent, &stiffness(&*element, &cell(&*element, &stack)));
        assert!(error < 1e-12, "{element:?}: {error:e}");
    }
}

/// Elements may sum forces alone in another way than with the tangent, several points at a time and what is left of them.
#[test]
fn forces_are_the_same_without_the_tangent() {
    let stack = hot_plies();
    let quadrilateral = [[0.0, 0.0], [2.0e-3, 0.4e-3], [2.5e-3, 1.9e-3], [-0.3e-3, 1.2e-3]];
    let other_orders = [3, 5].map(|order| Box::new(HermitePrism::new(Mass::Cubic, order).unwrap()) as Box<dyn Element>);
    for element in all().chain(other_orders) {
        let regular = cell(&*element, &stack);
        let corners = if element.info().is_section() { regular.corners } else { quadrilateral.into() };
        let cell = Cell { corners, ..regular };
        let u = motion(&*element, &cell, &Matrix3::new(0.02, 0.1, 0.0, -0.1, 0.01, 0.05, -0.2, 0.1, 0.03), 0.05);
        let (energy, force, _) = internal(&*element, &cell, &u);
        let large = element.large_deflections().unwrap();
        let mut alone = DVector::repeat(u.len(), f64::NAN);
        let got = large.internal(&cell, u.as_slice(), &mut Scratch::default(), alone.as_mut_slice(), None).unwrap();
        assert!((got - energy).abs() < 1e-13 * energy, "{element:?}: {got} {energy}");
        for (unknown, (a, b)) in alone.iter().zip(&force).enumerate() {
            let dofs = element.info().dofs;
            let like =
                (0..u.len()).filter(|k| (dofs[k % dofs.len()].m() == 0) == (dofs[unknown % dofs.len()].m() == 0));
            let scale = like.map(|k| force[k].abs()).fold(0.0, f64::max);
            assert!((a - b).abs() < 1e-13 * scale, "{element:?}, force {unknown}: {a} {b}");
        }
    }
}

#[test]
fn forces_are_derivatives_of_the_energy_and_tangents_of_the_forces() {
    let stacks = [plies(), hot_plies()];
    for (element, stack) in all().flat_map(|element| stacks.iter().map(move |stack| (element.clone(), stack))) {
        let cell = cell(&*element, stack);
        let u = motion(&*element, &cell, &Matrix3::new(0.02, 0.1, 0.0, -0.1, 0.01, 0.05, -0.2, 0.1, 0.03), 0.05);
        let (_, force, tangent) = internal(&*element, &cell, &u);
        for k in 0..u.len() {
            // Displacements in metres, derivatives pure numbers. Energies are polynomials of the fourth degree.
            let translation = element.info().dofs[k % element.info().dofs.len()].m() == 0;
            let step = if translation { 1e-6 } else { 1e-3 };
            let at = |steps: f64| {
                let mut u = u.clone();
                u[k] += steps * step;
                internal(&*element, &cell, &u)
            };
            let [(a, fa, _), (b, fb, _), (c, fc, _), (d, fd, _)] = [-2.0, -1.0, 1.0, 2.0].map(at);
            let slope = (a - 8.0 * b + 8.0 * c - d) / (12.0 * step);
            let rough = (force[k] - slope).abs() / (force.amax().max(tangent[(k, k)] * step));
            assert!(rough < 1e-7, "{element:?}, force {k}: {} {slope}", force[k]);
            let column = (fa - fb * 8.0 + fc * 8.0 - fd) / (12.0 * step);
            for (i, (got, want)) in tangent.column(k).iter().zip(&column).enumerate() {
                let scale = (tangent[(i, i)] * tangent[(k, k)]).abs().sqrt();
                assert!((got - want).abs() < 1e-7 * scale, "{element:?}, tangent {i} {k}: {got} {want}");
            }
        }
    }
}

/// At rest large deflections have the force and the energy of small ones; a cell that is as its plies want to be has none.
/// The energy of third degree is ½ ∫ ε C η(u, u) with the quadratic strains η: along u the tangent changes by
/// φᵀ (∂K/∂u) φ = φᵀ K_G(u) φ + 2 uᵀ K_G(φ) φ. Free strains stress a cell that has not moved.
#[test]
fn geometric_stiffnesses_are_those_of_the_energy() {
    let stacks = [plies(), hot_plies()];
    for (element, stack) in all().flat_map(|element| stacks.iter().map(move |stack| (element.clone(), stack))) {
        let cell = cell(&*element, stack);
        let geometric = |u: &DVector<f64>| {
            let mut sum = DMatrix::repeat(u.len(), u.len(), f64::NAN);
            let large = element.large_deflections().unwrap();
            let done = large.geometric_stiffness(&cell, u.as_slice(), &mut Scratch::default(), sum.as_mut_slice());
            done.unwrap();
            assert!((&sum - sum.transpose()).amax() <= 1e-14 * sum.amax(), "{element:?}");
            sum
        };
        let zero = DVector::zeros(element.info().ndof());
        let at_rest = geometric(&zero);
        let hot = internal(&*element, &cell, &zero).2 - stiffness(&*element, &cell);
        assert!((&at_rest - &hot).amax() <= 1e-12 * internal(&*element, &cell, &zero).2.amax(), "{element:?}");
        let u = motion(&*element, &cell, &Matrix3::new(0.02, 0.1, 0.0, -0.1, 0.01, 0.05, -0.2, 0.1, 0.03), 0.05);
        let phi = motion(&*element, &cell, &Matrix3::new(0.1, -0.2, 0.1, 0.3, 0.05, 0.1, 0.1, -0.4, 0.1), 0.1);
        let tangent = |step: f64| internal(&*element, &cell, &(&u * step)).2;
        let change = (tangent(1e-3) - tangent(-1e-3)) / 2e-3;
        let of = |u: &DVector<f64>| geometric(u) - &at_rest;
        let (found, expected) =
            ((of(&u) * &phi).dot(&phi) + 2.0 * (of(&phi) * &phi).dot(&u), (change * &phi).dot(&phi));
        assert!((found - expected).abs() < 1e-6 * expected.abs(), "{element:?}: {found} {expected}");
    }
}

#[test]
fn free_strains_push_a_cell_at_rest() {
    let hot = hot_plies();
    for element in all() {
        let cell = cell(&*element, &hot);
        let n = element.info().ndof();
        let mut push = DVector::repeat(n, f64::NAN);
        let held = element.free_force(&cell, &mut Scratch::default(), push.as_mut_slice()).unwrap();
        let (energy, force, _) = internal(&*element, &cell, &DVector::zeros(n));
        assert!((energy / held - 1.0).abs() < 1e-12, "{element:?}: {energy} {held}");
        assert!((&force + &push).amax() < 1e-12 * push.amax(), "{element:?}");
    }
    let mut same = hot.slices;
    let free = [0.01, -0.02, 0.0, 0.03, 0.0, 0.0];
    same.iter_mut().for_each(|slice| slice.free = free);
    let stack = Stack::new(same);
    for element in solids() {
        let cell = cell(&*element, &stack);
        // Small displacements of that strain.
        let u = motion(&*element, &cell, &Matrix3::new(0.01, 0.015, 0.0, 0.015, -0.02, 0.0, 0.0, 0.0, 0.0), 0.0);
        let mut push = DVector::repeat(u.len(), f64::NAN);
        let held = element.free_force(&cell, &mut Scratch::default(), push.as_mut_slice()).unwrap();
        let k = stiffness(&*element, &cell);
        assert!((&k * &u - &push).amax() < 1e-12 * push.amax(), "{element:?}");
        assert!((0.5 * u.dot(&(&k * &u)) - u.dot(&push) + held).abs() < 1e-12 * held, "{element:?}");
    }
}

#[test]
fn a_turned_cell_has_no_energy_and_a_stretched_one_has_the_same_however_turned() {
    let stack = plies();
    let turn = Rotation3::from_euler_angles(0.7, -1.1, 2.0).into_inner();
    let stretch = Matrix3::new(1.01, 0.02, -0.01, 0.0, 0.98, 0.03, 0.01, 0.0, 1.02);
    for element in solids() {
        let cell = cell(&*element, &stack);
        let energy =
            |f: Matrix3<f64>| internal(&*element, &cell, &motion(&*element, &cell, &(f - Matrix3::identity()), 0.0)).0;
        // W = volume · mean of ½ Eᵀ C E
        let e = Vector6::from(green_lagrange(&(stretch - Matrix3::identity()).transpose().into()));
        let area = 2.45e-6;
        let mean: f64 = stack
            .slices
            .iter()
            .map(|s| {
                let stress: Vec<f64> = s.c.iter().map(|row| row.iter().zip(&e).map(|(c, e)| c * e).sum()).collect();
                0.5 * (s.q[1] - s.q[0]) * 0.5 * stress.iter().zip(&e).map(|(s, e)| s * e).sum::<f64>()
            })
            .sum();
        let want = area * 0.8e-3 * mean;
        let [got, turned, rigid] = [stretch, turn * stretch, turn].map(energy);
        // Plies that share stresses yield a little.
        let want = if shares(&*element) { 1.0_f64.min(got / want).max(0.99) * want } else { want };
        assert!((got / want - 1.0).abs() < 1e-12, "{element:?}: {got} {want}");
        assert!((turned / want - 1.0).abs() < 1e-12, "{element:?}: {turned} {want}");
        assert!(rigid < 1e-26 * want / 1e-4, "{element:?}: {rigid:e} of {want:e}");
    }
}

/// The parts of every ply: all of it, and its upper face.
fn parts(stack: &Stack) -> Vec<Part> {
    let of_slice = |(slice, s): (usize, &Slice)| [s.q, [s.q[1]; 2]].map(|q| Part { slice, q });
    stack.slices.iter().enumerate().flat_map(of_slice).collect()
}

fn mean_strains(element: &dyn Element, cell: &Cell<'_>, u: &DVector<f64>) -> Vec<f64> {
    mean_strains_over(element, cell, element.info().plane(), u)
}

fn mean_strains_over(element: &dyn Element, cell: &Cell<'_>, plane: &[Point], u: &DVector<f64>) -> Vec<f64> {
    let parts = parts(cell.stack);
    let mut strains = vec![f64::NAN; 6 * parts.len() * u.len() / element.info().ndof()];
    element.large_deflections().unwrap().mean_large_strains(cell, &parts, plane, u.as_slice(), &mut strains).unwrap();
    strains
}

#[test]
fn several_fields_have_the_strains_of_each() {
    let stack = plies();
    for element in all() {
        let (cell, n) = (cell(&*element, &stack), element.info().ndof());
        // More than go side by side, and some that do not fill the lanes.
        let fields = DVector::from_fn(6 * n, |i, _| 1e-5 * ((7 * i) as f64).sin());
        let each = fields
            .as_slice()
            .chunks_exact(n)
            .flat_map(|u| mean_strains(&*element, &cell, &DVector::from_column_slice(u)));
        assert_eq!(mean_strains(&*element, &cell, &fields), each.collect::<Vec<_>>(), "{element:?}");
    }
}

/// Plies that share stresses have a uniform strain in their mean, and their stresses are continuous.
#[test]
fn plies_that_share_stresses_share_a_uniform_strain() {
    let stack = plies();
    let element = smooth();
    let h = Matrix3::new(0.01, 0.02, -0.01, 0.0, -0.02, 0.03, 0.01, 0.0, 0.02);
    let want = green_lagrange(&h.transpose().into());
    let cell = cell(&element, &stack);
    let u = motion(&element, &cell, &h, 0.0);
    let strains = mean_strains(&element, &cell, &u);
    let mut mean = [0.0; 6];
    for (slice, strain) in stack.slices.iter().zip(strains.chunks_exact(12)) {
        mean.iter_mut().zip(strain).for_each(|(mean, e)| *mean += 0.5 * (slice.q[1] - slice.q[0]) * e);
    }
    let error = mean.iter().zip(want).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(error < 1e-15, "{mean:?} {want:?}");
    for (number, pair) in stack.slices.windows(2).enumerate() {
        let [below, above] = [0, 1].map(|side| {
            let xi = [0.2, -0.3, pair[0].q[1]];
            let e = element.large_strain(&cell, number + side, xi, u.as_slice()).unwrap();
            fem_core::tensor::apply(&pair[side].c, &e)
        });
        for row in [2, 4, 5] {
            assert!((below[row] - above[row]).abs() < 1e-12 * below[0].abs(), "{number} {row}: {below:?} {above:?}");
        }
    }
}

#[test]
fn means_of_a_uniform_strain_are_that_strain() {
    let stack = plies();
    let h = Matrix3::new(0.01, 0.02, -0.01, 0.0, -0.02, 0.03, 0.01, 0.0, 0.02);
    let want = green_lagrange(&h.transpose().into());
    for element in plain() {
        let cell = cell(&*element, &stack);
        let u = motion(&*element, &cell, &h, 0.0);
        let strains = mean_strains(&*element, &cell, &u);
        for strain in strains.chunks_exact(6) {
            let error = strain.iter().zip(want).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-15, "{element:?}: {strain:?} {want:?}");
        }
    }
}

#[test]
fn means_are_those_of_the_strains_at_points() {
    let stack = plies();
    for element in all() {
        let cell = cell(&*element, &stack);
        let u = motion(&*element, &cell, &Matrix3::new(0.02, 0.1, 0.0, -0.1, 0.01, 0.05, -0.2, 0.1, 0.03), 0.05);
        let large = element.large_deflections().unwrap();
        // A sample may be less than all of the cell.
        for plane in [element.info().plane(), &element.info().plane()[..1]] {
            let strains = mean_strains_over(&*element, &cell, plane, &u);
            for (Part { slice, q: [low, high] }, mean) in parts(&stack).into_iter().zip(strains.chunks_exact(6)) {
                let (mut sum, mut volume) = ([0.0; 6], 0.0);
                for point in plane {
                    let [r, s] = point.at;
                    for &(t, wt) in gauss_legendre(4) {
                        let q = 0.5 * (low + high) + 0.5 * (high - low) * t;
                        let dv = point.weight() * wt * cell.plane(r, s).det;
                        let strain = large.large_strain(&cell, slice, [r, s, q], u.as_slice()).unwrap();
                        sum.iter_mut().zip(strain).for_each(|(sum, e)| *sum += dv * e);
                        volume += dv;
                    }
                }
                for (mean, sum) in mean.iter().zip(sum) {
                    assert!((mean - sum / volume).abs() < 1e-14, "{element:?}: {mean} {}", sum / volume);
                }
            }
        }
    }
}

#[test]
fn a_turned_section_has_no_energy_and_strains_across_it_leave_no_stress() {
    let stack = plies();
    let turn = Rotation3::from_euler_angles(0.0, 0.9, 0.0).into_inner();
    let stretch = Matrix3::new(1.01, 0.0, -0.02, 0.0, 1.0, 0.0, 0.01, 0.0, 0.97);
    for element in sections() {
        let cell = cell(&*element, &stack);
        let at = |f: Matrix3<f64>| motion(&*element, &cell, &(f - Matrix3::identity()), 0.0);
        let [want, turned, rigid] = [stretch, turn * stretch, turn].map(|f| internal(&*element, &cell, &at(f)).0);
        assert!((turned / want - 1.0).abs() < 1e-12, "{element:?}: {turned} {want}");
        assert!(rigid < 1e-22 * want, "{element:?}: {rigid:e} of {want:e}");
        for (ply, strain) in stack.slices.iter().zip(mean_strains(&*element, &cell, &at(stretch)).chunks_exact(12)) {
            let across = [1, 3, 4].map(|k| ply.c[k].iter().zip(strain).map(|(c, e)| c * e).sum::<f64>());
            let free = if format!("{element:?}").contains("Stress") { across } else { [1, 3, 4].map(|k| strain[k]) };
            assert!(free.iter().all(|free| free.abs() < 1e-15 * ply.c[0][0]), "{element:?}: {free:?}");
        }
    }
}

/// The shell: slopes of w and the strains that they add to those of u and v (von Kármán).
#[test]
fn the_shell_has_the_strains_of_von_karman() {
    let stack = plies();
    let shell = Mitc4::default();
    let cell = cell(&shell, &stack);
    let slopes = [0.15, -0.1];
    // Normals stay upright to the middle, which is what the rotations U13 = −w,x do.
    let h = Matrix3::new(0.01, 0.004, -slopes[0], 0.0, -0.02, -slopes[1], slopes[0], slopes[1], 0.0);
    let u = motion(&shell, &Cell { z: [-0.4e-3, 0.4e-3], ..cell }, &h, 0.0);
    let part = Part { slice: 1, q: [0.0; 2] };
    let mut strain = [f64::NAN; 6];
    shell
        .mean_large_strains(
            &Cell { z: [-0.4e-3, 0.4e-3], ..cell },
            &[part],
            shell.info().plane(),
            u.as_slice(),
            &mut strain,
        )
        .unwrap();
    let want = [0.01 + 0.5 * slopes[0] * slopes[0], -0.02 + 0.5 * slopes[1] * slopes[1], 0.004 + slopes[0] * slopes[1]];
    for (got, want) in [strain[0], strain[1], strain[3]].into_iter().zip(want) {
        assert!((got - want).abs() < 1e-15, "{got} {want}");
    }
    assert!(strain[4].abs() < 1e-15 && strain[5].abs() < 1e-15, "{strain:?}");
}

#[test]
fn a_folded_cell_is_refused() {
    let stack = plies();
    let [a, b, c, d] = PARALLELOGRAM;
    for element in solids() {
        let n = element.info().ndof();
        let (u, mut force) = (vec![0.0; n], vec![0.0; n]);
        let folded = Cell { corners: [a, c, b, d].into(), ..cell(&*element, &stack) };
        let large = element.large_deflections().unwrap();
        let refused = large.internal(&folded, &u, &mut Scratch::default(), &mut force, None).unwrap_err();
        assert!(refused.0.contains("Jacobian"), "{refused}");
    }
}
