//! The error of the time step, from a second march.

use super::super::{Sizes, StepForces};
use fem_core::time::{Integrator, SecondOrderSystem, State};
use fem_dynamics::impact::{ImpactSystem, Impactor};
use fem_dynamics::reduce::Modal;

/// Entries of factors that solutions passed, for each unknown that the second march passes in a step: from here on it takes
/// less than about three hundredths of the run.
const CHEAP: u64 = 150;

/// Unknowns of a march that take as long as all else in a step.
const STEP: u64 = 30;

/// Evaluations of a contact law in a step, of the integrators that are most asked for.
const CALLS: u64 = 4;

/// Matrices that an iteration passes.
const FORMS: u64 = 16;

/// Power of the step with which the error falls, at most: forces have kinks where a contact begins, ends and turns.
const ORDER: f64 = 1.5;

/// States of the second march that are kept, at most.
const KEPT: u64 = 64;

/// The estimated error of the time step, relative.
///
/// From a march with another step Δt', twice the step Δt or half of it where twice is not stable:
///
/// ```text
/// ‖F − F'‖/‖F‖ / |(Δt'/Δt)ᵖ − 1|        p = min(order, 1.5)
/// ```
///
/// over those steps that both marches meet; where steps are divided until a tolerance is met, it changes by (Δt'/Δt)^order, so that
/// parts become longer or shorter as steps do. F the force of all impactors together. The order of the integrator
/// holds while forces are smooth, and contacts are not: against marches with a step of 0.0125 us the error of `newmark` fell
/// with the power 0.7 to 2.0 from one step to the next (three examples, steps of 0.05 to 0.4 us). Estimated over true error
/// was 0.6 to 1.7 there, 0.8 to 1.5 with `central-difference` and 1.5 to 6 with `rk4`. The peak of the force is a single value,
/// whose error passes through zero between two steps: its estimate was 0.1 to 26 times its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepAccuracy {
    /// Step of the second march, s.
    pub compared: f64,
    /// Difference of the contact forces of both marches.
    pub difference: f64,
    /// Estimated error of the contact force.
    pub force: f64,
    /// Estimated error of its peak.
    pub peak: f64,
}

/// The plate at an instant of the second march.
#[derive(Debug, Clone)]
pub(super) struct Instant {
    /// Coordinates of the reduced plate; of a damped one q + (c/k) q̇, whose stiffness gives the forces of both.
    pub(super) q: Vec<f64>,
    /// Force of each impactor, N.
    pub(super) forces: Vec<f64>,
    /// Force per indentation of the stiffest contact, N/m.
    pub(super) stiffness: f64,
}

/// Contact force of a second march.
#[derive(Debug)]
pub(super) struct Companion {
    /// Its step, s.
    dt: f64,
    /// What an error changes by between the marches, relative to that of the run; nothing where that is not known.
    change: Option<f64>,
    /// Steps of the run from one of the forces to the next.
    stride: u64,
    /// Of all impactors together, N.
    forces: Vec<f64>,
}

