//! K and M as files for other programs.

use crate::error::Error;
use crate::model::Model;
use fem_core::assembly::{Matrix, Symmetric, assemble, pattern};
use fem_core::counters::Counters;
use fem_io::files::OutputDir;
use fem_io::tables::{self, TableValue};
use sprs::{CsMatView, TriMat};
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Writes `stiffness.mtx` and `mass.mtx` (Matrix Market, `symmetric`: the lower triangle; N/m and kg for translations) and
/// `unknowns.csv`, which names row and column of each: their order is that in which they are eliminated, of which no more is
/// promised than that it is the same for equal scenes. Supports and other equations are eliminated; where these leave a plate
/// that moves free, restrained or not, K is singular.
///
/// # Errors
/// A cell that the element refuses, a material without the density of a mass, a folder that cannot be written.
pub fn write(dir: &OutputDir, model: &Model, threads: NonZeroUsize) -> Result<(), Error> {
    model.check_mass()?;
    let pattern = Arc::new(pattern(&model.plate, &model.constraints));
    let mut counters = Counters::default();
    for (matrix, name) in [(Matrix::Stiffness, "stiffness.mtx"), (Matrix::Mass, "mass.mtx")] {
        let mut values =
            assemble(&model.plate, &*model.element, &model.constraints, &pattern, matrix, threads, &mut counters)?;
        if matrix == Matrix::Stiffness {
            model.effects.on_stiffness(&model.body(), &mut values)?;
        }
        write_matrix(dir, name, &values)?;
    }
    let header = ["row", "unknown", "node", "x_m", "y_m", "z_m"];
    let named: Vec<_> = (0..pattern.ndof()).map(|i| model.plate.locate(model.constraints.original(i))).collect();
    let names: Vec<String> = named.iter().map(|n| n.2.to_string()).collect();
    let row = |(i, name): (usize, &(usize, usize, _))| {
        let [x, y] = model.plate.columns[name.0];
        let tag = model.plate.plane.node_tags.get(name.0).copied().unwrap_or(0);
        let place = [x, y, model.plate.levels[name.1]].map(TableValue::Number);
        [TableValue::Count(i as u64 + 1), TableValue::Text(&names[i]), TableValue::Count(tag)]
            .into_iter()
            .chain(place)
            .collect()
    };
    tables::write_columns(dir, "unknowns.csv", &header, named.iter().enumerate().map(row))?;
    Ok(())
}

/// Entries that are zero are left out, but for the diagonal.
fn write_matrix(dir: &OutputDir, name: &str, matrix: &Symmetric) -> Result<(), Error> {
    let matrix = matrix.compact();
    let (symbolic, values) = matrix.lower().parts();
    let shape = (matrix.ndof(), matrix.ndof());
    write_lower(dir, name, CsMatView::new_csc(shape, symbolic.col_ptr(), symbolic.row_idx(), values))
}

/// Writes a full symmetric matrix of `n` rows as Matrix Market does sparse ones, so that all of ours are read alike.
///
/// # Errors
/// As [`OutputDir::write`].
pub(crate) fn write_full(dir: &OutputDir, name: &str, n: usize, values: &[f64]) -> Result<(), Error> {
    let mut lower = TriMat::with_capacity((n, n), n * (n + 1) / 2);
    for (j, column) in values.chunks_exact(n.max(1)).enumerate() {
        (j..n).for_each(|i| lower.add_triplet(i, j, column[i]));
    }
    write_lower(dir, name, lower.to_csc::<usize>().view())
}

/// Writes a lower triangle in columns: what the format holds of a symmetric matrix. sprs itself would write the upper one, and
/// line by line.
fn write_lower(dir: &OutputDir, name: &str, lower: CsMatView<'_, f64>) -> Result<(), Error> {
    Ok(dir.write(name, |out| {
        let (rows, columns) = lower.shape();
        writeln!(out, "%%MatrixMarket matrix coordinate real symmetric\n{rows} {columns} {}", lower.nnz())?;
        let mut lines = String::new();
        for (j, column) in lower.outer_iterator().enumerate() {
            lines.clear();
            for (i, value) in column.iter() {
                // Into a string nothing fails.
                let _ = writeln!(lines, "{} {} {value:e}", i + 1, j + 1);
            }
            out.write_all(lines.as_bytes())?;
        }
        Ok(())
    })?)
}
