//! A structure under the impact of lumped masses: the system that integrators march.

mod influence;
mod mean;
mod newton;
mod seen;
mod tip;

use crate::lifting::{Lifting, OneSided};
use crate::vector::dot;
use fem_core::contact::{Branches, ContactHistory, ContactLaw, Indentation};
use fem_core::energy::Energy;
use fem_core::structure::Structure;
use fem_core::time::{Histories, SecondOrderSystem, State, StepError};
use influence::{Influence, Strikers};
use newton::Newton;
use seen::Seen;
use std::sync::Arc;
use tip::Pressed;
pub use tip::Tip;

/// Sweeps of an upper bound of what weight adds to an energy, and the change, relative, at which it counts as found.
const MOST_SINKING: usize = 200;
const SUNK: f64 = 1e-3;

/// A mass that meets the structure through a contact law.
#[derive(Debug, Clone)]
pub struct Impactor {
    /// Mass, kg.
    pub mass: f64,
    /// Velocity towards the structure at t = 0, m/s.
    pub velocity: f64,
    /// When it would reach the structure at rest, s; 0 if they touch from the beginning.
    pub start: f64,
    /// p: deflection under the impactor w = pᵀu, away from it; p is also the load of a unit contact force.
    pub load: Vec<(usize, f64)>,
    /// Contact law F(α), α = z − w.
    pub law: Box<dyn ContactLaw>,
}

impl Impactor {
    /// Indentation (m) at which the contact has taken `energy` (J) on first loading; `None` where it never does.
    pub fn indentation_of(&self, energy: f64) -> Option<f64> {
        let work = |alpha: f64| {
            let Energy { stored, dissipated } = self.law.energy(&ContactHistory::default(), alpha);
            stored + dissipated
        };
        let mut high = 1.0;
        while !(work(high) >= energy) {
            high *= 2.0;
            if high > f64::MAX {
                return None;
            }
        }
        while work(0.5 * high) >= energy && high > f64::MIN_POSITIVE {
            high *= 0.5;
        }
        let mut low = 0.5 * high;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if work(middle) < energy { low = middle } else { high = middle }
        }
        Some(high)
    }
}

/// `M ü + C u̇ + f(u) = Σ F p`, `m z̈ = m g − F` (report eqs 33-35), unknowns: those of the structure, then one z per impactor,
/// positive towards the structure.
///
/// Of a linear structure, f = K u, an implicit step needs the response to each contact load once per step length and then
/// one back-substitution and a scalar equation per step; on springs that only push, a small convex problem and another
/// back-substitution. Otherwise it is an iteration of Newton's, each turn of which costs
/// an internal force and as much again; the tangent is renewed where the iteration is slow.
#[derive(Debug)]
pub struct ImpactSystem {
    structure: Box<dyn Structure>,
    impactors: Vec<Impactor>,
    /// Of those that have one; none for any where it is empty.
    tips: Vec<Option<Tip>>,
    weight: Option<Weight>,
    inertia: bool,
    influence: Influence,
    newton: Newton,
    seen: Seen,
    /// Internal force of a structure that softens.
    force: Vec<f64>,
    contact_calls: u64,
    /// What it has taken note of, where that is asked for.
    noted: Option<Vec<Noted>>,
}

/// The end of a part of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Noted {
    /// Time, s.
    pub t: f64,
    /// Each impactor then.
    pub touches: Vec<Touch>,
}

/// One impactor at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Indentation, m.
    pub indentation: f64,
    /// Contact force, N.
    pub force: f64,
    /// Velocity of the impactor, m/s.
    pub velocity: f64,
    /// Deflection of the structure under it, m.
    pub deflection: f64,
    /// Radius of the patch under a tip, m, that of the Hertz pressure that is as far spread; 0 without a tip.
    pub radius: f64,
}

/// Energies of an impact, J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    /// Kinetic energy of the impactors.
    pub impactor: f64,
    /// Kinetic energy of the plate.
    pub kinetic: f64,
    /// Strain energy of the plate.
    pub strain: f64,
    /// Recoverable work in the contacts.
    pub stored: f64,
    /// Work lost in the contacts.
    pub dissipated: f64,
    /// Work lost in the plies, where they follow laws that lose some.
    pub plies: f64,
    /// Work lost in the damping of the plate, of which the march keeps count.
    pub damped: f64,
    /// Potential energy of the weights, 0 where the impactors touch the plate at rest.
    pub weight: f64,
}

