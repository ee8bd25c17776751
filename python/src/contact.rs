//! Contact laws that are classes of Python.

use crate::criterion::Raised;
use crate::kept;
use crate::mistakes::raise;
use fem::core::contact::{Branches, ContactForce, ContactHistory, ContactLaw};
use fem::core::energy::Energy;
use miette::MietteDiagnostic;
use pyo3::call::PyCallArgs;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// An object of a class derived from `femlam.ContactLaw`.
#[derive(Debug, Clone)]
pub(crate) struct PyContactLaw {
    object: Arc<Py<PyAny>>,
    pub(crate) name: &'static str,
    pub(crate) summary: &'static str,
    pub(crate) raised: Raised,
}

impl FromPyObject<'_, '_> for PyContactLaw {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let text = |name: &str| object.getattr(name)?.extract::<String>();
        Ok(Self {
            name: kept::text(&text("name")?),
            summary: kept::text(&text("summary")?),
            object: Arc::new(object.to_owned().unbind()),
            raised: Raised::default(),
        })
    }
}

impl PyContactLaw {
    /// What a method returns; `otherwise` where it raises, which ends the run.
    fn ask<T>(&self, method: &str, arguments: impl for<'py> PyCallArgs<'py>, otherwise: T) -> T
    where
        T: for<'a, 'py> FromPyObject<'a, 'py>,
    {
        let found = Python::attach(|py| {
            let found = self.object.bind(py).call_method1(method, arguments)?;
            found.extract::<T>().map_err(|error| {
                let error: PyErr = error.into();
                PyValueError::new_err(format!("`{method}` of the contact law `{}`: {error}", self.name))
            })
        });
        found.unwrap_or_else(|error| {
            self.raised.put(error);
            otherwise
        })
    }
}

impl ContactLaw for PyContactLaw {
    fn force(&self, history: &ContactHistory, alpha: f64) -> ContactForce {
        // No number stops the run, and what was raised says why.
        let (force, tangent) = self.ask("force", (*history, alpha), (f64::NAN, f64::NAN));
        ContactForce { force, tangent }
    }

    fn commit(&self, history: &mut ContactHistory, alpha: f64) {
        *history = self.ask("_commit", (*history, alpha), *history);
    }

    fn energy(&self, history: &ContactHistory, alpha: f64) -> Energy {
        let (stored, dissipated) = self.ask("energy", (*history, alpha), (f64::NAN, f64::NAN));
        Energy { stored, dissipated }
    }

    fn branches(&self, history: &ContactHistory) -> Branches {
        let (touch, peak) = self.ask("branches", (*history,), (0.0, None));
        Branches { touch, peak }
    }
}

/// Holds a contact law of Python against the contract of contact laws, up to the indentation `largest`, m.
#[pyfunction]
pub(crate) fn check_contact_law(py: Python<'_>, law: PyContactLaw, largest: f64) -> PyResult<()> {
    let checked = py.detach(|| fem_core::testkit::check_contact_law(&law, largest));
    match (law.raised.take(), checked) {
        (Some(raised), _) => Err(raised),
        (None, Err(why)) => Err(raise(&MietteDiagnostic::new(format!("the contact law `{}`: {why}", law.name)))),
        (None, Ok(())) => Ok(()),
    }
}
