//! Studies of what accuracy costs.

use crate::json;
use crate::mistakes::raise;
use crate::own::{Own, raised, registry};
use crate::watch::{Quiet, Watch};
use fem::io::files::OutputDir;
use fem::io::scene::{self, Scene};
use fem::study::{self, Document, Progress, Session};
use fem::{Error, Model};
use pyo3::prelude::*;
use std::cell::RefCell;
use std::path::PathBuf;

/// What is asked of a study.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedOfStudy {
    axes: Vec<String>,
    /// Processor time, s.
    budget: Option<f64>,
    tolerance: Option<f64>,
    folder: PathBuf,
    resume: bool,
    progress: Option<Py<PyAny>>,
    own: Vec<Own>,
}

/// What a study found.
struct Studied {
    document: String,
    text: String,
    /// The scene with the cheapest setting that keeps the tolerance.
    kept_by: Option<String>,
}

/// Runs the study of the scene into the folder: its document as JSON, its text, and the text of the scene with
/// the cheapest setting that keeps the tolerance.
pub(crate) fn study(py: Python<'_>, scene: &Scene, asked: AskedOfStudy) -> PyResult<(String, String, Option<String>)> {
    let AskedOfStudy { axes, budget, tolerance, folder, resume, progress, own } = asked;
    let registry = registry(&own);
    let raised = raised(&own);
    let mut watch = Watch::new(progress.as_ref(), &raised);
    let done = py.detach(|| -> Result<Result<Studied, PyErr>, Error> {
        let model = Model::new(scene, &registry)?;
        let axes = study::axes(scene, &model, &registry, &axes)?;
        let dir = OutputDir::create(&folder)?;
        let mut session = Session::open(scene, &model, &registry, dir, resume)?;
        let watch = RefCell::new(&mut watch);
        let mut tell = |told: Progress<'_>| {
            if let Progress::Runs { share, .. } = told {
                // What breaks it off is heard by the next run.
                let _ = watch.borrow_mut().hear(Some(share));
            }
        };
        let mut quiet = Quiet(&watch);
        let report = study::study(&mut session, scene, &model, &axes, budget, &mut tell, &mut quiet)?;
        let _ = watch.borrow_mut().hear(Some(1.0));
        study::write_results(session.dir(), &report)?;
        let all: Vec<usize> = (0..report.asked.len()).collect();
        let cheapest = tolerance.and_then(|tolerance| report.cheapest(&all, tolerance));
        let setting = cheapest.map(|row| &row.level.setting);
        let kept_by = setting.map(|setting| scene::rewrite(&scene.source, setting)).transpose()?;
        session.dir().remove_older()?;
        let document = json(&Document::new(&report, setting, session.dir().path()));
        Ok(document.map(|document| Studied { document, text: study::text(&report), kept_by }))
    });
    match (done, watch.raised()) {
        (_, Some(raised)) => Err(raised),
        (Err(error), None) => Err(raise(&error)),
        (Ok(studied), None) => studied.map(|studied| (studied.document, studied.text, studied.kept_by)),
    }
}
