//! What the tests of several elements share; each of them uses a part.

use faer::{MatRef, Side};
use fem_core::element::{Cell, Element, Scratch, Slice, Stack};
use fem_core::material::Elastic;
use fem_core::tensor::rotate_stiffness;

/// Eight plies of AS4/3502 with angles that leave no symmetry; N, mm, tonne.
pub(crate) fn eight_plies() -> Stack {
    let c = Elastic::transversely_isotropic(130_300.0, 9650.0, 0.35, 0.40, 5930.0).stiffness();
    let ply = |i: u32| {
        let q = |i: u32| -1.0 + 0.25 * f64::from(i);
        Slice { q: [q(i), q(i + 1)], c: rotate_stiffness(&c, 0.37 * f64::from(i)), density: 1.575e-9, free: [0.0; 6] }
    };
    Stack::new((0..8).map(ply).collect())
}

/// Largest difference of `got` from `want`, relative to sqrt(kᵢᵢ kⱼⱼ) of the latter.
pub(crate) fn scaled_error(n: usize, got: impl Fn(usize, usize) -> f64, want: impl Fn(usize, usize) -> f64) -> f64 {
    let mut worst = 0.0_f64;
    for i in 0..n {
        for j in 0..n {
            let scale = (want(i, i) * want(j, j)).sqrt();
            let difference = (got(i, j) - want(i, j)).abs();
            let error = if scale > 0.0 { difference / scale } else { difference };
            assert!(error.is_finite(), "entry ({i}, {j})");
            worst = worst.max(error);
        }
    }
    worst
}

pub(crate) fn stiffness(element: &dyn Element, cell: &Cell<'_>) -> Vec<f64> {
    let mut ke = vec![f64::NAN; element.info().ndof().pow(2)];
    element.stiffness(cell, &mut Scratch::default(), &mut ke).unwrap();
    ke
}

pub(crate) fn mass(element: &dyn Element, cell: &Cell<'_>) -> Vec<f64> {
    let mut me = vec![f64::NAN; element.info().ndof().pow(2)];
    element.mass(cell, &mut Scratch::default(), &mut me).unwrap();
    me
}

/// Deformations without energy: eigenvalues of the stiffness, scaled to a unit diagonal, that vanish.
pub(crate) fn zero_modes(element: &dyn Element, cell: &Cell<'_>) -> usize {
    let n = element.info().ndof();
    let ke = stiffness(element, cell);
    let scaled: Vec<f64> = (0..n * n).map(|k| ke[k] / (ke[(n + 1) * (k / n)] * ke[(n + 1) * (k % n)]).sqrt()).collect();
    let values = MatRef::from_column_major_slice(&scaled, n, n).self_adjoint_eigenvalues(Side::Lower).unwrap();
    values.iter().filter(|v| v.abs() < 1e-10 * values[n - 1]).count()
}

/// x, y and z of a monomial.
pub(crate) type Powers = [i32; 3];

/// Monomials of at most the given powers and total degree.
pub(crate) fn monomials(most: Powers, degree: i32) -> Vec<Powers> {
    let each =
        |[a, b, c]: Powers| (0..=a).flat_map(move |i| (0..=b).flat_map(move |j| (0..=c).map(move |k| [i, j, k])));
    each(most).filter(|p| p.iter().sum::<i32>() <= degree).collect()
}

/// Value (m = 0) or derivative (m = 1, 2, 3) of a monomial.
fn monomial(powers: Powers, m: usize, at: [f64; 3]) -> f64 {
    (0..3)
        .map(|d| match (powers[d], m == d + 1) {
            (0, true) => 0.0,
            (p, true) => f64::from(p) * at[d].powi(p - 1),
            (p, false) => at[d].powi(p),
        })
        .product()
}

/// Worst error of the displacements and strains inside `cell` when its unknowns are those of a monomial field of one
/// component.
pub(crate) fn interpolation_error(element: &dyn Element, cell: &Cell<'_>, component: usize, powers: Powers) -> f64 {
    let info = element.info();
    let n = info.ndof();
    let unknowns = info.nodes.iter().flat_map(|node| {
        let at = cell.position(*node);
        info.dofs.iter().map(move |d| if d.n() == component + 1 { monomial(powers, d.m(), at) } else { 0.0 })
    });
    let u: Vec<f64> = unknowns.collect();
    let (mut b, mut shape) = (vec![f64::NAN; 6 * n], vec![f64::NAN; 3 * n]);
    let mut worst = 0.0_f64;
    for xi in [[0.3, -0.7, 0.2], [-0.9, 0.4, -0.6], [0.0, 0.0, 0.95], [0.61, 0.83, -0.17]] {
        let xi = if info.is_section() { [xi[0], 0.0, xi[2]] } else { xi };
        let at = cell.position(xi);
        element.strain_operator(cell, 0, xi, &mut b);
        element.shape(cell, xi, &mut shape);
        let mut strain = [0.0; 6];
        for (d, row) in [[0, 3, 5], [3, 1, 4], [5, 4, 2]][component].into_iter().enumerate() {
            strain[row] += monomial(powers, d + 1, at);
        }
        for (i, want) in strain.iter().enumerate() {
            let got: f64 = u.iter().zip(b.chunks_exact(6)).map(|(u, b)| u * b[i]).sum();
            worst = worst.max((got - want).abs());
        }
        for i in 0..3 {
            let got: f64 = u.iter().zip(shape.chunks_exact(3)).map(|(u, n)| u * n[i]).sum();
            let want = if i == component { monomial(powers, 0, at) } else { 0.0 };
            worst = worst.max((got - want).abs());
        }
        assert!(worst.is_finite());
    }
    worst
}
