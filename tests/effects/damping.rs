//! Damping of the plate.

use super::{Struck, deflection, difference, force};
use crate::support::strip;

const RAYLEIGH: &str = "damping = { mass = '4000 1/s', stiffness = '5e-7 s' }";
const RATIO: &str = "damping = { ratio = 0.05 }";

#[test]
fn the_full_plate_and_all_its_modes_are_damped_alike() {
    let of = |reduction| Struck { reduction, ..Struck::new(RAYLEIGH) }.history();
    let [full, reduced] = ["method = 'none'", "method = 'modal', modes = 1000"].map(of);
    let [f, w] = [difference(&full, &reduced, force), difference(&full, &reduced, deflection)];
    assert!(f < 1e-6 && w < 1e-6, "{f:e} {w:e}");
    let free = Struck::new("").history();
    assert!(difference(&full, &free, deflection) > 1e-2, "it is felt");
}

/// Free vibration at equal times obeys C₊ − 2 e^(−ζωΔ) cos(ω_d Δ) C + e^(−2ζωΔ) C₋ = 0, ω_d = ω √(1 − ζ²).
#[test]
fn modes_of_a_plate_decay_once_it_is_left() {
    let struck = Struck {
        impactor: "mass = '1 g', velocity = '2 m/s'",
        more: "[output]\nmodes = 3\nhistory_every = '2 us'\n",
        ..Struck::new(RATIO).march("integrator = 'newmark', step = '0.1 us', end = '800 us'")
    };
    let outcome = struck.outcome();
    let modal = outcome.modal.unwrap();
    let left = outcome.history.iter().rposition(|row| force(row) > 0.0).unwrap() + 2;
    assert!(outcome.history.len() > left + 100, "it is left after {left} rows");
    for (i, mode) in modal.modes.iter().enumerate() {
        let c: Vec<f64> = modal.coordinates.chunks_exact(3).skip(left).map(|row| row[i]).collect();
        let (zeta, turn) = (0.05, std::f64::consts::TAU * mode.frequency_Hz * 2e-6);
        let (decay, cosine) = ((-zeta * turn).exp(), (turn * (1.0_f64 - zeta * zeta).sqrt()).cos());
        let largest = c.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        let left_over = c.windows(3).map(|c| (c[2] - 2.0 * decay * cosine * c[1] + decay * decay * c[0]).abs());
        let worst = left_over.fold(0.0, f64::max) / (largest * turn * turn);
        // A ratio that is wrong by 1 % leaves 1e-3.
        assert!(worst < 2e-4, "mode {i}: {worst:e}");
    }
}

#[test]
fn integrators_agree() {
    let of = |integrator: &str, effects| {
        let march = format!("integrator = '{integrator}', step = '0.05 us', end = '150 us'");
        Struck { reduction: "method = 'ritz', vectors = 12", ..Struck::new(effects).march(&march) }.history()
    };
    for effects in [RAYLEIGH, RATIO] {
        let fine = of("rk4", effects);
        for integrator in ["newmark", "central-difference", "generalized-alpha", "hht-alpha", "dormand-prince", "rk3"] {
            let history = of(integrator, effects);
            let [f, w] = [difference(&history, &fine, force), difference(&history, &fine, deflection)];
            assert!(f < 1e-4 && w < 1e-4, "{effects}, {integrator}: {f:e} {w:e}");
        }
    }
}

#[test]
fn what_is_lost_is_known() {
    for (effects, reduction) in [
        (RAYLEIGH, "method = 'none'"),
        (RAYLEIGH, "method = 'ritz'"),
        (RATIO, "method = 'ritz'"),
        (RATIO, "method = 'guyan'"),
    ] {
        let outcome = Struck { reduction, ..Struck::new(effects) }.outcome();
        let lost: Vec<f64> = outcome.history.iter().map(|row| row.effects[0]).collect();
        assert!(lost.windows(2).all(|w| w[0] <= w[1]) && lost[0] == 0.0);
        assert!(lost[lost.len() - 1] > 0.02 * 0.04, "{effects}: {:e} J", lost[lost.len() - 1]);
        assert!(outcome.energy_error < 1e-3, "{effects}, {reduction}: {:e}", outcome.energy_error);
    }
}