/// Marches `system`, the plate of which is `modal`, with another step than that of the run. Returns the force and states in contact, or nothing where that is
/// not cheap beside `solves` solutions with the full plate, or fails.
pub(super) fn march(
    mut system: ImpactSystem,
    modal: &Modal,
    mut integrator: Box<dyn Integrator>,
    sizes: &Sizes,
    solves: u64,
) -> Option<(Companion, Vec<Instant>)> {
    // Steps of the run, and of this march, from one force to the next.
    let (stride, parts) = if 2.0 * sizes.step <= sizes.longest_step { (2, 1) } else { (1, 2) };
    let ratio = stride as f64 / parts as f64;
    let (dt, count) = (sizes.step * ratio, sizes.steps / stride);
    // Whether their length or a tolerance decides, parts of steps are longer by the same ratio.
    let other = integrator.with_tolerance(ratio.powi(integrator.order() as i32));
    let proportional = other.is_some();
    integrator = other.unwrap_or(integrator);
    let budget = (sizes.factor_entries as u64).saturating_mul(solves) / CHEAP / (sizes.marched as u64 + STEP);
    // Each iteration of a plate under large deflections passes some matrices.
    let (unknowns, marched) = (sizes.marched as u64, sizes.marched as u64 + STEP);
    let nonlinear = |system: &ImpactSystem| system.iterations() * FORMS * unknowns * unknowns / marched;
    if count.saturating_mul(parts) > budget {
        return None;
    }
    let mut state = system.initial();
    integrator.start(&mut system, &mut state).ok()?;
    let (mut forces, mut instants) = (Vec::new(), Vec::new());
    for i in 0..count {
        for part in 1..=parts {
            integrator.step(&mut system, &mut state, dt).ok()?;
            state.t = (i * parts + part) as f64 * dt;
        }
        // Stages and divided steps are not seen in the number of steps.
        if system.contact_calls() / CALLS + nonlinear(&system) > budget {
            return None;
        }
        let each: Vec<f64> = (0..system.impactors().len()).map(|k| system.contact_force(k, &state)).collect();
        let all = each.iter().sum();
        if all > 0.0 && i.is_multiple_of(count.div_ceil(KEPT)) {
            let mut q = state.u[..sizes.marched].to_vec();
            let rates = modal.dampings().iter().zip(modal.stiffnesses()).zip(&state.v);
            q.iter_mut().zip(rates).for_each(|(q, ((c, k), v))| *q += c / k * v);
            instants.push(Instant { q, forces: each, stiffness: stiffness(&system, &state) });
        }
        forces.push(all);
    }
    // The error of divided steps does not follow the length of the whole ones.
    let divides = integrator.take_substeps().is_some();
    let change = (proportional || !divides).then(|| (ratio.powf(ORDER.min(f64::from(integrator.order()))) - 1.0).abs());
    Some((Companion { dt, change, stride, forces }, instants))
}

/// Of the stiffest contact.
fn stiffness(system: &ImpactSystem, state: &State) -> f64 {
    let tangent = |(i, impactor): (usize, &Impactor)| {
        impactor.law.force(&state.histories.contacts[i], system.indentation(i, state).alpha).tangent
    };
    system.impactors().iter().enumerate().map(tangent).fold(0.0, f64::max)
}

impl Companion {
    /// Compares with the forces of a run.
    pub(super) fn compare(&self, run: &StepForces) -> Option<StepAccuracy> {
        let change = self.change?;
        let (mut difference, mut size, mut peak, mut other_peak) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for (number, other) in (1..).zip(&self.forces) {
            let force = run.after(number * self.stride as usize);
            difference += (force - other).powi(2);
            size += force * force;
            (peak, other_peak) = (peak.max(force), other_peak.max(*other));
        }
        let difference = (difference / size).sqrt();
        let peak = (other_peak / peak - 1.0).abs() / change;
        // Neither exists without a contact at these times.
        (difference.is_finite() && peak.is_finite()).then_some(StepAccuracy {
            compared: self.dt,
            difference,
            force: difference / change,
            peak,
        })
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

    fn companion(ratio: f64, stride: u64, force: impl Fn(f64) -> f64) -> Companion {
        let change = Some((ratio.powf(ORDER) - 1.0).abs());
        let forces = (1..=10 / stride).map(|i| force((i * stride) as f64)).collect();
        Companion { dt: ratio, change, stride, forces }
    }

    #[test]
    fn an_error_of_the_order_is_found_from_either_side() {
        let exact = |t: f64| t * (12.0 - t);
        let marched = |dt: f64| move |t: f64| (1.0 + 1e-3 * dt.powf(ORDER)) * exact(t);
        for (ratio, stride) in [(2.0, 2), (0.5, 1)] {
            let found = companion(ratio, stride, marched(ratio)).compare(&run(marched(1.0)));
            let StepAccuracy { compared, force, peak, .. } = found.unwrap();
            assert!(
                compared == ratio && (force - 1e-3).abs() < 2e-6 && (peak - 1e-3).abs() < 2e-6,
                "{force:e} {peak:e}"
            );
        }
    }

    #[test]
    fn steps_that_the_marches_do_not_share_are_left_out() {
        let odd = run(|t| if t % 2.0 == 1.0 { 1e3 } else { t });
        let same = companion(2.0, 2, |t| t).compare(&odd).unwrap();
        assert_eq!((same.difference, same.force, same.peak), (0.0, 0.0, 0.0));
        assert_eq!(companion(2.0, 2, |_| 0.0).compare(&run(|_| 0.0)), None, "nothing touches");
    }
}