/// Gravity on a structure and its impactors.
///
/// The structure has sagged before t = 0: its unknowns count from there, where its internal forces and its weight cancel, and
/// what is left of gravity is the pull at the impactors. In the energies the sag is seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Weight {
    /// Acceleration towards the structure, m/s².
    pub acceleration: f64,
    /// Forces on the structure, N.
    pub load: Vec<f64>,
    /// Strain energy of the sag, J.
    pub sag: f64,
}

impl Energies {
    /// Sum; constant in an exact solution.
    pub fn total(&self) -> f64 {
        self.impactor
            + self.kinetic
            + self.strain
            + self.stored
            + self.dissipated
            + self.plies
            + self.damped
            + self.weight
    }
}

impl ImpactSystem {
    /// Couples `impactors` to `structure`.
    pub fn new(structure: Box<dyn Structure>, impactors: Vec<Impactor>) -> Self {
        Self {
            structure,
            impactors,
            tips: Vec::new(),
            weight: None,
            inertia: true,
            influence: Influence::default(),
            newton: Newton::default(),
            seen: Seen::default(),
            force: Vec::new(),
            contact_calls: 0,
            noted: None,
        }
    }

    /// Takes note from now on of the ends of parts of steps, which [`Self::take_noted`] is to fetch after each step.
    #[must_use]
    pub fn taking_notes(self) -> Self {
        Self { noted: Some(Vec::new()), ..self }
    }

    /// What it has taken note of since this was last asked, in the order of time.
    pub fn take_noted(&mut self) -> Vec<Noted> {
        self.noted.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// The same with spherical tips, one or none for each impactor: their contact is where they touch, and `load` of the impactor but what
    /// tells its deflection. States begin with [`initial`](Self::initial), which has room for what their beds remember.
    #[must_use]
    pub fn with_tips(self, tips: Vec<Option<Tip>>) -> Self {
        Self { tips, ..self }
    }

    /// Whether an impactor has a tip.
    pub fn has_tips(&self) -> bool {
        self.tips.iter().any(Option::is_some)
    }

    fn strikers(&self) -> Strikers<'_> {
        Strikers { impactors: &self.impactors, tips: &self.tips }
    }

    /// The tip of impactor `i` in a state, if it has one.
    fn pressed(&self, i: usize, h: &Histories, u: &[f64]) -> Option<(&Tip, Pressed)> {
        let tip = self.strikers().tip(i)?;
        Some((tip, tip.press(self.strikers().remembering(i, h), self.position(i, u), u)))
    }

    /// The same on `springs` that only push, which the structure has in its stiffness as if they pulled, too.
    #[must_use]
    pub fn on_one_sided(mut self, springs: Arc<[OneSided]>) -> Self {
        self.influence = Influence::default();
        self.influence.lifting = Lifting::new(springs);
        self
    }

    /// The springs that only push.
    pub fn one_sided(&self) -> &[OneSided] {
        self.influence.lifting.springs()
    }

    /// Turns of Newton's method so far that found which of them have let go.
    pub fn lifting_turns(&self) -> u64 {
        self.influence.lifting.turns()
    }

    /// Force (N) by which each spring that only pushes is relieved of its pull under displacements `u`.
    pub fn reliefs(&self, u: &[f64]) -> Vec<f64> {
        self.influence.lifting.reliefs(&u[..self.structure.ndof()])
    }

    /// The same under gravity, if there is some.
    #[must_use]
    pub fn with_weight(self, weight: Option<Weight>) -> Self {
        Self { weight, ..self }
    }

    /// Its gravity, if there is some.
    pub fn weight(&self) -> Option<&Weight> {
        self.weight.as_ref()
    }

    /// Adds the weights of the impactors.
    fn pull(&self, f: &mut [f64]) {
        if let Some(Weight { acceleration, .. }) = self.weight {
            f.iter_mut().zip(&self.impactors).for_each(|(f, impactor)| *f += impactor.mass * acceleration);
        }
    }

    /// With the gravity of `other`, of whose plate nothing but its sag is known: what pulls at the impactors.
    #[must_use]
    pub fn pulled_as(self, other: &Self) -> Self {
        let load = vec![0.0; self.structure.ndof()];
        let weight = other.weight.as_ref().map(|weight| Weight { acceleration: weight.acceleration, load, sag: 0.0 });
        self.with_weight(weight)
    }

