//! Loads at rest that grow through what interfaces do.

use super::delamination::{Delaminated, Onsets, separable_parts};
use super::supports;
use crate::error::Error;
use crate::model::{PathPlan, Separation};
use crate::{cost::Stopwatch, model::Model};
use fem_core::assembly::{Path, PathEnd, PathError, PathPoint, Separable, pattern};
use fem_core::counters::Counters;
use fem_core::functional::Functional;
use fem_core::interfaces::Interfaces;
use fem_core::structure::SolveError;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The states of equilibrium that loads at rest have led through.
#[derive(Debug, Clone)]
pub struct Followed {
    /// In their order; dissipation never falls.
    pub states: Vec<PathState>,
    /// What has delaminated.
    pub delaminated: Delaminated,
    /// Why it ended before the loads had moved as far as they were to, if it did.
    pub stopped: Option<String>,
}

/// A state of equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathState {
    /// Force that the loads stand for, N.
    pub force: f64,
    /// Its displacement, m.
    pub displacement: f64,
    /// Energy that is stored, J.
    pub stored: f64,
    /// Energy that is dissipated, J.
    pub dissipated: f64,
    /// Work of the force, by straight lines between the states, J.
    pub work: f64,
    /// Delaminated area of all interfaces, m².
    pub delaminated: f64,
    /// Of the plate under which some interface has delaminated, m².
    pub projected: f64,
    /// Iterations that it took.
    pub iterations: usize,
}

/// What following has left beside the path.
pub(super) struct End {
    pub(super) followed: Followed,
    /// The independent displacements.
    pub(super) u: Vec<f64>,
    pub(super) factor_entries: usize,
    pub(super) last: PathPoint,
    /// What [`supports::soft_under`] says of its loads.
    pub(super) softness: Option<f64>,
}

/// Follows the loads `plan` of a `model` whose interfaces are `separation`.
///
/// # Errors
/// A plate that is not held, a first state that is not found.
pub(super) fn follow(
    model: &Model,
    (plan, separation): (&PathPlan, &Separation),
    (threads, watch): (NonZeroUsize, &mut dyn FnMut(f64) -> ControlFlow<()>),
    counters: &mut Counters,
    stopwatch: &mut Stopwatch,
) -> Result<End, Error> {
    model.analyse(Arc::new(pattern(&model.plate, &model.constraints)))?;
    let parts = separable_parts(model, separation);
    let mut states = separation.states.clone();
    states.resize(states.len() + parts.plies.as_ref().map_or(0, |plies| plies.states()), 0.0);
    let mut plate = Separable::new(parts, &states, false, threads).map_err(SolveError::from)?;
    stopwatch.lap("assemble");
    let mut load = vec![0.0; plate.ndof()];
    Functional(model.constraints.restrict(&plan.load.0)).add_to(1.0, &mut load);
    let softness = supports::soft_under(model, &mut plate, &load);
    let mut seen: Vec<PathState> = Vec::new();
    let (mut last, mut broken_off) = (None, false);
    let mut path = Path::new(&mut plate, plan.load.0.clone(), plan.step, states);
    let end = PathEnd { opening: plan.until, dissipated: f64::INFINITY, steps: plan.steps };
    let followed = path.follow(end, |point, path| {
        let interfaces = &path.plate().parts().interfaces;
        let own = &path.states()[..interfaces.states()];
        let before = seen.last().copied().unwrap_or(AT_REST);
        let moved = point.opening - before.displacement;
        seen.push(PathState {
            force: point.load,
            displacement: point.opening,
            stored: point.energy.stored,
            dissipated: point.energy.dissipated,
            work: before.work + 0.5 * (before.force + point.load) * moved,
            delaminated: interfaces.lost_area(own, Interfaces::BROKEN).into_values().sum(),
            projected: interfaces.projected_area(own, Interfaces::BROKEN),
            iterations: point.iterations,
        });
        last = Some(*point);
        let done = watch(point.opening / plan.until);
        broken_off = done.is_break();
        done
    });
    let (u, ended) = (path.u().to_vec(), path.states().to_vec());
    let last = match (last, &followed) {
        (Some(last), _) => last,
        (None, Err(PathError::Plate(error))) => return Err(SolveError::from(error.clone()).into()),
        (None, Err(error)) => return Err(SolveError::other(error.clone()).into()),
        (None, Ok(_)) => return Err(Error::NoLoads),
    };
    let stopped = match followed {
        Err(error) => Some(error.to_string()),
        Ok(true) => None,
        Ok(false) if broken_off => Some("it was broken off".to_owned()),
        Ok(false) => Some(format!("its {} steps are used up: raise `path.steps`, or `path.step`", plan.steps)),
    };
    let work = plate.work();
    counters.elements += work.cells;
    counters.factorisations += work.factorisations;
    counters.solves += work.solves;
    let cells = separation.interfaces.cells().len();
    let delaminated = Onsets::new(cells).finish(separation, &ended[..separation.interfaces.states()]);
    let (_, factor_entries) = plate.size();
    Ok(End { followed: Followed { states: seen, delaminated, stopped }, u, factor_entries, last, softness })
}

const AT_REST: PathState = PathState {
    force: 0.0,
    displacement: 0.0,
    stored: 0.0,
    dissipated: 0.0,
    work: 0.0,
    delaminated: 0.0,
    projected: 0.0,
    iterations: 0,
};
