//! Frequencies of a uniform chain, one end held: ω_j = 2 √(k/m) sin((2j − 1)π/(4n + 2)).

use crate::{Dense, basis, reduction, spread};
use fem_core::functional::Functional;
use fem_core::structure::Structure;
use fem_dynamics::modes;
use fem_dynamics::reduce::Reduced;
use std::f64::consts::PI;

const N: usize = 60;
const K: f64 = 3e6;
const M: f64 = 0.2;

fn chain() -> Dense {
    Dense::chain(&[M; N], K)
}

fn exact(j: usize) -> f64 {
    2.0 * (K / M).sqrt() * ((2 * j - 1) as f64 * PI / (4 * N + 2) as f64).sin()
}

/// With the end held as well: 2 √(k/m) sin(jπ/2n).
fn exact_held(j: usize) -> f64 {
    2.0 * (K / M).sqrt() * (j as f64 * PI / (2 * N) as f64).sin()
}

fn frequencies(name: &str, count: usize) -> Vec<f64> {
    let mut chain = chain();
    let t = basis(&*reduction(name, count), &mut chain, &[Functional::dof(N - 1)], &spread(N - 1)).unwrap();
    Reduced::project(&chain, t.as_slice()).unwrap().modal.frequencies().collect()
}

#[test]
fn modal_holds_the_exact_frequencies() {
    let omega = frequencies("modal", 12);
    assert_eq!(omega.len(), 13);
    for (j, omega) in (1..=12).zip(omega) {
        assert!((omega / exact(j) - 1.0).abs() < 1e-11, "{j}: {omega} {}", exact(j));
    }
}

#[test]
fn craig_bampton_holds_the_exact_modes_with_the_contact_held() {
    let mut chain = chain();
    let t = basis(&*reduction("craig-bampton", 10), &mut chain, &[Functional::dof(N - 1)], &[]).unwrap();
    for j in 1..=10 {
        let mode = t.column(j);
        let square = (mode.transpose() * &chain.k * mode)[0] / (mode.transpose() * &chain.m * mode)[0];
        assert!((square.sqrt() / exact_held(j) - 1.0).abs() < 1e-11, "{j}: {} {}", square.sqrt(), exact_held(j));
        assert!(mode[N - 1].abs() < 1e-10 * mode.amax(), "{j}");
    }
}

#[test]
fn only_what_the_contact_excites_enters() {
    // Both ends held and hit in the middle: ω_j = 2 √(k/m) sin(jπ/(2n + 2)), of which the even j rest there.
    let n = 61;
    let mut chain = Dense::chain(&vec![M; n], K);
    chain.k[(n - 1, n - 1)] *= 2.0;
    let t = basis(&*reduction("modal", 8), &mut chain, &[Functional::dof(30)], &[]).unwrap();
    let omega = Reduced::project(&chain, t.as_slice()).unwrap().modal;
    for (j, omega) in (1..=15).step_by(2).zip(omega.frequencies()) {
        let exact = 2.0 * (K / M).sqrt() * (j as f64 * PI / (2 * n + 2) as f64).sin();
        assert!((omega / exact - 1.0).abs() < 1e-11, "{j}: {omega} {exact}");
    }
}

#[test]
fn every_frequency_is_approached_from_above() {
    for (name, bound) in [
        ("guyan", 2e-3),
        ("guyan-ratio", 2e-3),
        ("irs", 1e-6),
        ("modal", 1e-11),
        ("craig-bampton", 1e-4),
        ("ritz", 1e-11),
    ] {
        let first = frequencies(name, 9)[0] / exact(1) - 1.0;
        assert!(first > -1e-11 && first < bound, "{name}: {first:e}");
    }
}

#[test]
fn irs_gains_digits_in_the_first_frequency() {
    let error = |name| frequencies(name, 5)[0] / exact(1) - 1.0;
    assert!(error("irs") < 1e-2 * error("guyan"), "{:e} {:e}", error("irs"), error("guyan"));
}

