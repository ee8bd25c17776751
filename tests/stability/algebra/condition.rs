//! What is said of the digits that rounding costs.

use crate::case::{Case, Room};
use crate::plates::{SHELL, SOLIDS, jiggled, on, probe, rectangle, shuffled, solve, worst};
use crate::scene::{AS4, Plate, Side, isotropic};
use faer::Mat;
use faer::prelude::Solve;
use faer::sparse::SymbolicSparseColMat;
use fem::analyses::assembled;
use fem::core::assembly::{Pattern, SparseStructure, Symbolic, Symmetric};
use fem::core::counters::Counters;
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::sync::Arc;

pub(super) fn cases() -> Vec<Case> {
    vec![
        Room::Algebra.case(
            "estimate of a condition number: Hilbert's matrices",
            "orders 2 to 9, conditions to 1e12, whose inverses are known, in units of 1 to 1e9",
            "factor between the estimate and the number, either way",
            3.0,
            hilbert,
        ),
        Room::Algebra.case(
            "estimate of a condition number: plates",
            "4 cells of every element, held along a side, 0.01 to 10 mm thick",
            "factor between the estimate and the number by a dense inverse, either way",
            3.0,
            plates,
        ),
        Room::Algebra
            .case(
                "digits that rounding costs",
                "a clamped plate, 2 to 5000 times as wide as thick, in three orders of its nodes; every element",
                "change of the deflection over what the condition number says may be lost",
                1.0,
                digits,
            )
            .long(),
    ]
}

fn off(estimate: f64, exact: f64) -> f64 {
    (estimate / exact).max(exact / estimate)
}

fn hilbert() -> f64 {
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    let mut all = Vec::new();
    for n in 2..10 {
        for unit in [1.0, 1e3, 1e9] {
            // Units of the unknowns that are not powers of one number.
            let scale = |i: usize| f64::powf(unit, (i * 7 % n) as f64 / n as f64);
            let entry = |i: usize, j: usize| 1.0 / (i + j + 1) as f64;
            let starts = (0..=n).map(|j| (0..j).map(|j| n - j).sum()).collect();
            let rows = (0..n).flat_map(|j| j..n).collect();
            let lower = SymbolicSparseColMat::new_checked(n, n, starts, None, rows);
            let m = Symmetric::zero(Arc::new(Pattern::try_from(lower).unwrap()));
            let mut k = m.clone();
            let places = (0..n).flat_map(|j| (j..n).map(move |i| (i, j)));
            let values = k.lower_mut().val_mut().iter_mut();
            values.zip(places).for_each(|(k, (i, j))| *k = entry(i, j) * scale(i) * scale(j));
            let symbolic = Symbolic::new(k.pattern().clone()).unwrap();
            let mut structure = SparseStructure::new(symbolic, k, m, NonZeroUsize::MIN, |i| i.to_string());
            let inverse = |i: usize, j: usize| {
                let sign = if (i + j).is_multiple_of(2) { 1.0 } else { -1.0 };
                sign * (i + j + 1) as f64
                    * choose(n + i, n - j - 1)
                    * choose(n + j, n - i - 1)
                    * choose(i + j, i).powi(2)
            };
            let root = |i: usize| entry(i, i).sqrt();
            let norm = |a: &dyn Fn(usize, usize) -> f64| {
                (0..n).map(|j| (0..n).map(|i| a(i, j).abs()).sum::<f64>()).fold(0.0, f64::max)
            };
            let exact = norm(&|i, j| entry(i, j) / root(i) / root(j)) * norm(&|i, j| inverse(i, j) * root(i) * root(j));
            all.push(off(structure.condition().unwrap(), exact));
        }
    }
    worst(all)
}

fn plates() -> f64 {
    let mut all = Vec::new();
    for element in [SOLIDS[0], SOLIDS[1], SOLIDS[2], SHELL] {
        for thickness in [0.01, 0.1, 1.0, 10.0] {
            let layers = if element == SHELL { vec![2] } else { vec![1, 1] };
            let plate = Plate::new(AS4, "[0/90]", 0.5 * thickness, layers).element(element).pressure("1");
            let plate = plate.sides([Side::Clamped, Side::Free, Side::Free, Side::Free]).rectangle([20.0; 2], [2; 2]);
            let model = plate.model("static");
            let counters = &mut Counters::default();
            let mut structure = assembled::structure(&model, false, NonZeroUsize::MIN, counters).unwrap().structure;
            let a = structure.matrices().0.full().unwrap().to_dense();
            let n = a.ncols();
            let root: Vec<f64> = (0..n).map(|i| a[(i, i)].sqrt()).collect();
            let scaled = Mat::from_fn(n, n, |i, j| a[(i, j)] / root[i] / root[j]);
            let inverse = scaled.partial_piv_lu().solve(Mat::<f64>::identity(n, n));
            let norm = |a: &Mat<f64>| (0..n).map(|j| (0..n).map(|i| a[(i, j)].abs()).sum::<f64>()).fold(0.0, f64::max);
            all.push(off(structure.condition().unwrap(), norm(&scaled) * norm(&inverse)));
        }
    }
    worst(all)
}

fn digits() -> f64 {
    let mut all = Vec::new();
    for element in [SOLIDS[0], SOLIDS[1], SOLIDS[2], SHELL] {
        for slenderness in [2.0, 10.0, 100.0, 1e3, 5e3] {
            let solved = |order: usize| {
                let layers = if element == SHELL { vec![2] } else { vec![1, 1] };
                let mut plate = Plate::new(&isotropic(70.0, 0.3, 2.7), "[0_2]", 10.0 / slenderness, layers)
                    .element(element)
                    .sides([Side::Free; 4])
                    .pressure("1");
                for side in ["x-min", "x-max", "y-min", "y-max"] {
                    let _ =
                        writeln!(plate.more, "[[support]]\ngroup = '{side}'\nat = 'all'\nfix = ['U10', 'U20', 'U30']");
                }
                let mesh = jiggled(rectangle([20.0; 2], [8; 2]), 0.1);
                let mesh = if order == 0 { mesh } else { shuffled(&mesh, order) };
                let meshed = on(probe(plate, [11.0, 9.0]), &mesh);
                let (model, solution) = solve(&meshed.plate.text("static")).ok()?;
                let mut structure =
                    assembled::structure(&model, false, NonZeroUsize::MIN, &mut Counters::default()).ok()?.structure;
                Some((solution.profiles[0][0].displacement[2], structure.condition().unwrap()))
            };
            // Plates that are refused say so.
            let Some((w, condition)) = solved(0) else { continue };
            let lost = condition * f64::EPSILON;
            all.extend([1, 2, 3].into_iter().filter_map(solved).map(|(other, _)| (other / w - 1.0).abs() / lost));
        }
    }
    assert!(all.len() >= 40, "{} of 60 plates are solved", all.len());
    worst(all)
}
