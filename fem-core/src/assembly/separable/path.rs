//! Equilibrium along a load that grows, through snaps.

use super::{Separable, SeparableError};
use crate::words::energy::Energy;
use std::fmt;
use std::ops::ControlFlow;

/// Iterations before a step is cut.
const MOST: usize = 15;

/// Residual work at which an iteration ends, relative to that of the step.
const ENOUGH: f64 = 1e-9;

/// Cuts of a step before the path counts as lost.
const MOST_CUTS: usize = 30;

/// Share of the energy step at which the control changes from opening to dissipation.
const BEGUN: f64 = 0.05;

/// Of an opening or a dissipation that is given.
const ROUNDING: f64 = 1e-9;

/// Largest deviation of the dissipated energy from what was asked, relative.
const OFF: f64 = 0.5;

/// A state of equilibrium along a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Factor on the load.
    pub load: f64,
    /// Work of the load of factor 1 at these displacements, J.
    pub opening: f64,
    /// Work done on the plate, J.
    pub energy: Energy,
    /// What of it was dissipated by friction, J.
    pub friction: f64,
    /// Forces that are left over, relative to the load, in the unknowns of what is open.
    pub residual: f64,
    /// Iterations that it took.
    pub iterations: usize,
}

/// Where a path ends: at the first of these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathEnd {
    /// Work of the load of factor 1, J.
    pub opening: f64,
    /// Energy dissipated, J.
    pub dissipated: f64,
    /// Steps.
    pub steps: usize,
}

/// Why a path was lost.
#[derive(Debug, Clone)]
pub enum PathError {
    /// What the plate said.
    Plate(SeparableError),
    /// Steps were cut without an end; the factor on the load.
    Lost(f64),
}

impl fmt::Display for PathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plate(error) => error.fmt(f),
            Self::Lost(load) => {
                write!(
                    f,
                    "no equilibrium was found beyond {load:.4} times the load by steps of `path.step` or shorter; a longer one may find it"
                )
            }
        }
    }
}
impl std::error::Error for PathError {}

impl From<SeparableError> for PathError {
    fn from(error: SeparableError) -> Self {
        Self::Plate(error)
    }
}

/// What a step is long in.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Control {
    /// Work of the load of factor 1, J.
    Opening(f64),
    /// Energy dissipated, J.
    Dissipation(f64),
}

/// The states of equilibrium of a plate under a load λ f that leads through growth of its interfaces, snap-back included.
///
/// Until damage dissipates something a step has a given opening fᵀu. Then it has a given dissipation, ½ (λ₀ fᵀu − λ fᵀu₀), which grows on
/// every branch of the path (Gutiérrez 2004); friction, which leaves stresses behind, is no part of that. Each is a row beside the equations of equilibrium, and both are solved by Newton's
/// method with the consistent tangent; a step that does not converge, or dissipates what it should not, is halved.
#[derive(Debug)]
pub struct Path<'a> {
    plate: &'a mut Separable,
    /// Load before elimination of constraints.
    load: Vec<(usize, f64)>,
    /// Energy that a step dissipates, J.
    step: f64,
    states: Vec<f64>,
    u: Vec<f64>,
    /// What the last step changed.
    last: Vec<f64>,
    factor: f64,
    last_factor: f64,
    control: Option<Control>,
    energy: Energy,
    /// What of it was dissipated by damage, J.
    damage: f64,
}

impl<'a> Path<'a> {
    /// From rest, `states` being those of the interfaces; `step` (J) is what a step dissipates.
    pub fn new(plate: &'a mut Separable, load: Vec<(usize, f64)>, step: f64, states: Vec<f64>) -> Self {
        let n = plate.ndof();
        Self {
            plate,
            load,
            step,
            states,
            u: vec![0.0; n],
            last: vec![0.0; n],
            factor: 0.0,
            last_factor: 0.0,
            control: None,
            energy: Energy::default(),
            damage: 0.0,
        }
    }

    /// The states of the interfaces.
    pub fn states(&self) -> &[f64] {
        &self.states
    }

    /// The independent displacements.
    pub fn u(&self) -> &[f64] {
        &self.u
    }

    /// The plate.
    pub fn plate(&self) -> &Separable {
        self.plate
    }

    /// Makes steps until `end`, and shows each state to `see`, which may break off there; whether the opening or the dissipation of `end` is
    /// reached.
    ///
    /// # Errors
    /// A path that was lost; what has been seen stands.
    pub fn follow(
        &mut self,
        end: PathEnd,
        mut see: impl FnMut(&PathPoint, &Self) -> ControlFlow<()>,
    ) -> Result<bool, PathError> {
        for _ in 0..end.steps {
            let point = self.advance(end)?;
            let reached = point.opening >= (1.0 - ROUNDING) * end.opening
                || point.energy.dissipated >= (1.0 - ROUNDING) * end.dissipated;
            if see(&point, self).is_break() || reached {
                return Ok(reached);
            }
        }
        Ok(false)
    }

