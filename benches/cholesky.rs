//! The multifrontal factorisation beside faer's supernodal one, both in the order of nested dissection:
//! `cargo bench --bench cholesky`.
//!
//! Arguments are cells a side: 11 079, 30 252 and 100 839 unknowns. faer parallelises inside of blocks;
//! `cargo bench --bench cholesky --features faer/rayon` lets it use all cores where its rows say so. Before the times come the
//! entries of both factors, and that ours is the same on one thread and on two.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod plate;

use divan::Bencher;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::{Conj, MatMut, Par, Side, get_global_parallelism};
use fem::core::assembly::{Cholesky, Matrix, Symbolic, Symmetric, assemble, pattern};
use fem::core::counters::Counters;
use plate::{Subject, subject};
use std::num::NonZeroUsize;
use std::sync::Arc;

const SIDES: [usize; 3] = [16, 27, 50];
const SAMPLES: u32 = 3;

fn main() {
    for k in SIDES.map(stiffness) {
        let mut factors = [1, 2].map(|threads| ours(&k, threads));
        let [one, two] = factors.each_mut().map(|factor| {
            factor.factorise(k.lower()).unwrap();
            let mut x = vec![1.0; k.ndof()];
            factor.solve(&mut x, 1);
            x.into_iter().map(f64::to_bits).collect::<Vec<_>>()
        });
        assert_eq!(one, two, "one thread and two");
        let own = Symbolic::new(k.pattern().clone()).unwrap().entries();
        let faer = faers(&k).len_val();
        println!("{} unknowns: {own} entries here, {faer} by faer ({:.3})", k.ndof(), own as f64 / faer as f64);
    }
    divan::main();
}

fn stiffness(side: usize) -> Symmetric {
    let Subject { plate, element, constraints } = subject(side);
    let pattern = Arc::new(pattern(&plate, &constraints));
    let counters = &mut Counters::default();
    assemble(&plate, &element, &constraints, &pattern, Matrix::Stiffness, NonZeroUsize::MIN, counters).unwrap()
}

fn ours(k: &Symmetric, threads: usize) -> Cholesky {
    Cholesky::new(Symbolic::new(k.pattern().clone()).unwrap(), NonZeroUsize::new(threads).unwrap())
}

/// faer's identity order takes no lower triangle: one that names every column does.
fn faers(k: &Symmetric) -> SymbolicCholesky<usize> {
    let order: Vec<usize> = (0..k.ndof()).collect();
    let order = SymmetricOrdering::Custom(PermRef::new_checked(&order, &order, k.ndof()));
    factorize_symbolic_cholesky(k.pattern().symbolic(), Side::Lower, order, Default::default()).unwrap()
}

#[divan::bench(args = SIDES, sample_count = SAMPLES)]
fn a_analysis(bencher: Bencher<'_, '_>, side: usize) {
    let k = stiffness(side);
    bencher.bench_local(|| Symbolic::new(k.pattern().clone()).unwrap());
}

#[divan::bench(args = SIDES, sample_count = SAMPLES)]
fn a_analysis_by_faer(bencher: Bencher<'_, '_>, side: usize) {
    let k = stiffness(side);
    bencher.bench_local(|| faers(&k));
}

#[divan::bench(args = SIDES, consts = [1, 2], sample_count = SAMPLES)]
fn b_factor_on_threads<const THREADS: usize>(bencher: Bencher<'_, '_>, side: usize) {
    let k = stiffness(side);
    let mut factor = ours(&k, THREADS);
    bencher.bench_local(|| factor.factorise(k.lower()).unwrap());
}

fn factor_by_faer(bencher: Bencher<'_, '_>, side: usize, par: Par) {
    let k = stiffness(side);
    let symbolic = faers(&k);
    let mut values = vec![0.0; symbolic.len_val()];
    let mut memory = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(par, Default::default()));
    bencher.bench_local(|| {
        let stack = MemStack::new(&mut memory);
        let (lower, values) = (k.lower(), &mut values);
        let settings = Default::default();
        symbolic.factorize_numeric_llt(values, lower, Side::Lower, Default::default(), par, stack, settings).is_ok()
    });
}

#[divan::bench(args = SIDES, sample_count = SAMPLES)]
fn b_factor_by_faer(bencher: Bencher<'_, '_>, side: usize) {
    factor_by_faer(bencher, side, Par::Seq);
}

#[divan::bench(args = SIDES, sample_count = SAMPLES)]
fn b_factor_by_faer_on_all_cores(bencher: Bencher<'_, '_>, side: usize) {
    factor_by_faer(bencher, side, get_global_parallelism());
}

#[divan::bench(args = SIDES, consts = [1, 40], sample_count = SAMPLES)]
fn c_solve<const COLUMNS: usize>(bencher: Bencher<'_, '_>, side: usize) {
    let k = stiffness(side);
    let mut factor = ours(&k, 1);
    factor.factorise(k.lower()).unwrap();
    let x = || vec![1.0; k.ndof() * COLUMNS];
    bencher.with_inputs(x).bench_local_refs(|x| factor.solve(x, COLUMNS));
}

#[divan::bench(args = SIDES, consts = [1, 40], sample_count = SAMPLES)]
fn c_solve_by_faer<const COLUMNS: usize>(bencher: Bencher<'_, '_>, side: usize) {
    let k = stiffness(side);
    let (symbolic, par, n) = (faers(&k), Par::Seq, k.ndof());
    let mut values = vec![0.0; symbolic.len_val()];
    let mut memory = MemBuffer::new(
        symbolic
            .factorize_numeric_llt_scratch::<f64>(par, Default::default())
            .or(symbolic.solve_in_place_scratch::<f64>(COLUMNS, par)),
    );
    let stack = MemStack::new(&mut memory);
    let settings = Default::default();
    let lower = k.lower();
    symbolic.factorize_numeric_llt(&mut values, lower, Side::Lower, Default::default(), par, stack, settings).unwrap();
    let factor = LltRef::new(&symbolic, &values);
    let x = || vec![1.0; n * COLUMNS];
    bencher.with_inputs(x).bench_local_refs(|x| {
        let x = MatMut::from_column_major_slice_mut(x, n, COLUMNS);
        factor.solve_in_place_with_conj(Conj::No, x, par, MemStack::new(&mut memory));
    });
}
