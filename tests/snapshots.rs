//! Cards of element matrices.

use fem::core::element::{Cell, Element, Scratch, Slice, Stack};
use fem::core::material::Elastic;
use fem::core::tensor::rotate_stiffness;
use fem::core::testkit::card;
use fem::elements::{HermitePrism, Mass};

/// The plies [0/45/-45/90] of AS4/3502.
fn stack() -> Stack {
    let c = Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9).stiffness();
    let slice = |k: usize, angle: f64| {
        let q = |k: usize| -1.0 + 0.5 * k as f64;
        Slice { q: [q(k), q(k + 1)], c: rotate_stiffness(&c, angle.to_radians()), density: 1575.0 }
    };
    let angles = [0.0, 45.0, -45.0, 90.0];
    Stack::new(angles.iter().enumerate().map(|(k, a)| slice(k, *a)).collect())
}

fn snapshot(name: &str, mass: Mass, matrix: fn(&HermitePrism, &Cell<'_>, &mut [f64])) {
    let element = HermitePrism::new(mass, HermitePrism::IN_PLANE_ORDER).unwrap();
    let corners = [[0.0, 0.0], [2.0e-3, 0.1e-3], [2.2e-3, 1.9e-3], [-0.1e-3, 2.0e-3]];
    let cell = Cell { corners, z: [0.0, 0.5e-3], stack: &stack() };
    let mut out = vec![f64::NAN; 96 * 96];
    matrix(&element, &cell, &mut out);
    insta::assert_snapshot!(name, card(&out, element.info().dofs, 2e-3));
}

#[test]
fn hermite_prism_stiffness() {
    snapshot("hermite-prism stiffness", Mass::Cubic, |e, cell, out| {
        e.stiffness(cell, &mut Scratch::default(), out).unwrap();
    });
}

#[test]
fn hermite_prism_cubic_mass() {
    snapshot("hermite-prism cubic mass", Mass::Cubic, |e, cell, out| {
        e.mass(cell, &mut Scratch::default(), out).unwrap();
    });
}

#[test]
fn hermite_prism_linear_mass() {
    snapshot("hermite-prism linear mass", Mass::Linear, |e, cell, out| {
        e.mass(cell, &mut Scratch::default(), out).unwrap();
    });
}