/// A damped plate tells the estimate of the reduction apart from what damping takes.
#[test]
fn the_reduction_is_judged_as_without() {
    let error = |effects| {
        let march = "integrator = 'newmark', step = '2 us', end = '100 us'";
        let (_, outcome) =
            Struck { reduction: "method = 'ritz', vectors = 20", ..Struck::new(effects).march(march) }.run().unwrap();
        outcome.accuracy.reduction.unwrap().residual.unwrap().energy
    };
    let [free, damped] = [error(""), error(RAYLEIGH)];
    assert!(damped < 1.5 * free, "{damped:e} {free:e}");
}

#[test]
fn stable_steps_know_of_it() {
    let step = |integrator: &str, effects| {
        let march = format!("integrator = '{integrator}', step = '1 ns', end = '2 ns'");
        let (sizes, _) =
            Struck { reduction: "method = 'ritz', vectors = 12", ..Struck::new(effects).march(&march) }.run().unwrap();
        (sizes.longest_step, std::f64::consts::TAU * sizes.highest_frequency.unwrap())
    };
    for integrator in ["rk4", "central-difference"] {
        let (free, omega) = step(integrator, "");
        let heavy = "damping = { stiffness = '2e-5 s' }";
        assert_eq!(step(integrator, RATIO).0, free, "{integrator}");
        // Of explicit damping the fastest motion decays with b omega^2.
        let bound = if integrator == "rk4" { 1.5 / (2e-5 * omega * omega) } else { free };
        assert!((step(integrator, heavy).0 / bound - 1.0).abs() < 1e-12, "{integrator}");
    }
    // At the limit it is stable, beyond it is refused.
    let at = |share: f64| {
        let effects = "damping = { stiffness = '2e-5 s' }";
        let step = share * step("rk4", effects).0;
        let march = format!("integrator = 'rk4', step = '{step:e} s', end = '{:e} s'", 3000.0 * step);
        Struck { reduction: "method = 'ritz', vectors = 12", ..Struck::new(effects).march(&march) }
    };
    assert!(at(1.0).outcome().energy_error < 1e-2);
    at(1.01).refused(&["stability limit", "shorten `march.step`"]);
}

#[test]
fn resumed_it_loses_the_same() {
    let until = |end: &str, damping: &str| {
        let scene = strip().scene("end = \"20 us\"", &format!("end = \"{end}\""));
        scene.append("[output]\nhistory_every = \"1 us\"\n[effects]\n").append(damping)
    };
    for damping in ["damping = { mass = \"400 1/s\", stiffness = \"2e-7 s\" }\n", "damping = { ratio = 0.05 }\n"] {
        let (short, long) = (until("20.5 us", damping), until("61.5 us", damping));
        long.fem("run", &["--out", "straight"]).good();
        short.fem("run", &["--out", "out"]).good();
        std::fs::rename(short.folder().join("out"), long.folder().join("out")).unwrap();
        long.fem("run", &["--out", "out", "--resume"]).good();
        assert_eq!(long.differing("straight", "out"), [""; 0]);
        let (header, rows) = long.table("out/history.csv");
        let column = header.iter().position(|name| name == "damping_dissipated_J").unwrap();
        assert!(rows[rows.len() - 1][column].parse::<f64>().unwrap() > 0.0);
    }
}

#[test]
fn refusals_help() {
    let of = |effects| Struck::new(effects);
    Struck { reduction: "method = 'none'", ..of(RATIO) }.refused(&[
        "damps the modes of a reduced plate",
        "name a reduction",
        "stiffness",
    ]);
    of("damping = { ratio = 2 }").refused(&["`effects.damping.ratio`: 2 is not a ratio", "ratio = 0.02"]);
    of("damping = { ratio = 0.02, mass = '30 1/s' }").refused(&["cannot be combined with `mass`"]);
    of("damping = {}").refused(&["does not say how much", "C = mass M + stiffness K"]);
    of("damping = { mass = '-3 1/s' }").refused(&["must be positive"]);
    of("damping = { mass = '3 s' }").refused(&["is a time, not a frequency"]);
    of("damping = 'on'").refused(&["`on` is not one of the", "off"]);
}
