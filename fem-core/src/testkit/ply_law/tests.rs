use super::check_ply_law;
use crate::contracts::plugin::Dimension;
use crate::contracts::ply_law::{LawError, LawInfo, LawPoint, PlyLaw, PlyResponse};
use crate::testkit::Units;
use crate::words::energy::Energy;
use crate::words::material::{Elastic, Material, Strength, Strengths, Toughnesses};
use crate::words::tensor::{Matrix6, Ply, Strain6, Stress6, apply};
use std::sync::atomic::{AtomicBool, Ordering};

/// Shear in the plane that yields at a strength of the material and hardens; the rest is linear.
#[derive(Debug)]
struct Yielding {
    /// Hardening modulus, Pa.
    hardening: f64,
    spoil: fn(&mut Answer),
    /// What is wrong, relative, where it is asked about several points.
    several: f64,
    /// Has seen a large strain, which no law may remember.
    seen: AtomicBool,
}

/// What a fault may touch.
struct Answer<'a> {
    response: PlyResponse,
    new: &'a mut [f64],
    tangent: Option<&'a mut Matrix6>,
    strain: [f64; 6],
    seen: bool,
}

impl Clone for Yielding {
    fn clone(&self) -> Self {
        Self { hardening: self.hardening, spoil: self.spoil, several: self.several, seen: AtomicBool::new(false) }
    }
}

impl PlyLaw for Yielding {
    fn info(&self) -> &LawInfo {
        const INFO: LawInfo = LawInfo {
            state: &["plastic shear", "its length", "dissipated"],
            strengths: &[Strength::S12],
            toughness: &[],
        };
        &INFO
    }
    fn respond(
        &self,
        point: &LawPoint<'_>,
        strain: &Strain6<Ply>,
        old: &[f64],
        new: &mut [f64],
        mut tangent: Option<&mut Matrix6>,
    ) -> Result<PlyResponse, LawError> {
        let g = point.stiffness[3][3];
        let mut elastic = strain.0;
        elastic[3] -= old[0];
        let trial = g * elastic[3];
        let limit = point.material.strengths.s12() + self.hardening * old[1];
        let slip = ((trial.abs() - limit) / (g + self.hardening)).max(0.0);
        elastic[3] -= slip.copysign(trial);
        let stress = apply(point.stiffness, &elastic);
        new[0] = old[0] + slip.copysign(trial);
        new[1] = old[1] + slip;
        new[2] = old[2] + slip * (limit + 0.5 * self.hardening * slip);
        if let Some(tangent) = &mut tangent {
            **tangent = *point.stiffness;
            if slip > 0.0 {
                tangent[3][3] = g * self.hardening / (g + self.hardening);
            }
        }
        let stored = 0.5 * stress.iter().zip(elastic).map(|(s, e)| s * e).sum::<f64>();
        let response = PlyResponse { stress: Stress6::new(stress), energy: Energy { stored, dissipated: new[2] } };
        let seen = self.seen.fetch_or(strain.0[3] > 0.019, Ordering::Relaxed);
        let mut answer = Answer { response, new, tangent, strain: strain.0, seen };
        (self.spoil)(&mut answer);
        Ok(answer.response)
    }

    fn respond_all(
        &self,
        point: &LawPoint<'_>,
        strains: &[Strain6<Ply>],
        (old, new): (&[f64], &mut [f64]),
        answers: &mut [PlyResponse],
        tangents: &mut [Matrix6],
    ) -> Result<(), LawError> {
        let (states, mut tangents) = (old.chunks_exact(3).zip(new.chunks_exact_mut(3)), tangents.iter_mut());
        for ((strain, answer), (old, new)) in strains.iter().zip(answers).zip(states) {
            *answer = self.respond(point, strain, old, new, tangents.next())?;
            new[1] *= 1.0 + self.several;
        }
        Ok(())
    }
}

fn check(spoil: fn(&mut Answer)) -> Result<(), String> {
    check_of_several(spoil, 0.0)
}

fn check_of_several(spoil: fn(&mut Answer), several: f64) -> Result<(), String> {
    let tape = Material {
        name: "tape".into(),
        elastic: Elastic::transversely_isotropic(130e9, 9e9, 0.3, 0.4, 5e9),
        density: None,
        strengths: Strengths::default().with(Strength::S12, 60e6),
        toughness: Toughnesses::default(),
        eta: None,
        expansion: None,
    };
    let make = |units: &Units| -> Box<dyn PlyLaw> {
        let hardening = units.number(1e9, Dimension::PRESSURE);
        Box::new(Yielding { hardening, spoil, several, seen: AtomicBool::new(false) })
    };
    check_ply_law(make, &tape, 1e-3, &[0.01, 0.01, 0.01, 0.02, 0.02, 0.02])
}

#[test]
fn a_sound_law_passes() {
    assert_eq!(check(|_| ()), Ok(()));
}

#[test]
fn faults_are_found() {
    let said = check_of_several(|_| (), 1e-15).expect_err("other states");
    assert!(said.contains("two points at once"), "{said}");
    for (want, spoil) in [
        ("a virgin point without strain", (|a| a.response.stress.0[1] += 1e3) as fn(&mut Answer<'_>)),
        ("asked twice", |a| a.response.stress.0[3] *= if a.tangent.is_some() { 1.0 + 1e-12 } else { 1.0 }),
        ("is not written", |a| {
            if a.strain[3] > 0.015 {
                a.new[1] = f64::NAN
            }
        }),
        ("differences give", |a| {
            if let Some(t) = &mut a.tangent
                && a.new[1] > 0.0
            {
                t[3][3] *= 1.01
            }
        }),
        ("stiffness", |a| {
            if let Some(t) = &mut a.tangent
                && a.new[1] == 0.0
            {
                t[3][3] *= 1.01
            }
        }),
        ("is not the work", |a| a.response.energy.stored *= 1.01),
        ("dissipated energy falls", |a| {
            let given = 0.1 * a.response.energy.stored;
            a.response.energy.dissipated += given;
            a.response.energy.stored -= given;
        }),
        ("once its state is taken over", |a| a.new[0] *= 0.999),
        ("the mirror image", |a| {
            // A softer ply under shear of one sign: as good as any other law but for symmetry.
            if a.strain[4] > 0.0 {
                let lost = a.response.stress.0[4] * 0.1;
                a.response.energy.stored -= 0.5 * lost * a.strain[4];
                a.response.stress.0[4] -= lost;
                if let Some(t) = &mut a.tangent {
                    t[4][4] *= if a.strain.iter().all(|e| e.abs() < 1e-9) { 1.0 } else { 0.9 };
                }
            }
        }),
        ("is NaN", |a| a.response.stress.0 = a.response.stress.0.map(|s| if s.is_nan() { 0.0 } else { s })),
        ("in other units", |a| {
            // A softening by 0.1 MPa, whatever the units.
            let gamma = a.strain[5];
            a.response.stress.0[5] -= 1e5 * gamma.powi(3);
            a.response.energy.stored -= 0.25e5 * gamma.powi(4);
            if let Some(t) = &mut a.tangent {
                t[5][5] -= 3e5 * gamma * gamma;
            }
        }),
        ("remembers", |a| {
            if a.seen {
                a.response.stress.0[0] *= 1.0 + 1e-7
            }
        }),
    ] {
        let said = check(spoil).expect_err(want);
        assert!(said.contains(want), "{want}: {said}");
    }
}
