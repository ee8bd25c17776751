//! What a run found, for Python.

use crate::json;
use fem::Model;
use fem::analyses::matrices::{NamedUnknown, unknowns};
use fem::cost::Cost;
use fem::io::tables::TableValue;
use fem::job::{BucklingFound, Found, ImpactFound, ModesFound, StaticFound};
use fem::output::statics::{MovedNode, ProfileTable, nodes, profile};
use fem::output::{events, history_columns};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;

/// Everything by name; arrays are made once, and Python shows parts of them without copying.
pub(crate) fn results<'py>(
    py: Python<'py>,
    model: &Model,
    found: Found,
    cost: &Cost,
    folder: Option<PathBuf>,
) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    all.set_item("summary", json(&found)?)?;
    all.set_item("cost", json(cost)?)?;
    all.set_item("text", found.text(cost))?;
    all.set_item("folder", folder)?;
    match found {
        Found::Impact(found) => impact(&all, model, &found)?,
        Found::Static(found) => at_rest(&all, model, &found)?,
        Found::Modes(found) => modes(&all, model, *found)?,
        Found::Buckling(found) => buckling(&all, model, *found)?,
    }
    Ok(all)
}

fn impact(all: &Bound<'_, PyDict>, model: &Model, found: &ImpactFound) -> PyResult<()> {
    let rows = &found.outcome.history;
    let columns = history_columns(model);
    // A column after the other, so that each lies in one piece.
    let mut values = vec![0.0; columns.len() * rows.len()];
    for (i, row) in rows.iter().enumerate() {
        row.values().enumerate().for_each(|(k, value)| values[k * rows.len() + i] = value);
    }
    all.set_item("history", array(all.py(), values, [columns.len(), rows.len()])?)?;
    all.set_item("columns", columns)?;
    let events: Vec<_> = events(model, &found.outcome).iter().map(|event| event.named()).collect();
    all.set_item("events", json(&events)?)
}

fn at_rest(all: &Bound<'_, PyDict>, model: &Model, found: &StaticFound) -> PyResult<()> {
    let nodes = nodes(model, &found.solution.u);
    let of =
        |part: fn(&MovedNode) -> [f64; 3]| array(all.py(), nodes.iter().flat_map(part).collect(), [nodes.len(), 3]);
    all.set_item("nodes", PyArray1::from_iter(all.py(), nodes.iter().map(|node| node.tag)))?;
    all.set_item("places", of(|node| node.x)?)?;
    all.set_item("displacements", of(|node| node.u)?)?;
    let profiles = PyDict::new(all.py());
    for (which, named) in model.profiles.iter().enumerate() {
        profiles
            .set_item(&named.line.name.value, profile_columns(all.py(), profile(model, &found.solution, which))?)?;
    }
    all.set_item("profiles", profiles)
}

fn profile_columns(py: Python<'_>, (names, rows): ProfileTable) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for (k, name) in names.into_iter().enumerate() {
        let column = PyList::empty(py);
        for row in &rows {
            match row[k] {
                TableValue::Number(value) | TableValue::Index(value) => column.append(value)?,
                TableValue::Count(value) => column.append(value)?,
                TableValue::Text(text) => column.append(text)?,
            }
        }
        all.set_item(name, column)?;
    }
    Ok(all)
}

fn modes(all: &Bound<'_, PyDict>, model: &Model, found: ModesFound) -> PyResult<()> {
    let py = all.py();
    let ModesFound { solution, .. } = found;
    let (count, unknowns_of_each) = (solution.modes.omega.len(), solution.unknowns);
    all.set_item("omega", PyArray1::from_vec(py, solution.modes.omega))?;
    all.set_item("shapes", array(py, solution.modes.shapes, [count, unknowns_of_each])?)?;
    let masses = solution.effective_masses.into_iter().flatten().collect();
    all.set_item("effective_masses", array(py, masses, [count, 3])?)?;
    all.set_item("unknowns", names(py, &unknowns(model))?)
}

fn buckling(all: &Bound<'_, PyDict>, model: &Model, found: BucklingFound) -> PyResult<()> {
    let py = all.py();
    let BucklingFound { solution, .. } = found;
    let (count, unknowns_of_each) = (solution.buckling.factors.len(), solution.unknowns);
    all.set_item("load_factors", PyArray1::from_vec(py, solution.buckling.factors))?;
    all.set_item("shapes", array(py, solution.buckling.shapes, [count, unknowns_of_each])?)?;
    all.set_item("unknowns", names(py, &unknowns(model))?)
}

/// Unknowns as columns.
pub(crate) fn names<'py>(py: Python<'py>, unknowns: &[NamedUnknown]) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    all.set_item("unknown", unknowns.iter().map(|unknown| unknown.name.as_str()).collect::<Vec<_>>())?;
    all.set_item("node", PyArray1::from_iter(py, unknowns.iter().map(|unknown| unknown.node)))?;
    for (axis, name) in ["x_m", "y_m", "z_m"].into_iter().enumerate() {
        all.set_item(name, PyArray1::from_iter(py, unknowns.iter().map(|unknown| unknown.place[axis])))?;
    }
    Ok(all)
}

/// An array that takes `values` over.
pub(crate) fn array(py: Python<'_>, values: Vec<f64>, shape: [usize; 2]) -> PyResult<Bound<'_, PyArray2<f64>>> {
    PyArray1::from_vec(py, values).reshape(shape)
}
