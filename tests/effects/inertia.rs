//! A plate without inertia: at rest under the contact forces at every instant.

use super::{Struck, deflection, difference, force};
use crate::support::{impact_of, read_under, root};
use fem::analyses::impact;
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Model, Registry, advise};
use std::f64::consts::PI;
use std::num::NonZeroUsize;

const OFF: &str = "inertia = 'off'";
const LINEAR: &str = "law = 'linear', k = '2e3 N/mm'";

/// A heavy mass, up to the end of its contact and beyond.
fn heavy(effects: &'static str) -> Struck {
    Struck {
        impactor: "mass = '2 kg', velocity = '0.5 m/s'",
        ..Struck::new(effects).march("integrator = 'newmark', step = '2 us', end = '20 ms'")
    }
}

/// The same history with other forces.
fn forces(history: &[HistoryRow], force: impl Fn(f64) -> f64) -> Vec<HistoryRow> {
    let mut history = history.to_vec();
    history.iter_mut().for_each(|row| row.impactors[0].contact_force_n = force(row.time_s));
    history
}

#[test]
fn contact_and_plate_are_two_springs_in_a_row() {
    let (sizes, outcome) = Struck { contact: LINEAR, ..heavy(OFF) }.run().unwrap();
    assert_eq!(sizes.marched, 1);
    let (m, v, contact, plate) = (2.0, 0.5, 2e6, sizes.static_stiffness);
    let k: f64 = contact * plate / (contact + plate);
    let omega = (k / m).sqrt();
    assert!((2e-3..18e-3).contains(&(PI / omega)), "{k:e} N/m");
    let half_sine = |t: f64| if omega * t < PI { v * (k * m).sqrt() * (omega * t).sin() } else { 0.0 };
    let found = difference(&outcome.history, &forces(&outcome.history, half_sine), force);
    assert!(found < 1e-5, "{found:e}");
    let static_deflection = outcome.history.iter().map(|row| deflection(row) - force(row) / plate);
    assert!(static_deflection.fold(0.0_f64, |m, w| m.max(w.abs())) < 1e-12);
    assert!(outcome.history.iter().all(|row| row.plate_kinetic_j == 0.0));
    assert!(outcome.energy_error < 1e-6, "{:e}", outcome.energy_error);
}

/// `m z̈ = −F`, α + F/K = z, F = k α^1.5, by the classical Runge-Kutta scheme.
#[test]
fn hertz_law_on_a_spring() {
    let (sizes, outcome) = heavy(OFF).run().unwrap();
    let (m, k) = (2.0, 1e4 * 1e3_f64.powf(1.5));
    let force_at = |z: f64| {
        let mut alpha = z.max(0.0);
        for _ in 0..60 {
            let residual = alpha + k * alpha.powf(1.5) / sizes.static_stiffness - z.max(0.0);
            alpha -= residual / (1.0 + 1.5 * k * alpha.sqrt() / sizes.static_stiffness);
        }
        k * alpha.max(0.0).powf(1.5)
    };
    let (dt, mut z, mut v, mut t) = (1e-6, 0.0, 0.5, 0.0);
    let mut all = vec![0.0];
    while t < 20e-3 - 0.5 * dt {
        let slope = |z: f64, v: f64| [v, -force_at(z) / m];
        let a = slope(z, v);
        let b = slope(z + 0.5 * dt * a[0], v + 0.5 * dt * a[1]);
        let c = slope(z + 0.5 * dt * b[0], v + 0.5 * dt * b[1]);
        let d = slope(z + dt * c[0], v + dt * c[1]);
        let mean = |i: usize| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0;
        (z, v, t) = (z + dt * mean(0), v + dt * mean(1), t + dt);
        all.push(force_at(z));
    }
    let other = forces(&outcome.history, |t| all[(t / dt).round() as usize]);
    let found = difference(&outcome.history, &other, force);
    assert!(found < 1e-5, "{found:e}");
    let end = outcome.history[outcome.history.len() - 1].impactors[0].impactor_velocity_m_s;
    assert!((end / v - 1.0).abs() < 1e-6, "{end} {v}");
}

#[test]
fn a_reduction_has_nothing_to_add() {
    let run = |reduction| Struck { reduction, ..heavy(OFF) }.run().unwrap();
    let (sizes, ritz) = run("method = 'ritz', vectors = 30");
    let (_, full) = run("method = 'none'");
    assert_eq!((sizes.marched, sizes.lowest_frequency), (1, None));
    assert_eq!(ritz.history, full.history);
    let inert = heavy("inertia = 'on'").outcome();
    assert!(full.counters.solves * 10 < inert.counters.solves, "{} solves", full.counters.solves);
}

#[test]
fn the_advisor_leaves_it_out_where_the_mass_is_large() {
    const AUTO: &str = "inertia = 'auto'";
    let decided = |struck: Struck| {
        let model = struck.model().unwrap();
        assert!(model.effects.undecided() && model.effects.nature().inertia);
        let model = advise::decided(model, NonZeroUsize::MIN).unwrap();
        (model.effects.nature().inertia, model.decisions[0].expected)
    };
    let heavier = |effects| Struck {
        impactor: "mass = '20 kg', velocity = '0.5 m/s'",
        ..heavy(effects).march("integrator = 'newmark', step = '4 us', end = '40 ms'")
    };
    let (inertia, error) = decided(heavier(AUTO));
    assert!(!inertia && error < 0.05, "{error}");
    let (on, off) = (heavier("inertia = 'on'").history(), heavier(OFF).history());
    let [on, off] = [on, off].map(|history| history.iter().map(force).fold(0.0, f64::max));
    assert!((off / on - 1.0).abs() < error, "{on} {off} {error}");
    assert!(decided(Struck::new(AUTO)).0 && decided(heavy(AUTO)).0);
    assert!(decided(heavier(AUTO).march("integrator = 'rk4', step = '10 ns', end = '1 us'")).0);
    let refused = impact::prepare(&heavy(AUTO).model().unwrap(), NonZeroUsize::MIN).unwrap_err();
    assert!(super::said(refused).contains("decided"));
}

