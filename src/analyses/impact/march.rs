//! The march in time, with what is watched of it; a saved march can be continued.

mod sound;

use super::accuracy::{self, Accuracy, Before, Estimates};
use super::checkpoint::{self, Checkpoint};
use super::frames::frames;
use super::ledger::{Ledger, Look};
use super::modal::{self, ModalView};
use super::prepare::{Prepared, beside, describe_failure};
use super::squeeze::Squeeze;
use super::{Maximum, Outcome, Sizes};
use crate::analyses::delamination::Onsets;
use crate::analyses::expansion::{Expansion, Stressed};
use crate::analyses::samples::PlateStresses;
use crate::analyses::stress::{self, Watch};
use crate::cost::Stopwatch;
use crate::effect::Effect;
use crate::error::{CheckpointError, Error};
use crate::model::{Model, count_steps};
use fem_core::counters::Counters;
use fem_core::structure::Tangent;
use fem_core::time::{Integrator, State, Substeps};
use fem_dynamics::guard::Guard;
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::reduce::Reduced;
use fem_failure::scan::{self, Scan, Wanted};
use fem_io::files::{FileError, OutputDir};
use miette::Diagnostic;
use serde::{Deserialize, Serialize};
use std::rc::Rc;
use std::sync::Arc;
use tracing::info;

/// Coordinates of samples that may wait for the end of a march.
const WAITING: u64 = 1 << 22;

/// Marches a prepared model to its end; `progress` hears the share of the steps done.
///
/// # Errors
/// As [`March::start`].
pub fn march(prepared: Prepared<'_>, mut progress: impl FnMut(f64)) -> Result<Outcome, Error> {
    let mut march = March::start(prepared)?;
    while !march.done() {
        march.advance();
        progress(march.share());
    }
    Ok(march.finish())
}

/// A march in time.
///
/// One that meets what no impact can do ([`Guard`]), or an error, stops and keeps what it had ([`Outcome::stopped`]). One
/// that is saved, and resumed by another process, finds bit for bit what it would have found
/// in one piece, whenever and however often it was saved.
#[derive(Debug)]
pub struct March<'a> {
    model: &'a Model,
    system: ImpactSystem,
    effects: Vec<Box<dyn Effect>>,
    guard: Guard,
    integrator: Box<dyn Integrator>,
    sizes: Sizes,
    squeezes: Vec<Option<Squeeze>>,
    until_separation: bool,
    scan_every: u64,
    watch: Option<Watch<'a>>,
    modal: Option<ModalView>,
    expansion: Rc<Expansion<'a>>,
    /// Steps at which fields are written.
    frames: Vec<u64>,
    estimates: Estimates,
    /// Work of the preparation.
    counters: Counters,
    /// What the system had counted when `Progress::work` was.
    counted: SystemCounts,
    stopwatch: Stopwatch,
    progress: Progress,
}

/// How far a march is: with the scene, what it watches and the modes that it follows, all that a later process needs to
/// continue.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Progress {
    /// Steps done, and their length, s.
    step: u64,
    dt: f64,
    /// Steps between two rows of the history.
    row_every: u64,
    /// Time between two frames of the fields, s.
    frame_every: Option<f64>,
    state: State,
    ledger: Ledger,
    /// Of each effect, what it needs to go on.
    effects: Vec<Vec<f64>>,
    work: SystemCounts,
    /// Of steps that are divided by an estimate of their error.
    parts: Option<Substeps>,
    /// Of the cells of interfaces, where delaminations grow.
    onsets: Onsets,
    /// The tangent in use of a plate under large deflections.
    tangent: Option<Tangent>,
    stopped: Option<String>,
}

/// A march as it is saved.
pub(super) type Saved = (Progress, Option<modal::Record>, Option<(scan::ScanRecord, stress::Record)>);

/// Counts of the system that is marched.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct SystemCounts {
    factorisations: u64,
    solves: u64,
    contact_calls: u64,
    iterations: u64,
}

