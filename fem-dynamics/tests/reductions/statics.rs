//! What a reduction keeps of the static flexibility at the contacts.

use crate::{Dense, basis, reduction, spread};
use fem_core::functional::Functional;
use fem_dynamics::reduce::Reduced;

/// Relative error of pᵢᵀ K⁻¹ pⱼ on a uniform chain of 60, where a unit force at mass j moves mass i by (min(i, j) + 1)/k.
fn error(name: &str, count: usize) -> f64 {
    let (n, k) = (60, 3e6);
    let mut chain = Dense::chain(&vec![0.2; n], k);
    // A point and a mean over three masses.
    let contacts = [Functional::dof(22), Functional(vec![(46, 0.25), (47, 0.5), (48, 0.25)])];
    let t = basis(&*reduction(name, count), &mut chain, &contacts, &spread(n)).unwrap();
    let reduced = Reduced::project(&chain, t.as_slice()).unwrap();
    let mut worst = 0.0_f64;
    for a in &contacts {
        for b in &contacts {
            let sum = |(i, v): &(usize, f64)| b.0.iter().map(|(j, w)| v * w * (*i.min(j) + 1) as f64 / k).sum::<f64>();
            let exact: f64 = a.0.iter().map(sum).sum();
            let mut q = reduced.restrict(b);
            fem_core::structure::Structure::solve_shifted(&mut reduced.modal.clone(), 0.0, &mut q, 1).unwrap();
            let flexibility: f64 = reduced.restrict(a).iter().zip(&q).map(|(a, q)| a * q).sum();
            worst = worst.max((flexibility / exact - 1.0).abs());
        }
    }
    worst
}

#[test]
fn all_but_irs_keep_the_flexibility_at_the_contacts() {
    for name in ["guyan", "guyan-ratio", "modal", "craig-bampton", "ritz"] {
        for count in [1, 2, 7, 20, 40] {
            let error = error(name, count);
            assert!(error <= 1e-10, "{name} {count}: {error:e}");
        }
    }
}

#[test]
fn irs_does_not() {
    let error = error("irs", 7);
    assert!(error > 1e-4, "{error:e}");
}
