//! Many cases of one scene: what is varied, which cases that makes, what each found, and what all of them say together.
//!
//! A case is the scene with some of its keys set, as by `fem run --set`. Those that differ only in the impactor, the contact law
//! and strengths share their plate, assembled, reduced and with its stresses; their rows are those of a run of their own, to the
//! bit.

mod alike;
mod chart;
mod copula;
mod design;
mod distribution;
mod engine;
mod figures;
mod marcher;
mod page;
mod pareto;
mod picture;
mod quantity;
mod runner;
mod scatter;
mod sensitivity;
mod table;
mod variation;

pub use design::{Design, SweepAxis};
pub use distribution::Distribution;
pub use engine::Engine;
pub use figures::{CaseFigures, FirstDamage, ModeFigures, StruckFigures};
pub use marcher::Marcher;
pub(crate) use page::CasesPage;
pub use pareto::{Objective, Objectives};
pub(crate) use picture::border;
pub use picture::write_pictures;
pub use quantity::CaseQuantity;
pub use runner::CaseRow;
pub use scatter::{Basis, Probability, Scatter, basis_factor, scatter};
pub use sensitivity::{Importance, importance};
pub use table::{QuantityRange, Record, read_record, write, write_page};
pub use variation::Variation;

use crate::analyses::assembled::expected_memory;
use crate::analyses::saved::{self, Keys};
use crate::cost;
use crate::error::Error;
use crate::job::folder;
use crate::model::{Model, leaves_plate};
use crate::registry::Registry;
use fem_io::files::OutputDir;
use fem_io::scene::{Sampling, Scene, SceneSource, Setting, Varied, Written, under};
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
/// How long rows wait before they are saved: at least so long, and so many times as long as saving them takes.
const SAVED_AFTER: Duration = Duration::from_millis(200);
const SAVED_SHARE: u32 = 20;
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
    /// Correlations of pairs of keys, `KEY,KEY=0.6`; none: those of the scene.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub correlate: Vec<String>,
    /// Formulas of what cases set and find, each `NAME = FORMULA` or the formula alone; none: those of the scene.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<String>,
    /// Two quantities that are weighed against each other, `least FORMULA, most FORMULA`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pareto: Option<String>,
}

/// The cases of a scene.
#[derive(Debug)]
pub struct Sweep<'a> {
    /// Which there are.
    pub design: Design,
    /// What is said of each besides what it found.
    pub quantities: Vec<CaseQuantity>,
    /// What is weighed against each other.
    pub objectives: Option<Objectives>,
    registry: &'a Registry,
    source: Arc<SceneSource>,
    written: Written,
    identity: Keys,
}

