//! The coarse model of a plate, and Ritz vectors by way of it.

use crate::report::Computed;
use crate::support::root;
use fem::analyses::assembled;
use fem::core::assembly::column_order;
use fem::core::counters::Counters;
use fem::core::prolongation::Prolongation;
use fem::core::structure::Structure;
use fem::io::scene;
use fem::{Model, Registry};
use std::num::NonZeroUsize;

/// K and M of the coarse model are PᵀKP and PᵀMP, folded or not.
#[test]
fn coarse_matrices_are_projections() {
    let path = root().join("examples/as4-3502-8ply-25mm/scene.toml");
    let folded = std::fs::read_to_string(&path).unwrap();
    for text in [crate::support::whole(&folded), folded] {
        let model = Model::new(scene::parse(&text, &path).unwrap(), &Registry::standard()).unwrap();
        let mut structure =
            assembled::structure(&model, true, NonZeroUsize::MIN, &mut Counters::default()).unwrap().structure;
        let p = Prolongation::linear_in_z(&model.plate, &model.constraints, &column_order(&model.plate));
        structure.offer_coarse(p.clone());
        let coarse = structure.coarse().unwrap().unwrap().structure;
        assert!(coarse.ndof() == p.columns() && 5 * coarse.ndof() < 2 * structure.ndof(), "{}", coarse.ndof());
        // Three columns at once, whose entries no symmetry makes alike.
        let y: Vec<f64> = (0..3 * p.columns()).map(|i| ((i * 7919 + 13) % 1009) as f64 / 1009.0 - 0.4).collect();
        for stiffness in [true, false] {
            let product = |s: &dyn Structure, x: &[f64]| {
                let mut y = vec![0.0; x.len()];
                if stiffness {
                    s.add_stiffness(1.0, x, &mut y)
                } else {
                    s.add_mass(1.0, x, &mut y)
                }
                y
            };
            let (got, want) = (product(&*coarse, &y), p.restrict(&product(&structure, &p.expand(&y))));
            let largest = want.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let worst = got.iter().zip(&want).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            assert!(worst <= 1e-12 * largest, "{worst:e} of {largest:e}");
        }
    }
}

/// The exact Krylov space and the one by way of the coarse model, against many vectors.
#[test]
fn forces_are_as_good_as_from_the_exact_space() {
    let computed = |vectors: usize, space: &str| {
        let reduction = format!("[reduction]\nmethod = \"ritz\"\nvectors = {vectors}\nspace = \"{space}\"\n\n[march]");
        let quick = [("[march]", reduction.as_str()), ("end = \"1 ms\"", "end = \"0.3 ms\"")];
        Computed::example("as4-3502-16ply-50mm", "", &quick)
    };
    let forces = |c: &Computed| -> Vec<f64> { c.outcome.history.iter().map(|r| r.contact_force_n()).collect() };
    let exact = forces(&computed(200, "krylov"));
    let error = |c: &Computed| {
        let square = |f: &mut dyn Iterator<Item = f64>| f.map(|x| x * x).sum::<f64>().sqrt();
        square(&mut forces(c).iter().zip(&exact).map(|(a, b)| a - b)) / square(&mut exact.iter().copied())
    };
    // Where a space of one size is cut off is luck; that of several sizes is not.
    let sizes = [45, 50, 60, 70, 80];
    let mut ratio = 1.0_f64;
    for vectors in sizes {
        let (two_level, krylov) = (computed(vectors, "two-level"), computed(vectors, "krylov"));
        // Of the exact space the first vectors are solved for too.
        let solves = [two_level.outcome.counters.solves, krylov.outcome.counters.solves];
        assert_eq!(solves, [vectors as u64, vectors as u64 + 1]);
        let [two_level, krylov] = [error(&two_level), error(&krylov)];
        assert!(two_level < 1e-3, "{vectors} vectors: {two_level:e} {krylov:e}");
        ratio *= two_level / krylov;
    }
    let ratio = ratio.powf(1.0 / sizes.len() as f64);
    assert!(ratio < 1.5, "{ratio}");
}
