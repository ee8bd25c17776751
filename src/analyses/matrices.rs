//! K and M as files for other programs.

use super::assembled::undivided;
use crate::error::Error;
use crate::model::Model;
use fem_core::assembly::{Symmetric, pattern};
use fem_core::counters::Counters;
use fem_io::files::OutputDir;
use fem_io::tables::{self, TableValue};
use sprs::{CsMatView, TriMat};
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// K and M with the names of their unknowns. Supports and other equations are eliminated; where these leave a plate that moves free,
/// restrained or not, K is singular.
#[derive(Debug, Clone)]
pub struct PlateMatrices {
    /// K: N/m for translations.
    pub stiffness: Symmetric,
    /// M: kg for translations.
    pub mass: Symmetric,
    /// What each row and column stands for, in the order in which unknowns are eliminated, of which no more is promised than that it is
    /// the same for equal scenes.
    pub unknowns: Vec<NamedUnknown>,
}

/// An independent unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedUnknown {
    /// Which: `U30`, the displacement along z, `U31`, its derivative along x.
    pub name: String,
    /// Node of the mesh file above or below which it is; 0 for one that the file does not have.
    pub node: u64,
    /// Place, m.
    pub place: [f64; 3],
}

impl PlateMatrices {
    /// Those of `model`, assembled.
    ///
    /// # Errors
    /// A cell that the element refuses, a material without the density of a mass.
    pub fn new(model: &Model, threads: NonZeroUsize) -> Result<Self, Error> {
        model.check_mass()?;
        let pattern = Arc::new(pattern(&model.plate, &model.constraints));
        let (mut stiffness, mass) = undivided(model, &pattern, true, threads, &mut Counters::default())?;
        if let Some(geometric) = model.effects.geometric(&model.body(), &pattern)? {
            stiffness.add(1.0, &geometric);
        }
        Ok(Self { stiffness, mass, unknowns: unknowns(model) })
    }
}

/// The independent unknowns of `model`, in the order of its matrices and of the shapes of its modes.
pub fn unknowns(model: &Model) -> Vec<NamedUnknown> {
    let Model { plate, constraints, .. } = model;
    let named = |i| {
        let (column, level, dof) = plate.locate(constraints.original(i));
        let [x, y] = plate.columns[column];
        let node = plate.plane.node_tags.get(column).copied().unwrap_or(0);
        NamedUnknown { name: dof.to_string(), node, place: [x, y, plate.levels[level]] }
    };
    (0..constraints.ndof()).map(named).collect()
}

/// Writes `stiffness.mtx` and `mass.mtx` (Matrix Market, `symmetric`: the lower triangle) and `unknowns.csv`, which names row and column
/// of each: [`PlateMatrices`].
///
/// # Errors
/// As [`PlateMatrices::new`], and a folder that cannot be written.
pub fn write(dir: &OutputDir, model: &Model, threads: NonZeroUsize) -> Result<(), Error> {
    let PlateMatrices { stiffness, mass, unknowns } = PlateMatrices::new(model, threads)?;
    write_matrix(dir, "stiffness.mtx", &stiffness)?;
    write_matrix(dir, "mass.mtx", &mass)?;
    let header = ["row", "unknown", "node", "x_m", "y_m", "z_m"];
    let rows = unknowns.iter().enumerate().map(|(i, unknown)| {
        let names = [TableValue::Count(i as u64 + 1), TableValue::Text(&unknown.name), TableValue::Count(unknown.node)];
        names.into_iter().chain(unknown.place.map(TableValue::Number)).collect()
    });
    Ok(tables::write_columns(dir, "unknowns.csv", &header, rows)?)
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
