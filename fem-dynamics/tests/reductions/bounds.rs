//! More vectors than there are unknowns.

use crate::{Dense, basis, reduction};
use fem_core::functional::Functional;
use fem_core::structure::Structure;
use fem_dynamics::reduce::Reduced;

#[test]
fn no_more_vectors_than_unknowns_are_made() {
    let n = 30;
    let contacts = [Functional::dof(14), Functional::dof(n - 1)];
    for name in ["modal", "craig-bampton", "ritz"] {
        for asked in [n - 2, n, 10 * n, 1_000_000_000] {
            let mut chain = Dense::chain(&vec![0.2; n], 3e6);
            let t = basis(&*reduction(name, asked), &mut chain, &contacts, &[]).unwrap();
            assert!(t.ncols() <= n, "{name} {asked}: {} vectors", t.ncols());
            assert!(chain.solves <= 3 * n as u64, "{name} {asked}: {} solves", chain.solves);
            let reduced = Reduced::project(&chain, t.as_slice()).unwrap();
            let highest = reduced.modal.clone().highest_frequency().unwrap();
            assert!(highest <= 2.0 * (3e6_f64 / 0.2).sqrt() * (1.0 + 1e-9), "{name} {asked}");
        }
    }
}

#[test]
fn modes_that_rest_at_the_contact_do_not_enter() {
    // Held at both ends and hit in the middle: 15 of 31 modes rest there, whatever rounding makes of them.
    let n = 31;
    let mut chain = Dense::chain(&vec![0.2; n], 3e6);
    chain.k[(n - 1, n - 1)] *= 2.0;
    let t = basis(&*reduction("modal", n), &mut chain, &[Functional::dof(15)], &[]).unwrap();
    assert_eq!(t.ncols(), 16);
}

#[test]
fn a_basis_beyond_all_use_is_refused_at_once() {
    #[derive(Debug)]
    struct Large;
    impl Structure for Large {
        fn ndof(&self) -> usize {
            50_000
        }
        fn add_stiffness(&self, _: f64, _: &[f64], _: &mut [f64]) {}
        fn add_mass(&self, _: f64, _: &[f64], _: &mut [f64]) {}
        fn solve_shifted(&mut self, _: f64, _: &mut [f64], _: usize) -> Result<(), fem_core::structure::SolveError> {
            panic!("nothing may be solved");
        }
        fn solve_mass(&mut self, _: &mut [f64]) -> Result<(), fem_core::structure::SolveError> {
            panic!("nothing may be solved");
        }
    }
    for name in ["modal", "craig-bampton", "ritz"] {
        let why = reduction(name, 40_000).basis(&mut Large, &[Functional::dof(0)], &[]).unwrap_err().to_string();
        assert!(why.contains("more than 2000") && why.contains("ask for fewer"), "{name}: {why}");
    }
}
