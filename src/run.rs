//! The main job: assemble, reduce, march, scan.

use crate::cost::{Phase, Stopwatch};
use crate::error::Error;
use crate::model::{Impact, Model, Plan};
pub use crate::stress::IndexHistory;
use crate::stress::Watch;
use fem_core::assembly::{Matrix, SparseStructure, Symbolic, assemble, pattern};
use fem_core::counters::Counters;
use fem_core::structure::Structure;
use fem_core::time::{State, StepError, StepLimit};
use fem_dynamics::impact::{ImpactSystem, Impactor};
use fem_dynamics::limit::{self, TooLong};
use fem_dynamics::reduce::Reduced;
use fem_failure::scan::{FailureEvent, Peak, Scan, ScanSite};
use fem_io::tables::HistoryRow;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Energy error, relative to the energy of the impact, at which a run stops.
const ENERGY_TOLERANCE: f64 = 1e-2;

/// Rows of the history unless the scene says otherwise.
const HISTORY_ROWS: u64 = 2000;

/// Governors offered to a reduction.
const GOVERNORS: usize = 2000;

/// Sizes and limits of a model that is ready to march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    /// Independent unknowns of the full model.
    pub unknowns: usize,
    /// Unknowns of the march: modes of the reduced model, or those of the full one.
    pub marched: usize,
    /// Entries of one triangle of the stiffness.
    pub stiffness_entries: usize,
    /// Entries of its Cholesky factor.
    pub factor_entries: usize,
    /// Contact force per deflection under it, N/m, of the plate as marched.
    pub static_stiffness: f64,
    /// Highest frequency of the plate as marched, Hz; `None` where no integrator limit asked for it.
    pub highest_frequency: Option<f64>,
    /// Lowest frequency of the reduced plate that the impact excites, Hz.
    pub lowest_frequency: Option<f64>,
    /// Longest stable step, s; infinite for unconditionally stable integrators.
    pub longest_step: f64,
    /// Number of steps.
    pub steps: u64,
    /// The step, s: the scene's, shortened so that a whole number of steps reaches the end.
    pub step: f64,
}

/// A model assembled, reduced and coupled to its impactor.
#[derive(Debug)]
pub struct Prepared<'a> {
    model: &'a Model,
    impact: &'a Impact,
    system: ImpactSystem,
    reduced: Option<Reduced>,
    /// Sizes and limits.
    pub sizes: Sizes,
    counters: Counters,
    stopwatch: Stopwatch,
}

/// What a run found.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Mass of the impactor, kg.
    pub mass: f64,
    /// Its speed at first touch, m/s.
    pub velocity: f64,
    /// Force, motion and energies over time.
    pub history: Vec<HistoryRow>,
    /// First reaching of index 1 per criterion, mode and place, by time.
    pub events: Vec<FailureEvent>,
    /// Largest index per criterion and mode.
    pub peaks: Vec<Peak>,
    /// Indices over time at the gauges of the model.
    pub histories: Vec<IndexHistory>,
    /// Largest index per criterion and site, if the scene asks for maps.
    pub maxima: Vec<Maximum>,
    /// When the contact force first reached the threshold of the model, s.
    pub threshold_time: Option<f64>,
    /// Sites watched.
    pub sites: usize,
    /// Largest deviation of the total energy from the energy of the impact, relative to it.
    pub energy_error: f64,
    /// Number of separate contacts seen.
    pub contacts: u32,
    /// Work done.
    pub counters: Counters,
    /// Time per phase.
    pub phases: Vec<Phase>,
    /// Why the run ended before its time, if it did; everything above holds up to then.
    pub stopped: Option<String>,
}

/// The largest index of a criterion at a site over all samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Maximum {
    /// Number of the criterion in the model.
    pub criterion: usize,
    /// Its mode; `None` where no mode ever applied.
    pub mode: Option<usize>,
    /// The index.
    pub index: f64,
    /// Where.
    pub site: ScanSite,
}