#[test]
fn natural_modes_meet_the_closed_form() {
    let modes = modes::lowest(&mut chain(), 20, false).unwrap();
    for (j, omega) in (1..=20).zip(modes.omega) {
        assert!((omega / exact(j) - 1.0).abs() < 1e-11, "{j}: {omega} {}", exact(j));
    }
    // All there are, and no more.
    assert_eq!(modes::lowest(&mut chain(), 1000, false).unwrap().omega.len(), N);
}

#[test]
fn a_frequency_is_found_as_often_as_it_occurs() {
    // Three equal chains side by side.
    let one = chain();
    let (mut k, mut m) = (nalgebra::DMatrix::zeros(3 * N, 3 * N), nalgebra::DMatrix::zeros(3 * N, 3 * N));
    for i in 0..3 {
        k.view_mut((i * N, i * N), (N, N)).copy_from(&one.k);
        m.view_mut((i * N, i * N), (N, N)).copy_from(&one.m);
    }
    let modes = modes::lowest(&mut Dense::new(k, m), 9, false).unwrap();
    for (i, omega) in modes.omega.iter().enumerate() {
        assert!((omega / exact(i / 3 + 1) - 1.0).abs() < 1e-11, "{i}: {omega}");
    }
}

#[test]
fn a_singular_mass_does_not_disturb() {
    // Every second mass is none: a chain of half as many masses on springs half as stiff.
    let masses: Vec<f64> = (0..N).map(|i| if i % 2 == 1 { M } else { 0.0 }).collect();
    let mut chain = Dense::chain(&masses, K);
    let (n, k) = (N / 2, K / 2.0);
    for name in ["modal", "ritz"] {
        let t = basis(&*reduction(name, 12), &mut chain, &[Functional::dof(N - 1)], &[]).unwrap();
        let omega: Vec<f64> = Reduced::project(&chain, t.as_slice()).unwrap().modal.frequencies().collect();
        for j in 1..=3 {
            let exact = 2.0 * (k / M).sqrt() * ((2 * j - 1) as f64 * PI / (4 * n + 2) as f64).sin();
            assert!((omega[j - 1] / exact - 1.0).abs() < 1e-8, "{name} {j}: {} {exact}", omega[j - 1]);
        }
    }
}

#[test]
fn vectors_that_join_later_make_the_same_structure() {
    let mut chain = Dense::chain(&[0.2; 30], 3e6);
    let t = basis(&*reduction("ritz", 9), &mut chain, &[Functional::dof(11)], &[]).unwrap();
    let (some, more) = t.as_slice().split_at(6 * 30);
    let grown = Reduced::project(&chain, some).unwrap().with(&chain, more).unwrap();
    let whole = Reduced::project(&chain, t.as_slice()).unwrap();
    assert_eq!(grown.modal.stiffnesses().len(), 9);
    for (grown, whole) in grown.modal.frequencies().zip(whole.modal.frequencies()) {
        assert!((grown / whole - 1.0).abs() < 1e-9, "{grown} {whole}");
    }
    for (grown, whole) in grown.restrict(&Functional::dof(11)).iter().zip(whole.restrict(&Functional::dof(11))) {
        assert!((grown.abs() / whole.abs() - 1.0).abs() < 1e-6, "{grown} {whole}");
    }
}

#[test]
fn forces_that_are_known_take_the_place_of_products() {
    let mut chain = Dense::chain(&[0.2; 30], 3e6);
    let t = basis(&*reduction("ritz", 9), &mut chain, &[Functional::dof(11)], &[]).unwrap();
    let mut forces = vec![0.0; t.len()];
    chain.add_stiffness(1.0, t.as_slice(), &mut forces);
    let project = |forces: &[f64]| Reduced::project_loaded(&chain, t.as_slice(), forces).unwrap().modal;
    let [whole, some] = [project(&[]), project(&forces[..6 * 30])];
    for (one, other) in whole.frequencies().zip(some.frequencies()) {
        assert!((one / other - 1.0).abs() < 1e-9, "{one} {other}");
    }
    // They are believed: of twice the forces the plate is twice as stiff.
    forces.iter_mut().for_each(|force| *force *= 2.0);
    for (one, other) in whole.frequencies().zip(project(&forces).frequencies()) {
        assert!((other / one - 2_f64.sqrt()).abs() < 1e-9, "{one} {other}");
    }
}
