//! Assemble, reduce, couple to the impactors.

use super::Sizes;
use super::squeeze::{self, Squeeze};
use crate::analyses::assembled::{Assembled, Substructures, structure};
use crate::analyses::delamination::separable_parts;
use crate::analyses::kept::KeptPart;
use crate::analyses::samples::PlateStresses;
use crate::analyses::supports;
use crate::cost::Stopwatch;
use crate::effect::{Effect, Feature, Marched};
use crate::error::Error;
use crate::forecast::MemoryEstimate;
use crate::model::{Impact, Model, Plan, Separation, Strike};
use fem_core::assembly::{Condensation, Separable, SparseStructure, column_order, pattern};
use fem_core::contact::ContactLaw;
use fem_core::counters::Counters;
use fem_core::functional::Functional;
use fem_core::prolongation::Prolongation;
use fem_core::reduction::ReductionError;
use fem_core::springs::SupportSpring;
use fem_core::structure::{SolveError, Stretching, Structure};
use fem_core::time::{Integrator, StepError};
use fem_dynamics::impact::{ImpactSystem, Impactor, Tip};
use fem_dynamics::lifting::OneSided;
use fem_dynamics::limit::{self, TooLong};
use fem_dynamics::reduce::{Companions, MembranePlate, Reduced, Share, Stretch, StretchedPlate, static_responses};
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Governors offered to a reduction.
const GOVERNORS: usize = 2000;

/// An indentation, m.
const TOUCH: f64 = 1e-9;

/// A model assembled, reduced and coupled to its impactors.
#[derive(Debug)]
pub struct Prepared<'a> {
    pub(super) model: &'a Model,
    pub(super) impact: &'a Impact,
    pub(super) system: ImpactSystem,
    pub(super) effects: Vec<Box<dyn Effect>>,
    pub(super) reduced: Option<Arc<Reduced>>,
    /// A reduced plate that its deflections stretch, and what it does beside its modes.
    pub(super) membrane: Option<(MembranePlate, Companions)>,
    /// What the stretching of a full plate adds to its displacements.
    pub(super) share: Option<Arc<Share>>,
    /// What a reduced model was made from.
    pub(super) full: Option<Full>,
    /// Where each impactor strikes a linear plate that is not reduced, whose errors are to be estimated.
    pub(super) unreduced: Option<Vec<Functional>>,
    pub(super) condensation: Option<Arc<Condensation>>,
    /// What the criteria see of it, where that is known from an impact before.
    pub(super) stresses: Option<Arc<PlateStresses>>,
    /// Whether criteria judge only what can be first or largest.
    pub(super) firsts_alone: bool,
    /// What the contact laws leave to the plate.
    pub(super) squeezes: Vec<Option<Squeeze>>,
    /// Sizes and limits.
    pub sizes: Sizes,
    pub(super) counters: Counters,
    pub(super) stopwatch: Stopwatch,
}

impl Prepared<'_> {
    /// Without the plate before its reduction, so that the march estimates no errors.
    #[must_use]
    pub fn without_estimates(self) -> Self {
        Self { full: None, unreduced: None, ..self }
    }

    /// With criteria that judge only where an index can be the first to reach 1, or the largest: events and peaks are to the bit those
    /// of all places, but maps of all places cannot be made.
    #[must_use]
    pub fn firsts_alone(self) -> Self {
        Self { firsts_alone: true, ..self }
    }

    /// Another system like the one that is marched, where its plate is reduced.
    pub fn copy(&self) -> Option<ImpactSystem> {
        let plate: Box<dyn Structure> = match &self.membrane {
            Some((membrane, _)) => Box::new(membrane.clone()),
            None => Box::new(self.reduced.as_ref()?.modal.clone()),
        };
        Some(self.system.on(plate))
    }
}

/// The plate before its reduction.
#[derive(Debug)]
pub(super) struct Full {
    pub(super) structure: SparseStructure,
    /// Where each impactor strikes.
    pub(super) contacts: Vec<Functional>,
    /// Springs that only push.
    pub(super) springs: Vec<OneSided>,
    /// Right-hand sides that were solved for when the reduction was made that is kept, if it is.
    kept: u64,
}