/// K and M of `model`, and the number of entries of the factor of K. M is left zero where `inertia` is not wanted.
///
/// # Errors
/// A cell that the element refuses, a pattern too large to factorise.
pub fn structure(
    model: &Model,
    inertia: bool,
    threads: NonZeroUsize,
    counters: &mut Counters,
) -> Result<(SparseStructure, usize), Error> {
    let pattern = Arc::new(pattern(&model.plate, &model.constraints));
    let mut matrix =
        |which| assemble(&model.plate, &*model.element, &model.constraints, &pattern, which, threads, counters);
    let k = matrix(Matrix::Stiffness)?;
    let m = if inertia { matrix(Matrix::Mass)? } else { vec![0.0; k.len()] };
    let symbolic = Symbolic::new(pattern.clone())?;
    let entries = symbolic.entries();
    let (plate, originals) = (model.plate.clone(), model.constraints.clone());
    let name = move |column| plate.describe(originals.original(column));
    Ok((SparseStructure::new(symbolic, k, m, threads, name), entries))
}

/// Assembles and reduces `model` and checks the step.
///
/// # Errors
/// A scene without an impact, a cell that the element refuses, a structure that is not held, a reduction that fails, a
/// step beyond the stability limit.
pub fn prepare(model: &Model, threads: NonZeroUsize) -> Result<Prepared<'_>, Error> {
    let Plan::Impact(impact) = &model.plan else { return Err(Error::NoImpact) };
    let mut stopwatch = Stopwatch::default();
    let mut counters = Counters::default();
    let (mut structure, factor_entries) = structure(model, true, threads, &mut counters)?;
    stopwatch.lap("assemble");
    let (unknowns, stiffness_entries) = (structure.ndof(), structure.entries());
    let reduced = match &impact.reduction {
        None => None,
        Some(reduction) => {
            let governors = model.governors(impact, GOVERNORS);
            let contact = std::slice::from_ref(&impact.contact);
            let basis = reduction.basis(&mut structure, contact, &governors);
            Some(basis.and_then(|basis| Reduced::project(&structure, &basis)).map_err(|why| {
                let name = &impact.spec.reduction.name;
                model.scene.source.error_at(&name.place, format!("reduction `{}`: {why}", name.value), "")
            })?)
        }
    };
    (counters.factorisations, counters.solves) = structure.work();
    stopwatch.lap("reduce");

    let impactor = &impact.spec.impactor;
    let (structure, load): (Box<dyn Structure>, _) = match &reduced {
        None => (Box::new(structure), impact.contact.0.clone()),
        Some(r) => (Box::new(r.modal.clone()), r.restrict(&impact.contact).into_iter().enumerate().collect()),
    };
    let mut system = ImpactSystem::new(
        structure,
        vec![Impactor { mass: impactor.mass, velocity: impactor.velocity, load, law: impact.law.clone() }],
    );
    let march = &impact.spec.march;
    let limited = impact.integrator.limit();
    let (longest_step, highest) =
        limit::longest_step(&mut system, limited).map_err(|e| unmarchable(model, impact, e))?;
    let hertz = |omega: f64| omega / std::f64::consts::TAU;
    if let (StepLimit::OmegaDt(omega_dt), Some(omega)) = (limited, highest)
        && march.step.value > longest_step
    {
        let frequency = hertz(omega_dt / longest_step);
        let (step, limit, plate) = (march.step.value, longest_step, hertz(omega));
        let why = TooLong { step, limit, omega_dt, frequency, plate }.to_string();
        let help = "shorten `march.step`, reduce the model, or choose an implicit integrator such as `newmark`";
        return Err(model.scene.source.error_at(&march.step.place, why, help).into());
    }
    let steps = (march.end.value / march.step.value * (1.0 - 1e-12)).ceil().max(1.0) as u64;
    let sizes = Sizes {
        unknowns,
        marched: system.structure().ndof(),
        stiffness_entries,
        factor_entries,
        static_stiffness: 1.0 / system.static_flexibility(0)?,
        highest_frequency: highest.map(hertz),
        lowest_frequency: reduced.as_ref().and_then(|r| r.modal.frequencies().next()).map(hertz),
        longest_step,
        steps,
        step: march.end.value / steps as f64,
    };
    Ok(Prepared { model, impact, system, reduced, sizes, counters, stopwatch })
}

