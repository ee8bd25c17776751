//! Contact forces that are discrete gradients: energy whatever the step.

use super::contact::{K, sweep_of};
use super::plate::{MASS, Navier, Units};
use super::{hertz, integrator, largest, spring, sun_yang, sun_yang_reloading};
use crate::case::{Case, Room};
use crate::support::root;
use fem::Registry;
use fem::core::contact::ContactLaw;
use fem::core::testkit::{Mode, Oscillators};
use fem::core::time::State;
use fem::dynamics::impact::{ImpactSystem, Impactor, Weight};
use fem::dynamics::integrate::divided;
use fem::dynamics::limit::longest_step;
use fem::io::scene;
use fem::job::{self, Found, Options};
use std::f64::consts::PI;

pub(super) fn cases() -> Vec<Case> {
    let grown = "energy, the dissipated included, over that at the beginning, less 1";
    vec![
        Room::Time.case(
            "energy-conserving: stiff and soft contact",
            "the sweep of stiff and soft contact with undivided steps",
            "energy error over that of the impact",
            1e-9,
            stiff_and_soft,
        ),
        Room::Time.case(
            "energy-conserving: steps too long for the contact",
            "runs of a plate in shells; a mass of 0.1 g to 0.2 kg, steps of 1 to 200 us",
            "runs without a warning of their step whose force is off by more than 30 % (L2)",
            0.0,
            unseen,
        ),
        Room::Time.case(
            "divided steps: force",
            "newmark, energy-conserving, rk4; tolerance 1e-3, steps of a fiftieth of the lowest period or within the limit; Navier's \
             plate of 25 modes under 1/100, 1 and 100 of its mass; Hertz and Sun-Yang contact, K of a steel tip times 1e-2, 1; half a \
             period",
            "error of the force (L2), against rk4 at short steps",
            3e-3,
            || divided_steps(&[1e-2, 1.0]),
        ),
        Room::Time.case(
            "divided steps: force that chatters",
            "the same; K times 1e2, where errors grow from contact to contact",
            "error of the force (L2), against rk4 at short steps",
            0.03,
            || divided_steps(&[1e2]),
        ),
        Room::Time.case(
            "energy-conserving: chatter",
            "a plate of 9 modes under one and two impactors that their weight presses on; spring, Hertz' and Sun and Yang's \
             contact with both ways of reloading; omega dt of 0.1, 1 and 100, omega with the contact; 5000 steps",
            grown,
            1e-10,
            || largest(PARTS.map(|part| largest(laws(K).map(|law| largest(PLACES.map(|at| of_plate(law.clone(), at, part, 5000))))))),
        ),
        Room::Time
            .case(
                "energy-conserving: a million steps",
                "a mode that bounces on a spring, on Hertz' and on Sun and Yang's contact; a plate of 9 modes under an impactor with \
                 Sun and Yang's contact; omega dt of 0.1, 1 and 100; 1e6 steps",
                grown,
                1e-9,
                || {
                    let law = sun_yang_reloading(K, 2e-5);
                    largest(PARTS.map(|part| largest([of_mode(part), of_plate(law.clone(), PLACES[0], part, MILLION)])))
                },
            )
            .long(),
    ]
}

const NAME: &str = "energy-conserving";

/// Forces of a run every 10 us, and whether it warns of its step.
fn run(grams: f64, step_us: f64) -> (Vec<f64>, bool) {
    let edge = |side: &str| format!("[[support]]\ngroup = '{side}'\nat = 'all'\nfix = ['U10', 'U20', 'U30']\n");
    let text = format!(
        "title = 'long steps'\nmesh = {{ rectangle = ['60 mm', '40 mm'], cells = [12, 8] }}\nelement = {{ kind = 'mitc4' }}\n\
         impactor = {{ mass = '{grams} g', velocity = '1 m/s', patch_radius = '4 mm', at = {{ x = '30 mm', y = '20 mm' }} }}\n\
         contact = {{ law = 'hertz', k = '1e4 N/mm^1.5' }}\neffects = {{ damage = 'off' }}\n\
         reduction = {{ method = 'ritz', vectors = 30 }}\noutput = {{ plots = false, history_every = '200 us' }}\n\
         march = {{ integrator = '{NAME}', step = '{step_us} us', end = '4 ms' }}\n\
         laminate = {{ plies = '[0/90]s', material = 'tape', ply_thickness = '0.25 mm', layers = 1 }}\n\
         [materials.tape]\nlibrary = 'AS4/3502'\n{}",
        ["x-min", "x-max", "y-min", "y-max"].map(edge).concat()
    );
    let scene = scene::parse(&text, &root().join("scene.toml")).unwrap();
    let finished = job::run(&scene, &Registry::standard(), &Options::default(), &mut ()).unwrap();
    let Found::Impact(found) = finished.found else { panic!("an impact") };
    assert!(found.outcome.stopped.is_none() && found.outcome.energy_error < 1e-9);
    let forces = &found.outcome.forces;
    let forces = (1..=400).map(|k| forces.at(1e-5 * f64::from(k))).collect();
    (forces, found.summary.warnings.iter().any(|warning| warning.contains("`march.step`")))
}

