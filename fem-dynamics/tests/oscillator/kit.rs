//! The kit notices broken plug-ins.

use crate::{hertz, scheme, sun_yang};
use fem_core::contact::{Branches, ContactForce, ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use fem_core::testkit::{check_contact_law, check_integrator};
use fem_core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit};
use std::sync::{Arc, Mutex};

/// A sound law whose answers pass through functions.
#[derive(Debug, Clone)]
struct Spoiled {
    sound: Box<dyn ContactLaw>,
    force: Force,
    commit: Commit,
    energy: Falsify,
    branches: Branches,
}

type Force = fn(ContactForce, &ContactHistory, f64) -> ContactForce;
type Commit = fn(&mut ContactHistory, f64);
type Falsify = fn(Energy, &ContactHistory) -> Energy;

impl ContactLaw for Spoiled {
    fn force(&self, h: &ContactHistory, alpha: f64) -> ContactForce {
        (self.force)(self.sound.force(h, alpha), h, alpha)
    }

    fn commit(&self, h: &mut ContactHistory, alpha: f64) {
        (self.commit)(h, alpha);
    }

    fn energy(&self, h: &ContactHistory, alpha: f64) -> Energy {
        (self.energy)(self.sound.energy(h, alpha), h)
    }

    fn branches(&self, _: &ContactHistory) -> Branches {
        self.branches
    }
}

#[test]
fn of_contact_laws() {
    let branches = Branches::default();
    let sound = Spoiled { sound: hertz(2.0, 1.5), force: |f, _, _| f, commit: |_, _| (), energy: |e, _| e, branches };
    check_contact_law(&sound, 1.0).unwrap();

    let force = |force: Force| Spoiled { force, ..sound.clone() };
    let energy = |commit: Commit, energy: Falsify| Spoiled { commit, energy, ..sound.clone() };
    let stiffer: Force = |f, h, _| ContactForce { force: f.force * (1.0 + h[0]), tangent: f.tangent * (1.0 + h[0]) };
    let sticky: Force = |f, h, a| ContactForce { force: if a == h[0] { 1.1 * f.force } else { f.force }, ..f };
    let largest: Commit = |h, alpha| h[0] = alpha.max(0.0);
    let lost: Falsify = |e, h| Energy { dissipated: h[0], ..e };
    let lent: Falsify = |e, h| Energy { stored: e.stored - 1e-3 * h[0], dissipated: 1e-3 * h[0] };
    for (says, law) in [
        ("without indentation", force(|f, _, a| ContactForce { force: if a < 0.0 { 1.0 } else { f.force }, ..f })),
        ("negative", force(|f, _, _| ContactForce { force: -f.force, ..f })),
        ("tangent", force(|f, _, _| ContactForce { tangent: 1.01 * f.tangent, ..f })),
        ("NaN", force(|f, _, a| if a.is_nan() { ContactForce::default() } else { f })),
        ("does not begin", Spoiled { branches: Branches { touch: 1e-3, ..branches }, ..sound.clone() }),
        ("largest indentation so far", Spoiled { branches: Branches { peak: Some(0.0), ..branches }, ..sound.clone() }),
        ("names no peak", Spoiled { commit: largest, ..force(stiffer) }),
        ("commit changes the force", Spoiled { commit: largest, ..force(sticky) }),
        ("but the work is", energy(|_, _| (), |e, _| Energy { stored: 1.001 * e.stored, ..e })),
        ("commit changes the energy", energy(|h, _| h[0] += 1e-8, lost)),
        ("fallen", energy(largest, lent)),
        ("jumps", force(|f, _, a| ContactForce { force: f.force + if a > 0.37 { 1e-3 } else { 0.0 }, ..f })),
        ("the force falls", force(|f, _, _| ContactForce { tangent: -f.tangent, ..f })),
    ] {
        let why = check_contact_law(&law, 1.0).unwrap_err();
        assert!(why.contains(says), "{says}: {why}");
    }
}

/// A law that leaves a dent, and gives back all or keeps its history to itself.
#[derive(Debug, Clone)]
struct Secretive {
    sound: Box<dyn ContactLaw>,
    own: Option<Arc<Mutex<ContactHistory>>>,
}

