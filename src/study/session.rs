//! The runs of a study, kept from process to process.

use super::record::RunRecord;
use crate::analyses::saved::{self, Keys};
use crate::error::{CheckpointError, Error};
use crate::job::{Follow, folder};
use crate::model::Model;
use crate::registry::Registry;
use fem_io::files::OutputDir;
use fem_io::scene::{Scene, SceneSource, Setting};
use std::sync::Arc;

/// Name of the file in the folder of the study.
const FILE: &str = "study.bin";

/// A run, or why it failed.
type Kept = (Setting, Result<RunRecord, String>);

/// The runs of a study of one scene; each is saved as soon as it is done, none is made twice.
#[derive(Debug)]
pub struct Session<'a> {
    source: Arc<SceneSource>,
    registry: &'a Registry,
    dir: OutputDir,
    identity: Keys,
    runs: Vec<Kept>,
    /// How many of these another process has made.
    found: usize,
}

impl<'a> Session<'a> {
    /// A session on `scene`, whose model is `model`, in `dir`; with `resume` it continues one that lies there.
    ///
    /// # Errors
    /// With `resume`, no study in the folder, a damaged one or one of another scene.
    pub fn open(
        scene: &Scene,
        model: &Model,
        registry: &'a Registry,
        dir: OutputDir,
        resume: bool,
    ) -> Result<Self, CheckpointError> {
        let identity = saved::identity(model)?;
        let kept = || folder::saved(dir.path(), saved::read(dir.path(), FILE, &identity));
        let kept: Option<Vec<Kept>> = if resume { kept()? } else { None };
        dir.begin_run();
        if kept.is_some() {
            // Where all runs are there, none will write it again.
            dir.adopt(FILE)?;
        }
        let runs = kept.unwrap_or_default();
        let found = runs.len();
        Ok(Self { source: Arc::clone(&scene.source), registry, dir, identity, runs, found })
    }

    /// Number of runs that another process has left.
    pub fn found(&self) -> usize {
        self.found
    }

    /// The folder.
    pub fn dir(&self) -> &OutputDir {
        &self.dir
    }

    pub(super) fn source(&self) -> &SceneSource {
        &self.source
    }

    pub(super) fn registry(&self) -> &Registry {
        self.registry
    }

    /// Whether the run under `setting` is known.
    pub(super) fn has(&self, setting: &Setting) -> bool {
        self.runs.iter().any(|run| run.0 == *setting)
    }

    /// All that ran.
    pub(super) fn records(&self) -> impl Iterator<Item = &RunRecord> + Clone {
        self.runs.iter().filter_map(|(_, run)| run.as_ref().ok())
    }

    /// Runs the scene under `setting`, unless that is done.
    ///
    /// # Errors
    /// A folder that cannot be written, a run that `follow` broke off. What is wrong with the run itself is its result.
    pub(super) fn run(
        &mut self,
        setting: &Setting,
        follow: &mut dyn Follow,
    ) -> Result<Result<RunRecord, String>, Error> {
        if let Some((_, run)) = self.runs.iter().find(|run| run.0 == *setting) {
            return Ok(run.clone());
        }
        let run = match RunRecord::of(&self.source, setting, self.registry, follow) {
            Err(broken_off @ Error::Cancelled { .. }) => return Err(broken_off),
            run => run.map_err(|why| why.to_string()),
        };
        self.runs.push((setting.clone(), run.clone()));
        saved::write(&self.dir, FILE, &self.identity, &self.runs)?;
        Ok(run)
    }
}
