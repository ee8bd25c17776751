//! Puck's criterion in plane stress.

use super::plane_stress::OutOfPlane;
use super::puck::{
    E1F, FIBRE, FibreFailure, MOST_WEAKENED, MSF, NU12F, WEAKENING, check_slope, read_common_params, weakening,
};
use crate::prelude::*;

/// Puck's closed form for plane stress, with the plane's own inclination p23 = p12c RA/S12.
///
/// ```text
/// RA = S12/(2 p12c) (√(1 + 2 p12c Yc/S12) − 1),  σ12c = S12 √(1 + 2 p23)
/// mode A  σ22 ≥ 0                   √{(σ12/S12)² + (1 − p12t Yt/S12)² (σ22/Yt)²} + p12t σ22/S12
/// mode B  σ22 < 0, −σ22 σ12c ≤ RA |σ12|  [√{σ12² + (p12c σ22)²} + p12c σ22]/S12
/// mode C  σ22 < 0 otherwise         [(σ12/(2 (1 + p23) S12))² + (σ22/Yc)²] Yc/(−σ22)
/// ```
///
/// With p23t = p23c = p23 the three-dimensional search finds the same.
#[derive(Debug, Clone, Copy)]
pub struct Puck2d {
    /// Inclination at σ22 = 0 towards tension.
    pub p12t: f64,
    /// Inclination at σ22 = 0 towards compression.
    pub p12c: f64,
    /// Fibre failure.
    pub fibre: FibreFailure,
    /// Whether a stress along the fibres weakens the matrix.
    pub weakening: bool,
    /// Treatment of the other three stresses.
    pub out_of_plane: OutOfPlane,
}

impl Default for Puck2d {
    fn default() -> Self {
        Self {
            p12t: P12T.default_number(),
            p12c: P12C.default_number(),
            fibre: FibreFailure::Simple,
            weakening: false,
            out_of_plane: OutOfPlane::default(),
        }
    }
}

impl Puck2d {
    /// RA, the fracture resistance across the fibre, Pa, and p23.
    pub fn transverse(&self, m: &Material) -> (f64, f64) {
        let s12 = m.strengths.s12();
        let ra = 0.5 * s12 / self.p12c * ((1.0 + 2.0 * self.p12c * m.strengths.yc() / s12).sqrt() - 1.0);
        (ra, self.p12c * ra / s12)
    }

    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 5] {
        if !self.out_of_plane.admits(s) {
            return [Terms::REFUSED; 5];
        }
        let r = &m.strengths;
        let (s2, tau) = (s.s22(), s.s12().abs());
        let (ra, p23) = self.transverse(m);
        let plane = Stress6::new([s.s11(), s2, 0.0, s.s12(), 0.0, 0.0]);
        let [tension, compression] = self.fibre.exposures(&plane, m);
        let inter = |exposure: f64, on: bool| {
            let factor = if self.weakening { weakening(exposure, tension.max(compression)) } else { 1.0 };
            Terms::linear(exposure * factor).when(on)
        };
        let flat = -s2 * (1.0 + 2.0 * p23).sqrt() * r.s12() <= ra * tau;
        let opens = s2 >= 0.0;
        let a = (tau / r.s12()).hypot((1.0 - self.p12t * r.yt() / r.s12()) * s2 / r.yt()) + self.p12t * s2 / r.s12();
        let b = (tau.hypot(self.p12c * s2) + self.p12c * s2) / r.s12();
        let c = ((tau / (2.0 * (1.0 + p23) * r.s12())).powi(2) + (s2 / r.yc()).powi(2)) * r.yc() / -s2;
        [
            Terms::linear(tension),
            Terms::linear(compression),
            inter(a, opens),
            inter(b, !opens && flat),
            inter(c, !opens && !flat),
        ]
    }
}

impl FailureCriterion for Puck2d {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &[
                "fibre tension",
                "fibre compression",
                "inter-fibre mode A",
                "inter-fibre mode B",
                "inter-fibre mode C",
            ],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12],
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    /// Modes A and B grow with σ22 and |σ12|; of mode C, where |σ12| ≤ −k σ22, the first term is at most that of −σ22 = |σ12|/k.
    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        if !self.out_of_plane.admits_all(s) {
            return out.fill(f64::INFINITY);
        }
        let r = &m.strengths;
        let (s2, tau) = (s.s22(), s.s12().magnitude());
        let flat = |of: Stress6<Ply>| Stress6::new([of.s11(), of.s22(), 0.0, of.s12(), 0.0, 0.0]);
        let [tension, compression] = self.fibre.bounds(&StressRange { low: flat(s.low), high: flat(s.high) }, m);
        let (ra, p23) = self.transverse(m);
        let k = (1.0 + 2.0 * p23).sqrt() * r.s12() / ra;
        let (opened, pressed) = (s2.positive().high, -s2.negative().low);
        let a = (tau / r.s12()).hypot((1.0 - self.p12t * r.yt() / r.s12()) * opened / r.yt())
            + self.p12t * opened / r.s12();
        let inclined = (2.0 * (1.0 + p23) * r.s12()).powi(2);
        let c = tau.min(k * pressed) * k * r.yc() / inclined + pressed / r.yc();
        let most = if self.weakening { MOST_WEAKENED } else { 1.0 };
        out.copy_from_slice(&[
            tension,
            compression,
            when(s2.reaches_positive(), most * a),
            when(s2.reaches_negative(), most * tau / r.s12()),
            when(s2.reaches_negative(), most * c),
        ]);
    }

    fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        check_slope("p12t Yt/S12 < 1", self.p12t * m.strengths.yt() / m.strengths.s12())
    }

    fn scope(&self) -> &'static str {
        self.out_of_plane.scope()
    }
}

const P12T: ParamInfo = ParamInfo::number("p12t", "inclination towards tension; recommended for carbon")
    .at_least(0.0)
    .at_most(1.0)
    .default(0.35);
const P12C: ParamInfo =
    ParamInfo::number("p12c", "inclination towards compression").at_least(0.01).at_most(1.0).default(0.30);

impl Plugin for Puck2d {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "puck-2d",
        summary: "inter-fibre modes A, B, C and fibre failure in plane stress",
        source: "Puck and Schuermann, Compos. Sci. Technol. 58 (1998) 1045; VDI 2014 Part 3",
        params: &[P12T, P12C, FIBRE, E1F, NU12F, MSF, WEAKENING, OutOfPlane::PARAM],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let (fibre, weakening) = read_common_params(params)?;
        Ok(Built::Criterion(Box::new(Self {
            p12t: params.number(&P12T)?,
            p12c: params.number(&P12C)?,
            fibre,
            weakening,
            out_of_plane: OutOfPlane::from_params(params)?,
        })))
    }
}
