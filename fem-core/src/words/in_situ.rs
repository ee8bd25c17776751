//! Strengths of plies in their laminate, where plies of other angles hold their cracks together.

use super::material::{Material, MaterialError, Strength, Strengths, Toughness};
use std::f64::consts::{PI, SQRT_2};

/// On how many faces plies of one angle have others, which hold their cracks together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Confined {
    /// Plies at a face of the laminate.
    OnOneFace,
    /// Plies within it.
    OnBothFaces,
}

impl Material {
    /// The strengths of plies of this material that are `thick`, m, together and `confined` by plies of other angles (Camanho, Dávila,
    /// Pinho, Iannucci and Robinson, Compos. Part A 37 (2006) 165).
    ///
    /// Those of the material are measured on laminates of one angle, which the first crack along the fibres breaks. Between other plies a
    /// crack takes its energy from its own ply alone, so that thin ones bear more. With Λ = 2 (1/E2 − ν21²/E1) and the energy of a shear
    /// τ, U(τ) = τ²/2G12 + 3/4 α τ⁴:
    ///
    /// | | across the fibres, Yt | shear, S12: the τ whose U is |
    /// | --- | --- | --- |
    /// | on both faces | max(1.12 √2 Yt, √(8 Gmt/(π t Λ))) | max(2 U(S12), 4 Gms/(π t)) |
    /// | on one face | max(Yt, 1.79 √(Gmt/(π t Λ))) | max(U(S12), 2 Gms/(π t)) |
    ///
    /// `alpha` is that of Hahn and Tsai's shear γ = τ/G12 + α τ³, 1/Pa³; 0 of a linear one, which makes S12 of tapes twice as large. Gmt
    /// and Gms, where they are not given, are GIc and GIIc. All other strengths stay, and all of a material that is not stiffer along 1
    /// than along 2, as a fabric. Not considered: neighbours that are soft or have come off, and that Yc may rise with S12.
    ///
    /// # Errors
    /// The material has one of these strengths, but not the toughness that goes with it.
    pub fn in_situ(&self, thick: f64, confined: Confined, alpha: f64) -> Result<Strengths, MaterialError> {
        let (e, given) = (&self.elastic, self.strengths);
        let mut strengths = given;
        if e.e1 <= e.e2 {
            return Ok(strengths);
        }
        let needed = |strength: Strength, [own, of_interface]: [Toughness; 2]| {
            self.toughness.get(own).or(self.toughness.get(of_interface)).ok_or_else(|| MaterialError {
                material: self.name.clone(),
                why: format!(
                    "strength {} in situ needs the toughness {} or {}, which the material does not give",
                    strength.name(),
                    own.name(),
                    of_interface.name()
                ),
            })
        };
        if let Some(yt) = given.get(Strength::Yt) {
            let g = needed(Strength::Yt, [Toughness::Gmt, Toughness::GIc])?;
            let nu21 = e.nu12 * e.e2 / e.e1;
            let of_crack = (g / (PI * thick * 2.0 * (1.0 / e.e2 - nu21 * nu21 / e.e1))).sqrt();
            let strength = match confined {
                Confined::OnBothFaces => f64::max(1.12 * SQRT_2 * yt, 8.0_f64.sqrt() * of_crack),
                Confined::OnOneFace => f64::max(yt, 1.79 * of_crack),
            };
            strengths = strengths.with(Strength::Yt, strength);
        }
        if let Some(s12) = given.get(Strength::S12) {
            let g = needed(Strength::S12, [Toughness::Gms, Toughness::GIIc])?;
            let linear = 0.5 / e.g12;
            let faces = match confined {
                Confined::OnBothFaces => 2.0,
                Confined::OnOneFace => 1.0,
            };
            let energy = faces * f64::max(s12 * s12 * (linear + 0.75 * alpha * s12 * s12), 2.0 * g / (PI * thick));
            let square = 2.0 * energy / (linear + (linear * linear + 3.0 * alpha * energy).sqrt());
            strengths = strengths.with(Strength::S12, square.sqrt());
        }
        Ok(strengths)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::material::{Elastic, Toughnesses};

    /// Camanho, Maimí and Dávila, Compos. Sci. Technol. 67 (2007) 2715.
    fn im7_8552() -> Material {
        Material {
            name: "IM7/8552".into(),
            elastic: Elastic::transversely_isotropic(171.42e9, 9.08e9, 0.32, 0.45, 5.29e9),
            density: None,
            strengths: Strengths::default().with(Strength::Yt, 62.3e6).with(Strength::S12, 92.3e6),
            toughness: Toughnesses::default().with(Toughness::GIc, 277.4).with(Toughness::GIIc, 787.9),
            eta: None,
            expansion: None,
        }
    }

    const ALPHA: f64 = 2.98e-26;

    /// The paper's strengths in situ, MPa, of plies of 0.125 mm: an inner one, one at a face, two together.
    #[test]
    fn published_strengths_come_out() {
        let of = |plies: f64, confined, which| {
            1e-6 * im7_8552().in_situ(plies * 0.125e-3, confined, ALPHA).unwrap().get(which).unwrap()
        };
        for (plies, confined, which, published) in [
            (1.0, Confined::OnBothFaces, Strength::Yt, 160.2),
            (1.0, Confined::OnBothFaces, Strength::S12, 130.2),
            (1.0, Confined::OnOneFace, Strength::Yt, 101.4),
            (1.0, Confined::OnOneFace, Strength::S12, 107.0),
            (2.0, Confined::OnBothFaces, Strength::Yt, 113.3),
        ] {
            let found = of(plies, confined, which);
            assert!((found - published).abs() < 0.051, "{} of {plies}: {found}, not {published}", which.name());
        }
    }

    #[test]
    fn thick_plies_have_limits_and_thin_ones_go_by_the_root_of_their_thickness() {
        let of = |thick: f64, confined, alpha| {
            let found = im7_8552().in_situ(thick, confined, alpha).unwrap();
            [Strength::Yt, Strength::S12].map(|which| found.get(which).unwrap())
        };
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        let [y, s] = of(1.0, Confined::OnBothFaces, 0.0);
        assert!(near(y, 1.12 * SQRT_2 * 62.3e6) && near(s, SQRT_2 * 92.3e6));
        for alpha in [0.0, ALPHA] {
            let [y, s] = of(1.0, Confined::OnOneFace, alpha);
            assert!(near(y, 62.3e6) && near(s, 92.3e6));
        }
        for confined in [Confined::OnOneFace, Confined::OnBothFaces] {
            let [thin, half] = [of(2e-5, confined, 0.0), of(1e-5, confined, 0.0)];
            assert!(thin.iter().zip(half).all(|(thin, half)| near(half, SQRT_2 * thin)));
        }
        let [_, s] = of(1e-5, Confined::OnBothFaces, 0.0);
        assert!(near(s, (8.0 * 5.29e9 * 787.9 / (PI * 1e-5)).sqrt()));
    }

    #[test]
    fn what_is_missing_is_named_and_what_has_no_fibres_stays() {
        let bare = Material { toughness: Toughnesses::default(), ..im7_8552() };
        let why = bare.in_situ(1e-4, Confined::OnOneFace, 0.0).unwrap_err().to_string();
        assert!(why.contains("Yt in situ needs the toughness Gmt or GIc"), "{why}");
        let own =
            Toughnesses::default().with(Toughness::Gmt, 100.0).with(Toughness::GIc, 1.0).with(Toughness::Gms, 50.0);
        let found = Material { toughness: own, ..im7_8552() }.in_situ(1e-4, Confined::OnBothFaces, 0.0).unwrap();
        let weak = im7_8552().in_situ(2.774e-4, Confined::OnBothFaces, 0.0).unwrap();
        assert!((found.get(Strength::Yt).unwrap() / weak.get(Strength::Yt).unwrap() - 1.0).abs() < 1e-12);
        let foam = Material { elastic: Elastic::isotropic(70e6, 0.3), ..bare };
        assert_eq!(foam.in_situ(1e-3, Confined::OnBothFaces, 0.0).unwrap().get(Strength::Yt), Some(62.3e6));
    }
}
