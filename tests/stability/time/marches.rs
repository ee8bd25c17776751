//! Long marches, and what must not change them.

use super::plate::{MASS, Navier, Units};
use super::{hertz, integrator, largest, march, spring, struck, sun_yang};
use crate::case::{Case, Room};
use crate::support::{Case as Scene, strip};
use fem::core::testkit::{Mode, Oscillators};
use fem::core::time::{State, StepLimit};
use fem::dynamics::limit::longest_step;
use std::f64::consts::PI;
use std::fs;

pub(super) fn cases() -> Vec<Case> {
    vec![
        Room::Time.case(
                "a second at microsecond steps",
                "Newmark; Navier's plate of 25 modes under 1/100, 1 and 300 of its mass, which fly away after the contact",
                "drift of the energy after 1e5 of 1e6 steps, over that of the impact",
                1e-10,
                || struck_once(1e-6, 1_000_000, |e| largest(e[100_000..].iter().map(|energy| (energy - e[100_000]).abs()))),
            ).long(),
        Room::Time
            .case(
                "a tenth of a second, contact and all",
                "the same impacts; 4e5 steps of a quarter of a microsecond",
                "energy error over that of the impact",
                1e-3,
                || struck_once(2.5e-7, 400_000, |e| largest(e.iter().map(|energy| (energy - 1.0).abs()))),
            )
            .long(),
        Room::Time.case(
            "high modes on a spring that stays pressed",
            "Newmark, HHT, generalized-alpha; spring 0.01 to 100 times as stiff as the mode, omega dt = 0.5 to 73, 1e5 steps \
             (exact modes with a contact force that is linear within the step blow up from omega dt = 3.1 to 0.35 on)",
            "largest energy of the second half of the march over that of the first, less 1",
            1e-9,
            pressed,
        ),
        Room::Time.case(
            "one mode bouncing on a spring",
            "Newmark, HHT, generalized-alpha; spring 0.01 to 100 times as stiff as the mode; 40 steps from 0.01 to 0.1 of \
             1/omega with the spring; 200 radians of the mode",
            "growth of the energy per bounce, relative",
            1e-3,
            bouncing,
        ),
        Room::Time.case(
            "units",
            "Newmark, HHT, generalized-alpha, rk4, central-difference, dormand-prince; units of mass 1e-9, 1e3, of length \
             1e-6, 1e3, of time 1e-6, 1e3 of SI; Hertz and Sun-Yang contact",
            "difference of the force over the largest, and of the longest step, relative",
            1e-9,
            units,
        ),
        Room::Time.case(
            "impacts without an impact",
            "`fem check` and `fem run` of a clamped strip; mass, velocity, start, step and end that are zero, negative, not \
             finite, denormal or out of the march",
            "scenes that are not refused with their line and a remedy",
            0.0,
            none,
        ),
        Room::Time.case(
            "the same run",
            "`fem run` of a clamped strip with 1, 2, 4 threads, and once more; by default and in divided steps of energy-conserving",
            "files but cost.json that are not the same in every byte",
            0.0,
            same_bytes,
        ),
    ]
}

/// The worst of what `of` makes of the energies of impacts that end within a tenth of a second.
fn struck_once(dt: f64, steps: usize, of: fn(&[f64]) -> f64) -> f64 {
    let plate = Navier::new(5, Units::SI);
    largest([1e-2, 1.0, 300.0].map(|ratio| {
        let mut system = struck(&plate, &[ratio * MASS], 1.5, hertz(8e8));
        let seen = march(integrator("newmark"), &mut system, dt, steps).unwrap();
        assert!(seen.forces[(0.0999 / dt) as usize..].iter().all(|force| *force == 0.0));
        of(&seen.energies)
    }))
}

/// Largest energy of an oscillator that `step` moves `steps` times, over that at the beginning.
fn largest_energy(energy: impl Fn([f64; 2]) -> f64, steps: usize, mut step: impl FnMut([f64; 2]) -> [f64; 2]) -> f64 {
    let mut state = [0.0, 1.0];
    largest((0..steps).map(|_| {
        state = step(state);
        energy(state)
    }))
}

