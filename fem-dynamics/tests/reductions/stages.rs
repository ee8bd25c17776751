//! Report eqs 27-32: condensation of substructures, assembly, and condensation again.

use crate::{Dense, basis, random_definite, reduction};
use nalgebra::DMatrix;

/// Guyan's matrix T for these governors, in their order.
fn guyan(structure: &Dense, governors: &[usize]) -> DMatrix<f64> {
    basis(&*reduction("guyan", governors.len()), &mut structure.clone(), &[], governors).unwrap()
}

/// `to ← to + L a Lᵀ`, with the unknown of the whole for each of the part.
fn add(to: &mut DMatrix<f64>, a: &DMatrix<f64>, place: &[usize]) {
    for (i, r) in place.iter().enumerate() {
        for (j, c) in place.iter().enumerate() {
            to[(*r, *c)] += a[(i, j)];
        }
    }
}

fn assembled(parts: &[(&Dense, &[usize])], n: usize) -> Dense {
    let mut whole = Dense::new(DMatrix::zeros(n, n), DMatrix::zeros(n, n));
    for (part, place) in parts {
        add(&mut whole.k, &part.k, place);
        add(&mut whole.m, &part.m, place);
    }
    whole
}

fn assert_equal(a: &DMatrix<f64>, b: &DMatrix<f64>, what: &str) {
    let error = (a - b).amax() / b.amax();
    assert!(error < 1e-13, "{what}: {error:e}");
}

#[test]
fn two_stages_equal_one_with_the_same_governors() {
    // Two substructures of 12 unknowns that share three; masters are those three and three more of each.
    let parts = [0, 1].map(|s| Dense::new(random_definite(12, s), random_definite(12, s + 7)));
    let places: [Vec<usize>; 2] = [(0..12).collect(), (9..21).collect()];
    let masters = [[9, 10, 11, 0, 3, 5], [0, 1, 2, 4, 6, 11]];
    let masters_of_whole = [[0, 1, 2, 3, 4, 5], [0, 1, 2, 6, 7, 8]];
    let condensed = [0, 1].map(|s| parts[s].condensed(&guyan(&parts[s], &masters[s])));
    let first = assembled(&[(&condensed[0], &masters_of_whole[0]), (&condensed[1], &masters_of_whole[1])], 9);
    // Governors: one shared unknown and three others, first as masters, then as unknowns of the whole.
    let two = first.condensed(&guyan(&first, &[1, 3, 5, 7]));
    let whole = assembled(&[(&parts[0], &places[0]), (&parts[1], &places[1])], 21);
    let one = whole.condensed(&guyan(&whole, &[10, 0, 5, 15]));
    assert_equal(&two.k, &one.k, "stiffness");
    assert_equal(&two.m, &one.m, "mass");
    // With another last governor they are not equal: the test can tell.
    let other = whole.condensed(&guyan(&whole, &[10, 0, 5, 16]));
    assert!((&two.k - other.k).amax() > 1e-3 * two.k.amax());
}

#[test]
fn the_stiffness_is_the_schur_complement() {
    let structure = Dense::new(random_definite(10, 3), random_definite(10, 4));
    let k = structure.condensed(&guyan(&structure, &[0, 1, 2])).k;
    let (kmm, kms) = (structure.k.view((0, 0), (3, 3)), structure.k.view((0, 3), (3, 7)));
    let kss = structure.k.view((3, 3), (7, 7)).into_owned().try_inverse().unwrap();
    assert_equal(&k, &(kmm - kms * kss * kms.transpose()), "K_mm − K_ms K_ss⁻¹ K_sm");
}