impl SystemCounts {
    fn of(system: &ImpactSystem) -> Self {
        let (factorisations, solves) = system.structure().work();
        Self { factorisations, solves, contact_calls: system.contact_calls(), iterations: system.iterations() }
    }

    fn between(self, from: Self, to: Self) -> Self {
        Self {
            factorisations: self.factorisations + to.factorisations - from.factorisations,
            solves: self.solves + to.solves - from.solves,
            contact_calls: self.contact_calls + to.contact_calls - from.contact_calls,
            iterations: self.iterations + to.iterations - from.iterations,
        }
    }
}

impl<'a> March<'a> {
    /// A march at its beginning.
    ///
    /// # Errors
    /// A criterion whose material lacks a constant, a singular mass.
    pub fn start(prepared: Prepared<'a>) -> Result<Self, Error> {
        let (model, impact) = (prepared.model, prepared.impact);
        let mut state = prepared.system.initial();
        if let Some(separation) = &model.separation {
            state.histories.points[..separation.states.len()].copy_from_slice(&separation.states);
        }
        let Sizes { steps, step: dt, .. } = prepared.sizes;
        let row_every = model.row_every(steps, dt);
        let progress = Progress {
            step: 0,
            dt,
            row_every,
            frame_every: model.output.fields.as_ref().and_then(|fields| fields.every),
            ledger: Ledger::new(
                dt,
                state.histories.contacts.len(),
                model.threshold.map(|of| [of.force_of_all, of.force]),
            ),
            effects: Vec::new(),
            state,
            work: SystemCounts::default(),
            parts: None,
            onsets: Onsets::new(model.separation.as_ref().map_or(0, |of| of.interfaces.cells().len())),
            tangent: None,
            stopped: None,
        };
        let mut march = Self::at(prepared, progress)?;
        let Self { integrator, system, progress: Progress { state, .. }, .. } = &mut march;
        integrator.start(system, state).map_err(|e| describe_failure(model, impact, e))?;
        if let Some(separation) = &model.separation {
            march.progress.onsets.take(0.0, separation, &march.progress.state.histories.points);
        }
        march.look(Look::due(0, true))?;
        march.sample()?;
        Ok(march)
    }

    /// A march that continues from `checkpoint`.
    ///
    /// # Errors
    /// A checkpoint of another step, beyond the end, or of another size than the model; as [`March::start`].
    pub fn resume(prepared: Prepared<'a>, checkpoint: Checkpoint) -> Result<Self, Error> {
        let Checkpoint { folder, saved: (progress, modal, watched) } = checkpoint;
        let Sizes { steps, step: dt, .. } = prepared.sizes;
        let differs =
            |what: String| Error::from(CheckpointError::Differs { folder: folder.clone(), differences: vec![what] });
        if progress.dt != dt {
            return Err(differs(format!(
                "its step was {:e} s and would be {dt:e} s: `march.end` must be a whole number of steps",
                progress.dt
            )));
        }
        if progress.step > steps {
            return Err(CheckpointError::Beyond { folder, at: progress.state.t }.into());
        }
        let (mut march, sizes) = (Self::at(prepared, progress)?, || differs("its sizes differ".to_owned()));
        let Self { model, system, integrator, progress, .. } = &mut march;
        if !progress.is_sound(model, system, &system.initial()) {
            return Err(sizes());
        }
        integrator.resume(system);
        if let Some(tangent) = progress.tangent.take() {
            system.linearise(tangent)?;
        }
        if progress.step < steps && progress.stopped.is_none() && !system.is_nonlinear() {
            // A step in vain makes what is made once and kept, such as factors, so that the work of the others is what it
            // would be in one piece. What it may meet, the next step meets again.
            let _ = integrator.step(system, &mut progress.state.clone(), dt);
            integrator.take_substeps();
            system.take_noted();
        }
        march.counted = SystemCounts::of(&march.system);
        let fits = match (&mut march.modal, modal) {
            (Some(view), Some(record)) => view.resume(record, march.progress.rows()),
            (view, record) => view.is_none() && record.is_none(),
        };
        let watch_fits = match (&mut march.watch, watched) {
            (Some(watch), Some((scan, record))) => watch.resume(scan, record, march.sizes.marched),
            (watch, record) => watch.is_none() && record.is_none(),
        };
        let kept = std::mem::take(&mut march.progress.effects);
        let effects_fit = kept.len() == march.effects.len()
            && march.effects.iter_mut().zip(&kept).all(|(effect, kept)| effect.resume(kept));
        if fits && watch_fits && effects_fit { Ok(march) } else { Err(sizes()) }
    }

