//! The program as a module of Python: `femlam._native`, which the package `femlam` wraps.
//!
//! Arrays are NumPy's, all else that is found is JSON: what `summary.json` and its like hold.

mod advice;
mod contact;
mod criterion;
mod envelope;
mod kept;
mod laminate;
mod matrices;
mod mistakes;
mod own;
mod plate;
mod ply_law;
mod results;
mod run;
mod scene;
mod study;
mod sweep;
mod watch;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::contact::check_contact_law;
    #[pymodule_export]
    use super::criterion::{check_criterion, indices};
    #[pymodule_export]
    use super::envelope::envelope;
    #[pymodule_export]
    use super::laminate::material;
    #[pymodule_export]
    use super::plate::Plate;
    #[pymodule_export]
    use super::ply_law::check_ply_law;
    #[pymodule_export]
    use super::scene::{Scene, as_toml, as_value, quantity};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}

/// What `found` holds, as JSON.
fn json(found: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(found).map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))
}