    fn gravity(&self) -> f64 {
        self.weight.as_ref().map_or(0.0, |weight| weight.acceleration)
    }

    /// The same impact on another `structure`, one with the same unknowns.
    pub fn on(&self, structure: Box<dyn Structure>) -> Self {
        let copy = Self::new(structure, self.impactors.clone()).with_weight(self.weight.clone());
        let copy = copy.on_one_sided(Arc::clone(self.influence.lifting.springs()));
        Self { inertia: self.inertia, ..copy.with_tips(self.tips.clone()) }
    }

    /// The same with a structure that has no inertia.
    pub fn without_inertia(mut self) -> Self {
        self.inertia = false;
        self
    }

    /// The state at t = 0: the structure at rest, the impactors on their way.
    pub fn initial(&self) -> State {
        let n = self.structure.ndof();
        let mut state = State::at_rest(self.ndof(), self.impactors.len());
        state.histories.beds = vec![[[0.0; 8]; 2]; self.tips.iter().flatten().map(Tip::count).sum()];
        state.histories.points = vec![0.0; self.structure.states()];
        for (i, impactor) in self.impactors.iter().enumerate() {
            let mean = impactor.velocity + 0.5 * self.gravity() * impactor.start;
            state.u[n + i] = 0.0 - mean * impactor.start;
            state.v[n + i] = impactor.velocity;
        }
        state
    }

    /// The structure.
    pub fn structure(&self) -> &dyn Structure {
        &*self.structure
    }

    /// The structure, to solve with it before a march.
    pub fn structure_mut(&mut self) -> &mut dyn Structure {
        self.seen = Seen::default();
        &mut *self.structure
    }

    /// The impactors.
    pub fn impactors(&self) -> &[Impactor] {
        &self.impactors
    }

    /// Evaluations of contact laws so far.
    pub fn contact_calls(&self) -> u64 {
        self.contact_calls
    }

    /// Deflection under impactor `i`.
    pub fn deflection(&self, i: usize, u: &[f64]) -> f64 {
        value(&self.impactors[i].load, u)
    }

    /// Displacement of impactor `i` from where it would touch the structure at rest.
    pub fn position(&self, i: usize, u: &[f64]) -> f64 {
        u[self.structure.ndof() + i]
    }

    /// Indentation z − w of impactor `i` for displacements, its rate for velocities.
    fn approach(&self, i: usize, x: &[f64]) -> f64 {
        self.position(i, x) - self.deflection(i, x)
    }

    /// Indentation that is left under impactor `i` when the force is gone, m: a dent.
    pub fn dent(&self, i: usize, state: &State) -> f64 {
        let by = self.strikers().remembering(i, &state.histories);
        if self.strikers().tip(i).is_some() { by.dent() } else { by.law.branches(by.whole).touch }
    }

    /// Contact force of impactor `i` in an accepted state.
    pub fn contact_force(&self, i: usize, state: &State) -> f64 {
        self.touch(i, state).force
    }

    /// Impactor `i` in an accepted state.
    pub fn touch(&self, i: usize, state: &State) -> Touch {
        let deflection = self.deflection(i, &state.u);
        let indentation = self.position(i, &state.u) - deflection;
        let (force, radius) = match self.pressed(i, &state.histories, &state.u) {
            Some((tip, pressed)) => (pressed.force(), tip.radius(&pressed)),
            None => (self.impactors[i].law.force(&state.histories.contacts[i], indentation).force, 0.0),
        };
        Touch { indentation, force, velocity: state.v[self.structure.ndof() + i], deflection, radius }
    }

