//! The choice of governors by their ratio of stiffness to mass.

use crate::{Dense, basis, random_definite, reduction};
use fem_core::functional::Functional;
use nalgebra::DMatrix;

/// The governors that `guyan` with `select = "ratio"` chooses: the rows in which T has a lone one.
fn chosen(structure: &mut Dense, keep: &[Functional], candidates: &[usize], count: usize) -> Vec<usize> {
    let t = basis(&*reduction("guyan-ratio", count), structure, keep, candidates).unwrap();
    let lone = |i: &usize| {
        let row = t.row(*i);
        let top = row.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        (top - 1.0).abs() < 1e-9 && (row.iter().map(|x| x.abs()).sum::<f64>() - 1.0).abs() < 1e-9
    };
    (0..t.nrows()).filter(lone).collect()
}

/// Guyan's K and M for the unknowns `left`, from the full matrices.
fn condensed(structure: &Dense, left: &[usize]) -> Dense {
    let n = structure.k.nrows();
    let out: Vec<usize> = (0..n).filter(|i| !left.contains(i)).collect();
    let kss = structure.k.select_rows(&out).select_columns(&out);
    let ksm = structure.k.select_rows(&out).select_columns(left);
    let slaves = -kss.try_inverse().unwrap() * ksm;
    let mut t = DMatrix::zeros(n, left.len());
    left.iter().enumerate().for_each(|(j, i)| t[(*i, j)] = 1.0);
    out.iter().enumerate().for_each(|(r, i)| t.set_row(*i, &slaves.row(r)));
    structure.condensed(&t)
}

#[test]
fn heavy_masses_govern() {
    let masses: Vec<f64> = (0..24).map(|i| if i % 7 == 3 { 1.0 } else { 0.01 }).collect();
    let mut chain = Dense::chain(&masses, 1e6);
    let all: Vec<usize> = (0..24).collect();
    assert_eq!(chosen(&mut chain, &[Functional::dof(10)], &all, 6).len(), 7);
    // Beside the contact at 10 the heavy ones at 3 and 17, and the free end, which is held least stiffly.
    let governors = chosen(&mut chain, &[Functional::dof(10)], &all, 6);
    assert!([3, 10, 17].iter().all(|i| governors.contains(i)), "{governors:?}");
}

#[test]
fn elimination_one_by_one_from_the_full_matrices_chooses_the_same() {
    for seed in 0..5 {
        let mut structure = Dense::new(random_definite(16, seed), random_definite(16, seed + 50));
        let mut left: Vec<usize> = (0..16).collect();
        while left.len() > 6 {
            let now = condensed(&structure, &left);
            let ratio = |i: &usize| now.k[(*i, *i)] / now.m[(*i, *i)];
            // The contact, unknown 2, stays.
            let free = (0..left.len()).filter(|i| left[*i] != 2);
            let out = free.max_by(|a, b| ratio(a).total_cmp(&ratio(b))).unwrap();
            left.remove(out);
        }
        let all: Vec<usize> = (0..16).collect();
        assert_eq!(chosen(&mut structure, &[Functional::dof(2)], &all, 5), left, "{seed}");
    }
}

#[test]
fn unknowns_without_mass_go_first() {
    let masses: Vec<f64> = (0..12).map(|i| if i % 3 == 2 { 0.5 } else { 0.0 }).collect();
    let mut chain = Dense::chain(&masses, 1e6);
    let all: Vec<usize> = (0..12).collect();
    assert_eq!(chosen(&mut chain, &[Functional::dof(5)], &all, 3), [2, 5, 8, 11]);
    let why = basis(&*reduction("guyan-ratio", 4), &mut chain, &[Functional::dof(5)], &all).unwrap_err().to_string();
    assert!(why.contains("4 governors") && why.contains("only 3 with inertia"), "{why}");
}
