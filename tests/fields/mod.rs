//! Fields for ParaView and PyVista: what the files hold, held against the model, the tables and other readers.

mod damaged;
mod decode;
mod impact;
mod readers;
mod refusals;
mod rest;

use crate::support::{Case, strip};
use decode::{Vtu, collection};
use std::path::PathBuf;

/// A strip that is struck at the node in its middle, with fields.
fn struck(fields: &str) -> Case {
    strip().scene("[impactor]", "[impactor]\nload = \"node\"").append(&format!("[output]\nfields = {fields}\n"))
}

/// A series of a folder of results: times and grids.
#[track_caller]
fn series(case: &Case, results: &str, name: &str) -> Vec<(f64, Vtu)> {
    let files = collection(&folder(case, results).join(format!("{name}.pvd")));
    files.iter().map(|(time, file)| (*time, Vtu::read(file))).collect()
}

fn folder(case: &Case, results: &str) -> PathBuf {
    case.folder().join(results).join("fields")
}

/// Volume of linear hexahedra over quadrilaterals with upright edges.
fn volume(grid: &Vtu) -> f64 {
    let (x, mut sum) = (grid.positions(), 0.0);
    for cell in grid.connectivity() {
        let p = |k: usize| x[cell[k]];
        let cross = (p(2)[0] - p(0)[0]) * (p(3)[1] - p(1)[1]) - (p(3)[0] - p(1)[0]) * (p(2)[1] - p(0)[1]);
        sum += 0.5 * cross * (p(4)[2] - p(0)[2]);
    }
    sum
}

/// Whether two numbers agree to single precision, relative to `scale`.
fn close(a: f64, b: f64, scale: f64) -> bool {
    (a - b).abs() <= 2e-7 * scale
}