    /// The energy ledger of an accepted state.
    pub fn energies(&mut self, state: &State, work: &mut Vec<f64>) -> Energies {
        let n = self.structure.ndof();
        work.clear();
        work.resize(n, 0.0);
        // What cannot be integrated is not a number, which the guard sees.
        let missing = Energy { stored: f64::NAN, dissipated: f64::NAN };
        let points = &state.histories.points;
        let nonlinear = match self.newton.stored(&state.u[..n]) {
            Some(stored) => Some(Energy { stored, dissipated: 0.0 }),
            None => {
                let of = (&state.u[..n], &points[..]);
                self.structure.nonlinear().map(|f| self.seen.internal(f, of, work).unwrap_or(missing))
            }
        };
        let mut product = |x: &[f64], add: &dyn Fn(&[f64], &mut [f64])| {
            work.clear();
            work.resize(n, 0.0);
            add(x, work);
            0.5 * dot(x, work)
        };
        let mut energies = Energies {
            kinetic: product(&state.v[..n], &|x, y| self.structure.add_mass(1.0, x, y)),
            strain: match nonlinear {
                Some(energy) => energy.stored,
                None => product(&state.u[..n], &|x, y| self.structure.add_stiffness(1.0, x, y)),
            },
            plies: nonlinear.map_or(0.0, |energy| energy.dissipated),
            ..Energies::default()
        };
        energies.strain -= self.influence.lifting.energy(&state.u[..n]);
        for (i, impactor) in self.impactors.iter().enumerate() {
            energies.impactor += 0.5 * impactor.mass * state.v[n + i].powi(2);
            let Energy { stored, dissipated } = match self.pressed(i, &state.histories, &state.u) {
                Some((tip, pressed)) => tip.energy(self.strikers().remembering(i, &state.histories), &pressed),
                None => impactor.law.energy(&state.histories.contacts[i], self.approach(i, &state.u)),
            };
            energies.stored += stored;
            energies.dissipated += dissipated;
        }
        if let Some(Weight { acceleration, load, sag }) = &self.weight {
            let sunk = dot(load, &state.u[..n]);
            energies.strain += sag + sunk;
            let fallen: f64 = self.impactors.iter().zip(&state.u[n..]).map(|(impactor, z)| impactor.mass * z).sum();
            energies.weight = -(sunk + acceleration * fallen);
        }
        energies
    }

    /// Power lost in the damping of the structure, u̇ᵀ C u̇, W.
    pub fn damping_power(&self, state: &State, work: &mut Vec<f64>) -> f64 {
        let n = self.structure.ndof();
        work.clear();
        work.resize(n, 0.0);
        self.structure.add_damping(1.0, &state.v[..n], work);
        dot(&state.v[..n], work)
    }

    /// Upper bound of |λ|, 1/s, of the roots of λ² M + λ C + K, where no circular frequency is above `omega`: a motion beyond
    /// its critical damping decays by less than the eigenvalues of M⁻¹C.
    pub fn root_bound(&self, omega: f64) -> f64 {
        omega.max(self.structure.damping_rate(omega))
    }

    /// Highest circular frequency of the structure alone, rad/s.
    ///
    /// # Errors
    /// A singular mass.
    pub fn highest_frequency(&mut self) -> Result<f64, StepError> {
        self.structure.highest_frequency().map_err(StepError::SingularMass)
    }

    /// Static deflection per force of impactor `i`, m/N: pᵀ K⁻¹ p.
    ///
    /// # Errors
    /// A structure that is not held.
    pub fn static_flexibility(&mut self, i: usize) -> Result<f64, StepError> {
        let load = &self.impactors[i].load;
        let mut x = vec![0.0; self.structure.ndof()];
        add(load, 1.0, &mut x);
        self.structure.solve_shifted(0.0, &mut x, 1).map_err(StepError::Factorisation)?;
        Ok(value(load, &x))
    }

    /// Upper bound of the energy (J) of an impact of `energy` that weight adds to: E = `energy` + Σ m g (α + w), the contact so
    /// deep that it alone would have taken E and the plate so far down that it alone would.
    ///
    /// # Errors
    /// A structure that is not held.
    pub fn highest_energy(&mut self, energy: f64) -> Result<f64, StepError> {
        let gravity = self.gravity();
        if gravity == 0.0 {
            return Ok(energy);
        }
        let flexibilities =
            (0..self.impactors.len()).map(|i| self.static_flexibility(i)).collect::<Result<Vec<_>, _>>()?;
        let mut highest = energy;
        for _ in 0..MOST_SINKING {
            let way = |(impactor, flexibility): (&Impactor, &f64)| {
                let indentation = impactor.indentation_of(highest).unwrap_or(f64::INFINITY);
                impactor.mass * gravity * (indentation + (2.0 * flexibility * highest).sqrt())
            };
            let next = energy + self.impactors.iter().zip(&flexibilities).map(way).sum::<f64>();
            if next <= highest * (1.0 + SUNK) {
                return Ok(next);
            }
            highest = next;
        }
        Ok(f64::INFINITY)
    }