impl Full {
    /// Right-hand sides solved for so far, those of a reduction that is kept among them: what a plate costs does not hang on who has
    /// made it.
    pub(super) fn solves(&self) -> u64 {
        self.kept + self.structure.work().1
    }
}

/// Assembles and reduces `model`, couples it to its impactors and checks the step.
///
/// # Errors
/// A scene without an impact, a cell that the element refuses, a structure that is not held, a reduction that fails, a
/// step beyond the stability limit.
pub fn prepare(model: &Model, threads: NonZeroUsize) -> Result<Prepared<'_>, Error> {
    let Plan::Impact(impact) = &model.plan else { return Err(Error::NoImpact) };
    if model.effects.undecided() || model.grown.is_some() {
        return Err(Error::Undecided);
    }
    if let Some(separation) = &model.separation {
        return prepare_separable(model, impact, separation, threads);
    }
    let ready = make_ready(model, impact, threads)?;
    let Ready { effects, plate: Marched { full, reduced, stretched, .. }, contacts, condensation, .. } = ready;
    let Ready { before, counters, stopwatch, .. } = ready;
    let reduced = reduced.map(Arc::new);
    let linear = !model.effects.nature().large && model.laws.is_none() && condensation.is_none();
    let unreduced = (reduced.is_none() && linear).then(|| contacts.clone());
    let kept = counters.solves - full.work().1;
    let of_reduced = |structure: SparseStructure| {
        Some(Full { structure, contacts: contacts.clone(), springs: springs(model, None), kept })
    };
    let (structure, full): (Box<dyn Structure>, _) = match (&reduced, &stretched) {
        (None, _) => (Box::new(full), None),
        (Some(reduced), None) => (Box::new(reduced.modal.clone()), of_reduced(full)),
        (Some(_), Some((stretched, _))) => (Box::new(stretched.clone()), of_reduced(full)),
    };
    let struck = Struck { structure, effects, reduced, membrane: stretched, condensation: condensation.map(Arc::new) };
    let prepared = strike((model, impact), struck, &contacts, before)?;
    // What a reduction leaves is asked under patches.
    let full = full.filter(|_| impact.strikes.iter().all(|strike| strike.tip.is_none()));
    Ok(Prepared { full, unreduced, counters, stopwatch, ..prepared })
}

/// A plate that waits for its impactors.
pub(super) struct Ready {
    pub(super) effects: Vec<Box<dyn Effect>>,
    pub(super) plate: Marched,
    pub(super) contacts: Vec<Functional>,
    pub(super) condensation: Option<Condensation>,
    pub(super) before: Before,
    pub(super) counters: Counters,
    pub(super) stopwatch: Stopwatch,
}

/// Assembles and reduces the plate of `model`.
pub(super) fn make_ready(model: &Model, impact: &Impact, threads: NonZeroUsize) -> Result<Ready, Error> {
    let mut stopwatch = Stopwatch::default();
    let mut counters = Counters::default();
    let mut effects = model.effects.acting().to_vec();

    let mut assembled = assemble(model, impact, threads, &mut counters)?;
    stopwatch.lap("assemble");
    let contacts: Vec<Functional> = impact.strikes.iter().map(|s| assembled.functional(&s.contact)).collect();
    let inertia = model.effects.nature().inertia;
    if !inertia && contacts.iter().any(|contact| assembled.structure.moves_under(contact)) {
        return Err(Error::Unheld { load: "the impactor", inertia });
    }
    offer_coarse(model, impact, &mut assembled);
    let kept = KeptPart::of_modes(model, impact).filter(|_| !rests(model));
    let known = kept.as_ref().and_then(|kept| kept.read_modes(&assembled.structure));
    let (known, work) = known.unzip();
    let before = assembled.structure.work();
    let basis = match &known {
        None => choose_basis(model, impact, &mut assembled, &contacts),
        Some(_) => None,
    };
    let after = assembled.structure.work();
    let mut reduced = reduce(model, impact, &mut assembled, (basis, known), &mut effects)?;
    if let (Some(kept), Some(reduced), None) = (&kept, &reduced, work) {
        kept.write_modes(reduced, (after.0 - before.0, after.1 - before.1));
    }
    if let Some(reduced) = &mut reduced {
        effects.iter_mut().for_each(|effect| effect.on_reduced(reduced));
    }
    let softness = soften(model, &mut assembled, &contacts, reduced.as_ref());
    let squeezes = squeezes(impact, &mut assembled, &contacts)?;
    let before = Before { squeezes, ..Before::of(&assembled, softness) };
    let Assembled { structure, condensation, .. } = assembled;
    let plate = Marched {
        full: structure,
        reduced,
        stretched: None,
        contacts: distinct(&contacts),
        springs: model.springs.clone(),
    };
    let plate = change_structure(model, plate, &mut effects)?;
    let own = plate.full.work();
    let (factorisations, solves) = work.unwrap_or_default();
    (counters.factorisations, counters.solves) = (factorisations.max(own.0), solves + own.1);
    stopwatch.lap("reduce");
    Ok(Ready { effects, plate, contacts, condensation, before, counters, stopwatch })
}