/// An oscillator of unit mass and stiffness on a spring, moved by the exact solution for a force that is linear in time,
/// which the spring's is taken to be. As the force depends on its own end, a step is implicit.
fn exact(kappa: f64, dt: f64) -> impl FnMut([f64; 2]) -> [f64; 2] {
    let (sin, cos) = dt.sin_cos();
    move |[u, v]| {
        let before = -kappa * u;
        let end = |after: f64| {
            let slope = (after - before) / dt;
            let (u, v) = (u - before, v - slope);
            [u * cos + v * sin + after, v * cos - u * sin + slope]
        };
        let [free, _] = end(0.0);
        end(-kappa * free / (1.0 + kappa * (1.0 - sin / dt)))
    }
}

/// Stiffness of the spring over that of the mode, and omega dt from which on exact modes blow up.
const LIMITS: [(f64, f64); 5] = [(0.01, 3.129), (0.1, 3.022), (1.0, 2.332), (10.0, 1.036), (100.0, 0.345)];

fn pressed() -> f64 {
    let mut worst = 0.0;
    for (kappa, limit) in LIMITS {
        let exact =
            |part: f64| largest_energy(|[u, v]| v * v + (1.0 + kappa) * u * u, 20_000, exact(kappa, part * limit));
        let [below, beyond] = [0.995, 1.003].map(exact);
        assert!(below < 1e3 && !(beyond <= 1e6), "{kappa}: {below:e} {beyond:e}");
        for name in ["newmark", "hht-alpha", "generalized-alpha"] {
            for omega_dt in [0.5, 1.0, 3.0, 7.3, 30.0, 73.0] {
                let contact = Some(spring(kappa));
                let mut system = Oscillators { contact, load: |_, _| 1.0, modes: vec![Mode::new(1.0, 0.0)] };
                let rest = 1.0 / (1.0 + kappa);
                let mut state = State { u: vec![0.9 * rest], ..system.state() };
                let mut scheme = integrator(name);
                scheme.start(&mut system, &mut state).unwrap();
                let energy = |[u, v]: [f64; 2]| v * v + (1.0 + kappa) * (u - rest) * (u - rest);
                let [first, second] = [(); 2].map(|()| {
                    largest_energy(energy, 50_000, |_| {
                        scheme.step(&mut system, &mut state, omega_dt).unwrap();
                        assert!(state.u[0] > 0.0);
                        [state.u[0], state.v[0]]
                    })
                });
                worst = largest([worst, (second - first).max(0.0) / energy([0.9 * rest, 0.0])]);
            }
        }
    }
    worst
}

fn bouncing() -> f64 {
    let mut worst = 0.0;
    for name in ["newmark", "hht-alpha", "generalized-alpha"] {
        for kappa in [0.01, 0.1, 1.0, 10.0, 100.0_f64] {
            for part in 1..=40 {
                let dt = 0.0025 * f64::from(part) / (1.0 + kappa).sqrt();
                let mut system =
                    Oscillators { contact: Some(spring(kappa)), ..Oscillators::free([Mode::new(1.0, 0.0)]) };
                let mut state = system.state();
                state.v[0] = 1.0;
                let mut scheme = integrator(name);
                scheme.start(&mut system, &mut state).unwrap();
                let energy = |[u, v]: [f64; 2]| v * v + u * u + kappa * u.max(0.0).powi(2);
                let grown = largest_energy(energy, (200.0 / dt) as usize, |_| {
                    scheme.step(&mut system, &mut state, dt).unwrap();
                    [state.u[0], state.v[0]]
                });
                let bounces = 200.0 / (PI + PI / (1.0 + kappa).sqrt());
                let grown = (grown - 1.0).max(0.0) / bounces;
                worst = largest([worst, grown]);
            }
        }
    }
    worst
}

