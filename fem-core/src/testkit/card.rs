//! A matrix as a card of invariants that people can read and text snapshots can hold.

use crate::words::dof::Dof;
use nalgebra::{DMatrix, SymmetricEigen};
use std::fmt::Write;

/// Eigenvalues below this fraction of the largest count as zero.
const ZERO: f64 = 1e-9;

/// The card of a symmetric element matrix, `n × n` column-major, with unknowns `dofs` at every node.
///
/// Derivative unknowns are scaled by `h`, a length of the cell, so that all entries have one unit and the eigenvalues mean
/// something. Numbers are fractions of the largest entry with seven digits, so rounding in the last bits and the unit of
/// stress change nothing:
///
/// * size, largest entry, trace, Frobenius norm, symmetry defect
/// * eigenvalues: zero, negative, smallest other, largest
/// * products with named probe vectors: unit translations and a fixed wave
pub fn card(matrix: &[f64], dofs: &[Dof], h: f64) -> String {
    let n = matrix.len().isqrt();
    let scale = |i: usize| if dofs[i % dofs.len()].m() == 0 { 1.0 } else { 1.0 / h };
    let mut a = DMatrix::from_fn(n, n, |i, j| matrix[i + n * j] * scale(i) * scale(j));
    let largest = a.amax();
    a /= largest;
    let defect = (&a - a.transpose()).amax();
    let mut eigenvalues: Vec<f64> =
        SymmetricEigen::new((&a + a.transpose()) * 0.5).eigenvalues.iter().copied().collect();
    eigenvalues.sort_by(f64::total_cmp);
    let top = eigenvalues.last().copied().unwrap_or(0.0);
    let zero = eigenvalues.iter().filter(|e| e.abs() <= ZERO * top).count();
    let negative = eigenvalues.iter().filter(|e| **e < -ZERO * top).count();
    let smallest = eigenvalues.iter().copied().find(|e| *e > ZERO * top).unwrap_or(0.0);
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<24} {value}");
    };
    line("size", format!("{n} x {n}"));
    line("largest entry", rounded(largest));
    line("trace", rounded(a.trace()));
    line("Frobenius norm", rounded(a.norm()));
    line("symmetric", if defect <= 1e-14 { "yes".into() } else { format!("no, defect {defect:.1e}") });
    line("eigenvalues zero", zero.to_string());
    line("eigenvalues negative", negative.to_string());
    line("smallest other", rounded(smallest));
    line("largest", rounded(top));
    for direction in 1..=3 {
        let probe = nalgebra::DVector::from_fn(n, |i, _| {
            let dof = dofs[i % dofs.len()];
            f64::from(u8::from(dof.n() == direction && dof.m() == 0))
        });
        line(&format!("translation {direction}"), rounded((probe.transpose() * &a * &probe)[0]));
    }
    let wave = nalgebra::DVector::from_fn(n, |i, _| (i as f64 + 1.0).sin());
    line("wave sin(i+1)", rounded((wave.transpose() * &a * &wave)[0]));
    text
}

/// Seven significant digits; rounding alone prints 0.
fn rounded(v: f64) -> String {
    if v.abs() < 1e-11 { "0".into() } else { format!("{v:.6e}") }
}
