//! Errors of the program as exceptions: every mistake with its file, line, column and remedy.

use miette::Diagnostic;
use pyo3::prelude::*;
use serde_json::{Value, json};

/// The exception for `error`: `femlam.SceneError` where it has a place in a scene or a mesh file, otherwise `femlam.FemError`.
pub(crate) fn raise(error: &dyn Diagnostic) -> PyErr {
    let mut mistakes = Vec::new();
    collect(error, &mut mistakes);
    Python::attach(|py| {
        let exception = || py.import("femlam._errors")?.getattr("_of")?.call1((Value::from(mistakes).to_string(),));
        exception().map_or_else(|failed| failed, PyErr::from_value)
    })
}

/// A diagnostic and those related to it, each by itself; lines and columns count from 1, columns in bytes.
fn collect(diagnostic: &dyn Diagnostic, found: &mut Vec<Value>) {
    let causes: Vec<String> =
        std::iter::successors(diagnostic.source(), |cause| cause.source()).map(ToString::to_string).collect();
    let help = diagnostic.help().map(|help| help.to_string());
    let mut mistake = json!({ "message": diagnostic.to_string(), "causes": causes, "help": help });
    if let Some(place) = place(diagnostic) {
        mistake["place"] = place;
    }
    found.push(mistake);
    for other in diagnostic.related().into_iter().flatten() {
        collect(other, found);
    }
}

fn place(diagnostic: &dyn Diagnostic) -> Option<Value> {
    let label = diagnostic.labels()?.next()?;
    let source = diagnostic.source_code()?;
    let at = source.read_span(label.inner(), 0, 0).ok()?;
    // With a line more, the rest of its own; the column is right without.
    let with_rest = source.read_span(label.inner(), 0, 1).ok()?;
    let before = source.read_span(&(0, label.offset()).into(), 0, 0).ok()?;
    let (before, rest) = (String::from_utf8_lossy(before.data()), String::from_utf8_lossy(with_rest.data()));
    let line = [before.rsplit('\n').next()?, rest.lines().next().unwrap_or_default()].concat();
    Some(json!({ "file": at.name(), "line": at.line() + 1, "column": at.column() + 1, "text": line }))
}
