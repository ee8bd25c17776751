//! An interface that softens exponentially: an interface law in one file.
//!
//! What to look at: one effective opening drives everything; the law remembers its largest value and what that took, by mode.
use fem_core::interface_law::{InterfaceLaw, InterfaceResponse, Jump, Sinks};
use fem_core::material::{Strength, Toughness};
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::ply_law::{LawError, LawInfo, LawPoint};

/// Ortiz and Pandolfi's irreversible law (Int. J. Numer. Meth. Eng. 44 (1999) 1267).
///
/// ```text
/// δ = √(⟨δn⟩² + β² δs²)                    effective opening
/// t = e Zt (δ/δc) exp(−δ/δc)               while it grows: Zt at δc = GIc/(e Zt); G = e Zt δc = GIc in every mode
/// t = t(δ_max) δ/δ_max                     on the way back, to the origin
/// ```
///
/// Tractions are t/δ times (δn, β² δs); faces in contact have the first stiffness.
///
/// State: 0 δ_max, m; 1 and 2 what opening and shear have taken, J/m², each by its share in δ².
#[derive(Debug, Clone, Copy)]
pub struct Exponential {
    /// Weight of the shears, β.
    pub weight: f64,
}

// ANCHOR: curves
/// The curve of a point.
struct Curve {
    /// Stiffness at the origin, e Zt/δc, Pa/m.
    stiffness: f64,
    /// δc, m.
    width: f64,
}

/// Openings over δc at which a number has no room for what is left.
const BROKEN: f64 = 1e3;

impl Curve {
    fn of(point: &LawPoint<'_>) -> Self {
        let peak = std::f64::consts::E * point.material.strengths.zt();
        let width = point.material.toughness.gic() / peak;
        Self { stiffness: peak / width, width }
    }

    /// t/δ with the largest opening `most`.
    fn secant(&self, most: f64) -> f64 {
        self.stiffness * (-most / self.width).exp()
    }

    /// Energy under the curve up to `most`, less the triangle that comes back.
    fn taken(&self, most: f64) -> f64 {
        let x = most / self.width;
        let unit = self.stiffness * self.width * self.width;
        unit * (-(-x).exp_m1() - x * (-x).exp() - 0.5 * x * x * (-x).exp())
    }
}
// ANCHOR_END: curves

// ANCHOR: law
impl InterfaceLaw for Exponential {
    fn info(&self) -> &LawInfo {
        const INFO: LawInfo = LawInfo {
            state: &["largest opening", "taken by opening", "taken by shear"],
            strengths: &[Strength::Zt],
            toughness: &[Toughness::GIc],
        };
        &INFO
    }

    /// What is lost beyond the peak, which is at δ = δc.
    fn damage(&self, point: &LawPoint<'_>, state: &[f64]) -> f64 {
        let curve = Curve::of(point);
        1.0 - curve.secant(state[0].max(curve.width)) / curve.secant(curve.width)
    }

    fn dissipated(&self, state: &[f64]) -> Sinks {
        Sinks { opening: state[1], shear: state[2], friction: 0.0 }
    }

    fn broken(&self, point: &LawPoint<'_>, state: &mut [f64]) {
        state[0] = BROKEN * Curve::of(point).width;
    }

    fn respond(
        &self,
        point: &LawPoint<'_>,
        jump: &Jump,
        old: &[f64],
        new: &mut [f64],
        tangent: Option<&mut [Jump; 3]>,
    ) -> Result<InterfaceResponse, LawError> {
        let (curve, closed) = (Curve::of(point), jump[0] < 0.0);
        let square = self.weight * self.weight;
        // What of the jump opens, weighted; its part in the normal is nothing where faces touch.
        let weights = [if closed { 0.0 } else { 1.0 }, square, square];
        let opening: Jump = std::array::from_fn(|k| weights[k] * jump[k]);
        let size = opening.iter().zip(jump).map(|(o, d)| o * d).sum::<f64>().sqrt();

        let grows = size > old[0];
        let most = if grows { size } else { old[0] };
        let taken = curve.taken(most) - curve.taken(old[0]);
        let share = if grows { opening[0] * jump[0] / (size * size) } else { 0.0 };
        new.copy_from_slice(&[most, old[1] + share * taken, old[2] + (1.0 - share) * taken]);

        let secant = curve.secant(most);
        let mut traction = opening.map(|o| secant * o);
        if let Some(tangent) = tangent {
            let slope = if grows { -secant / (curve.width * size) } else { 0.0 };
            *tangent = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    slope * opening[i] * opening[j] + if i == j { secant * weights[i] } else { 0.0 }
                })
            });
            if closed {
                tangent[0][0] = curve.stiffness;
            }
        }
        if closed {
            traction[0] = curve.stiffness * jump[0];
        }
        let stored = 0.5 * traction.iter().zip(jump).map(|(t, d)| t * d).sum::<f64>();
        Ok(InterfaceResponse { traction, stored, dissipated: self.dissipated(new) })
    }
}
// ANCHOR_END: law

// ANCHOR: plugin
const WEIGHT: ParamInfo =
    ParamInfo::number("weight", "of shears in the effective opening, beta").above(0.0).default(1.0);

impl Plugin for Exponential {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::InterfaceLaw,
        name: "exponential",
        summary: "exponential softening in one effective opening, the same toughness in all modes",
        source: "Ortiz and Pandolfi 1999",
        params: &[WEIGHT],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::InterfaceLaw(Box::new(Self { weight: params.number(&WEIGHT)? })))
    }
}
// ANCHOR_END: plugin
