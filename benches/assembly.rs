//! What making and multiplying K costs, one thread, all cells distinct: `cargo bench --bench assembly`.
//!
//! Assembly beside the integration of its element matrices; the sum of these beside faer's, from triplets that it has sorted
//! once; products with K beside faer's, which wants both triangles.
#![allow(clippy::unwrap_used, missing_docs)]

mod plate;

use divan::Bencher;
use faer::sparse::linalg::matmul::sparse_dense_matmul;
use faer::sparse::{Pair, SparseColMat, SymbolicSparseColMat};
use faer::{Accum, MatMut, MatRef, Par};
use fem::core::assembly::{Matrix, Symmetric, assemble, pattern};
use fem::core::counters::Counters;
use fem::core::element::{Element, Scratch};
use plate::{Subject, subject};
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Cells a side: 100 839 unknowns.
const SIDE: usize = 50;

fn main() {
    divan::main();
}

fn stiffness() -> Symmetric {
    let Subject { plate, element, constraints } = subject(SIDE);
    let pattern = Arc::new(pattern(&plate, &constraints));
    let counters = &mut Counters::default();
    assemble(&plate, &element, &constraints, &pattern, Matrix::Stiffness, NonZeroUsize::MIN, counters).unwrap()
}

#[divan::bench(sample_count = 3)]
fn element_matrices(bencher: Bencher<'_, '_>) {
    let s = subject(SIDE);
    let mut ke = vec![0.0; s.element.info().ndof().pow(2)];
    let mut scratch = Scratch::default();
    bencher.bench_local(|| {
        for cell in s.plate.cell_numbers() {
            s.element.stiffness(&s.plate.cell(cell), &mut scratch, &mut ke).unwrap();
        }
        ke[0]
    });
}

#[divan::bench(sample_count = 3)]
fn assembly_on_a_known_pattern(bencher: Bencher<'_, '_>) {
    let s = subject(SIDE);
    let (pattern, one) = (Arc::new(pattern(&s.plate, &s.constraints)), NonZeroUsize::MIN);
    bencher.bench_local(|| {
        let counters = &mut Counters::default();
        assemble(&s.plate, &s.element, &s.constraints, &pattern, Matrix::Stiffness, one, counters).unwrap()
    });
}

#[divan::bench(sample_count = 3)]
fn pattern_of_cells(bencher: Bencher<'_, '_>) {
    let s = subject(SIDE);
    bencher.bench_local(|| pattern(&s.plate, &s.constraints));
}

/// Lower triangles of all cells as triplets.
fn triplets() -> (usize, Vec<Pair<usize, usize>>) {
    let Subject { plate, constraints, .. } = subject(SIDE);
    let (mut dofs, mut triplets) = (Vec::new(), Vec::new());
    for (cell, _) in plate.kept_cells() {
        plate.cell_dofs(cell, &mut dofs);
        let free: Vec<usize> = dofs.iter().filter_map(|dof| constraints.position(*dof)).collect();
        for j in &free {
            triplets.extend(free.iter().filter(|i| *i >= j).map(|i| Pair::new(*i, *j)));
        }
    }
    (constraints.ndof(), triplets)
}

#[divan::bench(sample_count = 3)]
fn pattern_of_triplets_by_faer(bencher: Bencher<'_, '_>) {
    let (n, triplets) = triplets();
    bencher.bench_local(|| SymbolicSparseColMat::try_new_from_indices(n, n, &triplets).unwrap());
}

/// Without the integration of cells, which [`assembly_on_a_known_pattern`] holds.
#[divan::bench(sample_count = 3)]
fn sum_of_sorted_triplets_by_faer(bencher: Bencher<'_, '_>) {
    let (n, triplets) = triplets();
    let (symbolic, order) = SymbolicSparseColMat::try_new_from_indices(n, n, &triplets).unwrap();
    let values = vec![1.0; triplets.len()];
    let symbolic = || symbolic.clone();
    bencher.with_inputs(symbolic).bench_local_values(|s| SparseColMat::new_from_argsort(s, &order, &values).unwrap());
}

#[divan::bench(sample_count = 10, args = [1, 40])]
fn product(bencher: Bencher<'_, '_>, columns: usize) {
    let k = stiffness();
    let (x, mut y) = (vec![1.0; k.ndof() * columns], vec![0.0; k.ndof() * columns]);
    bencher.bench_local(|| k.add_product(1.0, &x, &mut y));
}

#[divan::bench(sample_count = 10, args = [1, 40])]
fn product_by_faer(bencher: Bencher<'_, '_>, columns: usize) {
    let k = stiffness().full().unwrap();
    let n = k.ncols();
    let (x, mut y) = (vec![1.0; n * columns], vec![0.0; n * columns]);
    bencher.bench_local(|| {
        let x = MatRef::from_column_major_slice(&x, n, columns);
        let y = MatMut::from_column_major_slice_mut(&mut y, n, columns);
        sparse_dense_matmul(y, Accum::Add, k.as_ref(), x, 1.0, Par::Seq);
    });
}
