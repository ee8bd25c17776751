//! Who follows a run from Python: Ctrl-C, the callback for its progress, errors of criteria.

use crate::criterion::Raised;
use fem::job::Follow;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Time between two looks at signals and calls of the callback.
const INTERVAL: Duration = Duration::from_millis(50);

pub(crate) struct Watch<'a> {
    /// Called with the share of the march that is done.
    progress: Option<&'a Py<PyAny>>,
    /// What criteria have raised.
    criteria: &'a [Raised],
    looked: Option<Instant>,
    raised: Option<PyErr>,
}

impl<'a> Watch<'a> {
    pub(crate) fn new(progress: Option<&'a Py<PyAny>>, criteria: &'a [Raised]) -> Self {
        Self { progress, criteria, looked: None, raised: None }
    }

    /// The exception that broke the run off.
    pub(crate) fn raised(mut self) -> Option<PyErr> {
        self.look();
        self.raised
    }

    fn look(&mut self) {
        if self.raised.is_none() {
            self.raised = self.criteria.iter().find_map(Raised::take);
        }
    }

    fn tell(&self, share: f64) -> PyResult<()> {
        Python::attach(|py| {
            py.check_signals()?;
            self.progress.map_or(Ok(()), |progress| progress.call1(py, (share,)).map(drop))
        })
    }
}

impl Follow for Watch<'_> {
    fn marched(&mut self, share: f64) -> ControlFlow<()> {
        self.look();
        if share >= 1.0 || self.looked.is_none_or(|looked| looked.elapsed() >= INTERVAL) {
            self.looked = Some(Instant::now());
            if let Err(error) = self.tell(share) {
                self.raised.get_or_insert(error);
            }
        }
        if self.raised.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
