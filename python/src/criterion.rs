//! Failure criteria that are classes of Python, and those of the program.

use crate::kept;
use crate::laminate::{constants, find};
use crate::mistakes::raise;
use crate::results::array;
use fem::Registry;
use fem::core::failure::{CriterionInfo, FailureCriterion, Site, check_material};
use fem::core::material::Material;
use fem::core::tensor::{Ply, Stress6};
use fem::envelope::criteria;
use miette::MietteDiagnostic;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// What a criterion has raised first; the run it belongs to ends with it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    pub(crate) fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    pub(crate) fn put(&self, error: PyErr) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }
}

/// An object of a class derived from `femlam.Criterion`.
#[derive(Debug, Clone)]
pub(crate) struct PyCriterion {
    object: Arc<Py<PyAny>>,
    pub(crate) name: &'static str,
    pub(crate) summary: &'static str,
    info: CriterionInfo,
    pub(crate) raised: Raised,
}

impl FromPyObject<'_, '_> for PyCriterion {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let text = |name: &str| object.getattr(name)?.extract::<String>();
        let texts = |name: &str| object.getattr(name)?.extract::<Vec<String>>();
        let modes = texts("modes")?;
        if modes.is_empty() {
            return Err(PyValueError::new_err("`modes` is empty: a criterion has at least one mode"));
        }
        let info = CriterionInfo {
            site: if object.getattr("at_interfaces")?.extract()? { Site::Interface } else { Site::Ply },
            modes: kept::texts(&modes),
            strengths: kept::strengths(&texts("strengths")?)?,
            invariant_about_fibre: object.getattr("invariant_about_fibre")?.extract()?,
        };
        Ok(Self {
            object: Arc::new(object.to_owned().unbind()),
            name: kept::text(&text("name")?),
            summary: kept::text(&text("summary")?),
            info,
            raised: Raised::default(),
        })
    }
}

impl FailureCriterion for PyCriterion {
    fn info(&self) -> &CriterionInfo {
        &self.info
    }

    fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
        self.indices_many(std::slice::from_ref(s), m, out);
    }

    fn indices_many(&self, s: &[Stress6<Ply>], m: &Material, out: &mut [f64]) {
        if let Err(error) = Python::attach(|py| self.call(py, s, m, out)) {
            // No number stops the run, and what was raised says why.
            out.fill(f64::NAN);
            self.raised.put(error);
        }
    }

    fn scope(&self) -> &'static str {
        "stresses for which no index is NaN"
    }
}

impl PyCriterion {
    fn call(&self, py: Python<'_>, s: &[Stress6<Ply>], m: &Material, out: &mut [f64]) -> PyResult<()> {
        let states = array(py, s.iter().flat_map(|s| s.0).collect(), [s.len(), 6])?;
        let material = serde_json::Value::from(constants(m)).to_string();
        let found = self.object.bind(py).call_method1("_judge", (states, material))?;
        let found: PyReadonlyArray2<'_, f64> = found.extract()?;
        out.copy_from_slice(found.as_slice()?);
        Ok(())
    }
}

/// Holds a criterion of Python against the contract of criteria, on a material of the library.
#[pyfunction]
pub(crate) fn check_criterion(py: Python<'_>, criterion: PyCriterion, material: &str) -> PyResult<()> {
    let material = find(material)?;
    let checked = py.detach(|| fem_core::testkit::check_criterion(&criterion, material));
    match (criterion.raised.take(), checked) {
        (Some(raised), _) => Err(raised),
        (None, Err(why)) => Err(raise(&MietteDiagnostic::new(format!("the criterion `{}`: {why}", criterion.name)))),
        (None, Ok(())) => Ok(()),
    }
}

/// The names of the modes of the criterion `name` of the program and its indices of many states, (n, 6) Pa to (n, modes).
#[pyfunction]
pub(crate) fn indices<'py>(
    py: Python<'py>,
    name: &str,
    states: PyReadonlyArray2<'py, f64>,
    material: &str,
) -> PyResult<(Vec<&'static str>, Bound<'py, PyArray2<f64>>)> {
    let material = find(material)?;
    let refused = |why: String| raise(&MietteDiagnostic::new(why));
    let found = criteria(&Registry::standard(), &[name.to_owned()], None).map_err(|error| raise(&error))?;
    let Some((_, criterion)) = found.first() else { return Err(refused(format!("there is no criterion `{name}`"))) };
    check_material(&**criterion, name, material).map_err(|error| refused(error.to_string()))?;
    let states: Vec<_> = states.as_slice()?.chunks_exact(6).map(state).collect();
    if let Some(wrong) = states.iter().find(|s| !s.is_finite()) {
        return Err(refused(format!("a stress is not finite: {wrong:?}")));
    }
    let modes = criterion.info().modes;
    let found = py.detach(|| {
        let mut found = vec![0.0; states.len() * modes.len()];
        criterion.indices_many(&states, material, &mut found);
        found
    });
    Ok((modes.to_vec(), PyArray1::from_vec(py, found).reshape([states.len(), modes.len()])?))
}

fn state(components: &[f64]) -> Stress6<Ply> {
    let mut state = [0.0; 6];
    state.copy_from_slice(components);
    Stress6::new(state)
}
