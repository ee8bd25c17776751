//! Nonlinear shear: the contract, and closed forms.

use fem_core::material::{Elastic, Material, Strengths, Toughnesses};
use fem_core::plugin::{Built, Dimension, Params, Plugin, Value};
use fem_core::ply_law::{LawPoint, PlyLaw, PlyResponse};
use fem_core::tensor::{Matrix6, Strain6};
use fem_core::testkit::{Units, check_ply_law};
use fem_failure::laws::{HahnTsai, Unloading};

const G: f64 = 5.93e9;
/// 2.44e-8 / MPa³, of the order of carbon in epoxy.
const ALPHA: f64 = 2.44e-26;

fn tape() -> Material {
    Material {
        name: "tape".into(),
        elastic: Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, G),
        density: None,
        strengths: Strengths::default(),
        toughness: Toughnesses::default(),
        eta: None,
        expansion: None,
    }
}

/// The answers along shears γ₁₂, each step accepted, and the last tangent.
fn shears(law: &dyn PlyLaw, path: &[f64]) -> (Vec<PlyResponse>, Matrix6) {
    let (material, mut tangent) = (tape(), [[0.0; 6]; 6]);
    let stiffness = material.elastic.stiffness();
    let point = LawPoint { material: &material, stiffness: &stiffness, length: 1e-3, thickness: 1e-3, means: &[] };
    let mut state = vec![0.0; law.info().state.len()];
    let answers = path.iter().map(|gamma| {
        let mut new = state.clone();
        let strain = Strain6::new([0.0, 0.0, 0.0, *gamma, 0.0, 0.0]);
        let answer = law.respond(&point, &strain, &state, &mut new, Some(&mut tangent)).unwrap();
        state = new;
        answer
    });
    (answers.collect(), tangent)
}

fn curve(tau: f64) -> f64 {
    tau / G + ALPHA * tau.powi(3)
}

fn close(got: f64, want: f64, tolerance: f64) {
    assert!((got / want - 1.0).abs() < tolerance, "{got:e}, not {want:e}");
}

#[test]
fn it_keeps_the_contract() {
    for unloading in [Unloading::Elastic, Unloading::Permanent] {
        let make = |units: &Units| -> Box<dyn PlyLaw> {
            Box::new(HahnTsai::new(units.number(ALPHA, HahnTsai::ALPHA), unloading))
        };
        assert_eq!(check_ply_law(make, &tape(), 1e-3, &[0.01, 0.01, 0.01, 0.05, 0.03, 0.03]), Ok(()), "{unloading:?}");
    }
    let blind = |_: &Units| -> Box<dyn PlyLaw> { Box::new(HahnTsai::new(ALPHA, Unloading::Elastic)) };
    let said = check_ply_law(blind, &tape(), 1e-3, &[0.01, 0.01, 0.01, 0.05, 0.03, 0.03]).unwrap_err();
    assert!(said.contains("in other units"), "{said}");
}

#[test]
fn stresses_lie_on_the_curve_and_energies_are_its_areas() {
    for unloading in [Unloading::Elastic, Unloading::Permanent] {
        let law = HahnTsai::new(ALPHA, unloading);
        for tau in [1.0, 1e4, 1e6, 30e6, 60e6, 100e6, 300e6] {
            for sign in [1.0, -1.0] {
                let (answers, tangent) = shears(&law, &[sign * curve(tau)]);
                let PlyResponse { stress, energy } = answers[0];
                close(stress.s12(), sign * tau, 1e-14);
                close(energy.total(), tau * tau / (2.0 * G) + 0.75 * ALPHA * tau.powi(4), 1e-13);
                close(1.0 / tangent[3][3], 1.0 / G + 3.0 * ALPHA * tau * tau, 1e-13);
                assert!(stress.0.iter().enumerate().all(|(k, s)| k == 3 || *s == 0.0));
            }
        }
    }
}

#[test]
fn unloaded_it_goes_back_or_keeps_a_strain() {
    let (tau, steps) = (80e6_f64, 50);
    let left = ALPHA * tau.powi(3);
    let up = (1..=steps).map(|k| curve(tau) * f64::from(k) / f64::from(steps));
    let path: Vec<f64> = up.chain([curve(0.5 * tau), left, 0.0, -curve(tau)]).collect();

    let (answers, _) = shears(&HahnTsai::new(ALPHA, Unloading::Elastic), &path);
    let [.., half, _, none, reversed] = &answers[..] else { unreachable!() };
    close(half.stress.s12(), 0.5 * tau, 1e-13);
    assert!(none.stress.s12() == 0.0 && none.energy.total() == 0.0);
    close(reversed.stress.s12(), -tau, 1e-13);

    let (answers, _) = shears(&HahnTsai::new(ALPHA, Unloading::Permanent), &path);
    let [.., half, free, pressed, reversed] = &answers[..] else { unreachable!() };
    close(half.stress.s12(), tau - G * (curve(tau) - curve(0.5 * tau)), 1e-12);
    assert!(free.stress.s12().abs() < 1e-6 * tau && free.energy.stored < 1e-9 * free.energy.dissipated);
    close(free.energy.dissipated, 0.75 * ALPHA * tau.powi(4), 1e-12);
    // Back at no strain the ply is sheared the other way, still within the stress that it has known.
    close(pressed.stress.s12(), -G * left, 1e-12);
    // Beyond: γ = left − τ/G − α (τ³ − 80³), the length of the way being α τ³.
    let t = -reversed.stress.s12();
    close(left - t / G - (ALPHA * t.powi(3) - left), -curve(tau), 1e-12);
    close(reversed.energy.dissipated, 0.75 * ALPHA * t.powi(4), 1e-12);
}

#[test]
fn a_tiny_alpha_is_linear() {
    let (answers, tangent) = shears(&HahnTsai::new(1e-60, Unloading::Permanent), &[0.02]);
    close(answers[0].stress.s12(), G * 0.02, 1e-15);
    close(tangent[3][3], G, 1e-15);
}

#[test]
fn it_is_built_from_a_scene() {
    let alpha = Value::Quantity(ALPHA, HahnTsai::ALPHA);
    let built = HahnTsai::build(&Params::default().with("alpha", alpha.clone())).unwrap();
    let Built::PlyLaw(law) = built else { unreachable!() };
    assert_eq!(law.info().state.len(), 2);
    let elastic = Params::default().with("alpha", alpha).with("unloading", Value::Text("elastic".into()));
    let Built::PlyLaw(law) = HahnTsai::build(&elastic).unwrap() else { unreachable!() };
    assert!(law.info().state.is_empty());
    let wrong = Params::default().with("alpha", Value::Quantity(1.0, Dimension::PRESSURE));
    assert_eq!(HahnTsai::build(&wrong).unwrap_err().key, "alpha");
}
