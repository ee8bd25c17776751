//! Marches beside that of the run, of reduced plates and without stresses: what they differ by is what an error does.

use super::super::{ContactRecord, Sizes, StepForces};
use fem_core::functional::Functional;
use fem_core::structure::Structure;
use fem_core::time::{Integrator, SecondOrderSystem as _, State};
use fem_dynamics::impact::{ImpactSystem, Impactor};
use fem_dynamics::lifting::OneSided;
use fem_dynamics::reduce::{MembranePlate, Modal, Reduced};

/// Entries of factors that solutions passed, for each unknown that a second march passes in a step: from here on it takes
/// less than about three hundredths of the run.
const CHEAP: u64 = 150;

/// Steps of the linear plate that take no time, however short the run is.
const NOTHING: u64 = 4096;

/// Longest step of a companion over that of the run: however little else a run has to do, it may be told so much of its errors.
const LONGEST: u64 = 16;

/// Solutions that take as long as a factorisation.
const FACTORISATION: u64 = 30;

/// Unknowns of a march that take as long as all else in a step.
const STEP: u64 = 30;

/// Evaluations of a contact law in a step, of the integrators that are most asked for.
const CALLS: u64 = 4;

/// The same of an impactor with a tip, each ring of which asks the law.
const TIP_CALLS: u64 = 128;

/// Matrices that an iteration of a plate under large deflections passes, and iterations of a step.
const FORMS: u64 = 16;
const ITERATIONS: u64 = 2;

/// Turns of the search for the springs that let go in a step or an iteration; each passes their matrix once.
const TURNS: u64 = 5;

/// States of a march that are kept, at most.
const KEPT: u64 = 64;

/// How far the results of two marches are apart, relative to the first of them: |difference|, of the force in L2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Differences {
    /// History of the force of all impactors.
    pub force: f64,
    /// Its peak.
    pub peak: f64,
    /// ∫ F dt.
    pub impulse: f64,
    /// Largest deflection under the first impactor.
    pub deflection: f64,
}

impl Differences {
    /// Each as `make` makes it of the two.
    pub fn with(self, other: Self, make: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            force: make(self.force, other.force),
            peak: make(self.peak, other.peak),
            impulse: make(self.impulse, other.impulse),
            deflection: make(self.deflection, other.deflection),
        }
    }

    /// Each times `factor`.
    pub fn times(self, factor: f64) -> Self {
        self.with(self, |a, _| a * factor)
    }

    /// Of the steps that `forces` have, one by one, and of the largest deflections.
    fn of(forces: impl Iterator<Item = (f64, f64)>, deflections: [f64; 2]) -> Option<Self> {
        let (mut difference, mut size, mut peaks, mut impulses) = (0.0, 0.0, [0.0_f64; 2], [0.0; 2]);
        for (force, other) in forces {
            difference += (force - other).powi(2);
            size += force * force;
            peaks = [peaks[0].max(force), peaks[1].max(other)];
            impulses = [impulses[0] + force, impulses[1] + other];
        }
        let relative = |[one, other]: [f64; 2]| (other / one - 1.0).abs();
        let found = Self {
            force: (difference / size).sqrt(),
            peak: relative(peaks),
            impulse: relative(impulses),
            deflection: relative(deflections),
        };
        // None of them exists without a contact at these steps.
        [found.force, found.peak, found.impulse, found.deflection].iter().all(|d| d.is_finite()).then_some(found)
    }
}

/// The plate at an instant of a march.
#[derive(Debug, Clone)]
pub(super) struct Instant {
    /// Coordinates of the reduced plate; of a damped one q + (c/k) q̇, whose stiffness gives the forces of both.
    pub(super) q: Vec<f64>,
    /// Force of each impactor, N.
    pub(super) forces: Vec<f64>,
    /// Force by which each spring that only pushes is relieved of its pull, N.
    pub(super) reliefs: Vec<f64>,
    /// Force per indentation of the stiffest contact, N/m.
    pub(super) stiffness: f64,
}

/// How a companion is marched: with twice the step of the run, or more where that is not cheap, or half of it where twice is not
/// stable.
#[derive(Debug, Clone)]
pub(super) struct Pace {
    integrator: Box<dyn Integrator>,
    /// Steps of the run from one force to the next.
    stride: u64,
    /// Steps of the companion from one force to the next.
    parts: u64,
    /// Its step, s.
    pub(super) dt: f64,
    /// Steps of the run.
    steps: u64,
    /// Whether the parts of divided steps are longer as its step is.
    proportional: bool,
    /// Steps of a linear plate without springs that one of its own takes as long as, an iteration, and a turn of the search for springs
    /// that let go.
    passes: u64,
    iteration: u64,
    turn: u64,
    /// Work that is not worth a word beside that of the run.
    budget: u64,
}