    /// Upper bound of the highest frequency (rad/s) of structure, impactors and contacts together: ω² ≤ ω_s² + Σ k_c
    /// (pᵀM⁻¹p + 1/m), with `omega` = ω_s of the structure and k_c the steepest tangent of a contact that took the energy of
    /// all impactors.
    ///
    /// # Errors
    /// A singular mass: the bound does not exist.
    pub fn frequency_bound(&mut self, omega: f64) -> Result<f64, StepError> {
        let mut square = omega * omega;
        let mut x = vec![0.0; self.structure.ndof()];
        let fall = |i: &Impactor| self.gravity() * i.start * (i.velocity + 0.5 * self.gravity() * i.start);
        let energy = self.impactors.iter().map(|i| 0.5 * i.mass * i.velocity.powi(2) + i.mass * fall(i)).sum();
        let energy = self.highest_energy(energy)?;
        for impactor in &self.impactors {
            x.fill(0.0);
            add(&impactor.load, 1.0, &mut x);
            self.structure.solve_mass(&mut x).map_err(StepError::SingularMass)?;
            let mobility = value(&impactor.load, &x) + 1.0 / impactor.mass;
            square += mobility * steepest(impactor, energy);
        }
        Ok(square.sqrt())
    }

    /// An implicit step; its forces are means over one that begins with the displacements `start`, if these are given.
    fn solve(
        &mut self,
        [cm, cc, t]: [f64; 3],
        h: &Histories,
        start: Option<&[f64]>,
        from: &[f64],
        d: &mut [f64],
    ) -> Result<(), StepError> {
        let n = self.structure.ndof();
        self.pull(&mut d[n..]);
        if self.is_nonlinear() && !self.softens() {
            return self.iterate([cm, cc, t], h, start, from, d);
        }
        match self.structure.nonlinear() {
            None => self.structure.add_stiffness(-1.0, &from[..n], &mut d[..n]),
            Some(softening) => {
                let force = &mut self.force;
                force.resize(n, 0.0);
                softening.internal(&from[..n], &h.points, force).map_err(StepError::Factorisation)?;
                d.iter_mut().zip(&*force).for_each(|(d, f)| *d -= f);
            }
        }
        self.prepare(cm, cc)?;
        let Self { structure, impactors, tips, influence, contact_calls, .. } = self;
        let strikers = Strikers { impactors, tips };
        structure.solve_damped(cm, cc, &mut d[..n], 1).map_err(StepError::Factorisation)?;
        for (d, impactor) in d[n..].iter_mut().zip(impactors.iter()) {
            *d /= cm * impactor.mass;
        }
        influence.begin(start.map(|u| &u[..n]));
        influence.set_approaches(strikers, from);
        let solve = |x: &mut [f64], count| structure.solve_damped(cm, cc, x, count);
        *contact_calls += influence.touch(strikers, t, h, start, d, solve)?;
        Ok(())
    }

    fn prepare(&mut self, cm: f64, cc: f64) -> Result<(), StepError> {
        let of = (cm, cc, self.structure.revision());
        let Self { structure, impactors, tips, influence, .. } = self;
        if (influence.cm, influence.cc, influence.revision) == of && !influence.x.is_empty() {
            return Ok(());
        }
        let n = structure.ndof();
        influence.revision = of.2;
        influence.set(cm, cc, n, Strikers { impactors, tips }, |x, count| structure.solve_damped(cm, cc, x, count))
    }
}

/// Steepest tangent on loading and unloading up to the indentation that takes `energy`.
fn steepest(impactor: &Impactor, energy: f64) -> f64 {
    let (law, fresh) = (&*impactor.law, ContactHistory::default());
    let high = impactor.indentation_of(energy).unwrap_or(f64::MAX);
    let mut pressed = fresh;
    law.commit(&mut pressed, high);
    let below = high * (1.0 - 1e-9);
    law.force(&fresh, high).tangent.max(law.force(&pressed, below).tangent)
}

fn value(w: &[(usize, f64)], u: &[f64]) -> f64 {
    w.iter().map(|(i, w)| w * u[*i]).sum()
}

fn add(w: &[(usize, f64)], scale: f64, u: &mut [f64]) {
    for (i, w) in w {
        u[*i] += scale * w;
    }
}

impl SecondOrderSystem for ImpactSystem {
    fn ndof(&self) -> usize {
        self.structure.ndof() + self.impactors.len()
    }

