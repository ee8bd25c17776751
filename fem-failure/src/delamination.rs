//! The contact force at which an impact delaminates a plate.

use fem_core::laminate::Laminate;
use fem_core::material::{Material, Toughness};
use std::f64::consts::PI;

/// Davies and Olsson's threshold: the force at which a circular delamination in the mid-plane grows at once.
///
/// ```text
/// F = π √(32 D* GIIc / 3),  D* = √(D11 D22 (η + 1)/2),  η = (D12 + 2 D66)/√(D11 D22)
/// ```
///
/// D* is [`Laminate::effective_bending_stiffness`]; for an isotropic plate F = π √(8 GIIc E h³ / 9(1 − ν²)). It depends neither on the
/// span nor on the place. It is not a stress criterion: it compares energies, for one crack under a quasi-static load.
/// Under an impactor much lighter than the plate delamination starts at about 1.2 times this force (Olsson 2006).
///
/// Sources: Davies and Zhang, Int. J. Impact Eng. 16 (1995) 149; Olsson, Compos. Part A 32 (2001) 1207.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DelaminationThreshold {
    /// The force, N.
    pub force: f64,
    /// D*, N·m.
    pub bending_stiffness: f64,
    /// GIIc, J/m².
    pub giic: f64,
}

impl DelaminationThreshold {
    /// The threshold of `laminate`, whose interfaces are of the material `resin`; `None` where no material gives GIIc.
    ///
    /// The toughness is that of `resin` if it gives one, otherwise the smallest that a ply's material gives.
    pub fn of(laminate: &Laminate, materials: &[Material], resin: Option<usize>) -> Option<Self> {
        let of = |material: usize| materials[material].toughness.get(Toughness::GIIc);
        let of_plies = || laminate.plies.iter().filter_map(|ply| of(ply.material)).min_by(f64::total_cmp);
        let giic = resin.and_then(of).or_else(of_plies)?;
        let bending_stiffness = laminate.effective_bending_stiffness(materials);
        Some(Self { force: PI * (32.0 * bending_stiffness * giic / 3.0).sqrt(), bending_stiffness, giic })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use fem_core::laminate::LaminaPly;
    use fem_core::material::{Elastic, Strengths, Toughnesses};

    fn material(elastic: Elastic, giic: Option<f64>) -> Material {
        let toughness = giic.map_or(Toughnesses::default(), |v| Toughnesses::default().with(Toughness::GIIc, v));
        let strengths = Strengths::default();
        Material { name: "m".into(), elastic, density: None, strengths, toughness, eta: None, expansion: None }
    }

    fn laminate(angles: &[f64], thickness: f64) -> Laminate {
        let ply = |deg: &f64| LaminaPly { angle: deg.to_radians(), angle_deg: *deg, thickness, material: 0 };
        Laminate { plies: angles.iter().map(ply).collect(), layers: vec![angles.len()] }
    }

    #[test]
    fn an_isotropic_plate_has_the_classical_form() {
        let (e, nu, h, giic) = (70e9, 0.3, 4e-3, 900.0);
        let found = DelaminationThreshold::of(
            &laminate(&[0.0, 30.0, 0.0, 90.0], h / 4.0),
            &[material(Elastic::isotropic(e, nu), Some(giic))],
            None,
        );
        let want = PI * (8.0 * giic * e * h * h * h / (9.0 * (1.0 - nu * nu))).sqrt();
        assert!((found.unwrap().force / want - 1.0).abs() < 1e-13, "{found:?}, not {want}");
    }

    /// Values worked out apart from this program, to the digits that are given.
    #[test]
    fn the_laminates_of_the_report() {
        let tape = Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9);
        let quarter = [0.0, 45.0, -45.0, 90.0];
        let half = [quarter, quarter].concat();
        for (half, stiffness, forces) in [(&half[..], 43.1, [1507.0, 1906.0]), (&quarter, 4.78, [502.0, 635.0])] {
            let plies: Vec<f64> = half.iter().chain(half.iter().rev()).copied().collect();
            for (giic, force) in [500.0, 800.0].into_iter().zip(forces) {
                let materials = [material(tape, Some(giic))];
                let found = DelaminationThreshold::of(&laminate(&plies, 0.13208e-3), &materials, None).unwrap();
                assert!((found.bending_stiffness / stiffness - 1.0).abs() < 2e-3, "{found:?}");
                assert!((found.force - force).abs() < 1.0, "{found:?}");
            }
        }
    }

    #[test]
    fn the_interface_goes_before_the_plies() {
        let e = Elastic::isotropic(70e9, 0.3);
        let giic = |plies, resin| {
            let materials = [material(e, plies), material(e, resin)];
            DelaminationThreshold::of(&laminate(&[0.0], 1e-3), &materials, Some(1)).map(|found| found.giic)
        };
        assert_eq!(giic(Some(500.0), Some(900.0)), Some(900.0));
        assert_eq!(giic(Some(500.0), None), Some(500.0));
        assert_eq!(giic(None, None), None);
    }
}
