//! Steps that end where a contact law changes its branch.

use super::copy;
use fem_core::contact::{Branches, Indentation};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit, Substeps};

/// Length of the bracket around a switch, over that of the step. The error that it leaves is of its square.
const PRECISION: f64 = 1e-9;
/// Trial steps for one switch. Every third one halves the bracket, so that they always suffice.
const MOST_TRIALS: usize = 96;
/// Switches within one step; what is left of a step after them is taken as it comes.
const MOST_SWITCHES: usize = 64;

/// `integrator`, with its steps divided where a contact begins, ends, exceeds its largest indentation or turns from
/// loading to unloading.
///
/// The histories of contacts are committed at the end of a step. A turn within it would be missed by O(Δt²) and the
/// law of an undivided step has a kink: no scheme keeps more than order 2 then. With a division at the switch each part
/// is smooth and the scheme keeps its order, as far as the law has it: αⁿ with n not whole is itself singular at α = 0,
/// which leaves an error of order n + 1 (2.5 for Hertz' law, with a factor of 2·10⁻³).
///
/// Schemes of order 1 and 2 come back as they are. They lose nothing by a kink, and an implicit step of another length
/// would need a new factorisation.
pub fn located(integrator: Box<dyn Integrator>) -> Box<dyn Integrator> {
    if integrator.order() > 2 { Box::new(Located { integrator, before: State::default() }) } else { integrator }
}

#[derive(Debug, Clone)]
struct Located {
    integrator: Box<dyn Integrator>,
    /// The state that trial steps begin with.
    before: State,
}

impl Integrator for Located {
    fn order(&self) -> u32 {
        self.integrator.order()
    }

    fn limit(&self) -> StepLimit {
        self.integrator.limit()
    }

    fn conserves_energy(&self) -> bool {
        self.integrator.conserves_energy()
    }

    fn take_substeps(&mut self) -> Option<Substeps> {
        self.integrator.take_substeps()
    }

    fn with_tolerance(&self, factor: f64) -> Option<Box<dyn Integrator>> {
        self.integrator.with_tolerance(factor).map(located)
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        self.integrator.start(sys, s)
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        self.integrator.resume(sys);
    }

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        let end = s.t + dt;
        let mut left = dt;
        for _ in 0..MOST_SWITCHES {
            copy(s, &mut self.before);
            self.integrator.step(sys, s, left)?;
            left -= self.up_to_switch(sys, s, left)?;
            if left <= 0.0 {
                break;
            }
        }
        if left > 0.0 {
            self.integrator.step(sys, s, left)?;
        }
        s.t = end;
        Ok(())
    }
}

impl Located {
    /// Takes `s`, `span` after `before`, back to just behind the first switch between them; returns its time.
    fn up_to_switch(
        &mut self,
        sys: &mut dyn SecondOrderSystem,
        s: &mut State,
        mut span: f64,
    ) -> Result<f64, StepError> {
        let mut last = None;
        for _ in 0..MOST_SWITCHES {
            match self.first(sys, s, span) {
                // Contacts that switch together are found together.
                Some(found) if last != Some(found.switch) && (last.is_none() || found.at < 1.0 - 1e-6) => {
                    span = self.locate(sys, s, span, found.switch)?;
                    last = Some(found.switch);
                }
                _ => break,
            }
        }
        Ok(span)
    }

    /// The switch that comes first on the way from `before` to `s`, by the cubics through both ends.
    fn first(&self, sys: &dyn SecondOrderSystem, s: &State, span: f64) -> Option<Found> {
        let each = |contact: usize| {
            let path = self.path(sys, contact, s, [0.0, span]);
            let kind = path.switch(sys.branches(contact, &self.before.histories.contacts[contact]))?;
            Some(Found { switch: Switch { contact, kind }, at: path.meets(kind) })
        };
        (0..s.histories.contacts.len()).filter_map(each).min_by(|a, b| a.at.total_cmp(&b.at))
    }

    fn path(&self, sys: &dyn SecondOrderSystem, contact: usize, s: &State, times: [f64; 2]) -> Path {
        Path { times, ends: [sys.indentation(contact, &self.before), sys.indentation(contact, s)] }
    }

