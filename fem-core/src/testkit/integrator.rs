//! The contract of a time integrator, and a system with known solutions.

use crate::contracts::contact::{Branches, ContactForce, ContactHistory, ContactLaw, Indentation};
use crate::contracts::structure::SolveError;
use crate::contracts::time::{Histories, Integrator, SecondOrderSystem, State, StepError};
use crate::words::energy::Energy;
use std::error::Error;

/// One oscillator `m a + c v + k u = p(t)`.
#[derive(Debug, Clone, Copy)]
pub struct Mode {
    /// Mass, kg.
    pub m: f64,
    /// Damping, N s/m.
    pub c: f64,
    /// Stiffness, N/m; zero for a free body.
    pub k: f64,
}

impl Mode {
    /// Of mass 1, circular frequency `omega` and damping ratio `zeta`.
    pub fn new(omega: f64, zeta: f64) -> Self {
        Self { m: 1.0, c: 2.0 * zeta * omega, k: omega * omega }
    }
}

/// Uncoupled oscillators; the first may push a contact whose indentation is its displacement.
#[derive(Debug, Clone)]
pub struct Oscillators {
    /// One per unknown.
    pub modes: Vec<Mode>,
    /// Load p of oscillator i at time t.
    pub load: fn(usize, f64) -> f64,
    /// The law that resists the first oscillator.
    pub contact: Option<Box<dyn ContactLaw>>,
}

impl Oscillators {
    /// Without load and contact.
    pub fn free(modes: impl Into<Vec<Mode>>) -> Self {
        Self { modes: modes.into(), load: |_, _| 0.0, contact: None }
    }

    /// A free mass that meets `law` at u = 0.
    pub fn sphere(m: f64, law: Box<dyn ContactLaw>) -> Self {
        Self { contact: Some(law), ..Self::free([Mode { m, c: 0.0, k: 0.0 }]) }
    }

    /// At rest, with a history for the contact.
    pub fn state(&self) -> State {
        State::at_rest(self.modes.len(), usize::from(self.contact.is_some()))
    }

    /// Kinetic, strain and contact energy, the dissipated included, J.
    pub fn energy(&self, s: &State) -> f64 {
        let of = |(mode, (u, v)): (&Mode, (&f64, &f64))| 0.5 * (mode.m * v * v + mode.k * u * u);
        let modes = self.modes.iter().zip(s.u.iter().zip(&s.v)).map(of).sum::<f64>();
        let work = |law: &dyn ContactLaw| law.energy(&s.histories.contacts[0], s.u[0]).total();
        modes + self.contact.as_deref().map_or(0.0, work)
    }

    fn contact(&self, h: &Histories, i: usize, u: f64) -> ContactForce {
        match &self.contact {
            Some(law) if i == 0 => law.force(&h.contacts[0], u),
            _ => ContactForce::default(),
        }
    }

    /// Solves `(cm m + cc c + k) d = r + p(t) − k from − contact(from + d)` of each oscillator.
    fn solve(&self, [cm, cc, t]: [f64; 3], from: &[f64], d: &mut [f64], contact: impl Fn(usize, f64) -> ContactForce) {
        for (i, mode) in self.modes.iter().enumerate() {
            let slope = cm * mode.m + cc * mode.c + mode.k;
            let r = d[i] + (self.load)(i, t) - mode.k * from[i];
            // The force never falls with u: the root lies between here and where this force would push it.
            d[i] = r / slope;
            let (mut low, mut high) = (d[i] - contact(i, from[i] + d[i]).force / slope, d[i]);
            for _ in 0..200 {
                let contact = contact(i, from[i] + d[i]);
                let residual = slope * d[i] + contact.force - r;
                *(if residual > 0.0 { &mut high } else { &mut low }) = d[i];
                let newton = d[i] - residual / (slope + contact.tangent);
                // At the solution, the rounding of from + d decides on which side of it the next value lies.
                if (newton - d[i]).abs() <= 1e-14 * d[i].abs() + 1e-15 * from[i].abs() {
                    d[i] = newton;
                    break;
                }
                d[i] = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            }
        }
    }
}

impl SecondOrderSystem for Oscillators {
    fn ndof(&self) -> usize {
        self.modes.len()
    }

    fn force(&mut self, t: f64, u: &[f64], v: &[f64], h: &Histories, f: &mut [f64]) {
        for (i, mode) in self.modes.iter().enumerate() {
            f[i] = (self.load)(i, t) - mode.c * v[i] - mode.k * u[i] - self.contact(h, i, u[i]).force;
        }
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        for (i, mode) in self.modes.iter().enumerate() {
            y[i] += scale * mode.m * x[i];
        }
    }

    fn add_damping(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        for (i, mode) in self.modes.iter().enumerate() {
            y[i] += scale * mode.c * x[i];
        }
    }