    fn at(prepared: Prepared<'a>, progress: Progress) -> Result<Self, Error> {
        let Prepared {
            model,
            impact,
            mut system,
            effects,
            reduced,
            membrane,
            share,
            full,
            condensation,
            stresses,
            firsts_alone,
            squeezes,
            unreduced,
            ..
        } = prepared;
        let Prepared { sizes, counters, mut stopwatch, .. } = prepared;
        stopwatch.lap("reduce");
        let (membrane, companions) = membrane.unzip();
        let mut estimates = Estimates::default();
        // Here, where nothing else takes memory yet beside the full plate.
        if let (Some(reduced), Some(full)) = (&reduced, full) {
            let contacts = full.contacts.clone();
            let couple = |mut richer: Reduced| {
                effects.clone().iter_mut().for_each(|effect| effect.on_reduced(&mut richer));
                (beside((model, impact), &system, &contacts, &richer), richer.modal)
            };
            let run = Before {
                system: &system,
                reduced,
                membrane: membrane.as_ref(),
                integrator: impact.integrator.clone(),
                sizes: &sizes,
                couple: if model.effects.nature().inertia { Some(&couple) } else { None },
                mesh: accuracy::mesh::estimate(model, &system, reduced, condensation.as_deref())?,
                layers: accuracy::layers::estimate(model, reduced)?,
            };
            let solves = full.solves();
            estimates = Estimates::new(run, Some(full), solves);
            stopwatch.lap("accuracy");
        }
        let before = SystemCounts::of(&system);
        if let Some(contacts) = unreduced {
            let found = accuracy::unreduced::estimate((model, impact), &mut system, &effects, &contacts, &sizes);
            estimates = found.unwrap_or_default();
            stopwatch.lap("accuracy");
        }
        // What was counted for the estimates is no work of the run.
        let counted = SystemCounts::between(SystemCounts::default(), before, SystemCounts::of(&system));
        let followed = model.output.modes.as_ref().zip(reduced.as_deref());
        let modal = followed.and_then(|(count, r)| ModalView::new(&r.modal, &modal::load(&system), count.value));
        let expansion = Rc::new(Expansion { model, reduced, companions, share, condensation });
        let scan_every = count_steps(model.sample_every, sizes.step);
        let watch = match model.criteria.is_empty() {
            true => None,
            false => {
                let known = stresses.map_or_else(|| PlateStresses::new(model, &expansion).map(Arc::new), Ok)?;
                let wanted = if firsts_alone { Some(Wanted::Extremes) } else { wanted(model, &sizes, scan_every) };
                Some(Watch::new(model, expansion.clone(), known, wanted)?)
            }
        };
        stopwatch.lap("prepare stresses");
        let integrator = impact.integrator.clone();
        Ok(Self {
            model,
            guard: Guard::new(&mut system),
            system: system.taking_notes(),
            effects,
            integrator,
            sizes,
            squeezes,
            until_separation: impact.spec.march.until_separation,
            scan_every,
            watch,
            modal,
            expansion,
            frames: frames(model.output.fields.as_ref(), progress.frame_every, (sizes.steps, sizes.step)),
            estimates,
            counters,
            counted,
            stopwatch,
            progress,
        })
    }

