//! How far ahead of a crack an interface softens.

use fem_core::material::Elastic;

/// Rice's factor of the zone in a large body, and those of thin arms: the exact zones of Timoshenko beams on the bilinear law, 1.71
/// and 5.18 mm of IM7/8552 specimens with arms of 1.5 mm, are 0.47 and 0.75 of the formulas.
const LARGE: f64 = 0.88;
const THIN: [f64; 2] = [0.5, 0.75];

/// Length of the process zone, m, in modes I and II: the smaller one of a crack in a large body and between arms of `thickness`.
///
/// ```text
/// large   l = 0.88 E' G/X²                            E' of the orthotropic half-spaces, plane stress in 1-3
/// thin    l = 0.50 (E1 GI/Zt²)^1/4 h^3/4              arms that bend
///         l = 0.75 (E1 GII/S13²)^1/2 h^1/2            arms that slide
/// ```
///
/// An estimate, within some 20 % for beams and 50 % for plates with fibres of many directions, where E1 of a ply is too large for the
/// arm: give the `arm` the mean moduli of its plies.
///
/// Sources: Turon, Dávila, Camanho and Costa, Eng. Fract. Mech. 74 (2007) 1665; Harper and Hallett, Eng. Fract. Mech. 75 (2008)
/// 4774; E' of Sih, Paris and Irwin, Int. J. Fract. Mech. 1 (1965) 189.
pub fn process_zone(arm: &Elastic, thickness: f64, toughness: [f64; 2], strength: [f64; 2]) -> [f64; 2] {
    let Elastic { e1, e3, nu13, g13, .. } = *arm;
    let ratio = (e1 / e3).sqrt();
    let shape = (ratio + 0.5 * e1 / g13 - nu13).sqrt();
    // 1/E' = √(a11 a33/2) shape in mode I, a11/√2 shape in mode II, where a are compliances.
    let large = [e1 / ratio, e1].map(|e| std::f64::consts::SQRT_2 * e / shape);
    let zone = |k: usize, thin: f64| {
        let brittle = toughness[k] / (strength[k] * strength[k]);
        (LARGE * large[k] * brittle).min(THIN[k] * thin)
    };
    let bent =
        (e1 * toughness[0] / (strength[0] * strength[0])).sqrt().sqrt() * thickness.sqrt() * thickness.sqrt().sqrt();
    let slid = (e1 * toughness[1] / (strength[1] * strength[1]) * thickness).sqrt();
    [zone(0, bent), zone(1, slid)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Softening lengths of the exact solutions of a double cantilever and an end-notched flexure specimen.
    #[test]
    fn zones_of_thin_arms_are_those_of_beams() {
        let tape = Elastic::transversely_isotropic(150e9, 11e9, 0.3, 0.45, 6e9);
        let [opening, shear] = process_zone(&tape, 1.5e-3, [210.0, 770.0], [25e6, 60e6]);
        assert!((opening / 1.71034e-3 - 1.0).abs() < 0.1, "{opening}");
        assert!((shear / 5.18367e-3 - 1.0).abs() < 0.1, "{shear}");
    }

    /// E' of an isotropic body is E.
    #[test]
    fn a_thick_isotropic_body_has_rices_zone() {
        let resin = Elastic::isotropic(3e9, 0.35);
        let zones = process_zone(&resin, 10.0, [200.0, 800.0], [60e6, 90e6]);
        let want = [0.88 * 3e9 * 200.0 / 3.6e15, 0.88 * 3e9 * 800.0 / 8.1e15];
        assert!(zones.iter().zip(want).all(|(a, b)| (a / b - 1.0).abs() < 1e-12), "{zones:?} {want:?}");
    }
}