fn units() -> f64 {
    let mut worst = 0.0;
    for name in ["newmark", "hht-alpha", "generalized-alpha", "rk4", "central-difference", "dormand-prince"] {
        let forces = |units: Units, elastic: bool| {
            let Units { mass, length, time } = units;
            let k = 8e8 / (mass / length.sqrt() / (time * time));
            let law = if elastic { hertz(k) } else { sun_yang(k, 2e-5 / length) };
            let mut system = struck(&Navier::new(5, units), &[MASS / mass], 2.0 * time / length, law);
            let (longest, _) = longest_step(&mut system, StepLimit::OmegaDt(1.0)).unwrap();
            let seen = march(integrator(name), &mut system, 2e-7 / time, 2000).unwrap();
            let force = mass * length / (time * time);
            (longest * time, seen.forces.into_iter().map(|f| f * force).collect::<Vec<_>>())
        };
        for elastic in [true, false] {
            let (longest, reference) = forces(Units::SI, elastic);
            let peak = largest(reference.iter().copied());
            for [mass, length, time] in [
                [1e-9, 1.0, 1.0],
                [1e3, 1.0, 1.0],
                [1.0, 1e-6, 1.0],
                [1.0, 1e3, 1.0],
                [1.0, 1.0, 1e-6],
                [1.0, 1.0, 1e3],
                [1e-9, 1e-6, 1e-6],
                [1e3, 1e3, 1e3],
            ] {
                let (step, forces) = forces(Units { mass, length, time }, elastic);
                let off = largest(forces.iter().zip(&reference).map(|(a, b)| (a - b).abs())) / peak;
                worst = largest([worst, off, (step / longest - 1.0).abs()]);
            }
        }
    }
    worst
}

fn same_bytes() -> f64 {
    let divided = "[march]\nintegrator = \"energy-conserving\"\nstep = \"2 us\"\ntolerance = 1e-3";
    [strip(), strip().scene("[march]", divided)].iter().map(different_files).sum::<usize>() as f64
}

fn different_files(case: &Scene) -> usize {
    let runs = [("1", "first"), ("1", "again"), ("2", "two"), ("4", "four")];
    let files = runs.map(|(threads, out)| {
        case.fem("run", &["--threads", threads, "--out", out]).good();
        let bytes = |name: String| {
            let bytes = fs::read(case.folder().join(out).join(&name)).unwrap();
            (name, bytes)
        };
        case.names(out)
            .into_iter()
            .filter(|name| !["cost.json", ".fem"].contains(&name.as_str()))
            .map(bytes)
            .collect::<Vec<_>>()
    });
    assert!(files[0].len() > 5 && files.iter().all(|run| run.len() == files[0].len()));
    files[1..].iter().flat_map(|run| run.iter().zip(&files[0])).filter(|(a, b)| a != b).count()
}

fn none() -> f64 {
    let velocity = "velocity = \"1.56 m/s\"";
    let velocities = ["0 m/s", "-1.56 m/s", "nan m/s", "inf m/s", "1e-200 m/s", "1e200 m/s", "1e-320 m/s"];
    let masses = ["0 kg", "-1 kg", "nan kg", "inf kg", "1e-320 kg"];
    // A start before t = 0 would be a penetration at the beginning.
    let starts = ["-1 us", "nan us", "inf us", "20 us", "1 s"];
    let steps = ["0 us", "-1 us", "nan us", "inf us", "1e-18 us", "21 us"];
    let ends = ["0 us", "-20 us", "nan us", "inf us", "1e9 s"];
    let mass = "mass = \"2.49 kg\"";
    let keys: [(_, &[&str], &str, &str); 5] = [
        ("velocity", &velocities, velocity, ""),
        ("mass", &masses, mass, ""),
        ("start", &starts, mass, mass),
        ("step", &steps, "[march]", "[march]"),
        ("end", &ends, "end = \"20 us\"", ""),
    ];
    let each = |(key, values, from, before): &(&str, &[&str], &str, &str)| {
        let scene = |value| (strip().scene(from, &format!("{before}\n{key} = \"{value}\"")), format!("{key} ="));
        values.iter().map(scene).collect::<Vec<_>>()
    };
    let mut passed = 0;
    for (case, line) in keys.iter().flat_map(each) {
        for command in ["check", "run"] {
            let done = case.fem(command, &[]);
            let named = ["scene.toml:", &line, "help:"].iter().all(|words| done.stderr.contains(words));
            passed += u32::from(done.status == 0 || !named);
        }
    }
    f64::from(passed)
}
