//! The contact force at which an impact delaminates a plate.

use fem_core::laminate::Laminate;
use fem_core::material::{Material, Toughness};
use std::f64::consts::PI;

/// Davies and Olsson's threshold: the force at which circular delaminations in a plate grow at once.
///
/// ```text
/// F = π √(32 D* GIIc/(n + 2)),  D* = √(D11 D22 (η + 1)/2),  η = (D12 + 2 D66)/√(D11 D22)
/// ```
///
/// with n delaminations that divide the thickness evenly and grow together. For one in the mid-plane of an isotropic plate F = π √(8
/// GIIc E h³ / 9(1 − ν²)). What n is, the theory does not say: impacts find many, and the least force is that of as many as there are
/// interfaces on which plies of different angle or material meet; those between like plies do not delaminate.
///
/// D* is [`Laminate::effective_bending_stiffness`]. The force depends neither on the span nor on the place, nor on how large the
/// delaminations are. It is not a stress criterion: it compares energies, under a quasi-static load. Under an impactor much lighter than
/// the plate delamination starts at about 1.2 times this force (Olsson 2006).
///
/// Sources: Davies and Zhang, Int. J. Impact Eng. 16 (1995) 149; Olsson, Compos. Part A 32 (2001) 1207.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DelaminationThreshold {
    /// The force for one delamination, N.
    pub force: f64,
    /// Interfaces that may delaminate, one at least.
    pub interfaces: usize,
    /// The force for as many delaminations, N: the least.
    pub force_of_all: f64,
    /// D*, N·m.
    pub bending_stiffness: f64,
    /// GIIc, J/m².
    pub giic: f64,
}

impl DelaminationThreshold {
    /// The threshold of `laminate`, whose interfaces are of the material `resin`; `None` where no material gives GIIc, and of one
    /// ply, which has no interface.
    ///
    /// The toughness is that of `resin` if it gives one, otherwise the smallest that a ply's material gives.
    pub fn of(laminate: &Laminate, materials: &[Material], resin: Option<usize>) -> Option<Self> {
        let of = |material: usize| materials[material].toughness.get(Toughness::GIIc);
        let of_plies = || laminate.plies.iter().filter_map(|ply| of(ply.material)).min_by(f64::total_cmp);
        let giic = resin.and_then(of).or_else(of_plies).filter(|_| laminate.plies.len() > 1)?;
        let bending_stiffness = laminate.effective_bending_stiffness(materials);
        let interfaces = laminate.unlike().count().max(1);
        let force_of = |n: usize| PI * (32.0 * bending_stiffness * giic / (n as f64 + 2.0)).sqrt();
        Some(Self { force: force_of(1), interfaces, force_of_all: force_of(interfaces), bending_stiffness, giic })
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
        Laminate { plies: angles.iter().map(ply).collect(), layers: vec![angles.len()], middle: 0.0 }
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

    #[test]
    fn one_ply_does_not_delaminate() {
        let materials = [material(Elastic::isotropic(70e9, 0.3), Some(900.0))];
        assert_eq!(DelaminationThreshold::of(&laminate(&[0.0], 4e-3), &materials, None), None);
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

    /// T700/M21, 4.16 mm, as worked out apart from this program: a test whose peak was 4400 N delaminated 312 mm², which one
    /// delamination denies and six allow.
    #[test]
    fn many_interfaces_delaminate_at_a_smaller_force() {
        let tape = Elastic {
            e1: 130e9,
            e2: 7.7e9,
            e3: 7.7e9,
            nu12: 0.3,
            nu13: 0.3,
            nu23: 0.35,
            g12: 4.8e9,
            g13: 4.8e9,
            g23: 3.8e9,
        };
        let half = [0.0, 0.0, 45.0, 45.0, 90.0, 90.0, -45.0, -45.0];
        let plies: Vec<f64> = half.iter().chain(half.iter().rev()).copied().collect();
        let found =
            DelaminationThreshold::of(&laminate(&plies, 0.26e-3), &[material(tape, Some(1600.0))], None).unwrap();
        assert_eq!(found.interfaces, 6);
        assert!((found.bending_stiffness - 295.6).abs() < 0.1, "{found:?}");
        assert!((found.force - 7056.0).abs() < 1.0 && (found.force_of_all - 4321.0).abs() < 1.0, "{found:?}");
        // Plies of one angle are one.
        let alike =
            DelaminationThreshold::of(&laminate(&[90.0, -90.0], 1e-3), &[material(tape, Some(1600.0))], None).unwrap();
        assert_eq!((alike.interfaces, alike.force), (1, alike.force_of_all));
    }

    #[test]
    fn the_interface_goes_before_the_plies() {
        let e = Elastic::isotropic(70e9, 0.3);
        let giic = |plies, resin| {
            let materials = [material(e, plies), material(e, resin)];
            DelaminationThreshold::of(&laminate(&[0.0, 90.0], 1e-3), &materials, Some(1)).map(|found| found.giic)
        };
        assert_eq!(giic(Some(500.0), Some(900.0)), Some(900.0));
        assert_eq!(giic(Some(500.0), None), Some(500.0));
        assert_eq!(giic(None, None), None);
    }
}