impl Pace {
    /// Beside a run of these `sizes` that took so many `solves` with the full plate, which lies on so many `springs` that only push and
    /// whose deflections stretch it or not.
    pub(super) fn new(
        integrator: Box<dyn Integrator>,
        sizes: &Sizes,
        (solves, springs): (u64, usize),
        stretched: Option<&MembranePlate>,
    ) -> Self {
        let solves = solves + FACTORISATION;
        let steps = |numbers: usize| (numbers as u64).pow(2) / (sizes.marched as u64 + STEP);
        let (iteration, turn) = (stretched.map_or(0, |plate| FORMS * steps(plate.motions())), steps(springs));
        let iterations = stretched.map_or(1, |_| ITERATIONS);
        let each = 1 + iterations * (iteration + TURNS * turn);
        let passes = |steps: u64| steps.saturating_mul(each);
        let budget = (sizes.factor_entries as u64).saturating_mul(solves) / CHEAP / (sizes.marched as u64 + STEP);
        // Iterations of contacts may be worth a step each.
        let budget = budget.max(passes(2 * sizes.steps / LONGEST)).max(NOTHING);
        let stable = |stride: &u64| *stride as f64 * sizes.step <= sizes.longest_step;
        let strides =
            || std::iter::successors(Some(2), |stride| Some(2 * stride)).take_while(|stride| *stride <= LONGEST);
        // The shortest that is cheap enough, or the longest that is stable; long steps iterate more.
        let all = |stride: &u64| passes(sizes.steps / stride * u64::from(stride.ilog2().min(2)));
        let cheap = strides().filter(stable).find(|stride| all(stride) <= budget);
        let stride = cheap.or_else(|| strides().filter(stable).last());
        let (stride, parts) = stride.map_or((1, 2), |stride| (stride, 1));
        let dt = sizes.step * stride as f64 / parts as f64;
        // Whether their length or a tolerance decides, parts of steps are longer by the same ratio.
        let ratio = stride as f64 / parts as f64;
        let other = integrator.with_tolerance(ratio.powi(integrator.order() as i32));
        let proportional = other.is_some();
        let integrator = other.unwrap_or(integrator);
        Self { integrator, stride, parts, dt, steps: sizes.steps, proportional, passes: each, iteration, turn, budget }
    }

    /// With so many steps of the run in one, whatever that takes; nothing where its step is no longer.
    pub(super) fn shorter(&self, stride: u64) -> Option<Self> {
        if self.stride <= stride {
            return None;
        }
        let share = stride as f64 / self.stride as f64;
        let integrator = self.integrator.with_tolerance(share.powi(self.integrator.order() as i32));
        let integrator = integrator.unwrap_or_else(|| self.integrator.clone());
        Some(Self { integrator, stride, dt: share * self.dt, budget: u64::MAX, ..self.clone() })
    }

    /// With half of its step, whatever that takes; nothing where it is twice that of the run already.
    pub(super) fn halved(&self) -> Option<Self> {
        self.shorter((self.stride / 2).max(2))
    }

    /// The same for what so many steps should take.
    pub(super) fn halved_as_cheap(&self) -> Option<Self> {
        let half = self.halved()?;
        Some(Self { budget: self.budget.max(self.passes.saturating_mul(half.steps / half.stride)), ..half })
    }

    /// Whether so many steps are worth it.
    pub(super) fn is_cheap(&self) -> bool {
        (self.steps / self.stride).saturating_mul(self.parts) <= self.budget
    }

    /// Its step over that of the run.
    pub(super) fn ratio(&self) -> f64 {
        self.stride as f64 / self.parts as f64
    }

    /// Order of the error in the step.
    pub(super) fn order(&self) -> u32 {
        self.integrator.order()
    }

    /// Marches `system`; nothing where that is not cheap, or fails. `see` hears of states in contact.
    pub(super) fn march(
        &self,
        system: &mut ImpactSystem,
        modal: &Modal,
        mut see: impl FnMut(Instant),
    ) -> Option<Companion> {
        let count = self.steps / self.stride;
        let calls = if system.has_tips() { TIP_CALLS } else { CALLS };
        let work = |system: &ImpactSystem| {
            let [iterations, turns] = [system.iterations(), system.lifting_turns()];
            system.contact_calls() / calls + iterations * self.iteration + turns * self.turn
        };
        let before = work(system);
        if !self.is_cheap() {
            return None;
        }
        let mut integrator = self.integrator.clone();
        let mut state = system.initial();
        integrator.start(system, &mut state).ok()?;
        let mut companion = Companion { stride: self.stride, forces: Vec::new(), deflection: 0.0, follows: true };
        for i in 0..count {
            for part in 1..=self.parts {
                integrator.step(system, &mut state, self.dt).ok()?;
                state.t = (i * self.parts + part) as f64 * self.dt;
            }
            // Stages and divided steps are not seen in the number of steps; others do not stop little beyond a march that did not.
            if work(system) - before > self.budget.saturating_mul(MORE) {
                return None;
            }
            let each: Vec<f64> = (0..system.impactors().len()).map(|k| system.contact_force(k, &state)).collect();
            let all = each.iter().sum();
            if all > 0.0 && i.is_multiple_of(count.div_ceil(KEPT)) {
                let mut q = state.u[..system.structure().ndof()].to_vec();
                let rates = modal.dampings().iter().zip(modal.stiffnesses()).zip(&state.v);
                q.iter_mut().zip(rates).for_each(|(q, ((c, k), v))| *q += c / k * v);
                let reliefs = system.reliefs(&state.u);
                see(Instant { q, forces: each, reliefs, stiffness: stiffness(system, &state) });
            }
            companion.forces.push(all);
            companion.deflection = companion.deflection.max(system.touch(0, &state).deflection);
        }
        // The error of divided steps does not follow the length of the whole ones.
        companion.follows = self.proportional || integrator.take_substeps().is_none();
        Some(companion)
    }
}

