//! The law fulfils the contract of all interface laws, takes its toughness, and is one of the tool's.

use fem_core::interface_law::InterfaceLaw;
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughness, Toughnesses};
use fem_core::ply_law::LawPoint;
use fem_core::testkit::check_interface_law;
use plugin_interface_law::Exponential;
use std::process::Command;

fn resin() -> Material {
    Material {
        name: "resin".into(),
        elastic: Elastic::isotropic(3.8e9, 0.36),
        density: None,
        strengths: Strengths::default().with(Strength::Zt, 60e6),
        toughness: Toughnesses::default().with(Toughness::GIc, 300.0),
        eta: None,
        expansion: None,
    }
}

#[test]
fn it_fulfils_the_contract() {
    for weight in [0.7, 1.0, 1.5] {
        let law = |_: &_| -> Box<dyn InterfaceLaw> { Box::new(Exponential { weight }) };
        assert_eq!(check_interface_law(law, &resin(), 1e-3, &[1e-5, 1e-5, 1e-5]), Ok(()), "{weight}");
    }
}

#[test]
fn a_broken_interface_has_taken_its_toughness() {
    let (law, material) = (Exponential { weight: 1.4 }, resin());
    let stiffness = material.elastic.stiffness();
    let point = LawPoint { material: &material, stiffness: &stiffness, length: 1e-3, thickness: 1e-3, means: &[] };
    for direction in [[1.0, 0.0, 0.0], [0.0, 0.6, -0.8], [0.5, 0.5, 0.5]] {
        let broken = direction.map(|v: f64| 1e-3 * v);
        let answer = law.respond(&point, &broken, &[0.0; 3], &mut [0.0; 3], None).unwrap();
        assert!((answer.dissipated.total() / 300.0 - 1.0).abs() < 1e-12, "{answer:?}");
    }
    // The strength, at the width of the curve.
    let at = 300.0 / (std::f64::consts::E * 60e6);
    let peak = law.respond(&point, &[at, 0.0, 0.0], &[0.0; 3], &mut [0.0; 3], None).unwrap();
    assert!((peak.traction[0] / 60e6 - 1.0).abs() < 1e-12, "{peak:?}");
}

#[test]
fn the_tool_lists_it() {
    let fem =
        Command::new(env!("CARGO_BIN_EXE_plugin-interface-law")).args(["list", "interface-laws"]).output().unwrap();
    let listed = String::from_utf8(fem.stdout).unwrap();
    assert!(listed.contains("bilinear") && listed.contains("exponential"), "{listed}");
}