/// A plate as it is struck.
pub(super) struct Struck {
    pub(super) structure: Box<dyn Structure>,
    pub(super) effects: Vec<Box<dyn Effect>>,
    pub(super) reduced: Option<Arc<Reduced>>,
    pub(super) membrane: Option<(MembranePlate, Companions)>,
    pub(super) condensation: Option<Arc<Condensation>>,
}

/// Couples a plate to the impactors of `model` and checks the step.
pub(super) fn strike<'a>(
    (model, impact): (&'a Model, &'a Impact),
    plate: Struck,
    contacts: &[Functional],
    before: Before,
) -> Result<Prepared<'a>, Error> {
    let Struck { structure, mut effects, reduced, membrane, condensation } = plate;
    let of_march = reduced.as_deref();
    let (laws, squeezes) = squeeze::laws(model, impact, &before.squeezes)?;
    let impactors = place_impactors(impact, contacts, of_march, &laws);
    let system = ImpactSystem::new(structure, impactors).with_tips(tips(impact, of_march));
    let system = couple(model, system, of_march, &mut effects);
    let mut system = system.on_one_sided(springs(model, of_march).into());
    try_inertia(model, impact, &system, of_march)?;
    let sizes = check_step(model, impact, &mut system, of_march, before)?;
    Ok(Prepared {
        model,
        impact,
        system,
        effects,
        reduced,
        membrane,
        share: None,
        full: None,
        unreduced: None,
        condensation,
        stresses: None,
        firsts_alone: false,
        squeezes,
        sizes,
        counters: Counters::default(),
        stopwatch: Stopwatch::default(),
    })
}

