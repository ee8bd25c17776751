//! Failure criteria that are classes of Python, and those of the program.

use crate::laminate::{constants, find};
use crate::mistakes::raise;
use crate::results::array;
use fem::Registry;
use fem::core::failure::{CriterionInfo, FailureCriterion, Site, check_material};
use fem::core::material::{Material, Strength};
use fem::core::plugin::{Built, Kind, Params, unknown_key};
use fem::core::tensor::{Ply, Stress6};
use miette::MietteDiagnostic;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::BTreeSet;
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
        let strength = |name: &String| {
            let named = |strength: &&Strength| strength.name() == name;
            let unknown = || {
                PyValueError::new_err(format!(
                    "strength `{name}` {}",
                    unknown_key(name, Strength::ALL.iter().map(|s| s.name()))
                ))
            };
            Strength::ALL.iter().find(named).copied().ok_or_else(unknown)
        };
        let (modes, strengths) = (texts("modes")?, texts("strengths")?);
        if modes.is_empty() {
            return Err(PyValueError::new_err("`modes` is empty: a criterion has at least one mode"));
        }
        let strengths: Vec<_> = strengths.iter().map(strength).collect::<PyResult<_>>()?;
        let (modes, strengths) = lists(modes.iter().map(|mode| keep(mode)).collect(), strengths);
        let info = CriterionInfo {
            site: if object.getattr("at_interfaces")?.extract()? { Site::Interface } else { Site::Ply },
            modes,
            strengths,
            invariant_about_fibre: object.getattr("invariant_about_fibre")?.extract()?,
        };
        Ok(Self {
            object: Arc::new(object.to_owned().unbind()),
            name: keep(&text("name")?),
            summary: keep(&text("summary")?),
            info,
            raised: Raised::default(),
        })
    }
}

/// A text that lives until the program ends, once however often it is kept: what a registry lists and events carry.
pub(crate) fn keep(text: &str) -> &'static str {
    static KEPT: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = kept.get(text) {
        return known;
    }
    let text: &'static str = text.to_owned().leak();
    kept.insert(text);
    text
}

/// Modes and strengths of a class.
type Lists = (&'static [&'static str], &'static [Strength]);

/// The same for lists.
fn lists(modes: Vec<&'static str>, strengths: Vec<Strength>) -> Lists {
    static KEPT: Mutex<Vec<Lists>> = Mutex::new(Vec::new());
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = kept.iter().find(|known| known.0 == modes && known.1 == strengths) {
        return *known;
    }
    let lists: Lists = (modes.leak(), strengths.leak());
    kept.push(lists);
    lists
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
    let refused = |why: String, help: String| raise(&MietteDiagnostic::new(why).with_help(help));
    let built = Registry::standard().build(Kind::Criterion, name, &Params::default());
    let criterion = match built {
        Ok(Built::Criterion(criterion)) => criterion,
        Ok(_) => return Err(refused(format!("`{name}` is no criterion"), String::new())),
        Err(fem::RegistryError::Unknown { hint, .. }) => {
            return Err(refused(format!("there is no criterion `{name}`"), hint));
        }
        Err(error) => return Err(refused(format!("criterion `{name}`: {error}"), String::new())),
    };
    check_material(&*criterion, name, material).map_err(|error| refused(error.to_string(), String::new()))?;
    let states: Vec<_> = states.as_slice()?.chunks_exact(6).map(state).collect();
    if let Some(wrong) = states.iter().find(|s| !s.is_finite()) {
        return Err(refused(format!("a stress is not finite: {wrong:?}"), String::new()));
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
