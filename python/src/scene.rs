//! Scenes.

use crate::advice::advise;
use crate::laminate::laminate;
use crate::matrices::matrices;
use crate::mistakes::raise;
use crate::own::{Own, registry};
use crate::plate::Plate;
use crate::run::{Asked, run};
use crate::study::{AskedOfStudy, study};
use crate::sweep::{AskedOfSweep, sweep};
use fem::io::scene;
use fem::io::units::{self, UnitError};
use fem::{Error, Model};
use miette::MietteDiagnostic;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::BTreeMap;
use std::fmt::Display;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// A scene that was read; it does not change.
#[pyclass(frozen, module = "femlam._native")]
pub(crate) struct Scene(scene::Scene);

/// A document of JSON as one of TOML.
#[pyfunction]
pub(crate) fn as_toml(json: &str) -> PyResult<String> {
    toml::to_string(&read_json(json)?).map_err(cannot_hold)
}

/// A value of JSON as one of TOML, in one line.
#[pyfunction]
pub(crate) fn as_value(json: &str) -> PyResult<String> {
    toml::Value::try_from(read_json(json)?).map(|value| value.to_string()).map_err(cannot_hold)
}

/// A number with its unit, in SI.
#[pyfunction]
pub(crate) fn quantity(text: &str) -> PyResult<f64> {
    let refused = |error: UnitError| {
        let help = error.remedy(None);
        raise(&MietteDiagnostic::new(error.to_string()).with_help(help))
    };
    units::parse_quantity(text).map(|(value, _)| value).map_err(refused)
}

fn read_json(json: &str) -> PyResult<serde_json::Value> {
    serde_json::from_str(json).map_err(|error| PyValueError::new_err(error.to_string()))
}

fn cannot_hold(error: impl Display) -> PyErr {
    PyTypeError::new_err(format!("a scene cannot hold this: {error}"))
}

#[pymethods]
impl Scene {
    /// Reads a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        py.detach(|| scene::read(&path)).map(Self).map_err(|error| raise(&error))
    }

    /// Reads a text; `path` names it in errors, and its folder is where the mesh file is looked for.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, path: PathBuf) -> PyResult<Self> {
        py.detach(|| scene::parse(text, &path)).map(Self).map_err(|error| raise(&error))
    }

    /// The same with values of TOML in the place of others, by the paths of their keys.
    fn replaced(&self, py: Python<'_>, keys: Vec<(String, String)>) -> PyResult<Self> {
        let replaced = || scene::parse_set(self.0.source.text(), self.path(), &keys);
        py.detach(replaced).map(Self).map_err(|error| raise(&error))
    }

    #[getter]
    fn text(&self) -> &str {
        self.0.source.text()
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.source.name()
    }

    /// Every value by the path of its key, as TOML writes it.
    #[getter]
    fn keys(&self) -> BTreeMap<String, String> {
        self.0.keys.clone()
    }

    /// What is wrong with the scene and its mesh, if anything; otherwise warnings.
    fn check(&self, py: Python<'_>, own: Vec<Own>) -> PyResult<Vec<String>> {
        let warnings = || Ok(Model::new(&self.0, &registry(&own))?.warnings);
        py.detach(warnings).map_err(|error: Error| raise(&error))
    }

    fn run<'py>(&self, py: Python<'py>, asked: Asked) -> PyResult<Bound<'py, PyDict>> {
        run(py, &self.0, asked)
    }

    /// Its plate, reduced and kept.
    fn plate(&self, py: Python<'_>, own: Vec<Own>, threads: NonZeroUsize) -> PyResult<Plate> {
        Plate::of(py, self, &own, threads)
    }

    /// Runs its cases into a folder; what `sweep.json` holds.
    fn sweep(&self, py: Python<'_>, asked: AskedOfSweep) -> PyResult<String> {
        sweep(py, &self.0, self.path(), asked)
    }

    /// Studies what accuracy costs; its document as JSON, its text, and the text of the scene with the cheapest setting that keeps
    /// the tolerance.
    fn study(&self, py: Python<'_>, asked: AskedOfStudy) -> PyResult<(String, String, Option<String>)> {
        study(py, &self.0, asked)
    }

    /// What the advisor answers, as JSON.
    fn advise(&self, py: Python<'_>, threads: NonZeroUsize) -> PyResult<String> {
        advise(py, &self.0, threads)
    }

    /// K and M.
    fn matrices<'py>(&self, py: Python<'py>, threads: NonZeroUsize) -> PyResult<Bound<'py, PyDict>> {
        matrices(py, &self.0, threads)
    }

    /// A, B, D and moduli.
    fn laminate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        laminate(py, &self.0)
    }

    /// Whether the scene names the criterion, the contact law or the ply law `name`.
    fn asks_for(&self, name: &str) -> bool {
        let laws = self.0.impact().into_iter().flat_map(|impact| &impact.impactors).map(|impactor| &impactor.contact);
        let plugins = self.0.failure.criteria.iter().map(|spec| &spec.plugin);
        let mut plugins = plugins.chain(laws).chain(self.0.laws.iter().flatten());
        plugins.any(|plugin| plugin.name.value == name)
    }
}

impl Scene {
    pub(crate) fn read_one(&self) -> &scene::Scene {
        &self.0
    }

    fn path(&self) -> &Path {
        Path::new(self.0.source.name())
    }
}
