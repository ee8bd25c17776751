//! Steps at the limits of integrators, and beyond them.

use super::plate::{MASS, Navier, Units};
use super::{TOLERANCE, hertz, integrator, integrators, largest, limit, march, struck, sun_yang};
use crate::case::{Case, Room};
use crate::support::strip;
use fem::core::testkit::{Mode, Oscillators};
use fem::core::time::{Integrator, StepError};
use fem::dynamics::limit::longest_step;

/// Explicit schemes that no step of an undamped oscillator suits; their limit holds the growth of a step to 1e-6.
const GROWING: [&str; 2] = ["rk1", "rk2"];

pub(super) fn cases() -> Vec<Case> {
    vec![
        Room::Time.case(
            "just below the limit",
            "every integrator with a limit but rk1 and rk2, also newmark of beta = 1/6 and 0.1; one oscillator, 1e6 steps \
             of 0.999 of the limit that runs are held to",
            "largest energy of the second half of the march over that of the first, less 1",
            1e-9,
            below_the_limit,
        ),
        Room::Time.case(
            "about the limit of theory",
            "central-difference, rk3, rk4; one oscillator, 1e6 steps of 0.999 and 1.001 of 2, sqrt 3 and 2 sqrt 2 (the limits \
             that runs are held to are 0.9, 0.87 and 0.53 of these)",
            "schemes that grow below, or do not grow above",
            0.0,
            about_theory,
        ),
        Room::Time.case(
            "without a limit",
            "every integrator without; one oscillator, omega dt = 3, 100, 1e4; 2e5 steps, where these are divided, 6e4 radians",
            "largest energy of the second half of the march over that of the first, less 1",
            1e-9,
            without_a_limit,
        ),
        Room::Time.case(
            "schemes that grow at every step",
            "rk1, rk2; one oscillator, 1e4 steps of 0.999 of the limit",
            "amplitude at the end over that at the beginning, less 1 (over 1e6 steps it is e)",
            1.01e-2,
            growth_as_stated,
        ),
        Room::Time.case(
            "schemes that grow grow as they should",
            "rk1, rk2; one oscillator, 1e6 steps of 0.999 of the limit, against Taylor's series of exp(i omega dt)",
            "error of the logarithm of the amplitude, relative",
            1e-6,
            growth_of_theory,
        ),
        Room::Time.case(
            "plate and contact just below the limit",
            "every integrator with a limit but rk1 and rk2; Navier's plate of 25 modes under 1/100 and 10 of its mass, \
             elastic and dissipating contact; 4e4 steps of 0.999 of the longest",
            "largest energy of the second half of the march over that of the first, less 1",
            1e-3,
            plate_below_the_limit,
        ),
        Room::Time.case(
            "beyond the limit, by command",
            "`fem check --full` and `fem run` of a clamped strip; every integrator with a limit; 1.0001, 1.5 and 1000 of it",
            "commands that do not refuse with line, frequency and limit, or that leave results",
            0.0,
            refused,
        ),
        Room::Time.case(
            "beyond the limit, unchecked",
            "every integrator with a limit but rk1 and rk2; Navier's plate of 25 modes under its own mass; 4/3 to 1300 of \
             the longest step that a run with the plate alone is held to",
            "marches without an error whose energy error stays below 1e-2 while their force is off by more than 5 %",
            0.0,
            unchecked,
        ),
    ]
}

/// Integrators that have stable steps, with their limits.
fn limited() -> impl Iterator<Item = (String, Box<dyn Integrator>, f64)> {
    let all = integrators().into_iter().filter(|(name, _)| !GROWING.contains(&name.as_str()));
    all.filter_map(|(name, scheme)| limit(&*scheme).map(|limit| (name, scheme, limit)))
}

/// Largest energies of the two halves of 2 `half` steps of an oscillator that starts at unit energy.
fn halves(mut scheme: Box<dyn Integrator>, omega_dt: f64, half: usize) -> Result<[f64; 2], StepError> {
    let mut system = Oscillators::free([Mode::new(1.0, 0.0)]);
    let mut state = system.state();
    state.v[0] = 1.0;
    scheme.start(&mut system, &mut state)?;
    let mut largest = [0.0_f64; 2];
    for largest in &mut largest {
        for _ in 0..half {
            scheme.step(&mut system, &mut state, omega_dt)?;
            *largest = largest.max(state.u[0].powi(2) + state.v[0].powi(2));
        }
    }
    Ok(largest)
}

/// Without bound where the numbers end.
fn grown(scheme: Box<dyn Integrator>, omega_dt: f64, half: usize) -> f64 {
    halves(scheme, omega_dt, half).map_or(f64::INFINITY, |[first, second]| (second / first - 1.0).max(0.0))
}

fn below_the_limit() -> f64 {
    largest(limited().map(|(_, scheme, limit)| grown(scheme, 0.999 * limit, 500_000)))
}

/// Schemes with the ω Δt up to which an oscillator does not grow.
const THEORY: [(&str, f64); 3] = [("central-difference", 2.0), ("rk3", 1.732_050_8), ("rk4", 2.828_427_1)];

fn about_theory() -> f64 {
    let wrong = THEORY.map(|(name, limit)| {
        let [below, above] = [0.999, 1.001].map(|part| grown(integrator(name), part * limit, 500_000));
        u32::from(!(below < 1e-9)) + u32::from(!(above > 1.0))
    });
    f64::from(wrong.iter().sum::<u32>())
}

