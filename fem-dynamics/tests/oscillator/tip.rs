//! Spherical tips, against Hertz' equations for two bent surfaces.

use crate::{hertz, law, scheme, stiffness, sun_yang};
use fem_core::contact::ContactLaw;
use fem_core::plugin::Value;
use fem_core::structure::{SolveError, Structure};
use fem_dynamics::contact::{Linear, YigitChristoforou};
use fem_dynamics::impact::{ImpactSystem, Impactor, Tip};

const TIP: f64 = 8e-3;
const K: f64 = 9.7e8;

/// A surface w − r² b/2 on a spring; b is so heavy that it stays what it is.
#[derive(Debug, Clone)]
struct Bent;

const SPRING: f64 = 2e6;
const MASSES: [f64; 2] = [0.02, 1e6];

impl Structure for Bent {
    fn ndof(&self) -> usize {
        2
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        y[0] += scale * SPRING * x[0];
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        (0..2).for_each(|i| y[i] += scale * MASSES[i] * x[i]);
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        for x in x.chunks_exact_mut(2).take(columns) {
            x[0] /= SPRING + shift * MASSES[0];
            x[1] /= shift * MASSES[1];
        }
        Ok(())
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        (0..2).for_each(|i| x[i] /= MASSES[i]);
        Ok(())
    }
}

/// One step of an impact: approach of the centres, curvature of the surface, force, radius, energy.
struct Seen {
    alpha: f64,
    curvature: f64,
    force: f64,
    radius: f64,
    dent: f64,
    energy: f64,
}

/// 2 kg at 2 m/s on a surface of curvature `bent`, 1/m, with the tip or with a contact at the centre, up to `end` in steps of `dt`, s.
fn impact(bent: f64, law: Box<dyn ContactLaw>, tip: bool, (dt, end): (f64, f64)) -> Vec<Seen> {
    let rings = Tip::radii(TIP).map(|[a, b]| vec![(0, 1.0), (1, -0.25 * (a * a + b * b))]).collect();
    let tips = vec![tip.then(|| Tip::new(TIP, rings))];
    let impactor = Impactor { mass: 2.0, velocity: 2.0, start: 0.0, load: vec![(0, 1.0)], law };
    let mut system = ImpactSystem::new(Box::new(Bent), vec![impactor]).with_tips(tips);
    let (mut state, mut newmark) = (system.initial(), scheme("newmark-average"));
    state.u[1] = bent;
    newmark.start(&mut system, &mut state).unwrap();
    let mut see = || {
        newmark.step(&mut system, &mut state, dt).unwrap();
        let touch = system.touch(0, &state);
        let energy = system.energies(&state, &mut Vec::new()).total();
        let [alpha, curvature] = [state.u[2] - state.u[0], state.u[1]];
        Seen { alpha, curvature, force: touch.force, radius: touch.radius, dent: system.dent(0, &state), energy }
    };
    (0..(end / dt).round() as usize).map(|_| see()).collect()
}

fn largest(seen: &[Seen], what: impl Fn(&Seen) -> f64) -> f64 {
    seen.iter().fold(0.0_f64, |m, s| m.max(what(s)))
}

/// Of a surface that is bent round the tip, by up to half of its curvature, or away from it: with 1/R' = 1/R - 1/rho the approach is
/// that of the bed under R' and of the other half under R. Hertz has k sqrt(R'/R) alpha^1.5 and a^2 = R' alpha.
#[test]
fn a_bent_surface_is_touched_as_hertz_says() {
    for bent in [60.0, 20.0, -60.0] {
        let seen = impact(bent, hertz(K, 1.5), true, (2e-6, 3e-3));
        let deep: Vec<&Seen> = seen.iter().filter(|s| s.force > 4000.0).collect();
        assert!(deep.len() > 200);
        for s in deep {
            let share = 1.0 - TIP * s.curvature;
            let force = K * (2.0 * s.alpha / (1.0 + share.powf(2.0 / 3.0))).powf(1.5);
            assert!((s.force / force - 1.0).abs() < 0.03, "{bent}: {} {force}", s.force);
            let radius = (2.0 * TIP / share * 0.5 * (s.force * share / K).powf(2.0 / 3.0)).sqrt();
            assert!((s.radius / radius - 1.0).abs() < 0.05, "{bent}: {} {radius}", s.radius);
            let of_hertz = K * s.alpha.powf(1.5) / share.sqrt();
            assert!((s.force / of_hertz - 1.0).abs() < 0.05, "{bent}: {} {of_hertz}", s.force);
            let of_hertz = (TIP / share * s.alpha).sqrt();
            assert!((s.radius / of_hertz - 1.0).abs() < 0.15, "{bent}: {} {of_hertz}", s.radius);
        }
    }
}

