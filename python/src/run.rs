//! Runs.

use crate::mistakes::raise;
use crate::own::{Own, raised, registry};
use crate::results::results;
use crate::watch::{Quiet, Watch};
use fem::io::scene::{self, Scene};
use fem::job::{self, Finished, Options, Results, Task};
use fem::{Error, Model, Registry, study};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::cell::RefCell;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// What is asked of a run.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    /// So many modes, whatever the scene asks for; 0 for as many as it says.
    modes: Option<usize>,
    threads: NonZeroUsize,
    folder: Option<PathBuf>,
    resume: bool,
    progress: Option<Py<PyAny>>,
    own: Vec<Own>,
    /// Largest error of the main results, for which settings are raised.
    accuracy: Option<f64>,
}

pub(crate) fn run<'py>(py: Python<'py>, scene: &Scene, asked: Asked) -> PyResult<Bound<'py, PyDict>> {
    let Asked { modes, threads, folder, resume, progress, own, accuracy } = asked;
    let registry = registry(&own);
    let results_in = match (folder, resume) {
        (None, _) => Results::InMemory,
        (Some(folder), false) => Results::Folder(folder),
        (Some(folder), true) => Results::Resumed(folder),
    };
    let task = modes.map_or(Task::Scene, |count| Task::Modes(NonZeroUsize::new(count)));
    let mut options = Options { task, results: results_in, threads, ..Options::default() };
    follow(py, progress.as_ref(), &own, |watch| {
        let raised = match accuracy.or_else(|| scene.accuracy.as_ref().map(|accuracy| accuracy.value)) {
            Some(asked) if task == Task::Scene => Some(attain(scene, &registry, asked, &mut options, watch)?),
            _ => None,
        };
        job::run(raised.as_ref().unwrap_or(scene), &registry, &options, watch)
    })
}

/// What `job` finds, other threads of Python running meanwhile; what its callback or a criterion raises comes first.
pub(crate) fn follow<'py>(
    py: Python<'py>,
    progress: Option<&Py<PyAny>>,
    own: &[Own],
    job: impl FnOnce(&mut Watch<'_>) -> Result<Finished, Error> + Send,
) -> PyResult<Bound<'py, PyDict>> {
    let raised = raised(own);
    let mut watch = Watch::new(progress, &raised);
    let done = py.detach(|| job(&mut watch));
    match (done, watch.raised()) {
        (_, Some(raised)) => Err(raised),
        (Err(error), None) => Err(raise(&error)),
        (Ok(Finished { model, found, cost, folder }), None) => results(py, &model, found, &cost, folder),
    }
}

/// The scene with settings raised until its main results are as exact as is `asked`.
fn attain(
    scene: &Scene,
    registry: &Registry,
    asked: f64,
    options: &mut Options,
    watch: &mut Watch<'_>,
) -> Result<Scene, Error> {
    let model = Model::new(scene, registry)?;
    let watch = RefCell::new(watch);
    let attained = study::attain((scene, &model), registry, asked, None, &mut |_, _| {}, &mut Quiet(&watch))?;
    let raised = scene::parse(&scene::rewrite(&scene.source, &attained.setting)?, Path::new(scene.source.name()))?;
    options.attained = Some(attained);
    Ok(raised)
}