fn without_a_limit() -> f64 {
    let unlimited = integrators().into_iter().filter(|(_, scheme)| limit(&**scheme).is_none());
    largest(unlimited.flat_map(|(name, scheme)| {
        [3.0, 100.0, 1e4].map(|omega_dt| {
            let half = if name == "dormand-prince" { (3e4 / omega_dt) as usize } else { 100_000 };
            grown(scheme.clone(), omega_dt, half)
        })
    }))
}

/// Logarithm of the amplitude after `steps` of 0.999 of the limit, which is the part per step that Taylor's series of
/// exp(i omega dt) grows by, times the steps; and the same by theory.
fn amplitude(name: &str, steps: usize) -> [f64; 2] {
    let mut scheme = integrator(name);
    let x = 0.999 * limit(&*scheme).unwrap();
    let mut system = Oscillators::free([Mode::new(1.0, 0.0)]);
    let mut state = system.state();
    state.v[0] = 1.0;
    scheme.start(&mut system, &mut state).unwrap();
    for _ in 0..steps {
        scheme.step(&mut system, &mut state, x).unwrap();
    }
    // |1 + ix|² and |1 + ix − x²/2|².
    let square = if name == "rk1" { x * x } else { 0.25 * x.powi(4) };
    let measured = (state.u[0].powi(2) + state.v[0].powi(2)).ln();
    [0.5 * measured, 0.5 * steps as f64 * square.ln_1p()]
}

fn growth_as_stated() -> f64 {
    largest(GROWING.map(|name| amplitude(name, 10_000)[0].exp_m1()))
}

fn growth_of_theory() -> f64 {
    largest(GROWING.map(|name| {
        let [measured, theory] = amplitude(name, 1_000_000);
        (measured / theory - 1.0).abs()
    }))
}

fn plate_below_the_limit() -> f64 {
    let plate = Navier::new(5, Units::SI);
    largest(limited().flat_map(|(_, scheme, _)| {
        let errors = [1e-2, 10.0].into_iter().flat_map(|ratio| {
            [hertz(8e8), sun_yang(8e8, 2e-5)].map(|law| {
                let mut system = struck(&plate, &[ratio * MASS], 2.0, law);
                let (longest, _) = longest_step(&mut system, scheme.limit()).unwrap();
                let seen = march(scheme.clone(), &mut system, 0.999 * longest, 40_000).unwrap();
                let (first, second) = seen.energies.split_at(20_000);
                let [first, second] = [first, second].map(|half| largest(half.iter().copied()));
                (second / first - 1.0).max(0.0)
            })
        });
        errors.collect::<Vec<_>>()
    }))
}

fn refused() -> f64 {
    let schemes = ["rk1", "rk2", "rk3", "rk4", "central-difference", "{ name = \"newmark\", beta = 0.1 }"];
    let mut passed = 0;
    for scheme in schemes {
        let scheme = if scheme.starts_with('{') { scheme.to_owned() } else { format!("\"{scheme}\"") };
        let case = |step: f64| {
            let march = format!("[march]\nintegrator = {scheme}\nstep = \"{step:e} us\"");
            strip().scene("[march]", &march).scene("end = \"20 us\"", "end = \"1 ms\"")
        };
        let beyond = case(10.0).fem("check", &["--full"]).stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        let (_, limit) = beyond.split_once("stability limit of ").unwrap_or_else(|| panic!("{scheme}: {beyond}"));
        let limit: f64 = limit.split(' ').next().unwrap().parse().unwrap();
        for part in [1.0001, 1.5, 1e3] {
            // The limit is written with four digits.
            let case = case((limit + 5e-5) * part);
            for command in ["check", "run"] {
                let options: &[&str] = if command == "run" { &["--out", "out"] } else { &["--full"] };
                let done = case.fem(command, options);
                let said =
                    ["scene.toml:", "step =", "stability limit", "highest frequency of plate and contact", " Hz"];
                let named = said.iter().all(|words| done.stderr.contains(words));
                passed += u32::from(done.status == 0 || !named || !case.names("out").is_empty());
            }
        }
    }
    f64::from(passed)
}

fn unchecked() -> f64 {
    let plate = Navier::new(5, Units::SI);
    let system = || struck(&plate, &[MASS], 2.0, hertz(8e8));
    let (end, fine) = (4e-4, 2e-8);
    let reference = march(integrator("newmark"), &mut system(), fine, (end / fine) as usize).unwrap();
    let peak = largest(reference.forces.iter().copied());
    let mut plausible = 0;
    for (_, scheme, limit) in limited() {
        let omega = system().highest_frequency().unwrap();
        for beyond in [4.0 / 3.0, 1.6, 2.0, 2.7, 13.0, 1.3e3] {
            let dt = beyond * limit / omega;
            let Ok(seen) = march(scheme.clone(), &mut system(), dt, (end / dt) as usize + 1) else { continue };
            let at = |step: usize| {
                reference.forces[(((step + 1) as f64 * dt / fine) as usize).min(reference.forces.len() - 1)]
            };
            let off = seen.forces.iter().enumerate().map(|(step, force)| (force - at(step)).abs());
            plausible += u32::from(seen.imbalance() <= TOLERANCE && largest(off) > 0.05 * peak);
        }
    }
    f64::from(plausible)
}
