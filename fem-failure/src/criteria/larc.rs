//! What the LaRC criteria share: friction on the fracture plane and the rotation of misaligned fibres.

use crate::prelude::*;
use std::f64::consts::FRAC_PI_4;

/// Stiffness against turning, over that without a load, below which rounding could make it none.
const UNSTABLE: f64 = 1e-6;

/// Constants of a ply that follow from its strengths and the fracture angle α0 under transverse compression.
///
/// ```text
/// ST = Yc cos α0 (sin α0 + cos α0/tan 2α0),  ηT = −1/tan 2α0,  ηL = −S12 cos 2α0/(Yc cos² α0)
/// φc = atan{[1 − √(1 − 4 (q + ηL) q)]/(2 (q + ηL))},  q = S12/Xc
/// ```
pub(crate) struct Friction {
    /// Shear strength across the fibre on the fracture plane, Pa.
    pub(crate) st: f64,
    pub(crate) eta_t: f64,
    pub(crate) eta_l: f64,
    /// Misalignment at failure under pure compression, radians.
    pub(crate) phi_c: f64,
}

pub(crate) const ALPHA0: ParamInfo =
    ParamInfo::number("alpha0", "fracture angle under transverse compression, degrees")
        .at_least(46.0)
        .at_most(60.0)
        .default(53.0);

pub(crate) fn alpha0_from(params: &Params) -> Result<f64, ParamError> {
    Ok(params.number(&ALPHA0)?.to_radians())
}

impl Friction {
    #[inline]
    pub(crate) fn new(alpha0: f64, m: &Material) -> Self {
        let r = &m.strengths;
        let cos = alpha0.cos();
        let cot = 1.0 / (2.0 * alpha0).tan();
        let eta_l = -r.s12() * (2.0 * alpha0).cos() / (r.yc() * cos * cos);
        let q = r.s12() / r.xc();
        Self {
            st: r.yc() * cos * (alpha0.sin() + cos * cot),
            eta_t: -cot,
            eta_l,
            // The quadratic's smaller root, in the form that does not cancel.
            phi_c: (2.0 * q / (1.0 + (1.0 - 4.0 * (q + eta_l) * q).sqrt())).atan(),
        }
    }

    /// Without a root for φc fibres kink under no compression at all.
    pub(crate) fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        if self.phi_c.is_finite() {
            return Ok(());
        }
        let (s12, xc) = (m.strengths.s12(), m.strengths.xc());
        Err(UnmetCondition {
            condition: "4 (q + etaL) q <= 1 with q = S12/Xc",
            reason: "otherwise there is no kink angle",
            values: vec![("S12".into(), s12, "Pa"), ("Xc".into(), xc, "Pa")],
        })
    }

    /// φ over ranges of σ11, σ22 and |σ12|; none where fibres may be unstable, or may turn by more than an eighth.
    pub(crate) fn misalignments(
        &self,
        s11: Interval,
        s22: Interval,
        shear: Interval,
        m: &Material,
    ) -> Option<Interval> {
        let begun = (m.elastic.g12 - m.strengths.xc()) * self.phi_c;
        let stiffness = s11 - s22 + Interval::exactly(m.elastic.g12);
        if !(stiffness.low > UNSTABLE * m.elastic.g12) {
            return None;
        }
        let shear = shear + Interval::exactly(begun);
        let phi = shear * Interval { low: 1.0 / stiffness.high, high: 1.0 / stiffness.low };
        (phi.magnitude() < FRAC_PI_4).then_some(phi)
    }

    /// Sine and cosine of the angle by which fibres under σ11, σ22 and |σ12| have turned; none when they are unstable.
    #[inline]
    pub(crate) fn misalignment(&self, s11: f64, s22: f64, shear: f64, m: &Material) -> Option<(f64, f64)> {
        let stiffness = m.elastic.g12 + s11 - s22;
        let phi = (shear + (m.elastic.g12 - m.strengths.xc()) * self.phi_c) / stiffness;
        (stiffness > 0.0).then(|| phi.sin_cos())
    }
}

/// σ22 and σ12 ≥ 0 in the frame turned by an angle with this sine and cosine.
#[inline]
pub(crate) fn turned(s11: f64, s22: f64, s12: f64, (s, c): (f64, f64)) -> (f64, f64) {
    (s11 * s * s + s22 * c * c - 2.0 * s12 * s * c, (s22 - s11) * s * c + s12 * (c * c - s * s))
}

/// Ranges of σ22 and σ12 in frames turned by the angles `phi`, and of the sines of these.
pub(crate) struct Turned {
    pub(crate) normal: Interval,
    pub(crate) shear: Interval,
    pub(crate) sin: Interval,
}

impl Turned {
    /// As [`turned`], of σ12 ≥ 0 and angles of at most an eighth of a turn.
    pub(crate) fn of(s11: Interval, s22: Interval, s12: Interval, phi: Interval) -> Self {
        /// What sums of stresses may be off by.
        const ROUNDING: f64 = 1e-12;
        // Within an eighth of a turn the sine and that of twice the angle grow, and both cosines fall with its size.
        let grows = |of: fn(f64) -> f64| Interval { low: of(phi.low), high: of(phi.high) };
        let size = phi.abs();
        let falls = |of: fn(f64) -> f64| Interval { low: of(size.high), high: of(size.low) };
        let (sin, sin_cos) = (grows(f64::sin), grows(|phi| 0.5 * (2.0 * phi).sin()));
        let (cos, cos_twice) = (falls(f64::cos), falls(|phi| (2.0 * phi).cos()));
        let off = ROUNDING * (s11.magnitude() + s22.magnitude() + s12.magnitude());
        let off = Interval { low: -off, high: off };
        Self {
            normal: s11 * sin.squared() + s22 * cos.squared() - s12 * sin_cos * 2.0 + off,
            shear: (s22 - s11) * sin_cos + s12 * cos_twice + off,
            sin,
        }
    }
}
