//! What layers of cells add to the stiffness of waves, against waves of exact elasticity and against many layers.

use fem::core::element::Element;
use fem::core::laminate::{LaminaPly, Laminate};
use fem::core::layup;
use fem::core::material::{Elastic, Material, Strengths, Toughnesses};
use fem::core::plate::ZDerivatives;
use fem::core::waves::LayerShares;
use fem::elements::{HermitePrism, Mass};

const H: f64 = 2e-3;
const RHO: f64 = 1600.0;
/// Wave numbers times the thickness.
const NUMBERS: [f64; 4] = [0.1, 0.3, 1.0, 3.0];

fn material(elastic: Elastic) -> Material {
    let strengths = Strengths::default();
    Material {
        name: "m".into(),
        elastic,
        density: Some(RHO),
        strengths,
        toughness: Toughnesses::default(),
        eta: None,
        expansion: None,
    }
}

fn laminate(plies: &str, layers: &[usize]) -> Laminate {
    let angles = layup::parse(plies).unwrap();
    let ply = |angle_deg: f64| LaminaPly {
        angle: angle_deg.to_radians(),
        angle_deg,
        thickness: H / angles.len() as f64,
        material: 0,
    };
    Laminate { plies: angles.iter().map(|p| ply(p.angle_deg)).collect(), layers: layers.to_vec(), middle: 0.0 }
}

fn shares(element: &dyn Element, laminate: &Laminate, elastic: Elastic) -> Vec<(f64, f64)> {
    let found = LayerShares::of(element, ZDerivatives::Shared, laminate, &[material(elastic)]);
    found.unwrap().unwrap().waves().to_vec()
}

/// ω of the lowest antisymmetric wave of Rayleigh and Lamb: tanh(β h/2)/tanh(α h/2) = (β² + k²)²/(4 k² α β) with
/// α² = k² − ω²/c_L², β² = k² − ω²/c_T².
fn lamb(e: f64, nu: f64, k: f64) -> f64 {
    let (lambda, mu) = (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 * e / (1.0 + nu));
    let [along, across] = [(lambda + 2.0 * mu) / RHO, mu / RHO];
    let gap = |omega: f64| {
        let [alpha, beta] = [along, across].map(|square| (k * k - omega * omega / square).sqrt());
        (0.5 * beta * H).tanh() * 4.0 * k * k * alpha * beta - (0.5 * alpha * H).tanh() * (beta * beta + k * k).powi(2)
    };
    // Below the wave's frequency the gap has one sign, and it vanishes at none but there and where ω is 0.
    let (mut low, mut high) = (1e-3 * k * across.sqrt() * (k * H).min(1.0), 0.9999 * k * across.sqrt());
    let sign = gap(low).signum();
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if gap(middle).signum() == sign { low = middle } else { high = middle }
    }
    low
}

/// A cubic through the thickness bends as exact waves do.
#[test]
fn waves_are_those_of_rayleigh_and_lamb() {
    let (e, nu) = (70e9, 0.3);
    let elastic = Elastic::transversely_isotropic(e, e, nu, nu, 0.5 * e / (1.0 + nu));
    let found = shares(&HermitePrism::new(Mass::Cubic, 4).unwrap(), &laminate("[0]", &[1]), elastic);
    for ((omega, share), number) in found.into_iter().zip(NUMBERS) {
        let exact = lamb(e, nu, number / H);
        let truth = 1.0 - (exact / omega).powi(2);
        let said = format!("k h = {number}: {omega:.5e}, exact {exact:.5e}; said {share:.2e}, true {truth:.2e}");
        assert!((share - truth).abs() < 2e-4 + 0.3 * truth, "{said}");
        // The shortest wave is as long as two thicknesses.
        assert!(truth.abs() < if number > 1.0 { 1e-2 } else { 1e-3 }, "{said}");
    }
}

/// Laminates: the distance from a layer per ply.
#[test]
fn of_layers_of_plies_it_is_what_a_layer_per_ply_is_softer() {
    let elastic = Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9);
    for (plies, layers) in [("[0/45/-45/90]2s", 8), ("[0/90]4s", 8), ("[0/45/-45/90]s", 4)] {
        let element = HermitePrism::new(Mass::Cubic, 4).unwrap();
        let found = shares(&element, &laminate(plies, &[layers; 2]), elastic);
        let fine = shares(&element, &laminate(plies, &vec![1; 2 * layers]), elastic);
        // The shortest waves are no longer bent as plates are.
        for (((omega, share), (finest, _)), number) in found.into_iter().zip(fine).zip(NUMBERS).take(3) {
            let truth = 1.0 - (finest / omega).powi(2);
            let said = format!("{plies}, k h = {number}: said {share:.3e}, true {truth:.3e}");
            assert!(share / truth > 0.5 && share / truth < 2.6, "{said}");
        }
    }
}

#[test]
fn between_waves_shares_are_linear() {
    let elastic = Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9);
    let laminate = laminate("[0/45/-45/90]2s", &[8, 8]);
    let shares = LayerShares::of(
        &HermitePrism::new(Mass::Cubic, 4).unwrap(),
        ZDerivatives::Shared,
        &laminate,
        &[material(elastic)],
    );
    let shares = shares.unwrap().unwrap();
    let (first, last) = (shares.waves()[0], shares.waves()[3]);
    assert_eq!((shares.at(0.0), shares.at(2.0 * last.0)), (0.0, last.1));
    assert!((shares.at(0.5 * first.0) - 0.5 * first.1).abs() < 1e-15);
}
