#![allow(clippy::unwrap_used)]

use super::analysis::Tree;
use super::schedule::Item;
use super::*;
use crate::assembly::Symmetric;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// A symmetric matrix of `blocks` blocks of `width` columns; `links` names the blocks below the diagonal that are filled.
fn blocks(blocks: usize, width: usize, links: &[(usize, usize)]) -> DMatrix<f64> {
    let n = blocks * width;
    let mut a = DMatrix::zeros(n, n);
    let mut seed = 1_u64;
    let mut number = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as f64 / f64::from(1 << 30) - 1.0
    };
    for (i, j) in links.iter().copied().chain((0..blocks).map(|b| (b, b))) {
        let (i, j) = (i % blocks, j % blocks);
        for k in 0..width {
            for l in 0..width {
                let value = number();
                a[(i * width + k, j * width + l)] = value;
                a[(j * width + l, i * width + k)] = value;
            }
        }
    }
    for i in 0..n {
        a[(i, i)] = 1.0 + a.column(i).iter().map(|v| v.abs()).sum::<f64>();
    }
    a
}

fn sparse(a: &DMatrix<f64>) -> Symmetric {
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for j in 0..a.ncols() {
        for i in j..a.nrows() {
            if i == j || a[(i, j)] != 0.0 {
                rows.push(i);
                values.push(a[(i, j)]);
            }
        }
        starts.push(rows.len());
    }
    let mut sparse = Symmetric::zero(Arc::new(Pattern::new(starts, rows)));
    sparse.lower_mut().val_mut().copy_from_slice(&values);
    sparse
}

fn cholesky(a: &Symmetric, threads: usize) -> Cholesky {
    Cholesky::new(Symbolic::new(a.pattern().clone()).unwrap(), NonZeroUsize::new(threads).unwrap())
}

/// A grid of `side × side` blocks, numbered by halves with their separator last.
fn grid(side: usize, width: usize) -> DMatrix<f64> {
    fn order(x: std::ops::Range<usize>, y: std::ops::Range<usize>, out: &mut Vec<(usize, usize)>) {
        if x.len() * y.len() <= 4 {
            out.extend(x.flat_map(|i| y.clone().map(move |j| (i, j))));
        } else if x.len() >= y.len() {
            let m = (x.start + x.end) / 2;
            order(x.start..m, y.clone(), out);
            order(m + 1..x.end, y.clone(), out);
            out.extend(y.map(|j| (m, j)));
        } else {
            let m = (y.start + y.end) / 2;
            order(x.clone(), y.start..m, out);
            order(x.clone(), m + 1..y.end, out);
            out.extend(x.map(|i| (i, m)));
        }
    }
    let mut places = Vec::new();
    order(0..side, 0..side, &mut places);
    let mut links = Vec::new();
    for (a, p) in places.iter().enumerate() {
        for (b, q) in places[..a].iter().enumerate() {
            if p.0.abs_diff(q.0) <= 1 && p.1.abs_diff(q.1) <= 1 {
                links.push((a, b));
            }
        }
    }
    blocks(side * side, width, &links)
}

fn check_against_dense(a: &DMatrix<f64>) {
    let sparse = sparse(a);
    let n = a.ncols();
    let mut factor = cholesky(&sparse, 2);
    factor.factorise(sparse.lower()).unwrap();
    let dense = a.clone().cholesky().unwrap();
    for columns in [1, 2, 5, 70] {
        let b = DMatrix::from_fn(n, columns, |i, j| ((i * 7 + j * 3) % 11) as f64 - 4.0);
        let mut x = b.clone();
        factor.solve(x.as_mut_slice(), columns);
        assert!((&x - dense.solve(&b)).amax() <= 1e-12 * dense.solve(&b).amax());
        assert!((a * &x - &b).amax() <= 1e-11);
    }
    let x = DVector::from_fn(n, |i, _| (i % 5) as f64 - 1.5);
    let mut y = DVector::from_element(n, 0.25);
    sparse.add_product(-2.0, x.as_slice(), y.as_mut_slice());
    let expected = DVector::from_element(n, 0.25) - a * &x * 2.0;
    assert!((y - &expected).amax() <= 1e-13 * expected.amax());
}

proptest! {
    #[test]
    fn any_pattern_gives_the_dense_solution(
        count in 1_usize..40,
        width in 1_usize..5,
        links in prop::collection::vec((0_usize..40, 0_usize..40), 0..90),
    ) {
        check_against_dense(&blocks(count, width, &links));
    }
}

#[test]
fn a_grid_gives_the_dense_solution() {
    check_against_dense(&grid(9, 7));
}

