//! Many impacts on one plate.

use crate::criterion::Raised;
use crate::mistakes::raise;
use crate::own::{Own, raised, registry};
use crate::run::follow;
use crate::scene::Scene;
use fem::job::KeptPlate;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::num::NonZeroUsize;

/// A reduced plate that is kept; it does not change, so that threads may strike it at the same time.
#[pyclass(frozen, module = "femlam._native")]
pub(crate) struct Plate(KeptPlate);

impl Plate {
    pub(crate) fn of(py: Python<'_>, scene: &Scene, own: &[Own], threads: NonZeroUsize) -> PyResult<Self> {
        let kept = py.detach(|| KeptPlate::new(scene.read_one(), &registry(own), threads));
        match raised(own).iter().find_map(Raised::take) {
            Some(raised) => Err(raised),
            None => kept.map(Self).map_err(|error| raise(&error)),
        }
    }
}

#[pymethods]
impl Plate {
    /// The impact of `scene` on it.
    fn impact<'py>(
        &self,
        py: Python<'py>,
        scene: &Scene,
        own: Vec<Own>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let registry = registry(&own);
        follow(py, progress.as_ref(), &own, |watch| self.0.impact(scene.read_one(), &registry, watch))
    }
}