    fn solve_mass(&mut self, cc: f64, x: &mut [f64]) -> Result<(), StepError> {
        for (mode, x) in self.modes.iter().zip(x) {
            if mode.m == 0.0 {
                return Err(StepError::SingularMass(SolveError::NoInertia { unknown: "the oscillator".into() }));
            }
            *x /= mode.m + cc * mode.c;
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
        self.solve([cm, cc, t], from, d, |i, u| self.contact(h, i, u));
        Ok(())
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
        self.solve([cm, cc, t], from, d, |i, middle| match &self.contact {
            Some(law) if i == 0 => {
                let mean = law.mean_force(&s.histories.contacts[0], s.u[0], 2.0 * middle - s.u[0]);
                ContactForce { tangent: 2.0 * mean.tangent, ..mean }
            }
            _ => ContactForce::default(),
        });
        Ok(())
    }

    fn commit(&mut self, s: &mut State) -> Result<(), StepError> {
        if let Some(law) = &self.contact {
            law.commit(&mut s.histories.contacts[0], s.u[0]);
        }
        Ok(())
    }

    fn indentation(&self, _: usize, s: &State) -> Indentation {
        Indentation { alpha: s.u[0], rate: s.v[0] }
    }

    fn branches(&self, _: usize, h: &ContactHistory) -> Branches {
        self.contact.as_ref().map_or(Branches::default(), |law| law.branches(h))
    }
}

/// Checks `integrator`.
///
/// Demanded: the order that it claims, less 0.2, in u and v of damped oscillators under load; time that advances by the step,
/// and steps that may change from one to the next; after a restart the same state, bit for bit; no growth at the limit it
/// claims and at parts of it, or at ω Δt from 1 to 100 where it claims none; a
/// commit of the accepted state at the end of each step; an elastic contact that gives a mass its speed back, the
/// better the shorter the step; of one that claims to conserve energy, that it does, in a contact that opens and closes, at ω Δt of
/// 0.1, 1 and 100; [`StepError::NotFinite`] for a state with NaN.
///
/// A scheme that divides its steps must take the short steps of the order's check, ω Δt = 0.2 and 0.1, whole.
///
/// # Errors
/// The first violation.
pub fn check_integrator(integrator: &dyn Integrator) -> Result<(), String> {
    check_order(integrator)
        .and_then(|()| check_restart(integrator))
        .and_then(|()| check_limit(integrator))
        .and_then(|()| check_contact(integrator))
        .and_then(|()| check_energy(integrator))
        .and_then(|()| check_nan(integrator))
        .map_err(|e| e.to_string())
}

type Checked<T> = Result<T, Box<dyn Error>>;

struct Trial<'a> {
    integrator: Box<dyn Integrator + 'a>,
    sys: Oscillators,
    s: State,
}

impl<'a> Trial<'a> {
    fn start(like: &'a dyn Integrator, mut sys: Oscillators, mut s: State) -> Result<Self, StepError> {
        let mut integrator = dyn_clone::clone_box(like);
        integrator.start(&mut sys, &mut s)?;
        Ok(Self { integrator, sys, s })
    }

    fn run(&mut self, dt: f64, steps: u32) -> Result<(), StepError> {
        (0..steps).try_for_each(|_| self.integrator.step(&mut self.sys, &mut self.s, dt))
    }
}

const DRIVEN: [Mode; 2] = [Mode { m: 1.0, c: 0.4, k: 4.0 }, Mode { m: 2.0, c: 0.1, k: 1.0 }];

/// The load under which oscillator i of [`DRIVEN`] follows sin(t + i).
fn driving(i: usize, t: f64) -> f64 {
    let (sin, cos) = (t + i as f64).sin_cos();
    DRIVEN[i].c * cos + (DRIVEN[i].k - DRIVEN[i].m) * sin
}

fn check_order(integrator: &dyn Integrator) -> Checked<()> {
    // Steps of h (1 + uneven) and h (1 - uneven) in turn.
    let error = |steps: u32, uneven: f64| -> Checked<f64> {
        let s = State { u: vec![0.0, 1.0_f64.sin()], v: vec![1.0, 1.0_f64.cos()], ..State::at_rest(2, 0) };
        let mut march =
            Trial::start(integrator, Oscillators { modes: DRIVEN.to_vec(), load: driving, contact: None }, s)?;
        for step in 0..steps {
            let part = if step % 2 == 0 { 1.0 + uneven } else { 1.0 - uneven };
            march.run(2.0 / f64::from(steps) * part, 1)?;
        }
        let State { t, u, v, .. } = march.s;
        if (t - 2.0).abs() > 1e-12 {
            return Err(format!("{steps} steps that make 2 s end at t = {t} s").into());
        }
        let errors = (0..2).map(|i| {
            let (sin, cos) = (t + i as f64).sin_cos();
            (u[i] - sin).abs().max((v[i] - cos).abs())
        });
        Ok(errors.fold(0.0, f64::max))
    };
    let (coarse, fine) = (error(20, 0.0)?, error(40, 0.0)?);
    let order = integrator.order();
    let observed = (coarse / fine).log2();
    if observed < f64::from(order) - 0.2 {
        let why =
            format!("order {observed:.2} where {order} is claimed: errors {coarse:e}, with half the step {fine:e}");
        return Err(why.into());
    }
    let uneven = error(20, 0.5)?;
    if uneven <= 20.0 * coarse {
        Ok(())
    } else {
        Err(format!("an error of {coarse:e} in equal steps becomes {uneven:e} in unequal ones").into())
    }
}