/// The same of a plate whose interfaces may open.
fn prepare_separable<'a>(
    model: &'a Model,
    impact: &'a Impact,
    separation: &Separation,
    threads: NonZeroUsize,
) -> Result<Prepared<'a>, Error> {
    let mut stopwatch = Stopwatch::default();
    let Model { plate, constraints, .. } = model;
    let states = &separation.states;
    let pattern = Arc::new(pattern(plate, constraints));
    let stiffness_entries = pattern.entries();
    let (_, memory) = model.analyse(pattern)?;
    model.check_mass()?;
    let parts = separable_parts(model, separation);
    let mut structure = Separable::new(parts, states, true, threads).map_err(SolveError::from)?;
    let counters = Counters { elements: structure.work().cells, ..Counters::default() };
    let (_, factor_entries) = structure.size();
    stopwatch.lap("assemble");
    let contacts: Vec<Functional> = impact.strikes.iter().map(|strike| strike.contact.clone()).collect();
    let ndof = structure.ndof();
    let at_rest = |load: &mut [f64]| respond(&mut structure, states, load);
    let squeezed: Vec<Functional> = impact.strikes.iter().map(|s| s.squeeze.clone().unwrap_or_default()).collect();
    let compliances = squeeze::compliances(&squeezed, &contacts, ndof, at_rest)?;
    let (laws, squeezes) = squeeze::laws(model, impact, &compliances)?;
    let impactors = place_impactors(impact, &contacts, None, &laws);
    let tips = tips(impact, None);
    let stiffness = match contacts.first() {
        Some(contact) if separation.is_cracked() => {
            let mut x = vec![0.0; ndof];
            contact.add_to(1.0, &mut x);
            respond(&mut structure, states, &mut x)?;
            Some(1.0 / contact.of(&x))
        }
        _ => None,
    };
    let softness = contacts.first().and_then(|contact| {
        let mut load = vec![0.0; ndof];
        contact.add_to(1.0, &mut load);
        supports::soft_under(model, &mut structure, &load)
    });
    let mut effects = model.effects.acting().to_vec();
    let (struck, (_, step)) = (distinct(&contacts), impact.spec.march.steps());
    let mut stretch = None;
    for effect in &effects {
        stretch = stretch.or(effect.stretch(&model.body(), &mut structure, &struck, step)?);
    }
    stopwatch.lap("reduce");
    let share = stretch.as_ref().map(Stretch::share);
    if let Some(share) = share.clone() {
        structure.stretch(&(share as Arc<dyn Stretching>)).map_err(SolveError::from)?;
    }
    let structure: Box<dyn Structure> = match stretch {
        Some(stretch) => Box::new(StretchedPlate::new(Box::new(structure), stretch)),
        None => Box::new(structure),
    };
    let system = ImpactSystem::new(structure, impactors).with_tips(tips);
    let mut system = couple(model, system, None, &mut effects);
    let (buckling, substructures, squeezed) = (None, None, compliances);
    let before =
        Before { stiffness_entries, factor_entries, buckling, substructures, memory, softness, squeezes: squeezed };
    let sizes = check_step(model, impact, &mut system, None, before)?;
    let sizes = Sizes { static_stiffness: stiffness.unwrap_or(sizes.static_stiffness), ..sizes };
    Ok(Prepared {
        model,
        impact,
        system,
        effects,
        reduced: None,
        membrane: None,
        share,
        full: None,
        unreduced: None,
        condensation: None,
        stresses: None,
        firsts_alone: false,
        squeezes,
        sizes,
        counters,
        stopwatch,
    })
}

/// Answers a `load` with the displacements at rest, with the delaminations that are there at the start.
fn respond(structure: &mut Separable, states: &[f64], load: &mut [f64]) -> Result<(), Error> {
    structure.linearise(&vec![0.0; load.len()], states, 0.0).map_err(SolveError::from)?;
    Ok(structure.solve(load).map_err(SolveError::from)?)
}

/// The squeeze of every contact that asks for it per force at rest, m/N.
fn squeezes(impact: &Impact, assembled: &mut Assembled, contacts: &[Functional]) -> Result<Vec<Option<f64>>, Error> {
    let own = |strike: &Strike| strike.squeeze.as_ref().map_or_else(Functional::default, |w| assembled.functional(w));
    let squeezes: Vec<Functional> = impact.strikes.iter().map(own).collect();
    let structure = &mut assembled.structure;
    let ndof = structure.ndof();
    squeeze::compliances(&squeezes, contacts, ndof, |u| {
        Ok(structure.solve_shifted(0.0, u, 1).map_err(StepError::Factorisation)?)
    })
}

/// What supports of nodal values cost under the first impactor.
fn soften(model: &Model, assembled: &mut Assembled, contacts: &[Functional], reduced: Option<&Reduced>) -> Option<f64> {
    let contact = contacts.first().filter(|_| !model.between.is_empty())?;
    let structure = &mut assembled.structure;
    let mut load = vec![0.0; structure.ndof()];
    contact.add_to(1.0, &mut load);
    let Some(reduced) = reduced else { return supports::soft_under(model, structure, &load) };
    // The response to the contact is in the space.
    let mut u = load.clone();
    let modes = reduced.basis.chunks_exact(load.len()).zip(reduced.modal.compliances());
    let q: Vec<f64> = modes.map(|(mode, compliance)| compliance * contact.of(mode)).collect();
    reduced.expand(&q, &mut u);
    supports::soft(model, structure, (&load, &u))
}