fn unseen() -> f64 {
    let mut unseen = 0;
    for grams in [0.1, 2.0, 20.0, 200.0] {
        let (fine, _) = run(grams, 0.2);
        let off = |forces: &[f64]| {
            let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|f| f * f).sum::<f64>().sqrt();
            norm(&mut forces.iter().zip(&fine).map(|(a, b)| a - b)) / norm(&mut fine.iter().copied())
        };
        for step in [1.0, 10.0, 20.0, 50.0, 100.0, 200.0] {
            let (forces, warned) = run(grams, step);
            unseen += u32::from(!warned && !(off(&forces) <= 0.3));
        }
    }
    f64::from(unseen)
}

fn stiff_and_soft() -> f64 {
    let mut worst = 0.0;
    sweep_of(|system, dt, steps| {
        let seen = super::march(integrator(NAME), system, dt, steps).unwrap();
        assert!(seen.forces.iter().all(|force| *force >= 0.0));
        worst = largest([worst, seen.imbalance()]);
    });
    worst
}

fn divided_steps(stiffer: &[f64]) -> f64 {
    let plate = Navier::new(5, Units::SI);
    let mut worst = 0.0;
    for ratio in [1e-2, 1.0, 100.0] {
        for law in stiffer.iter().flat_map(|stiffer| [hertz(stiffer * K), sun_yang(stiffer * K, 2e-5)]) {
            let system = || super::struck(&plate, &[ratio * MASS], 2.0, law.clone());
            let (longest, _) = longest_step(&mut system(), integrator("rk4").limit()).unwrap();
            let dt = 2.0 * PI / plate.lowest() / 50.0;
            let parts = (dt / (0.2 * longest)).ceil();
            let exact = super::march(integrator("rk4"), &mut system(), dt / parts, 25 * parts as usize).unwrap();
            for name in ["newmark", NAME, "rk4"] {
                // Whole steps within the limit.
                let stride = if name == "rk4" { 4.min(parts as usize) } else { parts as usize };
                let steps = 25 * parts as usize / stride;
                let scheme = divided(integrator(name), 1e-3);
                let seen = super::march(scheme, &mut system(), stride as f64 * dt / parts, steps).unwrap();
                let at = |k: usize| exact.forces[(k + 1) * stride - 1];
                let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|f| f * f).sum::<f64>().sqrt();
                let off = norm(&mut seen.forces.iter().enumerate().map(|(k, force)| force - at(k)));
                worst = largest([worst, off / norm(&mut (0..steps).map(at))]);
            }
        }
    }
    worst
}

/// ω Δt.
const PARTS: [f64; 3] = [0.1, 1.0, 100.0];
const MILLION: usize = 1_000_000;
/// Where impactors strike.
const PLACES: [&[[f64; 2]]; 2] = [&[[0.5, 0.5]], &[[0.5, 0.5], [0.51, 0.5]]];

fn laws(k: f64) -> [Box<dyn ContactLaw>; 4] {
    [spring(k), hertz(k), sun_yang(k, 2e-5), sun_yang_reloading(k, 2e-5)]
}

/// A mode that rests on a contact and is hit.
fn of_mode(omega_dt: f64) -> f64 {
    largest([spring(10.0), hertz(10.0), sun_yang(10.0, 0.1)].map(|law| {
        let mut system = Oscillators { contact: Some(law), ..Oscillators::free([Mode::new(1.0, 0.0)]) };
        let mut scheme = integrator(NAME);
        let mut state = State { v: vec![1.0], ..system.state() };
        scheme.start(&mut system, &mut state).unwrap();
        let dt = omega_dt / 11.0_f64.sqrt();
        largest((0..MILLION).map(|_| {
            scheme.step(&mut system, &mut state, dt).unwrap();
            (system.energy(&state) / 0.5 - 1.0).max(0.0)
        }))
    }))
}

fn of_plate(law: Box<dyn ContactLaw>, places: &[[f64; 2]], omega_dt: f64, steps: usize) -> f64 {
    let plate = Navier::new(3, Units::SI);
    let impactor =
        |at: &[f64; 2]| Impactor { mass: MASS, velocity: 2.0, start: 0.0, load: plate.load(*at), law: law.clone() };
    // So heavy that they come back before the lowest mode has swung four times.
    let weight = Weight { acceleration: plate.lowest() / PI, load: vec![0.0; 9], sag: 0.0 };
    let mut system =
        ImpactSystem::new(Box::new(plate.clone()), places.iter().map(impactor).collect()).with_weight(Some(weight));
    let dt = omega_dt / system.frequency_bound(plate.highest()).unwrap();
    let mut scheme = integrator(NAME);
    let mut state = system.initial();
    scheme.start(&mut system, &mut state).unwrap();
    let mut work = Vec::new();
    let start = system.energies(&state, &mut work).total();
    let (mut contacts, mut touching, mut worst) = (0_u32, false, 0.0);
    for _ in 0..steps {
        scheme.step(&mut system, &mut state, dt).unwrap();
        let force = system.contact_force(0, &state);
        assert!(force >= 0.0);
        contacts += u32::from(force > 0.0 && !touching);
        touching = force > 0.0;
        let energy = system.energies(&state, &mut work).total();
        worst = largest([worst, (energy / start - 1.0).max(0.0)]);
    }
    assert!(contacts > 1, "{contacts} contacts in {steps} steps of {omega_dt}");
    worst
}
