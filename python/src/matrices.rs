//! K and M as the parts of sparse matrices of SciPy.

use crate::mistakes::raise;
use crate::own::registry;
use crate::results::names;
use fem::Model;
use fem::analyses::matrices::PlateMatrices;
use fem::core::assembly::Symmetric;
use fem::io::scene::Scene;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::num::NonZeroUsize;

/// The lower triangles, in columns, and what their unknowns stand for.
pub(crate) fn matrices<'py>(py: Python<'py>, scene: &Scene, threads: NonZeroUsize) -> PyResult<Bound<'py, PyDict>> {
    let found = py.detach(|| PlateMatrices::new(&Model::new(scene, &registry(&[]))?, threads));
    let PlateMatrices { stiffness, mass, unknowns } = found.map_err(|error| raise(&error))?;
    let all = PyDict::new(py);
    all.set_item("stiffness", lower(py, &stiffness)?)?;
    all.set_item("mass", lower(py, &mass)?)?;
    all.set_item("unknowns", names(py, &unknowns)?)?;
    Ok(all)
}

/// Values, rows and starts of columns; entries that are zero are left out, but for the diagonal.
fn lower<'py>(py: Python<'py>, matrix: &Symmetric) -> PyResult<Bound<'py, PyAny>> {
    let matrix = matrix.compact();
    let (pattern, values) = matrix.lower().parts();
    let whole = |of: &[usize]| PyArray1::from_iter(py, of.iter().map(|i| *i as i64));
    let parts = (PyArray1::from_slice(py, values), whole(pattern.row_idx()), whole(pattern.col_ptr()));
    Ok(parts.into_pyobject(py)?.into_any())
}