/// The error of an integrator that cannot march `model`; one that needs M⁻¹ where M has none is shown in the scene.
fn unmarchable(model: &Model, impact: &Impact, error: StepError) -> Error {
    let StepError::SingularMass(why) = error else { return error.into() };
    let name = &impact.spec.march.integrator.name;
    let message = format!("`{}` needs the inverse of the mass matrix, which is singular: {why}", name.value);
    let help = "choose an implicit integrator such as `newmark`, a mass that is regular (`element.mass = \"cubic\"`), or \
                another reduction";
    model.scene.source.error_at(&name.place, message, help).into()
}

/// Marches a prepared model to its end; `progress` hears the share of the steps done.
///
/// A march that meets a number that is not finite, or whose energy error exceeds its tolerance, stops and keeps what it
/// had ([`Outcome::stopped`]).
///
/// # Errors
/// Trouble before the first step: a criterion whose material lacks a constant, a singular mass.
pub fn march(prepared: Prepared<'_>, mut progress: impl FnMut(f64)) -> Result<Outcome, Error> {
    let Prepared { model, impact, mut system, reduced, sizes, mut counters, mut stopwatch } = prepared;
    let mut watch = match model.criteria.is_empty() {
        true => None,
        false => Some(Watch::new(model, reduced.as_ref())?),
    };
    stopwatch.lap("prepare stresses");
    let scene = &model.scene;
    let every = |interval: f64| ((interval / sizes.step).round() as u64).max(1);
    let scan_every = every(scene.failure.every);
    let row_every = scene.output.history_every.map_or(sizes.steps.div_ceil(HISTORY_ROWS), every);
    let mut integrator = impact.integrator.clone();
    let mut state = system.initial();
    integrator.start(&mut system, &mut state).map_err(|e| unmarchable(model, impact, e))?;

    let mut ledger = Ledger::new(&system, &state)?;
    let mut threshold = model.threshold.map(|threshold| Crossing::new(threshold.force));
    let n = sizes.marched;
    if let Some(watch) = &mut watch {
        watch.sample(0.0, &state.u[..n])?;
    }
    let mut stopped = None;
    for step in 1..=sizes.steps {
        let mut advance = || -> Result<(), Error> {
            integrator.step(&mut system, &mut state, sizes.step)?;
            // A sum of steps drifts; the product does not.
            state.t = step as f64 * sizes.step;
            counters.steps += 1;
            let force = system.contact_force(0, &state);
            ledger.contact(force > 0.0);
            if let Some(threshold) = &mut threshold {
                threshold.sample(state.t, force);
            }
            if step.is_multiple_of(row_every) || step == sizes.steps {
                ledger.row(&system, &state)?;
            }
            if let Some(watch) = watch.as_mut().filter(|_| step.is_multiple_of(scan_every) || step == sizes.steps) {
                stopwatch.lap("march");
                watch.sample(state.t, &state.u[..n])?;
                stopwatch.lap("scan");
            }
            Ok(())
        };
        if let Err(error) = advance() {
            stopped = Some(format!("step {step} (t = {:.6e} s): {}", state.t, chain(&error)));
            break;
        }
        if !(ledger.error <= ENERGY_TOLERANCE) {
            stopped = Some(format!(
                "step {step} (t = {:.6e} s): the energy error is {:.3e} of the impact energy, more than {ENERGY_TOLERANCE:.0e}; \
                 shorten `march.step`",
                state.t, ledger.error
            ));
            break;
        }
        if step.is_multiple_of(64) {
            progress(step as f64 / sizes.steps as f64);
        }
    }
    stopwatch.lap("march");
    let (mut events, mut peaks, mut sites) = (Vec::new(), Vec::new(), 0);
    let (mut histories, mut maxima) = (Vec::new(), Vec::new());
    if let Some(watch) = &mut watch {
        if let (Err(error), None) = (watch.flush(), &stopped) {
            stopped = Some(chain(&error));
        }
        events = watch.scan().events();
        peaks = watch.scan().peaks();
        sites = watch.sites();
        histories = watch.histories().cloned().collect();
        if scene.output.maps {
            maxima = (0..model.criteria.len()).flat_map(|criterion| largest(watch.scan(), criterion)).collect();
        }
        counters.criterion_calls = watch.scan().evaluations();
        stopwatch.lap("scan");
    }
    counters.contact_calls = system.contact_calls();
    let (factorisations, solves) = system.structure().work();
    counters.factorisations = counters.factorisations.max(factorisations);
    counters.solves = counters.solves.max(solves);
    Ok(Outcome {
        mass: impact.spec.impactor.mass,
        velocity: impact.spec.impactor.velocity,
        history: ledger.rows,
        events,
        peaks,
        histories,
        maxima,
        threshold_time: threshold.and_then(|threshold| threshold.time),
        sites,
        energy_error: ledger.error,
        contacts: ledger.contacts,
        counters,
        phases: stopwatch.phases().to_vec(),
        stopped,
    })
}