#[test]
fn implicit_integrators_agree_and_others_are_refused() {
    let of = |integrator: &str, effects| {
        heavy(effects).march(&format!("integrator = '{integrator}', step = '2 us', end = '8 ms'"))
    };
    let fine = of("newmark", OFF).history();
    for integrator in ["hht-alpha", "generalized-alpha"] {
        let found = difference(&of(integrator, OFF).history(), &fine, force);
        assert!(found < 1e-4, "{integrator}: {found:e}");
    }
    for integrator in ["rk1", "rk4", "central-difference", "dormand-prince"] {
        of(integrator, OFF).refused(&[
            &format!("`{integrator}` needs the inverse of the mass matrix"),
            "choose an implicit integrator such as `newmark`, or leave `effects.inertia` out",
        ]);
    }
    let damped = of("newmark", "inertia = 'off', damping = { stiffness = '2e-5 s' }").outcome();
    assert!(damped.energy_error < 1e-3, "{:e}", damped.energy_error);
    assert!(difference(&damped.history, &fine, force) > 1e-3, "it is felt");
}

#[test]
fn several_impactors_bend_one_plate() {
    let several = heavy(OFF).text().replace(
        "impactor = { mass = '2 kg', velocity = '0.5 m/s', at = { x = '30 mm', y = '20 mm' } }",
        "impactor = [{ mass = '2 kg', velocity = '0.5 m/s', at = { x = '20 mm', y = '20 mm' } },\
         { mass = '1 kg', velocity = '0.5 m/s', start = '1 ms', at = { x = '40 mm', y = '20 mm' } }]",
    );
    let model = Model::new(scene::parse(&several, &root().join("scene.toml")).unwrap(), &Registry::standard()).unwrap();
    let prepared = impact::prepare(&model, NonZeroUsize::MIN).unwrap();
    assert_eq!(prepared.sizes.marched, 2);
    let outcome = impact::march(prepared, |_| {}).unwrap();
    assert!(outcome.stopped.is_none() && outcome.energy_error < 1e-3, "{:e}", outcome.energy_error);
    assert!((0..2).all(|i| outcome.contacts[i].count > 0));
}

#[test]
fn modes_cannot_be_followed() {
    Struck { more: "[output]\nmodes = 3\n", ..heavy(OFF) }.refused(&["without inertia has none", "leave one of"]);
}

/// A plate on rollers moves freely in its plane; halves and quarters of it do not. Without inertia nothing moves it.
#[test]
fn motions_in_the_plane_stay_where_they_are() {
    let run = |symmetry: &str| {
        let struck =
            heavy("inertia = 'off', membrane = 'on'").march("integrator = 'newmark', step = '20 us', end = '20 ms'");
        let text = struck.text().replace("['U10', 'U20', 'U30']", "['U30']");
        let text = format!("{symmetry}\n{text}[[support]]\nrestrain = 'rigid-motions'\n");
        let (_, found) = impact_of(scene::parse(&text, &root().join("scene.toml")).unwrap()).unwrap();
        assert!(found.outcome.stopped.is_none() && found.outcome.energy_error < 1e-3, "{:?}", found.outcome.stopped);
        found.outcome.history
    };
    let [whole, half, quarter] = ["", "symmetry = 'half-turn'", "symmetry = 'quarter'"].map(run);
    for part in [half, quarter] {
        let found = difference(&whole, &part, force);
        // As many vectors, but not the same.
        assert!(found < 1e-3, "{found:e}");
    }
    assert!(whole.iter().map(deflection).fold(0.0, f64::max) > 1e-3, "it is stretched");
}

/// 2.49 kg on a plate of some 10 g: the plate's inertia makes ripples on a half-sine.
#[test]
fn a_large_mass_needs_no_inertia_of_the_plate() {
    let run = |inertia: &str| {
        let setting = [
            ("effects.inertia", inertia),
            ("effects.damage", "\"off\""),
            ("march.step", "\"0.5 us\""),
            ("march.end", "\"10 ms\""),
            ("reduction.vectors", "30"),
        ];
        let setting = setting.into_iter().map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
        let path = root().join("examples/as4-3502-16ply-50mm/scene.toml");
        let model = Model::new(read_under(&path, &setting), &Registry::standard()).unwrap();
        let outcome = impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap();
        assert_eq!(outcome.stopped, None);
        outcome.history
    };
    let [inert, still] = ["\"on\"", "\"off\""].map(run);
    let peak = |history: &[HistoryRow]| history.iter().map(force).fold(0.0, f64::max);
    let peaks = peak(&still) / peak(&inert) - 1.0;
    // Afterwards the plate rings, or rests.
    let end = inert.iter().rposition(|row| force(row) > 0.0).unwrap();
    let f = difference(&still, &inert, force);
    let w = difference(&still[..end], &inert[..end], deflection);
    assert!(peaks.abs() < 0.02 && f < 0.03 && w < 0.03, "peak {peaks:e}, force {f:e}, deflection {w:e}");
}