#[test]
fn chains_stars_and_separate_parts_give_the_dense_solution() {
    let chain: Vec<_> = (1..60).map(|i| (i, i - 1)).collect();
    let star: Vec<_> = (1..60).map(|i| (i, 0)).collect();
    let late_star: Vec<_> = (0..59).map(|i| (59, i)).collect();
    for links in [chain, star, late_star, Vec::new()] {
        check_against_dense(&blocks(60, 2, &links));
    }
}

#[test]
fn the_factor_does_not_depend_on_the_threads() {
    let mut sparse = sparse(&grid(17, 6));
    let mut one = cholesky(&sparse, 1);
    one.factorise(sparse.lower()).unwrap();
    let first = one.panels.clone();
    for threads in [2, 3, 4, 50] {
        let mut many = cholesky(&sparse, threads);
        let second = |i: &Item| matches!(i, Item::Subtree { worker: 1, .. });
        assert!(many.schedule.items.iter().any(second), "the work is divided");
        many.factorise(sparse.lower()).unwrap();
        assert_eq!(first, many.panels, "{threads} threads");
    }
    // Nothing of an earlier matrix stays in the storage.
    sparse.lower_mut().val_mut().iter_mut().for_each(|v| *v *= 3.0);
    one.factorise(sparse.lower()).unwrap();
    let mut fresh = cholesky(&sparse, 1);
    fresh.factorise(sparse.lower()).unwrap();
    assert_eq!(one.panels, fresh.panels);
}

#[test]
fn a_pivot_that_is_not_positive_is_named() {
    let a = grid(9, 3);
    let n = a.ncols();
    for column in 0..n {
        for bad in [-1e3, 0.0] {
            let mut a = a.clone();
            a[(column, column)] = bad;
            let sparse = sparse(&a);
            for threads in [1, 2, 4] {
                let found = cholesky(&sparse, threads).factorise(sparse.lower());
                assert_eq!(found, Err(FactorError::NotPositive { column }), "{threads} threads");
            }
        }
    }
}

#[test]
fn of_several_bad_pivots_one_is_named_for_any_number_of_threads() {
    let a = grid(9, 3);
    let n = a.ncols();
    for first in 0..n / 7 {
        let mut a = a.clone();
        for column in (first..n).step_by(n / 7) {
            a[(column, column)] = -1e3;
        }
        let sparse = sparse(&a);
        let one = cholesky(&sparse, 1).factorise(sparse.lower());
        assert!(matches!(one, Err(FactorError::NotPositive { .. })));
        for threads in 2..5 {
            assert_eq!(one, cholesky(&sparse, threads).factorise(sparse.lower()));
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    let mut a = sparse(&grid(5, 2));
    let mut factor = cholesky(&a, 1);
    for bad in [f64::NAN, f64::INFINITY] {
        let at = a.pattern().starts()[7] + 1;
        a.lower_mut().val_mut()[at] = bad;
        assert_eq!(factor.factorise(a.lower()), Err(FactorError::NotFinite { column: 7 }));
    }
    // Finite numbers whose pivots overflow.
    let mut a = sparse(&grid(5, 2));
    a.lower_mut().val_mut().iter_mut().for_each(|v| *v = f64::MAX);
    assert!(matches!(cholesky(&a, 2).factorise(a.lower()), Err(FactorError::NotPositive { .. })));
}

#[test]
fn fill_that_does_not_fit_is_refused_before_it_is_counted_out() {
    let n = 1_000_000;
    // The centre of a star goes first: every column then has all rows below it.
    let starts = std::iter::once(0).chain(n..2 * n).collect();
    let rows = (0..n).chain(1..n).collect();
    let refused = Tree::new(&Pattern::new(starts, rows), |entries| entries < 10_000_000).err();
    assert!(refused.is_some_and(|entries| entries > 10_000_000));
}

#[test]
fn an_empty_matrix_has_a_factor() {
    let empty = Symmetric::zero(Arc::new(Pattern::new(vec![0], Vec::new())));
    let mut factor = cholesky(&empty, 2);
    factor.factorise(empty.lower()).unwrap();
    factor.solve(&mut [], 3);
}

#[test]
fn another_pattern_than_was_analysed_is_refused() {
    let (one, other) = (sparse(&grid(3, 2)), sparse(&grid(4, 2)));
    let mut factor = cholesky(&one, 1);
    assert_eq!(factor.factorise(other.lower()), Err(FactorError::OtherPattern));
    // An equal pattern elsewhere is none other.
    assert_eq!(factor.factorise(sparse(&grid(3, 2)).lower()), Ok(()));
}