/// On a plane the law is what it was, on all of its way, and what it loses and leaves; the patch is that of Hertz.
#[test]
fn on_a_plane_the_law_is_what_it_was() {
    let linear = law::<Linear>(&stiffness(3e7, 1.0).with("n", Value::Number(1.0)));
    let plastic: Box<dyn ContactLaw> = Box::new(YigitChristoforou::new(K, 4e-5));
    let [unloading, loading] = ["unloading-curve", "loading-exponent"].map(|rule| sun_yang(K, 8e-5, rule));
    for law in [hertz(K, 1.5), linear, unloading, loading, plastic] {
        let [point, tip] = [false, true].map(|tip| impact(0.0, law.clone(), tip, (2e-6, 9e-3)));
        let most = largest(&point, |s| s.force);
        let apart =
            |of: fn(&Seen) -> f64| point.iter().zip(&tip).fold(0.0_f64, |m, (a, b)| m.max((of(a) - of(b)).abs()));
        assert!(apart(|s| s.force) < 1e-9 * most, "{law:?}: {} of {most}", apart(|s| s.force));
        assert!(apart(|s| s.energy) < 1e-9 * 4.0, "{law:?}: {}", apart(|s| s.energy));
        assert!(apart(|s| s.dent) < 1e-9 * TIP, "{law:?}: {}", apart(|s| s.dent));
        assert!(point.last().unwrap().force == 0.0 && tip.last().unwrap().force == 0.0);
    }
    let tip = impact(0.0, hertz(K, 1.5), true, (2e-6, 9e-3));
    let plane = (TIP * (largest(&tip, |s| s.force) / K).powf(2.0 / 3.0)).sqrt();
    assert!((largest(&tip, |s| s.radius) / plane - 1.0).abs() < 0.04);
}

/// A patch that grows costs no energy of its own: what is missed falls with the second power of the step.
#[test]
fn energy_balances_while_a_patch_grows() {
    let errors = [8e-6, 4e-6, 2e-6].map(|dt| {
        let seen = impact(60.0, hertz(K, 1.5), true, (dt, 8e-3));
        assert!(seen.last().unwrap().force == 0.0);
        largest(&seen, |s| (s.energy / 4.0 - 1.0).abs())
    });
    assert!(errors[2] < 2e-5 && errors[0] / errors[2] > 12.0, "{errors:?}");
}

/// A surface that is bent more than the tip is touched along the rim, where they overlap at first already; nothing jumps.
#[test]
fn a_tip_that_is_wrapped_lies_on_its_rim() {
    let seen = impact(150.0, hertz(K, 1.5), true, (5e-7, 8e-3));
    assert!(largest(&seen, |s| s.radius) > 0.7 * TIP);
    let error = largest(&seen, |s| (s.energy / seen[0].energy - 1.0).abs());
    assert!(error < 1e-3, "{error}");
    let most = largest(&seen, |s| s.force);
    let jump = seen.windows(2).fold(0.0_f64, |m, s| m.max((s[1].force - s[0].force).abs()));
    assert!(jump < 0.02 * most, "{jump} of {most}");
}

/// Dents and turns of the load on a surface that is bent round the tip or away from it: what is lost is what the laws have lost.
#[test]
fn a_dent_under_a_tip_loses_what_the_law_says() {
    let plastic = Box::new(YigitChristoforou::new(K, 4e-5)) as Box<dyn ContactLaw>;
    for (law, bent) in [(sun_yang(K, 8e-5, "unloading-curve"), 60.0), (plastic.clone(), 60.0), (plastic, -60.0)] {
        let errors = [2e-6, 1e-6].map(|dt| {
            let seen = impact(bent, law.clone(), true, (dt, 9e-3));
            assert!(seen.last().unwrap().force == 0.0 && largest(&seen, |s| s.radius) > 1.5e-3);
            assert!(seen.last().unwrap().dent > 5e-5, "{}", seen.last().unwrap().dent);
            largest(&seen, |s| (s.energy / seen[0].energy - 1.0).abs())
        });
        assert!(errors[1] < 1e-3 && errors[1] < 0.6 * errors[0], "{law:?} {bent}: {errors:?}");
    }
}

/// Two halves of an impactor, on one place and with a tip each, are the whole.
#[test]
fn two_tips_share_a_place() {
    let rings = || Tip::radii(TIP).map(|[a, b]| vec![(0, 1.0), (1, -0.25 * (a * a + b * b))]).collect::<Vec<_>>();
    let forces = |parts: usize| {
        let part = |_| Impactor {
            mass: 2.0 / parts as f64,
            velocity: 2.0,
            start: 0.0,
            load: vec![(0, 1.0)],
            law: hertz(K / parts as f64, 1.5),
        };
        let tips = (0..parts).map(|_| Some(Tip::new(TIP, rings()))).collect();
        let mut system = ImpactSystem::new(Box::new(Bent), (0..parts).map(part).collect()).with_tips(tips);
        let (mut state, mut newmark) = (system.initial(), scheme("newmark-average"));
        state.u[1] = 40.0;
        newmark.start(&mut system, &mut state).unwrap();
        let mut step = || {
            newmark.step(&mut system, &mut state, 4e-6).unwrap();
            (0..parts).map(|i| system.contact_force(i, &state)).sum::<f64>()
        };
        (0..1000).map(|_| step()).collect::<Vec<f64>>()
    };
    let (one, two) = (forces(1), forces(2));
    let most = one.iter().fold(0.0_f64, |m, f| m.max(*f));
    assert!(most > 3000.0);
    one.iter().zip(&two).for_each(|(a, b)| assert!((a - b).abs() < 1e-6 * most, "{a} {b}"));
}