impl Pace {
    /// What changes against `base` where shares of their stiffness are taken from the modes of its plate.
    ///
    /// That of springs is part of it: K is S K S then, S² = 1 − share, and p of each spring S p, so that one that lets go is taken out whole.
    pub(super) fn soften(
        &self,
        system: &ImpactSystem,
        (reduced, membrane): (&Reduced, Option<&MembranePlate>),
        base: &Companion,
        shares: &[f64],
    ) -> Option<Differences> {
        let mut modal = reduced.modal.clone();
        modal.soften(shares);
        let plate: Box<dyn Structure> = match membrane {
            Some(membrane) => Box::new(membrane.with(modal.clone())),
            None => Box::new(modal.clone()),
        };
        let soften = |spring: &OneSided| {
            let at = spring.at.0.iter().map(|(j, p)| (*j, (1.0 - shares[*j]).sqrt() * p)).collect();
            OneSided { at: Functional(at), ..*spring }
        };
        let springs = system.one_sided().iter().map(soften).collect();
        base.against(&self.march(&mut system.on(plate).on_one_sided(springs), &modal, |_| ())?)
    }
}

/// Most work of a companion over the budget, by which its steps are chosen.
const MORE: u64 = 2;

/// Of the stiffest contact.
fn stiffness(system: &ImpactSystem, state: &State) -> f64 {
    let tangent = |(i, impactor): (usize, &Impactor)| {
        impactor.law.force(&state.histories.contacts[i], system.indentation(i, state).alpha).tangent
    };
    system.impactors().iter().enumerate().map(tangent).fold(0.0, f64::max)
}

/// What a march beside the run found.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Companion {
    /// Steps of the run from one of the forces to the next.
    stride: u64,
    /// Of all impactors together, N.
    forces: Vec<f64>,
    /// Largest deflection under the first impactor, m.
    deflection: f64,
    /// Whether its error follows its step.
    pub(super) follows: bool,
}

impl Companion {
    /// How far the run is from it.
    pub(super) fn against_run(&self, run: &StepForces, contact: &ContactRecord) -> Option<Differences> {
        let each = (1..).zip(&self.forces).map(|(number, other)| (run.after(number * self.stride as usize), *other));
        Differences::of(each, [contact.deflection, self.deflection])
    }

    /// How far another companion of the same pace is from it.
    pub(super) fn against(&self, other: &Self) -> Option<Differences> {
        Differences::of(
            self.forces.iter().copied().zip(other.forces.iter().copied()),
            [self.deflection, other.deflection],
        )
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// Forces at ten steps of 1 s.
    fn run(force: impl Fn(f64) -> f64) -> StepForces {
        let mut forces = StepForces::new(1.0);
        (1..=10).for_each(|step| forces.take(step, force(step as f64)));
        forces
    }

    fn contact(deflection: f64) -> ContactRecord {
        ContactRecord { deflection, ..ContactRecord::default() }
    }

    fn companion(stride: u64, deflection: f64, force: impl Fn(f64) -> f64) -> Companion {
        Companion {
            stride,
            forces: (1..=10 / stride).map(|i| force((i * stride) as f64)).collect(),
            deflection,
            follows: true,
        }
    }

    #[test]
    fn steps_that_the_marches_do_not_share_are_left_out() {
        let odd = run(|t| if t % 2.0 == 1.0 { 1e3 } else { t });
        let same = companion(2, 3.0, |t| t).against_run(&odd, &contact(3.0));
        assert_eq!(same, Some(Differences::default()));
        assert_eq!(companion(2, 0.0, |_| 0.0).against_run(&run(|_| 0.0), &contact(0.0)), None, "nothing touches");
    }

    #[test]
    fn differences_are_those_of_each_result() {
        let (one, other) = (companion(1, 2.0, |t| t), companion(1, 2.2, |t| 1.1 * t));
        let found = one.against(&other).unwrap();
        for difference in [found.force, found.peak, found.impulse, found.deflection] {
            assert!((difference - 0.1).abs() < 1e-12);
        }
        // A force that comes later is another force, but the same impulse.
        let late = companion(1, 2.0, |t| if t > 9.0 { 1.0 } else { t + 1.0 });
        let found = one.against(&late).unwrap();
        assert!(found.force > 0.3 && found.peak == 0.0 && found.impulse < 1e-12);
    }
}
