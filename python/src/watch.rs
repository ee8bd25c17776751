//! Who follows a run from Python: Ctrl-C, the callback for its progress, errors of criteria.

use crate::criterion::Raised;
use fem::job::Follow;
use pyo3::prelude::*;
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Time between two looks at signals and calls of the callback.
const INTERVAL: Duration = Duration::from_millis(50);

pub(crate) struct Watch<'a> {
    /// Called with the share of the whole that is done.
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

    fn tell(&self, share: Option<f64>) -> PyResult<()> {
        Python::attach(|py| {
            py.check_signals()?;
            self.progress.zip(share).map_or(Ok(()), |(progress, share)| progress.call1(py, (share,)).map(drop))
        })
    }

    /// Looks for what ends the run, and tells the callback the share of it that is done, if that is known.
    pub(crate) fn hear(&mut self, share: Option<f64>) -> ControlFlow<()> {
        self.look();
        if share >= Some(1.0) || self.looked.is_none_or(|looked| looked.elapsed() >= INTERVAL) {
            self.looked = Some(Instant::now());
            if let Err(error) = self.tell(share) {
                self.raised.get_or_insert(error);
            }
        }
        if self.raised.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Follow for Watch<'_> {
    fn marched(&mut self, share: f64) -> ControlFlow<()> {
        self.hear(Some(share))
    }
}

/// Follows one of many runs, whose own share says nothing of the whole.
pub(crate) struct Quiet<'a, 'b>(pub(crate) &'a RefCell<&'a mut Watch<'b>>);

impl Follow for Quiet<'_, '_> {
    fn marched(&mut self, _share: f64) -> ControlFlow<()> {
        self.0.borrow_mut().hear(None)
    }
}