    /// Takes `s`, which is `span` after `before` and behind `switch`, back to just behind it; returns its time.
    fn locate(
        &mut self,
        sys: &mut dyn SecondOrderSystem,
        s: &mut State,
        span: f64,
        Switch { contact, kind }: Switch,
    ) -> Result<f64, StepError> {
        let mut path = self.path(sys, contact, s, [0.0, span]);
        let precision = PRECISION * span;
        let mut tried = span;
        for trial in 0..MOST_TRIALS {
            let [low, high] = path.times;
            let root = low + path.meets(kind) * (high - low);
            if tried == high && high - low.max(root) <= precision {
                return Ok(high);
            }
            // A little behind the root, so that a good one ends the search.
            tried = if trial % 3 == 2 { 0.5 * (low + high) } else { (root + 0.5 * precision).min(high) };
            self.retry(sys, s, tried)?;
            let here = sys.indentation(contact, s);
            let end = usize::from(kind.passed(here));
            path.times[end] = tried;
            path.ends[end] = here;
        }
        let [_, high] = path.times;
        if tried != high {
            self.retry(sys, s, high)?;
        }
        Ok(high)
    }

    /// Steps from `before` by `length`.
    fn retry(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, length: f64) -> Result<(), StepError> {
        copy(&self.before, s);
        self.integrator.step(sys, s, length)
    }
}

/// A change of branch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Switch {
    contact: usize,
    kind: Kind,
}

/// A change of branch and the part of the step before it.
#[derive(Debug, Clone, Copy)]
struct Found {
    switch: Switch,
    at: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// The indentation rises above this.
    Above(f64),
    /// It falls to this.
    Down(f64),
    /// The indentation stops to rise.
    Highest,
    /// The indentation stops to fall.
    Lowest,
}

impl Kind {
    fn passed(self, Indentation { alpha, rate }: Indentation) -> bool {
        match self {
            Self::Above(level) => alpha > level,
            Self::Down(level) => alpha <= level,
            Self::Highest => rate <= 0.0,
            Self::Lowest => rate >= 0.0,
        }
    }
}

/// The indentation between two times, as the cubic that has its values and rates.
#[derive(Debug, Clone, Copy)]
struct Path {
    times: [f64; 2],
    ends: [Indentation; 2],
}

impl Path {
    /// At the part `x` of the way.
    fn at(&self, x: f64) -> Indentation {
        let length = self.times[1] - self.times[0];
        let [a, b] = self.ends;
        let (rise, from, to) = (b.alpha - a.alpha, length * a.rate, length * b.rate);
        let (second, third) = (3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise);
        Indentation {
            alpha: a.alpha + x * (from + x * (second + x * third)),
            rate: (from + x * (2.0 * second + x * 3.0 * third)) / length,
        }
    }

    /// Where `kind` is first met, as part of the way.
    fn meets(&self, kind: Kind) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if kind.passed(self.at(middle)) { high = middle } else { low = middle }
        }
        high
    }

    /// The first change of branch on the way.
    fn switch(&self, Branches { touch, peak }: Branches) -> Option<Kind> {
        let [start, end] = self.ends;
        let above = |level: f64| start.alpha > level || (start.alpha == level && start.rate > 0.0);
        // A commit leaves a contact that is loaded at its largest indentation.
        if peak.is_some_and(above) {
            return (end.rate <= 0.0).then_some(Kind::Highest);
        }
        if let Some(turn) = self.turn() {
            let there = self.at(self.meets(turn)).alpha;
            // There and back: each way is a step of its own.
            if [Some(touch), peak].into_iter().flatten().any(|c| above(c) == (end.alpha > c) && above(c) != (there > c))
            {
                return Some(turn);
            }
        }
        match peak {
            _ if !above(touch) => (end.alpha > touch).then_some(Kind::Above(touch)),
            Some(peak) if end.alpha > peak => Some(Kind::Above(peak)),
            _ => (end.alpha <= touch).then_some(Kind::Down(touch)),
        }
    }

    fn turn(&self) -> Option<Kind> {
        let [start, end] = self.ends.map(|end| end.rate);
        if start > 0.0 && end < 0.0 { Some(Kind::Highest) } else { (start < 0.0 && end > 0.0).then_some(Kind::Lowest) }
    }
}
