//! Ply laws that are classes of Python.

use crate::criterion::Raised;
use crate::kept;
use crate::laminate::{constants, find};
use crate::mistakes::raise;
use fem::core::energy::Energy;
use fem::core::material::Elastic;
use fem::core::plugin::Dimension;
use fem::core::ply_law::{LawError, LawInfo, LawPoint, PlyLaw, PlyResponse};
use fem::core::tensor::{Matrix6, Ply, Strain6, Stress6};
use fem_core::testkit::Units;
use miette::MietteDiagnostic;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// An object of a class derived from `femlam.PlyLaw`.
#[derive(Debug, Clone)]
pub(crate) struct PyPlyLaw {
    object: Arc<Py<PyAny>>,
    pub(crate) name: &'static str,
    pub(crate) summary: &'static str,
    info: LawInfo,
    points: Arc<Points>,
    pub(crate) raised: Raised,
}

/// Points that Python has been shown, by the bits of their lengths and thicknesses. A law is built for one material, so that the elasticity, the same
/// in other units or not, tells its materials apart; strengths that nobody gave are NaN, which equals nothing.
#[derive(Debug, Default)]
struct Points(Mutex<HashMap<[u64; 2], Shown>>);

type Shown = Vec<(Elastic, Py<PyAny>)>;

impl Points {
    /// The object for `point`. Making one may let other threads of Python run, which is why nothing is locked meanwhile.
    fn shown<'py>(&self, py: Python<'py>, point: &LawPoint<'_>) -> PyResult<Bound<'py, PyAny>> {
        let sizes = [point.length, point.thickness].map(f64::to_bits);
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner).get(&sizes).and_then(|points| {
            points.iter().find(|(elastic, _)| *elastic == point.material.elastic).map(|(_, shown)| shown.clone_ref(py))
        });
        if let Some(known) = known {
            return Ok(known.into_bound(py));
        }
        let constants = serde_json::Value::from(constants(point.material)).to_string();
        let stiffness = PyArray1::from_slice(py, point.stiffness.as_flattened());
        let make = py.import("femlam._ply_law")?.getattr("_point")?;
        let made = make.call1((constants, stiffness, point.length, point.thickness))?;
        let mut points = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        points.entry(sizes).or_default().push((point.material.elastic, made.clone().unbind()));
        Ok(made)
    }
}

impl FromPyObject<'_, '_> for PyPlyLaw {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let text = |name: &str| object.getattr(name)?.extract::<String>();
        let texts = |name: &str| object.getattr(name)?.extract::<Vec<String>>();
        Ok(Self {
            object: Arc::new(object.to_owned().unbind()),
            name: kept::text(&text("name")?),
            summary: kept::text(&text("summary")?),
            info: LawInfo {
                state: kept::texts(&texts("state")?),
                strengths: kept::strengths(&texts("strengths")?)?,
                toughness: kept::toughnesses(&texts("toughnesses")?)?,
            },
            points: Arc::default(),
            raised: Raised::default(),
        })
    }
}

/// Stress, state, energies stored and dissipated, tangent by rows.
type Answer<'py> = (PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, f64>, f64, f64, PyReadonlyArray1<'py, f64>);

impl PyPlyLaw {
    fn call(
        &self,
        py: Python<'_>,
        point: &LawPoint<'_>,
        strain: &Strain6<Ply>,
        (old, new): (&[f64], &mut [f64]),
        tangent: Option<&mut Matrix6>,
    ) -> PyResult<PlyResponse> {
        let arguments =
            (self.points.shown(py, point)?, PyArray1::from_slice(py, &strain.0), PyArray1::from_slice(py, old));
        let found = self.object.bind(py).call_method1("_respond", arguments)?;
        let (found, state, stored, dissipated, slopes): Answer<'_> = found.extract()?;
        let mut stress = [0.0; 6];
        stress.copy_from_slice(found.as_slice()?);
        new.copy_from_slice(state.as_slice()?);
        if let Some(tangent) = tangent {
            tangent.as_flattened_mut().copy_from_slice(slopes.as_slice()?);
        }
        Ok(PlyResponse { stress: Stress6::new(stress), energy: Energy { stored, dissipated } })
    }

    /// The law for one material.
    pub(crate) fn built(&self) -> Self {
        Self { points: Arc::default(), ..self.clone() }
    }

    /// The law with its constants in `units`.
    fn in_units(&self, units: &Units) -> PyResult<Self> {
        Python::attach(|py| {
            let copy = py.import("copy")?.call_method1("copy", (&*self.object,))?;
            for (name, [length, mass, time]) in copy.getattr("dimensions")?.extract::<HashMap<String, [f64; 3]>>()? {
                let value: f64 = copy.getattr(&*name)?.extract()?;
                copy.setattr(&*name, units.number(value, Dimension([length, mass, time, 0.0])))?;
            }
            Ok(Self { object: Arc::new(copy.unbind()), ..self.built() })
        })
    }
}

impl PlyLaw for PyPlyLaw {
    fn info(&self) -> &LawInfo {
        &self.info
    }

    fn respond(
        &self,
        point: &LawPoint<'_>,
        strain: &Strain6<Ply>,
        old: &[f64],
        new: &mut [f64],
        tangent: Option<&mut Matrix6>,
    ) -> Result<PlyResponse, LawError> {
        Python::attach(|py| self.call(py, point, strain, (old, new), tangent)).map_err(|error| {
            let why = error.to_string();
            self.raised.put(error);
            LawError(why)
        })
    }
}

/// Holds a ply law of Python against the contract of ply laws, on a material of the library in a cell of the width `length`, m,
/// under strains up to `largest`.
#[pyfunction]
pub(crate) fn check_ply_law(
    py: Python<'_>,
    law: PyPlyLaw,
    material: &str,
    length: f64,
    largest: [f64; 6],
) -> PyResult<()> {
    let material = find(material)?;
    // What goes wrong in other units is the same in these.
    let scaled = |units: &Units| {
        let scaled = law.in_units(units).unwrap_or_else(|error| {
            law.raised.put(error);
            law.clone()
        });
        Box::new(scaled) as Box<dyn PlyLaw>
    };
    let checked = py.detach(|| fem_core::testkit::check_ply_law(scaled, material, length, &largest));
    match (law.raised.take(), checked) {
        (Some(raised), _) => Err(raised),
        (None, Err(why)) => Err(raise(&MietteDiagnostic::new(format!("the ply law `{}`: {why}", law.name)))),
        (None, Ok(())) => Ok(()),
    }
}