/// What is known of a plate before it is marched.
#[derive(Debug, Clone)]
pub(super) struct Before {
    stiffness_entries: usize,
    factor_entries: usize,
    buckling: Option<f64>,
    substructures: Option<Substructures>,
    memory: MemoryEstimate,
    softness: Option<f64>,
    /// Of each contact, m/N.
    squeezes: Vec<Option<f64>>,
}

impl Before {
    fn of(assembled: &Assembled, softness: Option<f64>) -> Self {
        Self {
            stiffness_entries: assembled.structure.entries(),
            factor_entries: assembled.factor_entries,
            buckling: assembled.buckling,
            substructures: assembled.substructures(),
            memory: assembled.memory,
            softness,
            squeezes: Vec::new(),
        }
    }
}

/// The plate in the answers at rest to forces at `functionals` and in the columns of `basis`, of which the first answer to `forces`.
///
/// The former come first, with forces that are known: of stiff springs hardly any energy is in what the others share with them.
///
/// # Errors
/// Those of [`static_responses`] and of [`Reduced::project`].
pub(super) fn project_answers(
    structure: &mut dyn Structure,
    functionals: &[Functional],
    basis: Vec<f64>,
    forces: Vec<f64>,
) -> Result<Reduced, ReductionError> {
    let ndof = structure.ndof();
    let mut pushed = vec![0.0; functionals.len() * ndof];
    functionals.iter().zip(pushed.chunks_exact_mut(ndof.max(1))).for_each(|(at, force)| at.add_to(1.0, force));
    let mut all = match functionals {
        [] => Vec::new(),
        _ => static_responses(structure, functionals)?,
    };
    all.extend(basis);
    pushed.extend(forces);
    Reduced::project_loaded(structure, &all, &pushed)
}

/// Whether the plate is what its static responses are: linear, and without inertia.
pub(super) fn rests(model: &Model) -> bool {
    let nature = model.effects.nature();
    !nature.inertia && !nature.large
}

/// K, and M where something asks for it: without inertia the basis of a reduced plate that is stretched.
fn assemble(
    model: &Model,
    impact: &Impact,
    threads: NonZeroUsize,
    counters: &mut Counters,
) -> Result<Assembled, Error> {
    let nature = model.effects.nature();
    structure(model, nature.inertia || (nature.large && impact.reduction.is_some()), threads, counters)
}

/// Offers a plate that is reduced to modes what iterative solutions of it begin with.
fn offer_coarse(model: &Model, impact: &Impact, assembled: &mut Assembled) {
    if impact.reduction.is_some() && !rests(model) && assembled.condensation.is_none() {
        let columns = column_order(&model.plate);
        let coarse = Prolongation::linear_in_z(&model.plate, &model.constraints, &columns);
        assembled.structure.offer_coarse(coarse);
    }
}

/// T, and K T where it is known.
type Basis = (Vec<f64>, Option<Vec<f64>>);

/// The basis of the plate, if it is reduced: to a plate that rests a reduction has nothing to add.
fn choose_basis(
    model: &Model,
    impact: &Impact,
    assembled: &mut Assembled,
    contacts: &[Functional],
) -> Option<Result<Basis, ReductionError>> {
    match &impact.reduction {
        _ if rests(model) => {
            let rings = impact.strikes.iter().filter_map(|strike| strike.tip.as_ref()).flat_map(|(_, rings)| rings);
            let all: Vec<Functional> = contacts.iter().chain(rings).cloned().collect();
            let responses = static_responses(&mut assembled.structure, &distinct(&all));
            Some(responses.map(|responses| (responses, None)))
        }
        None => None,
        Some(reduction) => {
            let governors = assembled.own(model.governors(impact, GOVERNORS));
            Some(reduction.basis_and_forces(&mut assembled.structure, &distinct(contacts), &governors))
        }
    }
}

