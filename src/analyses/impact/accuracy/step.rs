//! The error of the time step, from a march with another one.

use super::companion::{Differences, Pace};

/// Power of the step with which the error falls, at most: forces have kinks where a contact begins, ends and turns.
const ORDER: f64 = 1.5;

/// Difference of two marches, of the force, from which on it no more follows the step.
const FAR: f64 = 0.2;

/// Ratio of differences at two steps, one twice the other, from which on they count as falling with the step: of order 1 they are 15 to 7.
const LEAST: f64 = 1.7;

/// The estimated error of the time step, relative.
///
/// From a march with another step Δt', twice the step Δt, four to sixteen times where twice is not cheap beside the run, or half of it
/// where twice is not stable:
///
/// ```text
/// ‖F − F'‖/‖F‖ / |(Δt'/Δt)ᵖ − 1|        p = min(order, 1.5), beyond twice the step min(order, 1)
/// ```
///
/// over those steps that both marches meet, F the force of all impactors together; the same of peak, impulse and deflection. Where
/// steps are divided until a tolerance is met, it changes by (Δt'/Δt)^order, so that parts become longer or shorter as steps do. The
/// order of the integrator
/// holds while forces are smooth, and contacts are not: against marches with a step of 0.0125 us the error of `newmark` fell
/// with the power 0.7 to 2.0 from one step to the next (three examples, steps of 0.05 to 0.4 us). Estimated over true error
/// was 0.6 to 1.7 there, 0.8 to 1.5 with `central-difference` and 1.5 to 6 with `rk4`. The peak of the force is a single value,
/// whose error passes through zero between two steps: its estimate was 0.1 to 26 times its error.
///
/// Beyond twice the step a third march with half of the second one's step shows whether differences fall with the step, at least by 1.7 and
/// below a fifth: of long steps that show nothing of a ripple any more the difference is the ripple, whatever the step of the run. They are replaced by
/// twice the step otherwise; where the marches still differ by a fifth, their difference follows no power and is the error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepAccuracy {
    /// Step of the second march, s.
    pub compared: f64,
    /// What changes with it.
    pub difference: Differences,
    /// Estimated errors.
    pub error: Differences,
}

impl StepAccuracy {
    /// From how far the run is from a march of this pace.
    pub(super) fn of(pace: &Pace, difference: Differences) -> Self {
        // Over several halvings the order of a kink is what counts.
        let most = if pace.ratio() > 2.0 { 1.0 } else { ORDER };
        let change = (pace.ratio().powf(most.min(f64::from(pace.order()))) - 1.0).abs();
        let change = if difference.force > FAR { change.min(1.0) } else { change };
        Self { compared: pace.dt, difference, error: difference.times(1.0 / change) }
    }

    /// Whether this is as much nearer to the run than `before`, with twice the step, as errors of steps are.
    pub(super) fn follows(&self, before: &Self) -> bool {
        self.difference.force <= FAR && self.difference.force * LEAST <= before.difference.force
    }
}