    /// Makes a step, none beyond `end`.
    fn advance(&mut self, end: PathEnd) -> Result<PathPoint, PathError> {
        let f = self.force();
        let mut control = match self.control {
            Some(control) => control,
            None => Control::Opening(self.first_opening(&f)?),
        };
        let most = end.opening - dot(&f, &self.u);
        match &mut control {
            Control::Opening(opening) => *opening = opening.min(most),
            Control::Dissipation(energy) => *energy = energy.min(end.dissipated - self.energy.dissipated),
        }
        // What goes too far is gone again by opening, or where that leads nowhere, by less.
        let mut beyond = None;
        for _ in 0..MOST_CUTS {
            match self.attempt(&f, control)? {
                Some((point, _)) if point.opening > (1.0 + ROUNDING) * end.opening => {
                    beyond = Some(halved(control));
                    control = Control::Opening(most);
                }
                Some((point, u)) => {
                    let damage = point.energy.dissipated - point.friction;
                    let more = damage - self.damage;
                    let too_much = more > (1.0 + OFF) * self.step;
                    let off = match control {
                        Control::Opening(_) => too_much,
                        Control::Dissipation(wanted) => (more - wanted).abs() > OFF * wanted,
                    };
                    if off {
                        control = halved(control);
                        continue;
                    }
                    self.accept(u, point)?;
                    self.control = Some(match control {
                        Control::Opening(_) if more > BEGUN * self.step => Control::Dissipation(more.min(self.step)),
                        Control::Opening(opening) => Control::Opening(1.5 * opening),
                        Control::Dissipation(wanted) => Control::Dissipation((1.5 * wanted).min(self.step)),
                    });
                    return Ok(point);
                }
                None => control = beyond.take().unwrap_or_else(|| halved(control)),
            }
        }
        Err(PathError::Lost(self.factor))
    }

    fn force(&self) -> Vec<f64> {
        let mut f = vec![0.0; self.plate.ndof()];
        self.plate.parts.constraints.restrict(&self.load).into_iter().for_each(|(i, w)| f[i] += w);
        f
    }

    /// An opening at which the plate takes a small part of the energy of a step.
    fn first_opening(&mut self, f: &[f64]) -> Result<f64, PathError> {
        self.plate.linearise(&self.u, &self.states, 0.0)?;
        let mut u = f.to_vec();
        self.plate.solve(&mut u)?;
        let compliance = dot(f, &u);
        Ok((2.0 * 0.05 * self.step * compliance).sqrt())
    }

    /// A step; `None` where its iteration did not converge.
    fn attempt(&mut self, f: &[f64], control: Control) -> Result<Option<(PathPoint, Vec<f64>)>, PathError> {
        let (u0, factor0) = (self.u.clone(), self.factor);
        let opened = dot(f, &u0);
        // h and w: derivatives of the row by u, as a multiple of f, and by λ.
        let (h, w, wanted) = match control {
            Control::Opening(opening) => (1.0, 0.0, opening),
            Control::Dissipation(energy) => (0.5 * factor0, -0.5 * opened, energy),
        };
        let row = |u: &[f64], factor: f64| match control {
            Control::Opening(_) => dot(f, u) - opened,
            Control::Dissipation(_) => 0.5 * (factor0 * dot(f, u) - factor * opened),
        };
        // The last increment, scaled to what this one is long.
        let (mut u, mut factor) = (u0.clone(), factor0);
        let reached: Vec<f64> = u0.iter().zip(&self.last).map(|(u, d)| u + d).collect();
        let length = row(&reached, factor0 + self.last_factor);
        if length > 0.0 {
            let scale = (wanted / length).min(3.0);
            u.iter_mut().zip(&self.last).for_each(|(u, d)| *u += scale * d);
            factor += scale * self.last_factor;
        }
        let mut force = vec![0.0; u.len()];
        let mut first = None;
        for iteration in 1..=MOST {
            self.plate.linearise(&u, &self.states, 0.0)?;
            self.plate.internal(&u, &self.states, &mut force)?;
            let residual: Vec<f64> = f.iter().zip(&force).map(|(f, internal)| factor * f - internal).collect();
            let (mut a, mut b) = (residual.clone(), f.to_vec());
            match self.plate.solve(&mut a).and_then(|()| self.plate.solve(&mut b)) {
                Err(SeparableError::Unsolved(_)) => return Ok(None),
                done => done?,
            }
            // Work that the step does on what is not yet as it should be: residual forces, and what the row misses.
            let short = wanted - row(&u, factor);
            let missing = short - h * dot(f, &a);
            let more = missing / (h * dot(f, &b) + w);
            let mut work = 0.0;
            for ((u, a), (b, r)) in u.iter_mut().zip(&a).zip(b.iter().zip(&residual)) {
                let step = a + more * b;
                *u += step;
                work += step * r;
            }
            factor += more;
            let change = work.abs() + (more * short).abs();
            if !change.is_finite() || !factor.is_finite() {
                return Ok(None);
            }
            let scale = *first.get_or_insert(change.max(self.step * 1e-3).max(wanted.abs() * factor.abs() * 1e-6));
            if change <= ENOUGH * scale {
                let energy = self.plate.internal(&u, &self.states, &mut force)?;
                force.iter_mut().zip(f).for_each(|(force, f)| *force = factor * f - *force);
                let residual = self.plate.size_of(&force) / (factor.abs() * self.plate.size_of(f));
                let (opening, friction) = (dot(f, &u), self.plate.friction);
                let point = PathPoint { load: factor, opening, energy, friction, residual, iterations: iteration };
                return Ok(Some((point, u)));
            }
        }
        Ok(None)
    }

    fn accept(&mut self, u: Vec<f64>, point: PathPoint) -> Result<(), PathError> {
        self.plate.commit(&u, &mut self.states)?;
        self.last = u.iter().zip(&self.u).map(|(new, old)| new - old).collect();
        self.last_factor = point.load - self.factor;
        (self.u, self.factor, self.energy) = (u, point.load, point.energy);
        self.damage = point.energy.dissipated - point.friction;
        Ok(())
    }
}

fn halved(control: Control) -> Control {
    match control {
        Control::Opening(opening) => Control::Opening(0.5 * opening),
        Control::Dissipation(energy) => Control::Dissipation(0.5 * energy),
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
