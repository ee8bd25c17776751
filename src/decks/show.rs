//! What lies in a project: descriptions, and files for other programs.

use super::project::Project;
use crate::analyses::matrices::write_full;
use crate::error::Error;
use fem_io::deck::{DeckSource, Fault};
use fem_io::files::OutputDir;
use fem_io::npy;
use fem_io::tables::{self, TableValue};
use serde::Serialize;

/// A result of a project.
#[derive(Debug, Clone, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum Shown {
    Matrices {
        name: String,
        deck: String,
        program: String,
        names: [String; 6],
        elements: usize,
        masters: Vec<String>,
        checksum: String,
    },
    Displacements {
        name: String,
        deck: String,
        substructures: Vec<String>,
        print_steps: usize,
        last_time: f64,
        #[serde(skip_serializing_if = "Option::is_none")]
        stale: Option<String>,
    },
}

/// What is kept under `name`, matrices and displacements.
///
/// # Errors
/// There is nothing of that name.
pub fn show(project: &Project, name: &str) -> Result<Vec<Shown>, Error> {
    let matrices = project.matrices(name).map(|matrices| Shown::Matrices {
        name: name.to_owned(),
        deck: matrices.deck.0.clone(),
        program: matrices.program().to_string(),
        names: matrices.names.clone(),
        elements: matrices.elements,
        masters: matrices.masters.iter().map(|(node, label)| format!("{node} {label}")).collect(),
        checksum: matrices.checksum(),
    });
    let set = project.set(name).map(|set| Shown::Displacements {
        name: name.to_owned(),
        deck: set.analysis.deck.0.clone(),
        substructures: set.analysis.parts.iter().map(|(name, _)| name.clone()).collect(),
        print_steps: set.count,
        last_time: set.steps.last().map_or(0.0, |(time, _)| *time),
        stale: project.fresh(&set.analysis.parts).err(),
    });
    let shown: Vec<Shown> = matrices.into_iter().chain(set).collect();
    if shown.is_empty() { Err(nothing(project, name)) } else { Ok(shown) }
}

fn nothing(project: &Project, name: &str) -> Error {
    let known: Vec<&str> = project.names().collect();
    let help =
        if known.is_empty() { "the project is empty".to_owned() } else { format!("known are {}", known.join(", ")) };
    DeckSource::new("", String::new())
        .error(0..0, Fault::NoSuchResult, format!("the project holds no `{name}`"), help)
        .into()
}

/// Writes what is kept under `name` for other programs into `dir`, and returns the names of the files: of matrices K and M as
/// Matrix Market and NumPy files and the masters as a table, of displacements print steps and times as NumPy files.
///
/// # Errors
/// There is nothing of that name; a folder that cannot be written.
pub fn export(project: &Project, name: &str, dir: &OutputDir) -> Result<Vec<String>, Error> {
    let mut files = Vec::new();
    if let Some(matrices) = project.matrices(name) {
        let n = matrices.masters.len();
        for (what, values) in [("stiffness", &matrices.k), ("mass", &matrices.m)] {
            files.push(format!("{name}.{what}.mtx"));
            write_full(dir, &format!("{name}.{what}.mtx"), n, values)?;
            files.push(format!("{name}.{what}.npy"));
            npy::write(dir, &format!("{name}.{what}.npy"), &[n, n], values)?;
        }
        let file = format!("{name}.masters.csv");
        let rows = matrices.masters.iter().enumerate().map(|(i, (node, label))| {
            vec![TableValue::Count(i as u64 + 1), TableValue::Count(u64::from(*node)), TableValue::Text(label)]
        });
        tables::write_columns(dir, &file, &["row", "node", "dir"], rows)?;
        files.push(file);
    }
    if let Some(set) = project.set(name) {
        let times: Vec<f64> = set.steps.iter().map(|(time, _)| *time).collect();
        let dofs = set.steps.first().map_or(0, |(_, u)| u.len());
        let u: Vec<f64> = set.steps.iter().flat_map(|(_, u)| u).copied().collect();
        for (what, shape, values) in
            [("times", vec![times.len()], &times), ("displacements", vec![times.len(), dofs], &u)]
        {
            files.push(format!("{name}.{what}.npy"));
            npy::write(dir, &format!("{name}.{what}.npy"), &shape, values)?;
        }
    }
    if files.is_empty() { Err(nothing(project, name)) } else { Ok(files) }
}
