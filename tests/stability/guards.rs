//! Plug-ins that do what none should: a march must notice, soon, and say why.

use crate::case::{Case, Room};
use crate::support;
use fem::analyses::impact::{self, Outcome};
use fem::core::contact::{ContactForce, ContactHistory, ContactLaw};
use fem::core::energy::Energy;
use fem::core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo, Value};
use fem::core::structure::{SolveError, Structure};
use fem::core::time::{Integrator, SecondOrderSystem, State, StepError, StepLimit};
use fem::dynamics::guard::{Alarm, Guard};
use fem::dynamics::impact::{ImpactSystem, Impactor};
use fem::{Model, Registry, io::scene};
use std::num::NonZeroUsize;

pub(crate) fn cases() -> Vec<Case> {
    vec![
        Room::Guards.case(
            "faulty contact laws",
            "a force of NaN, of infinity, below zero; one that gives back a hundred times what it took",
            "runs not stopped with step, time, cause and remedy",
            0.0,
            laws,
        ),
        Room::Guards.case(
            "faulty integrators",
            "NaN in one unknown; gain and loss of 0.1 % of the velocities a step; rk4 that hides its limit, at 3 and 30 \
             times that limit; an impactor set into the plate, and one made too fast",
            "runs not stopped with step, time, cause and remedy",
            0.0,
            integrators,
        ),
        Room::Guards.case(
            "steps until a fault is seen",
            "all of the above whose fault shows at once",
            "steps from the fault to the stop",
            impact::BALANCE_EVERY as f64,
            delay,
        ),
        Room::Guards.case(
            "matrices that are not positive definite",
            "an oscillator under a ball, its stiffness or its mass times five factors from -0.1 to -1000",
            "marches not stopped by name",
            0.0,
            indefinite,
        ),
        Room::Guards.case(
            "sound marches",
            "two balls on an oscillator, the second later; Hertz and Sun-Yang contact; 1 mm/s to 100 m/s; every integrator, steps \
             from 0.01 to 10 us that change the energy by less than 9e-3",
            "marches stopped by mistake",
            0.0,
            sound,
        ),
    ]
}

fn hertz(k: f64) -> Box<dyn ContactLaw> {
    let params = Params::default()
        .with("k", Value::Quantity(k, Dimension::contact_stiffness(1.5)))
        .with("n", Value::Number(1.5));
    match Registry::standard().build(Kind::Contact, "hertz", &params) {
        Ok(Built::Contact(law)) => law,
        other => panic!("{other:?}"),
    }
}

fn sun_yang() -> Box<dyn ContactLaw> {
    let params = Params::default()
        .with("k", Value::Quantity(1e8, Dimension::contact_stiffness(1.5)))
        .with("critical", Value::Quantity(1e-5, Dimension::LENGTH));
    match Registry::standard().build(Kind::Contact, "sun-yang", &params) {
        Ok(Built::Contact(law)) => law,
        other => panic!("{other:?}"),
    }
}

fn integrator(name: &str) -> Box<dyn Integrator> {
    match Registry::standard().build(Kind::Integrator, name, &Params::default()) {
        Ok(Built::Integrator(integrator)) => integrator,
        other => panic!("{name}: {other:?}"),
    }
}

/// Hertz' law with a fault once the indentation has been more than a micrometre.
#[derive(Debug, Clone)]
struct Faulty {
    sound: Box<dyn ContactLaw>,
    fault: String,
}

const FAULTS: ParamInfo =
    ParamInfo::word("fault", "what goes wrong", &[("nan", ""), ("infinity", ""), ("pull", ""), ("gain", "")]);

impl Plugin for Faulty {
    const INFO: PluginInfo =
        PluginInfo { kind: Kind::Contact, name: "faulty", summary: "", source: "", params: &[FAULTS] };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let fault = params.word(&FAULTS)?.to_owned();
        Ok(Built::Contact(Box::new(Self { sound: hertz(3e9), fault })))
    }
}

impl ContactLaw for Faulty {
    fn force(&self, h: &ContactHistory, alpha: f64) -> ContactForce {
        let ContactForce { force, tangent } = self.sound.force(h, alpha);
        let force = match self.fault.as_str() {
            _ if alpha < 1e-6 && h[7] < 1e-6 => force,
            "nan" => f64::NAN,
            "infinity" => f64::INFINITY,
            "pull" => -force,
            _ if alpha < h[7] => 100.0 * force,
            _ => force,
        };
        ContactForce { force, tangent }
    }

    fn commit(&self, h: &mut ContactHistory, alpha: f64) {
        self.sound.commit(h, alpha);
        h[7] = h[7].max(alpha);
    }

    fn energy(&self, h: &ContactHistory, alpha: f64) -> Energy {
        self.sound.energy(h, alpha)
    }
}

