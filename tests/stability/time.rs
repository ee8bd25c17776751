//! Steps at and beyond their limits, stiff and soft contact, long and short marches.

mod chatter;
mod conserving;
mod contact;
mod large;
mod marches;
mod plate;
mod steps;

use crate::case::Case;
use fem::Registry;
use fem::core::contact::ContactLaw;
use fem::core::plugin::{Built, Dimension, Kind, Params, Value};
use fem::core::time::{Integrator, State, StepError};
use fem::dynamics::impact::{ImpactSystem, Impactor};
use fem::dynamics::integrate::located;
use plate::Navier;

pub(crate) fn cases() -> Vec<Case> {
    [steps::cases(), contact::cases(), chatter::cases(), conserving::cases(), marches::cases(), large::cases()]
        .into_iter()
        .flatten()
        .collect()
}

/// The energy error at which a run stops.
const TOLERANCE: f64 = 1e-2;

fn integrator_with(name: &str, params: &Params) -> Box<dyn Integrator> {
    match Registry::standard().build(Kind::Integrator, name, params) {
        Ok(Built::Integrator(integrator)) => integrator,
        other => panic!("{name}: {other:?}"),
    }
}

/// As a run marches it.
fn integrator(name: &str) -> Box<dyn Integrator> {
    located(integrator_with(name, &Params::default()))
}

/// Every integrator of the registry, and those of Newmark's family that have a limit.
fn integrators() -> Vec<(String, Box<dyn Integrator>)> {
    let registry = Registry::standard();
    let names = registry.list(Kind::Integrator).map(|info| info.name);
    let mut all: Vec<_> = names.map(|name| (name.to_owned(), integrator(name))).collect();
    for beta in [0.1, 1.0 / 6.0] {
        let params = Params::default().with("beta", Value::Number(beta));
        all.push((format!("newmark of beta = {beta}"), integrator_with("newmark", &params)));
    }
    all
}

fn law(name: &str, params: &Params) -> Box<dyn ContactLaw> {
    match Registry::standard().build(Kind::Contact, name, params) {
        Ok(Built::Contact(law)) => law,
        other => panic!("{name}: {other:?}"),
    }
}

fn spring(k: f64) -> Box<dyn ContactLaw> {
    law("linear", &Params::default().with("k", Value::Quantity(k, Dimension::contact_stiffness(1.0))))
}

fn hertz(k: f64) -> Box<dyn ContactLaw> {
    law("hertz", &Params::default().with("k", Value::Quantity(k, Dimension::contact_stiffness(1.5))))
}

fn sun_yang(k: f64, critical: f64) -> Box<dyn ContactLaw> {
    let params = Params::default()
        .with("k", Value::Quantity(k, Dimension::contact_stiffness(1.5)))
        .with("critical", Value::Quantity(critical, Dimension::LENGTH));
    law("sun-yang", &params)
}

/// As [`sun_yang`], a second contact with the exponent of loading.
fn sun_yang_reloading(k: f64, critical: f64) -> Box<dyn ContactLaw> {
    let params = Params::default()
        .with("k", Value::Quantity(k, Dimension::contact_stiffness(1.5)))
        .with("critical", Value::Quantity(critical, Dimension::LENGTH))
        .with("reloading", Value::Text("loading-exponent".into()));
    law("sun-yang", &params)
}

fn limit(scheme: &dyn Integrator) -> Option<f64> {
    scheme.limit().product()
}

/// `plate` under masses that touch its middle at t = 0.
fn struck(plate: &Navier, masses: &[f64], velocity: f64, law: Box<dyn ContactLaw>) -> ImpactSystem {
    let impactor =
        |mass: &f64| Impactor { mass: *mass, velocity, start: 0.0, load: plate.load([0.5, 0.5]), law: law.clone() };
    ImpactSystem::new(Box::new(plate.clone()), masses.iter().map(impactor).collect())
}

/// What is seen of a march after every step.
#[derive(Debug, Default, Clone)]
struct Seen {
    /// Energy over that of the impact.
    energies: Vec<f64>,
    /// Contact force of the first impactor.
    forces: Vec<f64>,
    /// At the end.
    state: State,
}

impl Seen {
    fn imbalance(&self) -> f64 {
        largest(self.energies.iter().map(|energy| (energy - 1.0).abs()))
    }
}

fn march(mut scheme: Box<dyn Integrator>, system: &mut ImpactSystem, dt: f64, steps: usize) -> Result<Seen, StepError> {
    let mut state = system.initial();
    scheme.start(system, &mut state)?;
    let mut work = Vec::new();
    let start = system.energies(&state, &mut work).total();
    let mut seen = Seen::default();
    for _ in 0..steps {
        scheme.step(system, &mut state, dt)?;
        seen.energies.push(system.energies(&state, &mut work).total() / start);
        seen.forces.push(system.contact_force(0, &state));
    }
    Ok(Seen { state, ..seen })
}

/// The largest of some numbers, or NaN where one is.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |a, b| if b <= a { a } else { b })
}