/// The plate in the coordinates of a basis and of what effects add to it; `known` is the same where it was kept.
fn reduce(
    model: &Model,
    impact: &Impact,
    assembled: &mut Assembled,
    (basis, known): (Option<Result<Basis, ReductionError>>, Option<Reduced>),
    effects: &mut [Box<dyn Effect>],
) -> Result<Option<Reduced>, Error> {
    let mut more = Vec::new();
    for effect in &mut *effects {
        more.extend(effect.vectors(&model.body(), &mut assembled.structure)?);
    }
    let Some(basis) = basis else { return Ok(known) };
    let lifting = model.lifting();
    let project = |(mut basis, forces): Basis| {
        basis.extend(more);
        project_answers(&mut assembled.structure, &lifting, basis, forces.unwrap_or_default())
    };
    let reduced = basis.and_then(project).map_err(|why| {
        let name = &impact.spec.reduction.name;
        model.origin.source.error_at(&name.place, format!("reduction `{}`: {why}", name.value), "")
    })?;
    Ok(Some(reduced))
}

/// What effects make of the plate before it is coupled.
fn change_structure(model: &Model, mut plate: Marched, effects: &mut [Box<dyn Effect>]) -> Result<Marched, Error> {
    for effect in effects {
        effect.on_structure(&model.body(), &mut plate)?;
    }
    Ok(plate)
}

/// A functional in coordinates of the march.
fn in_march(functional: &Functional, reduced: Option<&Reduced>) -> Vec<(usize, f64)> {
    match reduced {
        None => functional.0.clone(),
        Some(reduced) => reduced.restrict(functional).into_iter().enumerate().collect(),
    }
}

/// The impactors of the scene, each with the load of its contact in coordinates of the march.
fn place_impactors(
    impact: &Impact,
    contacts: &[Functional],
    reduced: Option<&Reduced>,
    laws: &[Box<dyn ContactLaw>],
) -> Vec<Impactor> {
    let each = impact.spec.impactors.iter().zip(laws).zip(contacts);
    let impactors = each.map(|((spec, law), contact)| Impactor {
        mass: spec.mass,
        velocity: spec.velocity,
        start: spec.start,
        load: in_march(contact, reduced),
        law: law.clone(),
    });
    impactors.collect()
}

/// The spherical tips of the impactors, of those that have one, in coordinates of the march.
fn tips(impact: &Impact, reduced: Option<&Reduced>) -> Vec<Option<Tip>> {
    let each = impact.strikes.iter().map(|strike| {
        let (radius, rings) = strike.tip.as_ref()?;
        Some(Tip::new(*radius, rings.iter().map(|ring| in_march(ring, reduced)).collect()))
    });
    each.collect()
}

/// Plate and impactors as effects make one system of them.
fn couple(
    model: &Model,
    system: ImpactSystem,
    reduced: Option<&Reduced>,
    effects: &mut [Box<dyn Effect>],
) -> ImpactSystem {
    effects.iter_mut().fold(system, |system, effect| effect.on_system(&model.body(), reduced, system))
}

/// The springs that only push, in coordinates of the march.
fn springs(model: &Model, reduced: Option<&Reduced>) -> Vec<OneSided> {
    let spring = |spring: &SupportSpring| OneSided {
        at: Functional(in_march(&spring.at, reduced)),
        stiffness: spring.stiffness,
    };
    model.one_sided().map(spring).collect()
}

/// The impact of `system` on a plate in the vectors of `reduced`, struck by these contacts.
pub(super) fn beside(
    (model, impact): (&Model, &Impact),
    system: &ImpactSystem,
    contacts: &[Functional],
    reduced: &Reduced,
) -> ImpactSystem {
    let laws: Vec<_> = system.impactors().iter().map(|impactor| impactor.law.clone()).collect();
    let impactors = place_impactors(impact, contacts, Some(reduced), &laws);
    let beside = ImpactSystem::new(Box::new(reduced.modal.clone()), impactors).with_tips(tips(impact, Some(reduced)));
    beside.on_one_sided(springs(model, Some(reduced)).into()).pulled_as(system)
}

