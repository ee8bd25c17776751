//! Many cases of one scene: what is varied, which cases that makes, what each found, and what all of them say together.
//!
//! A case is the scene with some of its keys set, as by `fem run --set`. Those that differ only in the impactor, the contact law
//! and strengths share their plate, assembled, reduced and with its stresses; their rows are those of a run of their own, to the
//! bit.

mod design;
mod distribution;
mod figures;
mod picture;
mod runner;
mod scatter;
mod sensitivity;
mod table;
mod variation;

pub use design::{Design, SweepAxis};
pub use distribution::Distribution;
pub use figures::{CaseFigures, FirstDamage, ModeFigures, StruckFigures};
pub use picture::write_pictures;
pub use runner::CaseRow;
pub use scatter::{Basis, Probability, Scatter, basis_factor, scatter};
pub use sensitivity::{Importance, importance};
pub use table::{Record, read_record, write};
pub use variation::Variation;

use crate::analyses::saved::{self, Keys};
use crate::error::Error;
use crate::job::folder;
use crate::model::Model;
use crate::registry::Registry;
use fem_io::files::OutputDir;
use fem_io::scene::{Sampling, Scene, SceneSource, Setting, Varied, Written, parse_under};
use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Name of the file in the folder of a sweep from which it goes on.
const FILE: &str = "sweep.bin";
/// The same of a part of a sweep, `k` of `n`.
const PART: &str = "part-";
/// How long rows wait before they are saved.
const SAVED_EVERY: Duration = Duration::from_secs(5);
/// How often someone who waits is heard.
const PATIENCE: Duration = Duration::from_millis(50);

/// What is asked of a sweep: words of the command line, or of the scene.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SweepRequest {
    /// Keys with what they become.
    pub set: Vec<(String, String)>,
    /// How cases are chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub design: Option<String>,
    /// How many.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples: Option<usize>,
    /// What random numbers follow from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
}

/// The cases of a scene.
#[derive(Debug)]
pub struct Sweep<'a> {
    /// Which there are.
    pub design: Design,
    registry: &'a Registry,
    source: Arc<SceneSource>,
    written: Written,
    identity: Keys,
}

impl<'a> Sweep<'a> {
    /// That of `scene`, with what is `asked` over its own.
    ///
    /// # Errors
    /// What makes no sense, a key that the scene does not take, more cases than there can be, a scene without an impact.
    pub fn new(scene: &Scene, registry: &'a Registry, asked: &SweepRequest) -> Result<Self, Error> {
        if scene.impact().is_none() {
            return Err(Error::NoImpact);
        }
        let written = Written::in_scene(scene);
        let mut axes: Vec<SweepAxis> = Vec::new();
        let own = scene.sweep.set.iter().filter(|(key, _)| asked.set.iter().all(|(other, _)| other != key));
        let own = own.map(|(key, varied)| (key, varied.clone()));
        let given = asked.set.iter().map(|(key, words)| (key, Varied::Words(words.clone())));
        for (key, varied) in own.chain(given) {
            let refuse = |message: String| Error::Sweep {
                message: format!("`{key}`: {message}"),
                help: "write a list `1 m/s,2 m/s`, a range `1..5:9`, or a distribution `normal(50 MPa, 8 %)`".into(),
            };
            if axes.iter().any(|axis| axis.key == *key) {
                return Err(refuse("is varied twice".into()));
            }
            let variation = match varied {
                Varied::Words(words) => Variation::parse(&words, written.text(key)).map_err(refuse)?,
                Varied::Levels(levels) if levels.is_empty() => return Err(refuse("it becomes nothing".into())),
                Varied::Levels(levels) => Variation::Levels(levels),
            };
            axes.push(SweepAxis { key: key.clone(), variation });
        }
        let sampling = match &asked.design {
            Some(name) => Sampling::ALL.iter().find(|(known, _)| known == name).map(|(_, sampling)| *sampling),
            None => scene.sweep.design,
        };
        let samples = asked.samples.unwrap_or(scene.sweep.samples);
        let seed = asked.seed.unwrap_or(scene.sweep.seed);
        let design = Design::new(axes, sampling, samples, seed)?;
        let mut identity = saved::identity(&Model::new(scene, registry)?)?;
        identity.retain(|key, _| !key.starts_with("sweep."));
        identity.insert(
            "the cases of the sweep".into(),
            format!("{:?} {:?} {} {}", design.axes, sampling, design.count, seed),
        );
        let sweep = Self { design, registry, source: Arc::clone(&scene.source), written, identity };
        sweep.check()?;
        Ok(sweep)
    }

