#![allow(clippy::unwrap_used)]

use super::analysis::Tree;
use super::schedule::Item;
use super::*;
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

fn sparse(a: &DMatrix<f64>) -> (Arc<Pattern>, Vec<f64>) {
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
    (Arc::new(Pattern::new(starts, rows)), values)
}

fn cholesky(pattern: &Arc<Pattern>, threads: usize) -> Cholesky {
    Cholesky::new(Symbolic::new(pattern.clone()).unwrap(), NonZeroUsize::new(threads).unwrap())
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
    let (pattern, values) = sparse(a);
    let n = a.ncols();
    let mut factor = cholesky(&pattern, 2);
    factor.factorise(&values).unwrap();
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
    pattern.add_product(&values, -2.0, x.as_slice(), y.as_mut_slice());
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
    let (pattern, mut values) = sparse(&grid(17, 6));
    let mut one = cholesky(&pattern, 1);
    one.factorise(&values).unwrap();
    let first = one.panels.clone();
    for threads in [2, 3, 4, 50] {
        let mut many = cholesky(&pattern, threads);
        let second = |i: &Item| matches!(i, Item::Subtree { worker: 1, .. });
        assert!(many.schedule.items.iter().any(second), "the work is divided");
        many.factorise(&values).unwrap();
        assert_eq!(first, many.panels, "{threads} threads");
    }
    // Nothing of an earlier matrix stays in the storage.
    values.iter_mut().for_each(|v| *v *= 3.0);
    one.factorise(&values).unwrap();
    let mut fresh = cholesky(&pattern, 1);
    fresh.factorise(&values).unwrap();
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
            let (pattern, values) = sparse(&a);
            for threads in [1, 2, 4] {
                let found = cholesky(&pattern, threads).factorise(&values);
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
        let (pattern, values) = sparse(&a);
        let one = cholesky(&pattern, 1).factorise(&values);
        assert!(matches!(one, Err(FactorError::NotPositive { .. })));
        for threads in 2..5 {
            assert_eq!(one, cholesky(&pattern, threads).factorise(&values));
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    let (pattern, mut values) = sparse(&grid(5, 2));
    let mut factor = cholesky(&pattern, 1);
    for bad in [f64::NAN, f64::INFINITY] {
        values[pattern.starts[7] + 1] = bad;
        assert_eq!(factor.factorise(&values), Err(FactorError::NotFinite { column: 7 }));
    }
    // Finite numbers whose pivots overflow.
    let (pattern, mut values) = sparse(&grid(5, 2));
    values.iter_mut().for_each(|v| *v = f64::MAX);
    assert!(matches!(cholesky(&pattern, 2).factorise(&values), Err(FactorError::NotPositive { .. })));
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
    let mut factor = cholesky(&Arc::new(Pattern::new(vec![0], Vec::new())), 2);
    factor.factorise(&[]).unwrap();
    factor.solve(&mut [], 3);
}