/// Makes a step of a plate without inertia, to see whether the integrator can do without.
fn try_inertia(model: &Model, impact: &Impact, system: &ImpactSystem, reduced: Option<&Reduced>) -> Result<(), Error> {
    let (Some(reduced), false) = (reduced, model.effects.nature().inertia) else { return Ok(()) };
    let trial = ImpactSystem::new(Box::new(reduced.modal.clone()), system.impactors().to_vec());
    let step = impact.spec.march.step.value;
    try_step_in_contact(trial, impact.integrator.clone(), step).map_err(|e| describe_failure(model, impact, e))
}

/// Refuses a step beyond the stability limit; sizes of the march otherwise.
fn check_step(
    model: &Model,
    impact: &Impact,
    system: &mut ImpactSystem,
    reduced: Option<&Reduced>,
    before: Before,
) -> Result<Sizes, Error> {
    let march = &impact.spec.march;
    let limited = impact.integrator.limit();
    let (longest_step, highest) =
        limit::longest_step(system, limited).map_err(|e| describe_failure(model, impact, e))?;
    let hertz = |omega: f64| omega / std::f64::consts::TAU;
    if let (Some(omega_dt), Some(omega)) = (limited.product(), highest)
        && !(march.step.value <= longest_step)
    {
        let frequency = hertz(omega_dt / longest_step);
        let (step, limit, plate) = (march.step.value, longest_step, hertz(omega));
        let why = TooLong { step, limit, omega_dt, frequency, plate }.to_string();
        let help = "shorten `march.step`, reduce the model, or choose an implicit integrator such as `newmark`";
        return Err(model.origin.source.error_at(&march.step.place, why, help).into());
    }
    let (steps, step) = march.steps();
    let lowest = reduced.and_then(|r| r.modal.lowest_frequency());
    let Before { stiffness_entries, factor_entries, buckling, substructures, memory, softness, .. } = before;
    Ok(Sizes {
        unknowns: model.constraints.ndof(),
        substructures,
        marched: system.structure().ndof(),
        stiffness_entries,
        factor_entries,
        buckling,
        memory,
        static_stiffness: 1.0 / system.static_flexibility(0)?,
        softness,
        highest_frequency: highest.map(hertz),
        lowest_frequency: lowest.filter(|omega| omega.is_finite()).map(hertz),
        longest_step,
        steps,
        step,
    })
}

/// Makes a step with all impactors in contact, to see whether `integrator` needs the inverse of a mass that has none.
///
/// # Errors
/// [`StepError::SingularMass`], then; what else a step may meet is for the march to tell.
fn try_step_in_contact(
    mut system: ImpactSystem,
    mut integrator: Box<dyn Integrator>,
    dt: f64,
) -> Result<(), StepError> {
    let mut state = system.initial();
    state.u[system.structure().ndof()..].fill(TOUCH);
    integrator.resume(&mut system);
    match integrator.step(&mut system, &mut state, dt) {
        Err(error @ StepError::SingularMass(_)) => Err(error),
        _ => Ok(()),
    }
}

/// Contacts in the very same place once.
fn distinct(contacts: &[Functional]) -> Vec<Functional> {
    let mut distinct: Vec<Functional> = Vec::new();
    for contact in contacts {
        if !distinct.contains(contact) {
            distinct.push(contact.clone());
        }
    }
    distinct
}

/// The error of an integrator that cannot march `model`; one that needs M⁻¹ where M has none is shown in the scene.
pub(super) fn describe_failure(model: &Model, impact: &Impact, error: StepError) -> Error {
    let StepError::SingularMass(why) = error else { return error.into() };
    let name = &impact.spec.march.integrator.name;
    let message = format!("`{}` needs the inverse of the mass matrix, which is singular: {why}", name.value);
    let help = model.effects.way_out(Feature::ExplicitIntegrator).unwrap_or(
        "choose an implicit integrator such as `newmark`, a mass that is regular (`element.mass = \"cubic\"`), or another \
         reduction",
    );
    model.origin.source.error_at(&name.place, message, help).into()
}