/// Largest index of a criterion at each of its sites.
fn largest(scan: &Scan, criterion: usize) -> impl Iterator<Item = Maximum> {
    scan.maxima(criterion).map(move |(site, maxima)| {
        let (mode, index) =
            maxima.iter().enumerate().fold((None, 0.0), |m, (k, &v)| if v > m.1 { (Some(k), v) } else { m });
        Maximum { criterion, mode, index, site: *site }
    })
}

/// When a force first reaches a level, by linear interpolation between its samples.
struct Crossing {
    level: f64,
    last: (f64, f64),
    time: Option<f64>,
}

impl Crossing {
    /// The force is 0 at the time 0.
    fn new(level: f64) -> Self {
        Self { level, last: (0.0, 0.0), time: None }
    }

    fn sample(&mut self, t: f64, force: f64) {
        let (before, low) = self.last;
        if self.time.is_none() && force >= self.level {
            self.time = Some(before + (t - before) * ((self.level - low) / (force - low)));
        }
        self.last = (t, force);
    }
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

/// The history as it grows, with the energy ledger.
struct Ledger {
    rows: Vec<HistoryRow>,
    initial: f64,
    error: f64,
    contacts: u32,
    touching: bool,
    work: Vec<f64>,
}

impl Ledger {
    fn new(system: &ImpactSystem, state: &State) -> Result<Self, StepError> {
        let mut work = Vec::new();
        let initial = system.energies(state, &mut work).total();
        let mut ledger = Self { rows: Vec::new(), initial, error: 0.0, contacts: 0, touching: false, work };
        ledger.row(system, state)?;
        Ok(ledger)
    }

    fn contact(&mut self, touching: bool) {
        self.contacts += u32::from(touching && !self.touching);
        self.touching = touching;
    }

    /// Writes a row of numbers that are all finite.
    fn row(&mut self, system: &ImpactSystem, state: &State) -> Result<(), StepError> {
        let e = system.energies(state, &mut self.work);
        let n = system.structure().ndof();
        let balance = e.total() - self.initial;
        let error = (balance / self.initial).abs();
        let row = HistoryRow {
            time_s: state.t,
            contact_force_n: system.contact_force(0, state),
            impactor_displacement_m: system.position(0, &state.u),
            impactor_velocity_m_s: state.v[n],
            plate_displacement_m: system.deflection(0, &state.u),
            impactor_kinetic_j: e.impactor,
            plate_kinetic_j: e.kinetic,
            plate_strain_j: e.strain,
            contact_stored_j: e.stored,
            contact_dissipated_j: e.dissipated,
            energy_balance_j: balance,
        };
        // None of the energies is negative, so that a finite sum is one of finite terms.
        let numbers = [error, row.contact_force_n, row.impactor_displacement_m, row.plate_displacement_m];
        if !numbers.iter().all(|v| v.is_finite()) {
            return Err(StepError::NotFinite { t: state.t });
        }
        self.error = self.error.max(error);
        self.rows.push(row);
        Ok(())
    }
}
