//! Every element of the registry: cards of its matrices, and the contract.

use fem::Registry;
use fem::core::dof::Dof;
use fem::core::domain::Domain;
use fem::core::element::{Cell, Element, ElementError, Scratch, Slice, Stack};
use fem::core::material::Elastic;
use fem::core::plugin::{Built, Kind, Params, Value};
use fem::core::tensor::rotate_stiffness;
use fem::core::testkit::{card, check_element};
use std::fmt::Write;

/// Longest side of the cells, m: makes derivative unknowns comparable with the others.
const LENGTH: f64 = 2e-3;

/// Matrices up to this size are kept in full.
const SMALL: usize = 24;

const RECTANGLE: [[f64; 2]; 4] = [[0.0, 0.0], [2.0e-3, 0.0], [2.0e-3, 1.0e-3], [0.0, 1.0e-3]];
const QUADRILATERAL: [[f64; 2]; 4] = [[0.0, 0.0], [2.0e-3, 0.1e-3], [2.2e-3, 1.9e-3], [-0.1e-3, 2.0e-3]];

/// The plies [0/45/-45/90] of AS4/3502.
fn stack() -> Stack {
    let c = Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9).stiffness();
    let slice = |k: usize, angle: f64| {
        let q = |k: usize| -1.0 + 0.5 * k as f64;
        Slice { q: [q(k), q(k + 1)], c: rotate_stiffness(&c, angle.to_radians()), density: 1575.0, free: [0.0; 6] }
    };
    let angles = [0.0, 45.0, -45.0, 90.0];
    Stack::new(angles.iter().enumerate().map(|(k, a)| slice(k, *a)).collect())
}

/// An element of the registry.
pub(crate) fn element(name: &str, params: &Params) -> Box<dyn Element> {
    match Registry::standard().build(Kind::Element, name, params) {
        Ok(Built::Element(element)) => element,
        other => panic!("{name}: {other:?}"),
    }
}

/// All elements of the registry with the name of their mass: those that offer a choice of inertia once for each.
fn elements() -> Vec<(&'static str, String, Box<dyn Element>)> {
    let mut all = Vec::new();
    for info in Registry::standard().list(Kind::Element) {
        if info.params.iter().any(|p| p.name == "mass") {
            for mass in ["cubic", "linear"] {
                let params = Params::default().with("mass", Value::Text(mass.into()));
                all.push((info.name, format!("{mass} mass"), element(info.name, &params)));
            }
        } else {
            all.push((info.name, "mass".to_owned(), element(info.name, &Params::default())));
        }
    }
    all
}

type Integrate = fn(&dyn Element, &Cell<'_>, &mut [f64]) -> Result<(), ElementError>;

/// The matrix on a quadrilateral or the triangle at its first corner, or on a rectangle where the element takes no other shape.
fn matrix(element: &dyn Element, integrate: Integrate) -> Vec<f64> {
    let n = element.info().ndof();
    let stack = stack();
    let on = |[a, b, c, d]: [[f64; 2]; 4]| {
        let corners = match element.info().domain {
            Domain::Quadrilateral => [a, b, c, d].into(),
            Domain::Triangle => [a, b, d].into(),
        };
        let mut out = vec![f64::NAN; n * n];
        integrate(element, &Cell { corners, z: [0.0, 0.5e-3], stack: &stack }, &mut out).map(|()| out)
    };
    let general = if element.info().is_section() { None } else { on(QUADRILATERAL).ok() };
    general.unwrap_or_else(|| on(RECTANGLE).unwrap())
}

/// The lower triangle as fractions of the largest entry, derivative unknowns divided by the length.
fn triangle(matrix: &[f64], dofs: &[Dof]) -> String {
    let n = matrix.len().isqrt();
    let scale = |i: usize| if dofs[i % dofs.len()].m() == 0 { 1.0 } else { 1.0 / LENGTH };
    let entry = |i: usize, j: usize| matrix[i + n * j] * scale(i) * scale(j);
    let largest = (0..n).map(|i| entry(i, i)).fold(0.0, f64::max);
    let mut text = String::new();
    for i in 0..n {
        write!(text, "{:>2} {}", i / dofs.len() + 1, dofs[i % dofs.len()]).unwrap();
        for j in 0..=i {
            // Rounded to a number first: no minus before a zero.
            let value = (entry(i, j) / largest * 1e7).round() / 1e7 + 0.0;
            write!(text, " {value:>10.7}").unwrap();
        }
        text.push('\n');
    }
    text
}

fn snapshot(name: &str, element: &dyn Element, integrate: Integrate) {
    let (matrix, dofs) = (matrix(element, integrate), element.info().dofs);
    insta::assert_snapshot!(name, card(&matrix, dofs, LENGTH));
    if element.info().ndof() <= SMALL {
        insta::assert_snapshot!(format!("{name} in full"), triangle(&matrix, dofs));
    }
}

#[test]
fn stiffness_of_every_element() {
    for (name, _, element) in elements() {
        let name = format!("{name} stiffness");
        snapshot(&name, &*element, |e, cell, out| e.stiffness(cell, &mut Scratch::default(), out));
    }
}

#[test]
fn mass_of_every_element() {
    for (name, mass, element) in elements() {
        let name = format!("{name} {mass}");
        snapshot(&name, &*element, |e, cell, out| e.mass(cell, &mut Scratch::default(), out));
    }
}

#[test]
fn every_element_keeps_the_contract() {
    for (name, mass, element) in elements() {
        check_element(&*element).unwrap_or_else(|why| panic!("{name}, {mass}: {why}"));
    }
}
