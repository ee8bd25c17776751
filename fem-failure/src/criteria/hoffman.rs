//! Hoffman.

use crate::prelude::*;

/// Hoffman's polynomial for a transversely isotropic ply, one index for all modes.
///
/// ```text
/// C1 (σ22 − σ33)² + C2 [(σ33 − σ11)² + (σ11 − σ22)²] + (1/Xt − 1/Xc) σ11 + (1/Yt − 1/Yc)(σ22 + σ33)
///   + (σ23/S23)² + (σ31² + σ12²)/S12²
/// C1 = 1/(Yt Yc) − 1/(2 Xt Xc), C2 = 1/(2 Xt Xc)
/// ```
///
/// Tsai-Wu with F12 = −F11/2. Equal compression on all sides never fails. Not invariant about the fibre.
#[derive(Debug, Clone, Copy, Default)]
pub struct Hoffman;

impl Hoffman {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 1] {
        let r = &m.strengths;
        let c2 = 0.5 / (r.xt() * r.xc());
        let c1 = 1.0 / (r.yt() * r.yc()) - c2;
        let square = |v: f64| v * v;
        [Terms {
            linear: (1.0 / r.xt() - 1.0 / r.xc()) * s.s11() + (1.0 / r.yt() - 1.0 / r.yc()) * (s.s22() + s.s33()),
            quadratic: c1 * square(s.s22() - s.s33())
                + c2 * (square(s.s33() - s.s11()) + square(s.s11() - s.s22()))
                + square(s.s23() / r.s23())
                + (square(s.s31()) + square(s.s12())) / square(r.s12()),
        }]
    }
}

impl FailureCriterion for Hoffman {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["ply failure"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12, Strength::S23],
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let (r, [s11, s22, s33]) = (&m.strengths, [s.s11(), s.s22(), s.s33()]);
        let c2 = 0.5 / (r.xt() * r.xc());
        let c1 = 1.0 / (r.yt() * r.yc()) - c2;
        out[0] = most_of_sum([
            s11 * (1.0 / r.xt() - 1.0 / r.xc()),
            (s22 + s33) * (1.0 / r.yt() - 1.0 / r.yc()),
            (s22 - s33).squared() * c1,
            (s33 - s11).squared() * c2,
            (s11 - s22).squared() * c2,
            s.s23().squared() * (1.0 / (r.s23() * r.s23())),
            (s.s31().squared() + s.s12().squared()) * (1.0 / (r.s12() * r.s12())),
        ]);
    }
}

impl Plugin for Hoffman {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "hoffman",
        summary: "Hill's form with linear terms, one index for the ply",
        source: "Hoffman, J. Compos. Mater. 1 (1967) 200",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self)))
    }
}
