//! Long marches, and what must not change them.

use super::plate::{MASS, Navier, Units};
use super::{
    TOLERANCE, hertz, integrator, integrator_with, integrators, largest, limit, march, spring, struck, sun_yang,
};
use crate::case::{Case, Room};
use crate::support::strip;
use fem::core::plugin::{Dimension, Params, Value};
use fem::core::testkit::{Mode, Modes};
use fem::core::time::StepLimit;
use fem::dynamics::limit::longest_step;
use std::fs;

pub(super) fn cases() -> Vec<Case> {
    let case = |name, varied, measure, bound, worst| Case {
        room: Room::Time,
        name,
        varied,
        measure,
        bound,
        long: false,
        worst,
    };
    vec![
        Case {
            long: true,
            ..case(
                "a second at microsecond steps",
                "Newmark; Navier's plate of 25 modes under 1/100, 1 and 300 of its mass, which fly away after the contact",
                "drift of the energy after 1e5 of 1e6 steps, over that of the impact",
                1e-9,
                drift,
            )
        },
        case(
            "high modes under a stiff contact",
            "every integrator without a limit; one oscillator against a spring 0.01 to 100 times as stiff, omega dt = 0.5 to \
             73, 1e4 steps",
            "marches without an error whose energy stays within 1e-2 while it is not ...",
            0.0,
            high_modes,
        ),
        case(
            "units",
            "Newmark, HHT, generalized-alpha, rk4, central-difference, dormand-prince; units of mass 1e-9, 1e3, of length \
             1e-6, 1e3, of time 1e-6, 1e3 of SI; Hertz and Sun-Yang contact",
            "difference of the force over the largest, and of the longest step, relative",
            1e-9,
            units,
        ),
        case(
            "the same run",
            "`fem run` of a clamped strip with 1, 2, 4 threads, and once more",
            "files but cost.json that are not the same in every byte",
            0.0,
            same_bytes,
        ),
    ]
}

fn drift() -> f64 {
    let plate = Navier::new(5, Units::SI);
    largest([1e-2, 1.0, 300.0].map(|ratio| {
        let mut system = struck(&plate, &[ratio * MASS], 1.5, hertz(8e8));
        let seen = march(integrator("newmark"), &mut system, 1e-6, 1_000_000).unwrap();
        assert!(seen.forces[100_000..].iter().all(|force| *force == 0.0));
        eprintln!("imbalance {:e}", seen.imbalance());
        let after = &seen.energies[100_000..];
        largest(after.iter().map(|energy| (energy - after[0]).abs()))
    }))
}

fn high_modes() -> f64 {
    for (name, scheme) in integrators() {
        if limit(&*scheme).is_some() || name == "dormand-prince" {
            continue;
        }
        for kappa in [0.01, 0.1, 1.0, 10.0, 100.0] {
            let mut line = format!("{name} {kappa}:");
            for omega_dt in [0.1, 0.5, 1.0, 2.0, 3.0, 7.3, 10.0, 30.0, 73.0] {
                let mut system = Modes { contact: Some(spring(kappa)), ..Modes::free([Mode::new(1.0, 0.0)]) };
                let mut state = system.state();
                state.v[0] = 1.0;
                let mut scheme = scheme.clone();
                scheme.start(&mut system, &mut state).unwrap();
                let e = (0..100_000).map(|_| {
                    if scheme.step(&mut system, &mut state, omega_dt).is_err() {
                        return f64::INFINITY;
                    }
                    state.v[0].powi(2) + state.u[0].powi(2) + kappa * state.u[0].max(0.0).powi(2)
                });
                let (lo, hi) = e.fold((f64::MAX, 0.0), |(a, b): (f64, f64), e| (a.min(e), b.max(e)));
                line += &format!(" {omega_dt}: {lo:.1e} {hi:.1e};");
            }
            eprintln!("{line}");
        }
    }
    0.0
}

fn units() -> f64 {
    let mut worst = 0.0;
    for name in ["newmark", "hht-alpha", "generalized-alpha", "rk4", "central-difference", "dormand-prince"] {
        let forces = |units: Units, elastic: bool| {
            let Units { mass, length, time } = units;
            let k = 8e8 / (mass / length.sqrt() / (time * time));
            let law = if elastic { hertz(k) } else { sun_yang(k, 2e-5 / length) };
            let params = match name {
                "dormand-prince" => Params::default().with("atol", Value::Quantity(1e-12 / length, Dimension::LENGTH)),
                _ => Params::default(),
            };
            let mut system = struck(&Navier::new(5, units), &[MASS / mass], 2.0 * time / length, law);
            let (longest, _) = longest_step(&mut system, StepLimit::OmegaDt(1.0)).unwrap();
            let seen = march(integrator_with(name, &params), &mut system, 2e-7 / time, 2000).unwrap();
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
                eprintln!("{name} {elastic} {mass} {length} {time}: {off:e} {:e}", step / longest - 1.0);
                worst = largest([worst, off, (step / longest - 1.0).abs()]);
            }
        }
    }
    worst
}

fn same_bytes() -> f64 {
    let case = strip();
    let runs = [("1", "first"), ("1", "again"), ("2", "two"), ("4", "four")];
    let files = runs.map(|(threads, out)| {
        case.fem("run", &["--threads", threads, "--out", out]).good();
        let bytes = |name: String| {
            let bytes = fs::read(case.folder().join(out).join(&name)).unwrap();
            (name, bytes)
        };
        case.names(out).into_iter().filter(|name| name != "cost.json").map(bytes).collect::<Vec<_>>()
    });
    assert!(files[0].len() > 5 && files.iter().all(|run| run.len() == files[0].len()));
    files[1..].iter().flat_map(|run| run.iter().zip(&files[0])).filter(|(a, b)| a != b).count() as f64
}