/// A sound integrator with a fault from its tenth step on.
#[derive(Debug, Clone)]
struct Spoilt {
    sound: Box<dyn Integrator>,
    fault: String,
    step: u32,
}

const SPOILS: ParamInfo = ParamInfo::word(
    "fault",
    "what goes wrong",
    &[("nan", ""), ("gain", ""), ("loss", ""), ("deep", ""), ("fast", ""), ("no limit", "")],
);

impl Plugin for Spoilt {
    const INFO: PluginInfo =
        PluginInfo { kind: Kind::Integrator, name: "spoilt", summary: "", source: "", params: &[SPOILS] };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let fault = params.word(&SPOILS)?.to_owned();
        let sound: Box<dyn Integrator> = match fault.as_str() {
            "no limit" => integrator("rk4"),
            _ => integrator("newmark"),
        };
        Ok(Built::Integrator(Box::new(Self { sound, fault, step: 0 })))
    }
}

impl Integrator for Spoilt {
    fn order(&self) -> u32 {
        self.sound.order()
    }

    fn limit(&self) -> StepLimit {
        StepLimit::None
    }

    fn start(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State) -> Result<(), StepError> {
        self.sound.start(sys, s)
    }

    fn resume(&mut self, sys: &mut dyn SecondOrderSystem) {
        self.sound.resume(sys);
    }

    fn step(&mut self, sys: &mut dyn SecondOrderSystem, s: &mut State, dt: f64) -> Result<(), StepError> {
        self.sound.step(sys, s, dt)?;
        self.step += 1;
        let ball = s.u.len() - 1;
        match self.fault.as_str() {
            _ if self.step < 10 => {}
            "nan" => s.u[3] = f64::NAN,
            "gain" => s.v.iter_mut().for_each(|v| *v *= 1.001),
            "loss" => s.v.iter_mut().for_each(|v| *v *= 0.999),
            "deep" => s.u[ball] += 1e-2,
            "fast" => s.v[ball] = 1e3,
            _ => {}
        }
        Ok(())
    }
}

/// A march of a small plate whose scene is changed: what it found and its longest stable step.
///
/// Few rows are asked for: what is not looked at for the history must be looked at all the same.
fn march(from: &str, to: &str, step: f64) -> (Outcome, f64) {
    let end = format!("step = \"{:e} us\"\nend = \"{:e} us\"", step * 1e6, 200e6 * step);
    let case =
        support::strip().scene(from, to).scene("end = \"20 us\"", &end).append("[output]\nhistory_every = \"1 s\"\n");
    let path = case.folder().join(case.write());
    let registry = Registry::standard().with::<Faulty>().with::<Spoilt>();
    let model = Model::new(scene::read(&path).unwrap(), &registry).unwrap();
    let prepared = impact::prepare(&model, NonZeroUsize::MIN).unwrap();
    let longest = prepared.sizes.longest_step;
    (impact::march(prepared, |_| {}).unwrap(), longest)
}

const SUN_YANG: &str =
    "law = \"sun-yang\"\nk = \"1.07e5 N/mm^1.5\"\nn = 1.5\nm = 2.5\ncritical = \"0.08 mm\"\nbeta = 0.4\n";

fn with_law(fault: &str, step: f64) -> Option<String> {
    march(SUN_YANG, &format!("law = \"faulty\"\nfault = \"{fault}\"\n"), step).0.stopped
}

fn with_integrator(fault: &str, step: f64) -> Option<String> {
    let to = format!("[march]\nintegrator = {{ name = \"spoilt\", fault = \"{fault}\" }}");
    march("[march]", &to, step).0.stopped
}

/// Longest step of rk4.
fn limit() -> f64 {
    march("[march]", "[march]\nintegrator = \"rk4\"", 1e-9).1
}

/// How many do not say step, time, the cause that is expected, and the remedy.
fn silent(marches: &[(Option<String>, &str, &str)]) -> f64 {
    let silent = marches.iter().filter(|(stopped, cause, remedy)| {
        let said = stopped.as_deref().unwrap_or("nothing");
        let all = ["step ", "(t = ", cause, remedy].iter().all(|words| said.contains(words));
        if !all {
            eprintln!("instead of {cause:?} and {remedy:?}: {said}");
        }
        !all
    });
    silent.count() as f64
}

fn laws() -> f64 {
    silent(&[
        (with_law("nan", 1e-7), "not finite", "`march.step`"),
        (with_law("infinity", 1e-7), "not finite", "`march.step`"),
        (with_law("pull", 1e-7), "must not pull", "check_contact_law"),
        (with_law("gain", 5e-6), "energy has grown", "`march.step`"),
    ])
}

