//! Steps that are halved until an estimate of their error is within a tolerance.

use super::change::Change;
use super::copy;
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit, Substeps};

/// Halvings of a step at most.
const MOST: usize = 20;

/// `integrator`, with its steps halved until one step h of order p and two of half the length, which are kept, differ by at most
/// (2ᵖ − 1) `tolerance` of what changes (`Change::error`; Richardson's estimate). What a part changes of velocities and indentations is so
/// right to `tolerance`, and so is the sum, as far as errors do not grow with time: those of the phase of a vibration do, with its number of
/// periods.
///
/// Each step is tried whole first and each half of a half likewise: nothing but the state passes from step to step, so that a
/// restart changes no bit. A step takes about twice as long as its parts alone; an implicit one needs a factorisation for
/// each length, which a reduced plate has for nothing.
pub fn divided(integrator: Box<dyn Integrator>, tolerance: f64) -> Box<dyn Integrator> {
    Box::new(Divided { integrator, tolerance, levels: Vec::new(), change: Change::default(), parts: None })
}

#[derive(Debug, Clone)]
struct Divided {
    integrator: Box<dyn Integrator>,
    tolerance: f64,
    /// Those of a step, of its halves, and so on.
    levels: Vec<Level>,
    change: Change,
    parts: Option<Substeps>,
}

/// States about a part.
#[derive(Debug, Clone, Default)]
struct Level {
    start: State,
    /// After one step.
    whole: State,
    /// After half of it.
    half: State,
}

impl Integrator for Divided {
    fn order(&self) -> u32 {
        self.integrator.order()
    }

    fn limit(&self) -> StepLimit {
        self.integrator.limit()
    }

    fn radius_of_long_steps(&self) -> f64 {
        self.integrator.radius_of_long_steps()
    }

    fn conserves_energy(&self) -> bool {
        self.integrator.conserves_energy()
    }

    fn take_substeps(&mut self) -> Option<Substeps> {
        self.parts.take()
    }

    fn with_tolerance(&self, factor: f64) -> Option<Box<dyn Integrator>> {
        Some(divided(self.integrator.clone(), factor * self.tolerance))
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        self.integrator.start(sys, s)
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        self.integrator.resume(sys);
    }

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        let end = s.t + dt;
        self.advance(sys, s, dt, 0, None)?;
        s.t = end;
        Ok(())
    }
}

impl Divided {
    /// Advances `s` by `h`, a step halved `depth` times; `whole` is the state after one step, where it is known.
    fn advance(
        &mut self,
        sys: &mut dyn SecondOrderSystem,
        s: &mut State,
        h: f64,
        depth: usize,
        whole: Option<&State>,
    ) -> Result<(), StepError> {
        if self.levels.len() <= depth {
            self.levels.push(Level::default());
        }
        let mut level = std::mem::take(&mut self.levels[depth]);
        copy(s, &mut level.start);
        let tried = match whole {
            Some(whole) => {
                copy(whole, &mut level.whole);
                Ok(())
            }
            None => {
                copy(s, &mut level.whole);
                self.integrator.step(sys, &mut level.whole, h)
            }
        };
        let first = self.integrator.step(sys, s, 0.5 * h);
        copy(s, &mut level.half);
        let halves = first.clone().and_then(|()| self.integrator.step(sys, s, 0.5 * h));
        let allowed = (2.0_f64.powi(self.integrator.order() as i32) - 1.0) * self.tolerance;
        let done = match tried.and(halves) {
            Ok(()) if self.change.error(sys, &level.start, &level.whole, s) <= allowed => {
                let parts = Substeps::new(2, 0.5 * h);
                self.parts = Some(self.parts.map_or(parts, |before| before.and(parts)));
                sys.note(level.start.t, &level.half);
                sys.note(level.half.t, s);
                Ok(())
            }
            Err(why) if depth == MOST => Err(why),
            // Also where a step found no solution: a shorter one may.
            _ if depth < MOST => {
                copy(&level.start, s);
                let known = first.is_ok().then_some(&level.half);
                self.advance(sys, s, 0.5 * h, depth + 1, known)
                    .and_then(|()| self.advance(sys, s, 0.5 * h, depth + 1, None))
            }
            _ => {
                let what = format!("a part of {h:.3e} s does not meet the tolerance of {}; loosen it", self.tolerance);
                Err(StepError::NoConvergence { t: s.t, what })
            }
        };
        self.levels[depth] = level;
        done
    }
}