/// Keys by which cases would find different things.
const LOOKED_FOR: [&str; 5] = ["effects", "effects.damage", "effects.delamination", "failure", "failure.criteria"];

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
            if LOOKED_FOR.contains(&key.as_str()) {
                return Err(Error::Sweep {
                    message: format!("`{key}` says what is looked for, which is the same in all cases of a sweep"),
                    help: "make a sweep of each".into(),
                });
            }
            let variation = match varied {
                Varied::Words(words) => Variation::parse(&words, written.text(key)).map_err(refuse)?,
                Varied::Levels(levels) if levels.is_empty() => return Err(refuse("it becomes nothing".into())),
                Varied::Levels(levels) => Variation::Levels(levels),
            };
            axes.push(SweepAxis { key: key.clone(), variation });
        }
        if let Some(hidden) = written.hidden(axes.iter().map(|axis| axis.key.as_str())) {
            let message = format!("`{hidden}` varies nothing: other keys set all of its places");
            return Err(Error::Sweep { message, help: "leave it out".into() });
        }
        let sampling = match &asked.design {
            Some(name) => Sampling::ALL.iter().find(|(known, _)| known == name).map(|(_, sampling)| *sampling),
            None => scene.sweep.design,
        };
        let samples = asked.samples.unwrap_or(scene.sweep.samples);
        let seed = asked.seed.unwrap_or(scene.sweep.seed);
        let correlations = if asked.correlate.is_empty() { &scene.sweep.correlate } else { &asked.correlate };
        let design = Design::new(axes, sampling, samples, seed, correlations)?;
        let model = Model::new(scene, registry)?;
        let known = quantity::Known::new(&model, &design.axes, &written);
        let quantities = if asked.quantities.is_empty() { &scene.sweep.quantities } else { &asked.quantities };
        let quantities = known.quantities(quantities)?;
        let objectives = asked.pareto.as_ref().or(scene.sweep.pareto.as_ref());
        let objectives = objectives.map(|text| pareto::parse(text, &known)).transpose()?;
        let mut identity = saved::identity(&model)?;
        identity.retain(|key, _| !key.starts_with("sweep."));
        let axes = design.axes.iter().map(|axis| (format!("sweep of {}", axis.key), axis.variation.to_string()));
        identity.extend(axes);
        let chosen =
            Sampling::ALL.iter().find(|(_, sampling)| *sampling == design.sampling).map_or("", |(name, _)| name);
        let cases = [
            ("sweep.design", chosen.to_owned()),
            ("sweep.samples", design.count.to_string()),
            ("sweep.seed", seed.to_string()),
            ("sweep.correlate", correlations.join("; ")),
        ];
        identity.extend(cases.map(|(key, value)| (key.to_owned(), value)));
        let sweep =
            Self { design, quantities, objectives, registry, source: Arc::clone(&scene.source), written, identity };
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
                under(&self.source, &setting)?;
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

    /// The cases of part `k` of `n`, counted from 0, or all: those that share a plate are in one part, or in neighbours.
    pub fn part(&self, part: Option<(usize, usize)>) -> Vec<usize> {
        let all: Vec<usize> = (0..self.design.count).collect();
        let Some((k, n)) = part else { return all };
        let begin = |k: usize| (self.design.count as u128 * k as u128 / n as u128) as usize;
        runner::in_order(&self.design, &all)[begin(k - 1)..begin(k)].iter().map(|(.., case)| *case).collect()
    }

    /// How many cases this machine marches at a time: one on each core, as far as their plates fit its memory.
    ///
    /// # Errors
    /// A plate that takes more than there is.
    pub fn workers(&self) -> Result<NonZeroUsize, Error> {
        let cores = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
        let one_plate = self.design.axes.iter().all(|axis| leaves_plate(&axis.key));
        if one_plate || cores == NonZeroUsize::MIN {
            return Ok(cores);
        }
        let scene = under(&self.source, &BTreeMap::new())?;
        let memory = expected_memory(&Model::new(&scene, self.registry)?)?;
        let fit = memory.and_then(|plate| cost::how_many_fit(plate.bytes())).and_then(NonZeroUsize::new);
        Ok(fit.map_or(cores, |fit| fit.min(cores)))
    }

    /// Rows of the parts in `folder`, each case once; none where no part is there, or has saved any.
    ///
    /// # Errors
    /// A damaged part, one of another sweep.
    pub fn gather(&self, folder: &Path) -> Result<Vec<CaseRow>, Error> {
        let mut rows: BTreeMap<usize, CaseRow> = BTreeMap::new();
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let parts = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(PART));
        // A part that was killed at once has saved nothing.
        for part in parts.map(|entry| entry.path()).filter(|path| path.join(FILE).symlink_metadata().is_ok()) {
            rows.extend(self.saved(&part)?.into_iter().map(|row| (row.case, row)));
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
        let (mut last, mut wait, mut failed) = (Instant::now(), SAVED_AFTER, None);
        runner::run(self, &missing, threads, &mut |row| {
            rows.extend(row);
            if last.elapsed() >= wait && failed.is_none() {
                let begun = Instant::now();
                failed = self.save(dir, rows).err();
                last = Instant::now();
                wait = SAVED_AFTER.max(SAVED_SHARE * (last - begun));
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
