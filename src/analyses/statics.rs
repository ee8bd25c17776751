//! Displacements, stresses and margins under loads at rest.

use super::assembled::{self, Substructures};
pub use super::path::{Followed, PathState};
use super::stress::{self, Margin};
pub use super::stressed::Stressed;
use super::stressed::stressed;
use super::{path, supports};
use crate::cost::{Phase, Stopwatch};
use crate::error::Error;
use crate::model::{Model, NamedProfile, Plan};
use fem_core::assembly::{Equilibrium, EquilibriumError, FactorError, LargePlate, LawPlate, equilibrium, pattern};
use fem_core::counters::Counters;
use fem_core::dof::Dof;
use fem_core::element::ElementError;
use fem_core::energy::Energy;
use fem_core::estimate::mesh_errors;
use fem_core::field::Field as Displacements;
use fem_core::functional::Functional;
use fem_core::profile::{Choice, ProfilePoint, Resultants};
use fem_core::structure::{SolveError, Structure};
use fem_dynamics::lifting::{self, Lifting, OneSided};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Residual of the loads beyond which displacements are not a result: they are about as wrong, for rounding in K alone.
const MOST_RESIDUAL: f64 = 1e-2;

/// What a static analysis found.
#[derive(Debug, Clone)]
pub struct StaticSolution {
    /// Displacements, before elimination of constraints; one per unknown.
    pub u: Vec<f64>,
    /// Independent unknowns.
    pub unknowns: usize,
    /// How the plate is divided, if it is.
    pub substructures: Option<Substructures>,
    /// Entries of the factor of K.
    pub factor_entries: usize,
    /// The preload over the one that buckles the plate, of small displacements ([`Assembled::buckling`](assembled::Assembled::buckling)).
    pub buckling: Option<f64>,
    /// ½ uᵀ K u, J, or ½ ∫ Eᵀ C E dV.
    pub strain_energy: f64,
    /// Work lost in the plies, J, where some follow a law.
    pub dissipated: Option<f64>,
    /// ‖f − K u‖ / ‖f‖ of the independent unknowns, K u being the internal force.
    pub residual: f64,
    /// Condition number of K, or of its tangent at the end, estimated where it may be worth a word
    /// ([`notable_condition`](fem_core::assembly::SparseStructure::notable_condition)); not of a plate that comes apart.
    pub condition: Option<f64>,
    /// The path that the loads have taken, where interfaces may open.
    pub followed: Option<Followed>,
    /// Under large deflections, the Newton decrement of each iteration
    /// ([`Equilibrium::decrements`](fem_core::assembly::Equilibrium::decrements)).
    pub decrements: Option<Vec<f64>>,
    /// Error of the mesh in the energy norm, relative, where [`mesh_errors`] can say; never under large
    /// displacements or with free strains.
    pub mesh_error: Option<f64>,
    /// Share of the work of the loads that supports of nodal values cost between the nodes, where it is worth a word
    /// ([`softness`](fem_core::assembly::softness)).
    pub softness: Option<f64>,
    /// What stresses in the plane, of cure or loads, do to a plate that is computed for small displacements, if it is worth a word.
    pub stressed: Option<Stressed>,
    /// Sum of the loads along x, y, z, N.
    pub resultant: [f64; 3],
    /// Per criterion, the smallest reserve factor and where.
    pub margins: Vec<Margin>,
    /// The states along the profiles of the model.
    pub profiles: Vec<Vec<ProfilePoint>>,
    /// How σ₃₃ and the transverse shear of each were found.
    pub transverse: Vec<[Choice; 2]>,
    /// Forces and moments per length at each of them.
    pub resultants: Vec<Resultants>,
    /// Work done.
    pub counters: Counters,
    /// Time per phase.
    pub phases: Vec<Phase>,
}

/// Displacements of the independent unknowns, and how they were found.
struct Found {
    independent: Vec<f64>,
    substructures: Option<Substructures>,
    factor_entries: usize,
    buckling: Option<f64>,
    energy: Energy,
    residual: f64,
    condition: Option<f64>,
    softness: Option<f64>,
    stressed: Option<Stressed>,
    decrements: Option<Vec<f64>>,
    followed: Option<Followed>,
}

impl Found {
    /// By Newton's method, for which so many cells were `integrated`.
    fn of(found: Equilibrium, integrated: u64, counters: &mut Counters) -> Self {
        tracing::info!(iterations = found.decrements.len(), "equilibrium");
        counters.elements += integrated;
        counters.factorisations += found.decrements.len() as u64;
        counters.solves += found.solves;
        Self {
            independent: found.u,
            substructures: None,
            factor_entries: 0,
            buckling: None,
            energy: found.energy,
            residual: found.residual,
            condition: found.condition,
            softness: None,
            stressed: None,
            decrements: Some(found.decrements),
            followed: None,
        }
    }
}

