//! Classical laminate theory, and materials.

use crate::json;
use crate::mistakes::raise;
use crate::own::registry;
use crate::results::array;
use fem::Model;
use fem::core::classical::{ClassicalLaminate, PlaneModuli};
use fem::core::material::{Material, Strength};
use fem::core::plugin::unknown_key;
use fem::io::materials;
use fem::io::scene::Scene;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Map, Value};

/// A, B, D and moduli of the laminate of `scene`.
pub(crate) fn laminate<'py>(py: Python<'py>, scene: &Scene) -> PyResult<Bound<'py, PyDict>> {
    let model = py.detach(|| Model::new(scene, &registry(&[]))).map_err(|error| raise(&error))?;
    let plate = ClassicalLaminate::new(&model.laminate, &model.materials);
    let all = PyDict::new(py);
    for (name, matrix) in [("A", &plate.membrane), ("B", &plate.coupling), ("D", &plate.bending)] {
        all.set_item(name, array(py, matrix.as_slice().to_vec(), [3, 3])?)?;
    }
    for (name, PlaneModuli { ex, ey, gxy, nuxy }) in [("in_plane", plate.in_plane()), ("flexural", plate.flexural())] {
        let moduli = PyDict::new(py);
        for (name, value) in [("Ex", ex), ("Ey", ey), ("Gxy", gxy), ("nuxy", nuxy)] {
            moduli.set_item(name, value)?;
        }
        all.set_item(name, moduli)?;
    }
    all.set_item("thickness", plate.thickness)?;
    all.set_item("angles", model.laminate.plies.iter().map(|ply| ply.angle_deg).collect::<Vec<_>>())?;
    Ok(all)
}

/// The constants of a material of the library, SI, as JSON.
#[pyfunction]
pub(crate) fn material(name: &str) -> PyResult<String> {
    json(&constants(find(name)?))
}

pub(crate) fn find(name: &str) -> PyResult<&'static Material> {
    let unknown = || PyKeyError::new_err(format!("`{name}` {}", unknown_key(name, materials::names())));
    Ok(&materials::library(name).ok_or_else(unknown)?.material)
}

/// Its constants by the names that scenes have for them.
pub(crate) fn constants(material: &Material) -> Map<String, Value> {
    let of = &material.elastic;
    let elastic = [
        ("E1", of.e1),
        ("E2", of.e2),
        ("E3", of.e3),
        ("nu12", of.nu12),
        ("nu13", of.nu13),
        ("nu23", of.nu23),
        ("G12", of.g12),
        ("G13", of.g13),
        ("G23", of.g23),
    ];
    let strengths = Strength::ALL.iter().filter_map(|which| Some((which.name(), material.strengths.get(*which)?)));
    let density = material.density.map(|density| ("density", density));
    let numbers =
        elastic.into_iter().chain(strengths).chain(density).map(|(name, value)| (name.to_owned(), value.into()));
    [("name".to_owned(), Value::from(material.name.as_str()))].into_iter().chain(numbers).collect()
}