impl ContactLaw for Secretive {
    fn force(&self, h: &ContactHistory, alpha: f64) -> ContactForce {
        self.sound.force(&self.own.as_ref().map_or(*h, |own| *own.lock().unwrap()), alpha)
    }

    fn commit(&self, h: &mut ContactHistory, alpha: f64) {
        match &self.own {
            Some(own) => self.sound.commit(&mut own.lock().unwrap(), alpha),
            None => self.sound.commit(h, alpha),
        }
    }

    fn energy(&self, h: &ContactHistory, alpha: f64) -> Energy {
        if let Some(own) = &self.own {
            return self.sound.energy(&own.lock().unwrap(), alpha);
        }
        let Energy { stored, dissipated } = self.sound.energy(h, alpha);
        Energy { stored: stored + dissipated, dissipated: 0.0 }
    }

    fn branches(&self, h: &ContactHistory) -> Branches {
        self.sound.branches(&self.own.as_ref().map_or(*h, |own| *own.lock().unwrap()))
    }
}

#[test]
fn of_contact_laws_with_a_history() {
    let sound = sun_yang(2.0, 0.1, "unloading-curve");
    check_contact_law(&*sound, 1.0).unwrap();
    for (says, own) in [("stored without a force", None), ("remembers outside", Some(Arc::default()))] {
        let why = check_contact_law(&Secretive { sound: sound.clone(), own }, 1.0).unwrap_err();
        assert!(why.contains(says), "{says}: {why}");
    }
}

/// A sound scheme that something befalls after each step.
#[derive(Debug, Clone)]
struct Careless {
    sound: Box<dyn Integrator>,
    order: u32,
    limit: StepLimit,
    conserves: bool,
    deaf: bool,
    steps: f64,
    /// The step that it takes for one of dt, given the last that it took.
    step: fn(f64, f64) -> f64,
    last: f64,
    after: fn(f64, &mut State),
}

impl Integrator for Careless {
    fn order(&self) -> u32 {
        self.order
    }

    fn limit(&self) -> StepLimit {
        self.limit
    }

    fn conserves_energy(&self) -> bool {
        self.conserves
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        self.sound.start(sys, s)
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        self.sound.resume(sys);
    }

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        self.steps += 1.0;
        self.last = (self.step)(dt, self.last);
        let end = self.sound.step(sys, s, self.last);
        s.t += dt - self.last;
        (self.after)(self.steps, s);
        if self.deaf { Ok(()) } else { end }
    }
}

#[test]
fn of_integrators() {
    let sound = scheme("central-difference");
    let sound = Careless {
        order: 2,
        limit: sound.limit(),
        sound,
        conserves: false,
        deaf: false,
        steps: 0.0,
        step: |dt, _| dt,
        last: 0.0,
        after: |_, _| (),
    };
    check_integrator(&sound).unwrap();
    let why = check_integrator(&Careless { order: 3, ..sound.clone() }).unwrap_err();
    assert!(why.contains("where 3 is claimed"), "{why}");

    let after = |after: fn(f64, &mut State)| Careless { after, ..sound.clone() };
    for (says, scheme) in [
        ("unit amplitude grows", Careless { limit: StepLimit::None, ..sound.clone() }),
        // Stable at the limit, but not at a part of it.
        (
            "unit amplitude grows",
            Careless { step: |dt, _| if (1.4..=1.5).contains(&dt) { 2.1 } else { dt }, ..sound.clone() },
        ),
        ("unequal ones", Careless { step: |dt, last| if last > 0.0 { last } else { dt }, ..sound.clone() }),
        ("end at t", after(|_, s| s.t += 1e-6)),
        ("restarted", after(|step, s| s.v[0] += 1e-9 * step)),
        ("commit", after(|_, s| s.histories.contacts.iter_mut().for_each(|h| h[1] = 0.0))),
        ("elastic stop", after(|_, s| s.v[0] *= 1.0 - 1e-4 * s.histories.contacts.len() as f64)),
        ("claims to conserve", Careless { conserves: true, ..sound.clone() }),
        ("NaN gives Ok", Careless { deaf: true, ..sound.clone() }),
    ] {
        let why = check_integrator(&scheme).unwrap_err();
        assert!(why.contains(says), "{says}: {why}");
    }
}
