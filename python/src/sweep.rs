//! Sweeps.

use crate::json;
use crate::mistakes::raise;
use crate::own::{Own, raised, registry};
use crate::watch::Watch;
use fem::Error;
use fem::io::files::OutputDir;
use fem::io::scene::Scene;
use fem::job::Follow as _;
use fem::sweep::{self, Record, Sweep, SweepRequest};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// What is asked of a sweep.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedOfSweep {
    set: Vec<(String, String)>,
    design: Option<String>,
    samples: Option<usize>,
    seed: Option<u64>,
    correlate: Vec<String>,
    quantities: Vec<String>,
    pareto: Option<String>,
    threads: NonZeroUsize,
    folder: PathBuf,
    resume: bool,
    progress: Option<Py<PyAny>>,
    own: Vec<Own>,
}

/// Runs the cases into the folder; what `sweep.json` holds.
pub(crate) fn sweep(py: Python<'_>, scene: &Scene, path: &Path, asked: AskedOfSweep) -> PyResult<String> {
    let AskedOfSweep {
        set,
        design,
        samples,
        seed,
        correlate,
        quantities,
        pareto,
        threads,
        folder,
        resume,
        progress,
        own,
    } = asked;
    let asked = SweepRequest { set, design, samples, seed, correlate, quantities, pareto };
    let registry = registry(&own);
    let raised = raised(&own);
    let mut watch = Watch::new(progress.as_ref(), &raised);
    let done = py.detach(|| -> Result<Record, Error> {
        let sweep = Sweep::new(scene, &registry, &asked)?;
        let mut rows = if resume { sweep.saved(&folder)? } else { Vec::new() };
        let dir = OutputDir::create(&folder)?;
        dir.begin_run();
        let cases = sweep.part(None);
        sweep.run(&dir, &cases, threads, &mut rows, &mut |done| watch.marched(done as f64 / cases.len() as f64))?;
        let record = Record::new(scene, path, asked, &sweep, &rows);
        sweep::write(&dir, &sweep, &rows, &record)?;
        if scene.output.plots {
            sweep::write_pictures(&dir, &scene.title, &sweep, &rows, &record)?;
        }
        dir.remove_older()?;
        Ok(record)
    });
    match (done, watch.raised()) {
        (_, Some(raised)) => Err(raised),
        (Err(error), None) => Err(raise(&error)),
        (Ok(record), None) => json(&record),
    }
}
