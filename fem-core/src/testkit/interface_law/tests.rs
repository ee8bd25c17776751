use super::check_interface_law;
use crate::contracts::interface_law::{InterfaceLaw, InterfaceResponse, Jump, Sinks};
use crate::contracts::plugin::Dimension;
use crate::contracts::ply_law::{LawError, LawInfo, LawPoint};
use crate::testkit::Units;
use crate::words::material::{Elastic, Material, Strengths, Toughnesses};

/// Softens linearly with the norm of the opening, and presses back linearly; one mode for all directions.
#[derive(Debug, Clone)]
struct Softening {
    /// Penalty, Pa/m; onset and end, m.
    k: f64,
    onset: f64,
    end: f64,
    /// What a fault does to the damage, and to the answer.
    heal: f64,
    pull: f64,
    /// What moves to and fro between its sinks.
    leak: f64,
}

impl InterfaceLaw for Softening {
    fn info(&self) -> &LawInfo {
        const INFO: LawInfo = LawInfo { state: &["damage", "dissipated", "by shear"], strengths: &[], toughness: &[] };
        &INFO
    }

    fn damage(&self, _: &LawPoint<'_>, state: &[f64]) -> f64 {
        state[0]
    }

    fn dissipated(&self, state: &[f64]) -> Sinks {
        Sinks { opening: state[1] - state[2], shear: state[2], friction: 0.0 }
    }

    fn broken(&self, _: &LawPoint<'_>, state: &mut [f64]) {
        state[0] = 1.0;
    }

    fn respond(
        &self,
        _: &LawPoint<'_>,
        jump: &Jump,
        old: &[f64],
        new: &mut [f64],
        tangent: Option<&mut [Jump; 3]>,
    ) -> Result<InterfaceResponse, LawError> {
        let Self { k, onset, end, .. } = *self;
        let [n, s, t] = *jump;
        // Not `max`, which a NaN would pass.
        let opening = [if n <= 0.0 { 0.0 } else { n }, s, t];
        let norm = opening.iter().map(|v| v * v).sum::<f64>().sqrt();
        let damage =
            |norm: f64| if norm > onset { (end * (norm - onset) / (norm * (end - onset))).min(1.0) } else { 0.0 };
        new[0] = if damage(norm).is_nan() { f64::NAN } else { damage(norm).max(self.heal * old[0]) };
        // ∫ ½ k λ² dd with λ = f o / (f − d (f − o)).
        new[1] = 0.5 * k * onset * end * (new[0] * onset / (end - new[0] * (end - onset)));
        let sound = 1.0 - new[0];
        let mut traction = opening.map(|v| sound * k * v);
        traction[0] += k * n.min(0.0) * self.pull;
        if let Some(tangent) = tangent {
            *tangent = [[0.0; 3]; 3];
            // ∂d/∂λ of a damage that grows.
            let slope = if new[0] > old[0] && new[0] < 1.0 { end * onset / (norm * norm * (end - onset)) } else { 0.0 };
            for i in 0..3 {
                let open = |i: usize| i > 0 || n > 0.0;
                for j in 0..3 {
                    if open(i) && open(j) && norm > 0.0 {
                        tangent[i][j] = -slope * k * opening[i] * opening[j] / norm;
                    }
                }
                tangent[i][i] += if open(i) { sound * k } else { k * self.pull };
            }
        }
        let stored = 0.5 * traction.iter().zip(jump).map(|(t, d)| t * d).sum::<f64>();
        new[2] = self.leak * new[1] * jump[1].abs() / self.end;
        Ok(InterfaceResponse { traction, stored, dissipated: self.dissipated(new) })
    }
}

fn check(heal: f64, pull: f64, leak: f64) -> Result<(), String> {
    let resin = Material {
        name: "resin".into(),
        elastic: Elastic::isotropic(3.8e9, 0.36),
        density: None,
        strengths: Strengths::default(),
        toughness: Toughnesses::default(),
        eta: None,
        expansion: None,
    };
    let make = |units: &Units| -> Box<dyn InterfaceLaw> {
        let stiffness = Dimension([-2.0, 1.0, -2.0, 0.0]);
        let [onset, end] = [1e-6, 2e-5].map(|v| units.number(v, Dimension::LENGTH));
        Box::new(Softening { k: units.number(6e13, stiffness), onset, end, heal, pull, leak })
    };
    check_interface_law(make, &resin, 1e-3, &[3e-5, 3e-5, 3e-5])
}

#[test]
fn a_sound_law_passes() {
    assert_eq!(check(1.0, 1.0, 0.0), Ok(()));
}

#[test]
fn faults_are_found() {
    let healing = check(0.9, 1.0, 0.0).unwrap_err();
    assert!(healing.contains("dissipated energy falls") || healing.contains("is not the work"), "{healing}");
    let negative = check(1.0, -1.0, 0.0).unwrap_err();
    assert!(negative.contains("stored energy is negative"), "{negative}");
    let leaking = check(1.0, 1.0, 0.5).unwrap_err();
    assert!(leaking.contains("dissipated energy falls"), "{leaking}");
}