/// Solves K u = f, or f(u) = f where deflections are large or plies follow laws.
///
/// # Errors
/// A scene without loads at rest, a cell that the element refuses, a structure that is not held, buckles or is too
/// ill-conditioned, a result that is not finite, a criterion whose material lacks a constant.
pub fn solve(model: &Model, threads: NonZeroUsize) -> Result<StaticSolution, Error> {
    solve_watched(model, threads, &mut |_| ControlFlow::Continue(()))
}

/// [`solve`]; `watch` hears after every step along a path of loads which share of it is done, and may end it there: what has been
/// followed is kept.
///
/// # Errors
/// As [`solve`].
pub fn solve_watched(
    model: &Model,
    threads: NonZeroUsize,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<StaticSolution, Error> {
    let Plan::Static { forces, .. } = &model.plan else { return Err(Error::NoLoads) };
    if model.effects.undecided() {
        return Err(Error::Undecided);
    }
    let mut stopwatch = Stopwatch::default();
    let mut counters = Counters::default();
    let constraints = &model.constraints;
    // u = C ũ + g, so that Cᵀ K C ũ = Cᵀ f; supports hold at zero, g = 0.
    let nodal: Vec<(usize, f64)> = forces.iter().copied().enumerate().filter(|(_, force)| *force != 0.0).collect();
    let mut f = vec![0.0; constraints.ndof()];
    Functional(constraints.restrict(&nodal)).add_to(1.0, &mut f);
    let mut resultant = [1, 2, 3].map(|n| {
        let along = |(dof, f): (usize, &f64)| if model.plate.locate(dof).2 == dof_of(n) { *f } else { 0.0 };
        forces.iter().enumerate().map(along).sum()
    });
    let nature = model.effects.nature();
    let solver = match &model.laws {
        Some(_) => lawful,
        None if nature.large => nonlinear,
        None if model.one_sided().next().is_some() => lifting,
        None => linear,
    };
    let found = match model.separation {
        Some(_) => followed(model, threads, watch, &mut counters, &mut stopwatch)?,
        None => solver(model, &f, threads, &mut counters, &mut stopwatch)?,
    };
    if let Plan::Static { path: Some(plan), .. } = &model.plan {
        // What is left of the forces of the scene at the end of the path.
        let scale = found.followed.as_ref().and_then(|path| path.states.last()).map_or(1.0, |state| state.force);
        resultant = resultant.map(|force| force * scale / plan.unit);
    }
    if !found.energy.total().is_finite() {
        return Err(Error::NotFinite("displacement"));
    }
    if !(found.residual <= MOST_RESIDUAL) {
        let mut pushing = model.one_sided().peekable();
        if pushing.peek().is_some() && pushing.all(|spring| spring.lift(&found.independent).is_some()) {
            return Err(SolveError::other(lifting::LIFTED_OFF).into());
        }
        return Err(Error::IllConditioned { residual: found.residual });
    }
    let mut u = vec![0.0; model.plate.ndof()];
    constraints.expand(&found.independent, &mut u);
    stopwatch.lap("solve");
    let margins = stress::margins(model, &u)?;
    // Stresses of a profile are those of all that the plate has been through.
    let displaced = model.effects.displaced(&model.body())?;
    let since =
        displaced.as_ref().map(|before| before.iter().zip(&u).map(|(before, u)| before + u).collect::<Vec<_>>());
    let mut field = Displacements::new(&model.plate, &model.laminates, &*model.element, since.as_ref().unwrap_or(&u));
    if nature.large {
        field = field.with_large_strains();
    }
    let sample = |named: &NamedProfile| {
        let line = &named.line;
        // Equilibrium is that of small displacements of a plate at rest before.
        let equilibrium = if nature.large || displaced.is_some() { Some(false) } else { line.equilibrium };
        let sampled = named.profile.sample(&field, line.points, equilibrium, named.pressures)?;
        Ok(((sampled.points, [sampled.normal, sampled.shear]), sampled.resultants))
    };
    let sampled: Vec<_> = model.profiles.iter().map(sample).collect::<Result<_, ElementError>>()?;
    let (sampled, resultants): (Vec<_>, _) = sampled.into_iter().unzip();
    let (profiles, transverse) = sampled.into_iter().unzip();
    stopwatch.lap("stresses");
    // The estimate sees only strains that cause stress.
    let mesh_error = if nature.large || nature.strained || model.laws.is_some() || model.separation.is_some() {
        None
    } else {
        mesh_errors(&model.plate, &*model.element, &model.constraints, &u)?
            .map(|errors| errors[0])
            .filter(|error| *error > 0.0)
    };
    stopwatch.lap("mesh error");
    let phases = stopwatch.phases().to_vec();
    Ok(StaticSolution {
        unknowns: constraints.ndof(),
        substructures: found.substructures,
        factor_entries: found.factor_entries,
        buckling: found.buckling,
        strain_energy: found.energy.stored,
        dissipated: (model.laws.is_some() || model.separation.is_some()).then_some(found.energy.dissipated),
        residual: found.residual,
        condition: found.condition,
        followed: found.followed,
        softness: found.softness,
        stressed: found.stressed,
        decrements: found.decrements,
        u,
        mesh_error,
        resultant,
        margins,
        profiles,
        transverse,
        resultants,
        counters,
        phases,
    })
}

/// Small displacements.
fn linear(
    model: &Model,
    f: &[f64],
    threads: NonZeroUsize,
    counters: &mut Counters,
    stopwatch: &mut Stopwatch,
) -> Result<Found, Error> {
    let mut assembled = assembled::structure(model, false, threads, counters)?;
    stopwatch.lap("assemble");
    let (mut f, mut own_forces, mut held) = (f.to_vec(), vec![0.0; f.len()], 0.0);
    for effect in model.effects.acting() {
        let Some((forces, energy)) = effect.forces(&model.body())? else { continue };
        f.iter_mut().zip(&forces).for_each(|(f, force)| *f += force);
        own_forces.iter_mut().zip(&forces).for_each(|(sum, force)| *sum += force);
        held += energy;
    }
    let (mut rest, own) = assembled.load(&f);
    let (mut solved, own_load) = (rest.clone(), rest.clone());
    assembled.structure.solve_shifted(0.0, &mut solved, 1)?;
    assembled.structure.add_stiffness(-1.0, &solved, &mut rest);
    // One step of iterative refinement, for a solve beside the factor.
    let mut more = rest.clone();
    assembled.structure.solve_shifted(0.0, &mut more, 1)?;
    assembled.structure.add_stiffness(-1.0, &more, &mut rest);
    solved.iter_mut().zip(&more).for_each(|(u, more)| *u += more);
    let softness = supports::soft(model, &mut assembled.structure, (&own_load, &solved));
    let mut independent = assembled.expand(solved);
    independent.iter_mut().zip(own.iter().flatten()).for_each(|(u, own)| *u += own);
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let condition = assembled.structure.notable_condition()?;
    (counters.factorisations, counters.solves) = assembled.structure.work();
    let stressed = stressed(model, &mut assembled, &independent)?;
    // ½ uᵀ K u − uᵀ f₀ + ½ ∫ ε₀ C ε₀ dV with K u = f and f₀ that of free strains.
    let stored =
        held + f.iter().zip(&own_forces).zip(&independent).map(|((f, free), u)| (0.5 * f - free) * u).sum::<f64>();
    Ok(Found {
        energy: Energy { stored, dissipated: 0.0 },
        independent,
        substructures: assembled.substructures(),
        factor_entries: assembled.factor_entries,
        buckling: assembled.buckling,
        residual: norm(&rest) / norm(&f).max(f64::MIN_POSITIVE),
        condition,
        softness,
        stressed,
        decrements: None,
        followed: None,
    })
}

/// On springs that only push.
fn lifting(
    model: &Model,
    f: &[f64],
    threads: NonZeroUsize,
    counters: &mut Counters,
    stopwatch: &mut Stopwatch,
) -> Result<Found, Error> {
    let assembled = assembled::structure(model, false, threads, counters)?;
    stopwatch.lap("assemble");
    let (mut structure, factor_entries, buckling) = (assembled.structure, assembled.factor_entries, assembled.buckling);
    let softness = supports::soft_under(model, &mut structure, f);
    let springs = model.one_sided().map(|spring| OneSided { at: spring.at.clone(), stiffness: spring.stiffness });
    let mut lifting = Lifting::new(springs.collect());
    let mut independent = f.to_vec();
    structure.solve_shifted(0.0, &mut independent, 1)?;
    lifting::at_rest(&mut lifting, &mut independent, |x, columns| structure.solve_shifted(0.0, x, columns))?;
    let mut rest = f.to_vec();
    structure.add_stiffness(-1.0, &independent, &mut rest);
    lifting.add_forces(&independent, &mut rest);
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let condition = structure.notable_condition()?;
    (counters.factorisations, counters.solves) = structure.work();
    // The force is not linear in the displacements, and homogeneous of degree one.
    let stored = 0.5 * f.iter().zip(&independent).map(|(f, u)| f * u).sum::<f64>();
    Ok(Found {
        energy: Energy { stored, dissipated: 0.0 },
        independent,
        substructures: None,
        factor_entries,
        buckling,
        residual: norm(&rest) / norm(f).max(f64::MIN_POSITIVE),
        condition,
        softness,
        stressed: None,
        decrements: None,
        followed: None,
    })
}

/// Large deflections.
fn nonlinear(
    model: &Model,
    f: &[f64],
    threads: NonZeroUsize,
    counters: &mut Counters,
    stopwatch: &mut Stopwatch,
) -> Result<Found, Error> {
    let Model { plate, element, constraints, .. } = model;
    let pattern = Arc::new(pattern(plate, constraints));
    let geometric = model.effects.geometric(&model.body(), &pattern)?;
    let (symbolic, _) = model.analyse(pattern)?;
    let factor_entries = symbolic.entries();
    let mut large = LargePlate::new(plate, element.clone(), constraints).ok_or(Error::SmallOnly)?;
    geometric.iter().for_each(|geometric| large.carry(geometric));
    // A plate that is hot and has not moved is pressed in its plane more than it bears.
    let hot = match model.effects.nature().strained {
        true => Some(linear(model, f, threads, counters, stopwatch)?),
        false => None,
    };
    let told = hot.as_ref().map(|hot| hot.softness);
    let start = hot.map_or_else(|| vec![0.0; f.len()], |hot| hot.independent);
    let found = equilibrium(&mut large, symbolic, f, start, threads)?;
    let softness = match told {
        Some(softness) => softness,
        None if model.between.is_empty() => None,
        None => {
            // What is said of the supports is no reason to fail.
            let assembled = assembled::structure(model, false, threads, counters).ok();
            assembled.and_then(|mut linear| supports::soft_under(model, &mut linear.structure, f))
        }
    };
    Ok(Found { factor_entries, softness, ..Found::of(found, large.integrated(), counters) })
}

/// Interfaces that open, step by step.
fn followed(
    model: &Model,
    threads: NonZeroUsize,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    counters: &mut Counters,
    stopwatch: &mut Stopwatch,
) -> Result<Found, Error> {
    let (Some(separation), Plan::Static { path: Some(plan), .. }) = (&model.separation, &model.plan) else {
        return Err(Error::NoLoads);
    };
    let path::End { followed, u, factor_entries, last, softness } =
        path::follow(model, (plan, separation), (threads, watch), counters, stopwatch)?;
    Ok(Found {
        independent: u,
        substructures: None,
        factor_entries,
        buckling: None,
        energy: last.energy,
        residual: last.residual,
        condition: None,
        softness,
        stressed: None,
        decrements: None,
        followed: Some(followed),
    })
}

/// Plies that follow laws: all of the load at once, on a plate to which nothing has happened.
fn lawful(
    model: &Model,
    f: &[f64],
    threads: NonZeroUsize,
    counters: &mut Counters,
    stopwatch: &mut Stopwatch,
) -> Result<Found, Error> {
    let Model { plate, element, constraints, laws, .. } = model;
    let Some(laws) = laws else { return linear(model, f, threads, counters, stopwatch) };
    let mut f = f.to_vec();
    for effect in model.effects.acting() {
        let Some((forces, _)) = effect.forces(&model.body())? else { continue };
        f.iter_mut().zip(&forces).for_each(|(f, force)| *f += force);
    }
    let mut assembled = assembled::structure(model, false, threads, counters)?;
    stopwatch.lap("assemble");
    let (k, _) = assembled.structure.matrices();
    let (symbolic, _) = model.analyse(k.pattern().clone())?;
    let virgin = vec![0.0; laws.states()];
    let mut laws = LawPlate::new(plate, element.clone(), constraints, laws.clone());
    laws.share(threads);
    let found = equilibrium(&mut laws.on(k, &virgin), symbolic, &f, vec![0.0; f.len()], threads);
    let found = found.map_err(|why| match why {
        EquilibriumError::Factor(FactorError::NotPositive { .. }) | EquilibriumError::NoConvergence(_) => {
            Error::Softened(why)
        }
        other => other.into(),
    })?;
    let factor_entries = assembled.factor_entries;
    // When the factors of the tangents are gone.
    let softness = supports::soft_under(model, &mut assembled.structure, &f);
    Ok(Found { factor_entries, softness, ..Found::of(found, laws.integrated(), counters) })
}

/// The unknown of a translation along axis `n`, counted from 1.
pub(crate) fn dof_of(n: u8) -> Dof {
    Dof::SOLID[4 * (usize::from(n) - 1)]
}