fn integrators() -> f64 {
    silent(&[
        (with_integrator("nan", 1e-7), "not a finite number", "`march.step`"),
        (with_integrator("gain", 1e-7), "energy has grown", "`march.step`"),
        (with_integrator("loss", 1e-7), "energy was lost", "`march.step`"),
        (with_integrator("no limit", 3.0 * limit()), "", "`march.step`"),
        (with_integrator("no limit", 30.0 * limit()), "", "`march.step`"),
        (with_integrator("deep", 1e-7), "contact of impactor 1", "`march.step`"),
        (with_integrator("fast", 1e-7), "impactor 1 moves", "`march.step`"),
    ])
}

fn delay() -> f64 {
    let faults = ["nan", "gain", "loss", "deep", "fast"];
    let steps = faults.map(|fault| {
        let said = with_integrator(fault, 1e-7).expect(fault);
        let step = said.strip_prefix("step ").and_then(|rest| rest.split_once(' '));
        step.map(|(step, _)| step.parse::<f64>().unwrap()).expect(&said) - 10.0
    });
    steps.into_iter().fold(0.0, f64::max)
}

/// `m ü + k u = f`.
#[derive(Debug, Clone, Copy)]
struct Oscillator {
    k: f64,
    m: f64,
}

impl Structure for Oscillator {
    fn ndof(&self) -> usize {
        1
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        y[0] += scale * self.k * x[0];
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        y[0] += scale * self.m * x[0];
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], _: usize) -> Result<(), SolveError> {
        x[0] /= self.k + shift * self.m;
        Ok(())
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        x[0] /= self.m;
        Ok(())
    }
}

/// Balls of 10 g on an oscillator, marched and guarded at every step up to the first alarm; the error of the energy.
fn guarded(
    on: Oscillator,
    balls: &[Impactor],
    mut integrator: Box<dyn Integrator>,
    dt: f64,
    steps: u32,
) -> (Result<(), Alarm>, f64) {
    let mut system = ImpactSystem::new(Box::new(on), balls.to_vec());
    let (guard, mut state, mut work) = (Guard::new(&mut system), system.initial(), Vec::new());
    integrator.start(&mut system, &mut state).unwrap();
    let mut error = 0.0_f64;
    for _ in 0..steps {
        integrator.step(&mut system, &mut state, dt).unwrap();
        let energies = system.energies(&state, &mut work);
        error = error.max((energies.total() / guard.energy() - 1.0).abs());
        let touches = (0..balls.len()).try_for_each(|i| guard.touch(i, system.touch(i, &state)));
        if let Err(alarm) = touches.and_then(|()| guard.balance(&energies)) {
            return (Err(alarm), error);
        }
    }
    (Ok(()), error)
}

fn ball(velocity: f64, start: f64, law: Box<dyn ContactLaw>) -> Impactor {
    Impactor { mass: 0.01, velocity, start, load: vec![(0, 1.0)], law }
}

fn indefinite() -> f64 {
    let factors = [-0.1, -0.3, -1.0, -10.0, -1e3];
    let wrong = factors.into_iter().flat_map(|factor| {
        let (k, m) = (1e6, 0.05);
        [("stiffness", Oscillator { k: factor * k, m }), ("mass", Oscillator { k, m: factor * m })]
    });
    let unseen = wrong.filter(|(name, on)| {
        let (seen, _) = guarded(*on, &[ball(3.0, 0.0, hertz(1e8))], integrator("newmark"), 1e-6, 100_000);
        let named = matches!(seen, Err(Alarm::Indefinite { matrix, .. }) if matrix == *name);
        if !named {
            eprintln!("{name} of {on:?}: {seen:?}");
        }
        !named
    });
    unseen.count() as f64
}

fn sound() -> f64 {
    let (mut judged, mut mistaken) = (0, 0);
    for info in Registry::standard().list(Kind::Integrator) {
        for (velocity, dissipates) in [1e-3, 3.0, 100.0].into_iter().flat_map(|v| [(v, false), (v, true)]) {
            let law = || if dissipates { sun_yang() } else { hertz(1e8) };
            let balls = [ball(velocity, 0.0, law()), ball(velocity, 3e-4, law())];
            for dt in [1e-8, 1e-7, 1e-6, 1e-5] {
                let on = Oscillator { k: 1e6, m: 0.05 };
                let (seen, error) = guarded(on, &balls, integrator(info.name), dt, (1e-3 / dt) as u32);
                judged += u32::from(error < 9e-3);
                if error < 9e-3 && seen.is_err() {
                    eprintln!("{} with {dt:e}, {velocity}: {seen:?} at {error:e}", info.name);
                    mistaken += 1;
                }
            }
        }
    }
    assert!(judged > 100, "{judged} marches are judged");
    f64::from(mistaken)
}