    /// Whether the march has ended or stopped.
    pub fn done(&self) -> bool {
        self.progress.stopped.is_some() || self.ended()
    }

    /// Whether the march has come to its end: the last step, or the separation of all impactors where the scene asks for that.
    fn ended(&self) -> bool {
        let Progress { step, state, ledger, .. } = &self.progress;
        *step >= self.sizes.steps || (self.until_separation && ledger.separated(*step, &self.system, state))
    }

    /// Share of the steps done, of all that there may be.
    pub fn share(&self) -> f64 {
        self.progress.step as f64 / self.sizes.steps as f64
    }

    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.progress.state.t
    }

    /// Makes one step; does nothing when the march has ended.
    pub fn advance(&mut self) {
        if self.done() {
            return;
        }
        let step = self.progress.step + 1;
        let stepped = self.step();
        self.stop_on_error(step, stepped);
    }

    fn step(&mut self) -> Result<(), Error> {
        let Self { system, guard, effects, .. } = self;
        let Progress { step, dt, row_every, state, ledger, parts, onsets, .. } = &mut self.progress;
        let stepped = self.integrator.step(system, state, *dt);
        // Also of a step that fails in the end.
        ledger.parts(system.take_noted(), (*step + 1) as f64 * *dt);
        stepped?;
        if let Some(more) = self.integrator.take_substeps() {
            *parts = Some(parts.map_or(more, |parts| parts.and(more)));
        }
        *step += 1;
        // A sum of steps drifts; the product does not.
        state.t = *step as f64 * *dt;
        ledger.contacts(*step, system, guard, state)?;
        ledger.step(effects, system, state);
        if let Some(separation) = &self.model.separation {
            onsets.take(state.t, separation, &state.histories.points);
        }
        if let Some(modal) = &mut self.modal {
            modal.step(state);
        }
        let (look, scan) = (Look::due(*step, step.is_multiple_of(*row_every)), step.is_multiple_of(self.scan_every));
        self.look(look)?;
        if scan { self.sample() } else { Ok(()) }
    }

    fn look(&mut self, look: Option<Look>) -> Result<(), Error> {
        let Self { effects, system, guard, modal, progress: Progress { ledger, state, .. }, .. } = self;
        let Some(look) = look else { return Ok(()) };
        Ok(ledger.look(look, effects, system, guard, state, modal.as_mut())?)
    }

    fn sample(&mut self) -> Result<(), Error> {
        let u = self.coordinates();
        let beside = self.interface_states();
        let Some(watch) = &mut self.watch else { return Ok(()) };
        self.stopwatch.lap("march");
        let sampled = watch.sample(self.progress.state.t, &u, &self.progress.state.histories.points[beside..]);
        self.stopwatch.lap("scan");
        sampled
    }

    /// Displacements from the plate without loads, in coordinates of the march.
    fn coordinates(&self) -> Vec<f64> {
        let mut u = self.progress.state.u[..self.sizes.marched].to_vec();
        for offset in self.effects.iter().filter_map(|effect| effect.offset()) {
            u.iter_mut().zip(offset).for_each(|(u, offset)| *u += offset);
        }
        u
    }

    /// Times of all frames of the fields, s.
    pub fn frame_times(&self) -> Vec<f64> {
        self.frames.iter().map(|step| *step as f64 * self.progress.dt).collect()
    }

    /// Number of the frame, counted from 0, that the present step is; none in a march that has stopped.
    pub fn frame(&self) -> Option<usize> {
        let goes_on = self.progress.stopped.is_none();
        self.frames.binary_search(&self.progress.step).ok().filter(|_| goes_on)
    }

    /// Displacements at present, m, in the unknowns of the plate before elimination of constraints.
    pub fn displacements(&self) -> Vec<f64> {
        self.expansion.displacements(&self.coordinates(), 1)
    }

    /// What stresses follow from at present, where that is not the displacements alone.
    pub(crate) fn stressed(&self) -> Option<Stressed> {
        self.expansion.tensions().map(|_| self.expansion.stressed(&self.coordinates(), 1))
    }

    /// Largest index of every criterion and site over all samples so far.
    ///
    /// # Errors
    /// A stress or an index that is not finite.
    pub fn maxima(&self) -> Result<Vec<Maximum>, Error> {
        let Some(watch) = &self.watch else { return Ok(Vec::new()) };
        let scan = watch.so_far()?;
        Ok((0..self.model.criteria.len()).flat_map(|k| largest(&scan, k)).collect())
    }

    /// States of interfaces that may open, at present.
    pub fn interfaces(&self) -> &[f64] {
        &self.progress.state.histories.points[..self.interface_states()]
    }

    /// States of plies that follow laws, at present.
    pub fn points(&self) -> &[f64] {
        &self.progress.state.histories.points[self.interface_states()..]
    }

    /// How many states of interfaces come before those of plies.
    fn interface_states(&self) -> usize {
        self.model.separation.as_ref().map_or(0, |separation| separation.states.len())
    }

    /// Velocities of these, m/s; `None` where the plate has no inertia.
    pub fn velocities(&self) -> Option<Vec<f64>> {
        let rates = &self.progress.state.v[..self.sizes.marched];
        self.model.moves().then(|| self.expansion.velocities(&self.coordinates(), rates))
    }

    /// Does `work` between two steps, whose time is that of `phase`. A file that cannot be written fails it, any other error
    /// stops the march.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub fn beside(&mut self, phase: &'static str, work: impl FnOnce(&Self) -> Result<(), Error>) -> Result<(), Error> {
        self.stopwatch.lap("march");
        let done = work(self);
        self.stopwatch.lap(phase);
        match done {
            Err(error @ Error::File(FileError::Io { .. } | FileError::Locked { .. })) => Err(error),
            stopped => {
                self.stop_on_error(self.progress.step, stopped);
                Ok(())
            }
        }
    }

    /// Stops a march that met an error in `step`.
    fn stop_on_error(&mut self, step: u64, done: Result<(), Error>) {
        let Progress { state, stopped, .. } = &mut self.progress;
        if let Err(error) = done {
            let remedy = error.help().map_or_else(String::new, |help| format!("; {help}"));
            *stopped = Some(format!("step {step} (t = {:.6e} s): {}{remedy}", state.t, chain(&error)));
        }
    }

    /// Writes a checkpoint into `dir`, from which the march can be continued here or in another process.
    ///
    /// # Errors
    /// A folder that cannot be written, a mesh that cannot be read any more.
    pub fn save(&mut self, dir: &OutputDir) -> Result<(), Error> {
        self.stopwatch.lap("march");
        self.count();
        self.progress.tangent = self.system.tangent().cloned();
        self.progress.effects = self.effects.iter().map(|effect| effect.saved()).collect();
        let watched = self.watch.as_ref().map(Watch::record);
        let saved =
            checkpoint::write(dir, self.model, &(&self.progress, self.modal.as_ref().map(ModalView::record), watched));
        self.stopwatch.lap("checkpoint");
        saved
    }

    fn count(&mut self) {
        let now = SystemCounts::of(&self.system);
        self.progress.work = self.progress.work.between(self.counted, now);
        self.counted = now;
    }

    /// What the march found. Its end is a row of the history and a sample of the stresses.
    pub fn finish(mut self) -> Outcome {
        self.stopwatch.lap("march");
        let ended = self.ended();
        if self.progress.stopped.is_none() {
            let closed = self.close();
            self.stop_on_error(self.progress.step, closed);
        }
        let (mut events, mut peaks, mut sites) = (Vec::new(), Vec::new(), 0);
        let (mut histories, mut maxima) = (Vec::new(), Vec::new());
        if let Some(watch) = &mut self.watch {
            if let (Err(error), None) = (watch.flush(), &self.progress.stopped) {
                self.progress.stopped = Some(chain(&error));
            }
            events = watch.scan().events();
            peaks = watch.scan().peaks();
            sites = watch.sites();
            histories = watch.histories().to_vec();
            let output = &self.model.output;
            if output.maps || output.plots {
                maxima = (0..self.model.criteria.len()).flat_map(|k| largest(watch.scan(), k)).collect();
            }
            self.counters.criterion_calls = watch.scan().evaluations();
        }
        self.stopwatch.lap("scan");
        self.count();
        info!(steps = self.progress.step, work = ?self.progress.work, "march");
        let Progress { step, ledger, work, parts, stopped, onsets, state, .. } = self.progress;
        let separation = self.model.separation.as_ref();
        let beside = separation.map_or(0, |separation| separation.states.len());
        let laws = self.model.laws.as_ref().filter(|laws| laws.states() + beside == state.histories.points.len());
        let plies = laws.map_or_else(Vec::new, |laws| {
            laws.dissipated(&self.model.plate, &*self.model.element, &state.histories.points[beside..])
        });
        let delaminated = separation.map(|separation| onsets.finish(separation, &state.histories.points));
        let mut counters = self.counters;
        counters.steps = step;
        counters.contact_calls = work.contact_calls;
        counters.iterations = work.iterations;
        // A full system has counted since it was assembled, a reduced one counts nothing.
        counters.factorisations = counters.factorisations.max(work.factorisations);
        counters.solves = counters.solves.max(work.solves);
        let ended = stopped.is_none() && ended;
        let energy_error = ledger.error;
        let (mut contacts, forces, history) = ledger.records();
        for (i, contact) in contacts.iter_mut().enumerate() {
            contact.dent = self.system.dent(i, &state);
        }
        let accuracy = if ended { self.estimates.finish(&forces, contacts.first()) } else { Accuracy::default() };
        if accuracy.step.is_some() {
            self.stopwatch.lap("accuracy");
        }
        Outcome {
            accuracy,
            quantities: self.effects.iter().flat_map(|effect| effect.quantities(&self.system)).collect(),
            contacts,
            squeezes: self.squeezes,
            forces,
            delaminated,
            plies,
            modal: self.modal.map(ModalView::finish),
            history,
            events,
            peaks,
            histories,
            maxima,
            sites,
            energy_error,
            parts,
            counters,
            phases: self.stopwatch.phases().to_vec(),
            stopped,
            samples: self.watch.and_then(Watch::into_samples).map(Arc::new),
        }
    }

    /// Row and sample at the end, where they do not stand there yet.
    fn close(&mut self) -> Result<(), Error> {
        let Progress { step, row_every, .. } = self.progress;
        if !step.is_multiple_of(row_every) {
            self.look(Some(Look::ROW))?;
        }
        if step.is_multiple_of(self.scan_every) { Ok(()) } else { self.sample() }
    }
}

/// What is wanted of the stresses, where no fields ask for those of an instant and all samples may wait for the end of the march.
fn wanted(model: &Model, sizes: &Sizes, scan_every: u64) -> Option<Wanted> {
    let (output, waiting) = (&model.output, sizes.steps / scan_every.max(1) * sizes.marched as u64);
    let of_sites = if output.maps || output.plots { Wanted::EverySite } else { Wanted::Extremes };
    (output.fields.is_none() && waiting <= WAITING).then_some(of_sites)
}

/// Largest index of a criterion at each of its sites.
fn largest(scan: &Scan, criterion: usize) -> impl Iterator<Item = Maximum> {
    scan.maxima(criterion).map(move |(site, maxima, reached)| {
        let (mode, index) =
            maxima.iter().enumerate().fold((None, 0.0), |m, (k, &v)| if v > m.1 { (Some(k), v) } else { m });
        let reached = reached.iter().copied().enumerate().filter(|(_, time)| time.is_finite()).collect();
        Maximum { criterion, mode, index, reached, site: *site }
    })
}

/// An error with its causes, on one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text.push_str(": ");
        text.push_str(&cause.to_string());
        source = cause.source();
    }
    text
}