    /// What case `k`, counted from 0, sets in the scene.
    pub fn setting(&self, k: usize) -> Setting {
        let values = self.design.axes.iter().zip(self.design.case(k));
        values.map(|(axis, value)| (axis.key.clone(), self.written.toml(&axis.key, &value))).collect()
    }

    /// Reads the scene at the ends of each axis, so that a key or a unit that it does not take is refused before anything is
    /// computed.
    fn check(&self) -> Result<(), Error> {
        for axis in &self.design.axes {
            // Of what scatters without bounds there are no ends: a case that meets one beyond sense fails by itself.
            let ends = if axis.variation.has_ends() { [0.0, 0.5, 1.0] } else { [0.01, 0.5, 0.99] };
            for end in ends {
                let value = self.written.toml(&axis.key, &axis.variation.at(end));
                let setting = BTreeMap::from([(axis.key.clone(), value)]);
                parse_under(self.source.text(), Path::new(self.source.name()), &setting)?;
            }
        }
        Ok(())
    }

    /// Rows that were saved in `folder` before; none where a sweep has begun there that could not save any.
    ///
    /// # Errors
    /// Nothing of a sweep, or of another one.
    pub fn saved(&self, folder: &Path) -> Result<Vec<CaseRow>, Error> {
        Ok(folder::saved(folder, saved::read(folder, FILE, &self.identity))?.unwrap_or_default())
    }

    /// Saves rows in `dir`, from which the sweep goes on.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub fn save(&self, dir: &OutputDir, rows: &[CaseRow]) -> Result<(), Error> {
        Ok(saved::write(dir, FILE, &self.identity, &rows)?)
    }

    /// The cases of part `k` of `n`, counted from 0, or all: neighbours, which share plates where the keys of plates come first.
    pub fn part(&self, part: Option<(usize, usize)>) -> Vec<usize> {
        let (k, n) = part.unwrap_or((1, 1));
        let begin = |k: usize| (self.design.count as u128 * k as u128 / n as u128) as usize;
        (begin(k - 1)..begin(k)).collect()
    }

    /// Rows of the parts in `folder`, each case once.
    ///
    /// # Errors
    /// No parts, a damaged one, one of another sweep.
    pub fn gather(&self, folder: &Path) -> Result<Vec<CaseRow>, Error> {
        let mut rows: BTreeMap<usize, CaseRow> = BTreeMap::new();
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let parts = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(PART));
        for part in parts.map(|entry| entry.path()).filter(|path| path.is_dir()) {
            rows.extend(self.saved(&part)?.into_iter().map(|row| (row.case, row)));
        }
        if rows.is_empty() {
            let message = format!("`{}` holds no parts of this sweep", folder.display());
            return Err(Error::Sweep { message, help: "run them first: `fem sweep SCENE --part 1/4`".into() });
        }
        Ok(rows.into_values().collect())
    }

    /// Runs the cases of `part` that `rows` lack, and adds theirs, sorted by case; saves them in `dir` now and then and at the end.
    /// `follow` hears how many are done and may break the sweep off.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub fn run(
        &self,
        dir: &OutputDir,
        cases: &[usize],
        threads: NonZeroUsize,
        rows: &mut Vec<CaseRow>,
        follow: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        let done: BTreeSet<usize> = rows.iter().map(|row| row.case).collect();
        let missing: Vec<usize> = cases.iter().copied().filter(|case| !done.contains(&(case + 1))).collect();
        let (mut last, mut failed) = (Instant::now(), None);
        runner::run(self, &missing, threads, &mut |row| {
            rows.extend(row);
            if last.elapsed() >= SAVED_EVERY && failed.is_none() {
                failed = self.save(dir, rows).err();
                last = Instant::now();
            }
            match failed {
                Some(_) => ControlFlow::Break(()),
                None => follow(rows.len()),
            }
        });
        rows.sort_by_key(|row| row.case);
        failed.map_or_else(|| self.save(dir, rows), Err)
    }
}

/// The folder of part `k` of `n` in that of the sweep.
pub fn part_folder(folder: &Path, (k, n): (usize, usize)) -> std::path::PathBuf {
    folder.join(format!("{PART}{k}-of-{n}"))
}
