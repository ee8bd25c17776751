//! Steps that are halved where they find no solution.

use super::copy;
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit, Substeps};

/// Halvings of a step at most.
const MOST: u32 = 8;

/// `integrator`, with a step that does not converge taken back and made in two halves, each of which may be halved again: of a
/// structure that softens or closes gaps, equations of a long step may have no solution near their start.
///
/// The state is restored exactly, and nothing but it passes from step to step, so that a restart changes no bit.
pub fn cut(integrator: Box<dyn Integrator>) -> Box<dyn Integrator> {
    Box::new(Cut { integrator, starts: Vec::new(), parts: None })
}

#[derive(Debug, Clone)]
struct Cut {
    integrator: Box<dyn Integrator>,
    /// The state before a step, by how often it has been halved.
    starts: Vec<State>,
    parts: Option<Substeps>,
}

impl Integrator for Cut {
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

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        self.integrator.start(sys, s)
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        self.integrator.resume(sys);
    }

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        let end = s.t + dt;
        self.advance(sys, s, dt, 0)?;
        s.t = end;
        Ok(())
    }
}

impl Cut {
    fn advance(
        &mut self,
        sys: &mut dyn SecondOrderSystem,
        s: &mut State,
        dt: f64,
        halvings: u32,
    ) -> Result<(), StepError> {
        let depth = halvings as usize;
        if self.starts.len() <= depth {
            self.starts.push(State::default());
        }
        copy(s, &mut self.starts[depth]);
        match self.integrator.step(sys, s, dt) {
            Ok(()) => {
                let part = Substeps::new(1, dt);
                self.parts = Some(self.parts.map_or(part, |before| before.and(part)));
                Ok(())
            }
            Err(StepError::SingularMass(why)) => Err(StepError::SingularMass(why)),
            Err(why) if halvings == MOST => Err(why),
            Err(_) => {
                copy(&self.starts[depth], s);
                self.advance(sys, s, 0.5 * dt, halvings + 1)?;
                self.advance(sys, s, 0.5 * dt, halvings + 1)
            }
        }
    }
}