    fn force(&mut self, _: f64, u: &[f64], v: &[f64], h: &Histories, f: &mut [f64]) {
        let n = self.structure.ndof();
        f.fill(0.0);
        match self.structure.nonlinear() {
            None => self.structure.add_stiffness(-1.0, &u[..n], &mut f[..n]),
            // What cannot be integrated is not a number, which the guard sees.
            Some(structure) => match self.seen.internal(structure, (&u[..n], &h.points), &mut f[..n]) {
                Ok(_) => f[..n].iter_mut().for_each(|f| *f = -*f),
                Err(_) => f.fill(f64::NAN),
            },
        }
        self.influence.lifting.add_forces(&u[..n], &mut f[..n]);
        self.structure.add_damping(-1.0, &v[..n], &mut f[..n]);
        for (i, impactor) in self.impactors.iter().enumerate() {
            self.contact_calls += 1;
            f[n + i] = match self.pressed(i, h, u) {
                Some((tip, pressed)) => {
                    tip.loads().zip(&pressed.forces).for_each(|(load, force)| add(load, *force, f));
                    -pressed.force()
                }
                None => {
                    let force = impactor.law.force(&h.contacts[i], self.approach(i, u)).force;
                    add(&impactor.load, force, f);
                    -force
                }
            };
        }
        self.pull(&mut f[n..]);
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        let n = self.structure.ndof();
        self.structure.add_mass(scale, &x[..n], &mut y[..n]);
        for (i, impactor) in self.impactors.iter().enumerate() {
            y[n + i] += scale * impactor.mass * x[n + i];
        }
    }

    fn add_damping(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        let n = self.structure.ndof();
        self.structure.add_damping(scale, &x[..n], &mut y[..n]);
    }

    fn solve_mass(&mut self, cc: f64, x: &mut [f64]) -> Result<(), StepError> {
        let n = self.structure.ndof();
        // Weight pulls at impactors that do not touch yet; a plate without force may have no mass.
        if self.weight.is_none() || x[..n].iter().any(|f| *f != 0.0) {
            self.structure.solve_damped_mass(cc, &mut x[..n]).map_err(StepError::SingularMass)?;
        }
        for (x, impactor) in x[n..].iter_mut().zip(&self.impactors) {
            *x /= impactor.mass;
        }
        Ok(())
    }

    fn solve_implicit(
        &mut self,
        cm: f64,
        cc: f64,
        t: f64,
        h: &Histories,
        from: &[f64],
        d: &mut [f64],
    ) -> Result<(), StepError> {
        self.solve([cm, cc, t], h, None, from, d)
    }

    fn solve_midpoint(
        &mut self,
        cm: f64,
        cc: f64,
        t: f64,
        s: &State,
        from: &[f64],
        d: &mut [f64],
    ) -> Result<(), StepError> {
        self.solve([cm, cc, t], &s.histories, Some(&s.u), from, d)
    }

    fn commit(&mut self, state: &mut State) -> Result<(), StepError> {
        if !self.inertia {
            // Newmark's accelerations of unknowns without mass ring, and grow from step to step: nothing needs them.
            state.a[..self.structure.ndof()].fill(0.0);
        }
        for (i, impactor) in self.impactors.iter().enumerate() {
            let pressed = self.pressed(i, &state.histories, &state.u);
            let Histories { contacts, beds, .. } = &mut state.histories;
            match pressed {
                Some((tip, pressed)) => {
                    tip.commit(&*impactor.law, &pressed, &mut contacts[i], &mut beds[self.strikers().bed(i)]);
                }
                None => impactor.law.commit(&mut contacts[i], self.approach(i, &state.u)),
            }
        }
        let n = self.structure.ndof();
        match self.structure.nonlinear() {
            Some(plate) => plate.commit(&state.u[..n], &mut state.histories.points).map_err(StepError::Factorisation),
            None => Ok(()),
        }
    }

    fn note(&mut self, from: f64, state: &State) {
        let Some(mut noted) = self.noted.take() else { return };
        while noted.last().is_some_and(|last| last.t > from) {
            noted.pop();
        }
        noted.push(Noted { t: state.t, touches: (0..self.impactors.len()).map(|i| self.touch(i, state)).collect() });
        self.noted = Some(noted);
    }

    fn indentation(&self, i: usize, s: &State) -> Indentation {
        Indentation { alpha: self.approach(i, &s.u), rate: self.approach(i, &s.v) }
    }

    fn branches(&self, i: usize, h: &ContactHistory) -> Branches {
        self.impactors[i].law.branches(h)
    }
}