/// `F = u²`; remembers how often it was committed, and the last indentation.
#[derive(Debug, Clone)]
struct Stop;

impl ContactLaw for Stop {
    fn force(&self, _: &ContactHistory, alpha: f64) -> ContactForce {
        if alpha <= 0.0 {
            return ContactForce::default();
        }
        ContactForce { force: alpha * alpha, tangent: 2.0 * alpha }
    }

    fn commit(&self, h: &mut ContactHistory, alpha: f64) {
        *h = [h[0] + 1.0, alpha, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    }

    fn energy(&self, _: &ContactHistory, alpha: f64) -> Energy {
        Energy { stored: alpha.max(0.0).powi(3) / 3.0, dissipated: 0.0 }
    }
}

/// A mass that meets [`Stop`] at unit speed, and a damped oscillator beside it.
fn bounce(integrator: &dyn Integrator) -> Result<Trial<'_>, StepError> {
    let mut sys = Oscillators::sphere(1.0, Box::new(Stop));
    sys.modes.push(Mode::new(2.0, 0.05));
    let mut s = sys.state();
    s.v = vec![1.0, 1.0];
    Trial::start(integrator, sys, s)
}

fn check_restart(integrator: &dyn Integrator) -> Checked<()> {
    let mut straight = bounce(integrator)?;
    straight.run(0.05, 20)?;
    let mut restarted =
        Trial { integrator: dyn_clone::clone_box(integrator), sys: straight.sys.clone(), s: straight.s.clone() };
    restarted.integrator.resume(&mut restarted.sys);
    for march in [&mut straight, &mut restarted] {
        march.run(0.05, 20)?;
    }
    if straight.s == restarted.s {
        Ok(())
    } else {
        Err(format!("a restarted march ends in {:?}, a straight one in {:?}", restarted.s, straight.s).into())
    }
}

fn check_limit(integrator: &dyn Integrator) -> Checked<()> {
    let steps = match integrator.limit().product() {
        Some(limit) => [1.0, 0.8, 0.6, 0.4, 0.2].map(|part| part * limit),
        None => [100.0, 10.0, 5.0, 2.5, 1.0],
    };
    for dt in steps {
        let sys = Oscillators::free([Mode::new(1.0, 0.0)]);
        let mut march = Trial::start(integrator, sys, State { u: vec![1.0], ..State::at_rest(1, 0) })?;
        for step in 1..=1000 {
            march.run(dt, 1)?;
            let u = march.s.u[0].abs();
            if u > 1.5 {
                return Err(format!("unit amplitude grows to {u} in {step} steps of omega dt = {dt}").into());
            }
        }
    }
    Ok(())
}

fn check_contact(integrator: &dyn Integrator) -> Checked<()> {
    let error = |steps: u32| -> Checked<f64> {
        let mut march = bounce(integrator)?;
        for step in 1..=steps {
            march.run(8.0 / f64::from(steps), 1)?;
            let [commits, last, ..] = march.s.histories.contacts[0];
            if commits < f64::from(step) || last != march.s.u[0] {
                return Err(format!("step {step} does not end with a commit of its state").into());
            }
        }
        Ok((march.s.v[0] + 1.0).abs())
    };
    let (coarse, fine) = (error(200)?, error(800)?);
    if fine < 1e-6 || fine < 0.6 * coarse {
        Ok(())
    } else {
        Err(format!("an elastic stop changes the speed by {coarse:e}, with a fourth of the step by {fine:e}").into())
    }
}

/// An oscillator that rests on [`Stop`] and is hit, so that it bounces for ever.
fn check_energy(integrator: &dyn Integrator) -> Checked<()> {
    if !integrator.conserves_energy() {
        return Ok(());
    }
    for dt in [0.1, 1.0, 100.0] {
        let sys = Oscillators { modes: vec![Mode::new(1.0, 0.0)], ..Oscillators::sphere(1.0, Box::new(Stop)) };
        let mut s = sys.state();
        s.v = vec![1.0];
        let mut march = Trial::start(integrator, sys.clone(), s)?;
        for step in 1..=2000 {
            march.run(dt, 1)?;
            let change = sys.energy(&march.s) / 0.5 - 1.0;
            if !(change.abs() < 1e-10) {
                let why = format!(
                    "claims to conserve energy, and changes it by {change:e} in {step} steps of omega dt = {dt}"
                );
                return Err(why.into());
            }
        }
    }
    Ok(())
}

fn check_nan(integrator: &dyn Integrator) -> Checked<()> {
    let sys = Oscillators::free([Mode::new(1.0, 0.0)]);
    let s = State { u: vec![f64::NAN], ..sys.state() };
    match Trial::start(integrator, sys, s).and_then(|mut march| march.run(0.1, 1)) {
        Err(StepError::NotFinite { .. }) => Ok(()),
        other => Err(format!("a displacement of NaN gives {other:?}").into()),
    }
}
