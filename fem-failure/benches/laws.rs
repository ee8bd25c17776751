//! What laws of plies and of interfaces cost at a point, tangent and energies included.

use divan::counter::ItemsCount;
use fem_core::interface_law::{InterfaceLaw, Jump};
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughness, Toughnesses};
use fem_core::ply_law::{LawPoint, PlyLaw};
use fem_core::tensor::Strain6;
use fem_failure::laws::{Bilinear, Breaks, CrackBand, HahnTsai, MixedMode, Unloading};

fn main() {
    divan::main();
}

/// Constants of IM7/8552.
fn tape() -> Material {
    let strengths = [
        (Strength::Xt, 2326e6),
        (Strength::Xc, 1200e6),
        (Strength::Yt, 62.3e6),
        (Strength::Yc, 199.8e6),
        (Strength::S12, 92.3e6),
        (Strength::S23, 75.3e6),
        (Strength::Zt, 60e6),
        (Strength::S13, 90e6),
    ];
    let toughness = [
        (Toughness::GIc, 277.0),
        (Toughness::GIIc, 788.0),
        (Toughness::Gft, 81.5e3),
        (Toughness::Gfc, 106.3e3),
        (Toughness::Gmt, 277.0),
        (Toughness::Gmc, 1310.0),
        (Toughness::Gms, 788.0),
    ];
    Material {
        name: "IM7/8552".into(),
        elastic: Elastic::transversely_isotropic(171.4e9, 9.08e9, 0.32, 0.45, 5.29e9),
        density: None,
        strengths: strengths.into_iter().fold(Strengths::default(), |all, (which, v)| all.with(which, v)),
        toughness: toughness.into_iter().fold(Toughnesses::default(), |all, (which, v)| all.with(which, v)),
        eta: Some(1.634),
        expansion: None,
    }
}

/// An interface: sound, where its damage grows, where it unloads, broken and rubbing.
#[divan::bench(args = ["sound", "growing", "unloading", "rubbing"])]
fn bilinear(bencher: divan::Bencher<'_, '_>, state: &str) {
    let law = Bilinear {
        penalty: 1e14,
        shear_penalty: None,
        criterion: MixedMode::BenzeggaghKenane,
        strengthening: 0.0,
        friction: 0.3,
    };
    let (before, now): (Jump, Jump) = match state {
        "sound" => ([0.0; 3], [1e-7, 2e-7, -1e-7]),
        "growing" => ([2e-6, 3e-6, -1e-6], [2.02e-6, 3.1e-6, -1e-6]),
        "unloading" => ([2e-6, 3e-6, -1e-6], [1e-6, 2e-6, -1e-6]),
        _ => ([-1e-7, 3e-5, -1e-5], [-1e-7, 3.1e-5, -1e-5]),
    };
    let material = tape();
    let stiffness = material.elastic.stiffness();
    let point = LawPoint { material: &material, stiffness: &stiffness, length: 1e-3, thickness: 1e-3, means: &[] };
    let (mut old, mut new, mut tangent) = ([0.0; 9], [0.0; 9], [[0.0; 3]; 3]);
    let _ = law.respond(&point, &before, &[0.0; 9], &mut old, None);
    bencher
        .counter(ItemsCount::new(1_u32))
        .bench_local(|| law.respond(&point, &now, &old, &mut new, Some(&mut tangent)));
}

/// The strains of a ply before and after, under which it answers linearly, its damage grows, it unloads.
fn strains(state: &str) -> [[f64; 6]; 2] {
    let strain = |size: f64| [2e-3, 5e-3, -2e-3, 1.5e-2, 5e-3, 8e-3].map(|e| size * e);
    match state {
        "sound" => [strain(0.1), strain(0.2)],
        "growing" => [strain(1.3), strain(1.31)],
        _ => [strain(1.3), strain(0.9)],
    }
}

fn ply(bencher: divan::Bencher<'_, '_>, law: &dyn PlyLaw, state: &str) {
    let material = tape();
    let stiffness = material.elastic.stiffness();
    let point = LawPoint { material: &material, stiffness: &stiffness, length: 2e-4, thickness: 2e-4, means: &[] };
    let count = law.info().state.len();
    let (virgin, mut old, mut new, mut tangent) = (vec![0.0; count], vec![0.0; count], vec![0.0; count], [[0.0; 6]; 6]);
    let [before, now] = strains(state).map(Strain6::new);
    let _ = law.respond(&point, &before, &virgin, &mut old, None);
    bencher
        .counter(ItemsCount::new(1_u32))
        .bench_local(|| law.respond(&point, &now, &old, &mut new, Some(&mut tangent)));
}

#[divan::bench(args = ["sound", "growing", "unloading"])]
fn crack_band(bencher: divan::Bencher<'_, '_>, state: &str) {
    ply(bencher, &CrackBand { alpha: None, breaks: Breaks::All, faces: false, lower_strengths: false }, state);
}

#[divan::bench(args = ["sound", "growing", "unloading"])]
fn crack_band_permanent(bencher: divan::Bencher<'_, '_>, state: &str) {
    ply(
        bencher,
        &CrackBand { alpha: Some(2.44e-26), breaks: Breaks::All, faces: false, lower_strengths: false },
        state,
    );
}

#[divan::bench(args = ["sound", "growing", "unloading"])]
fn hahn_tsai(bencher: divan::Bencher<'_, '_>, state: &str) {
    ply(bencher, &HahnTsai::new(2.44e-26, Unloading::Permanent), state);
}
