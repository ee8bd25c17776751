//! Christensen.

use crate::prelude::*;

/// Christensen's two modes, polynomials in the invariants of transverse isotropy.
///
/// ```text
/// fibre   (1/Xt − 1/Xc) σ11 + σ11²/(Xt Xc)
/// matrix  (1/Yt − 1/Yc)(σ22 + σ33) + (σ22 + σ33)²/(Yt Yc) + (σ23² − σ22 σ33)/S23² + (σ12² + σ31²)/S12²
/// ```
///
/// Indices may be negative.
#[derive(Debug, Clone, Copy, Default)]
pub struct Christensen;

impl Christensen {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 2] {
        let r = &m.strengths;
        let sum = s.s22() + s.s33();
        [
            Terms { linear: (1.0 / r.xt() - 1.0 / r.xc()) * s.s11(), quadratic: s.s11() * s.s11() / (r.xt() * r.xc()) },
            Terms {
                linear: (1.0 / r.yt() - 1.0 / r.yc()) * sum,
                quadratic: sum * sum / (r.yt() * r.yc())
                    + (s.s23() * s.s23() - s.s22() * s.s33()) / (r.s23() * r.s23())
                    + (s.s12() * s.s12() + s.s31() * s.s31()) / (r.s12() * r.s12()),
            },
        ]
    }
}

impl FailureCriterion for Christensen {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["fibre", "matrix"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12, Strength::S23],
            invariant_about_fibre: true,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let (r, s11, sum) = (&m.strengths, s.s11(), s.s22() + s.s33());
        let per_s23 = 1.0 / (r.s23() * r.s23());
        out.copy_from_slice(&[
            most_of_sum([s11 * (1.0 / r.xt() - 1.0 / r.xc()), s11.squared() * (1.0 / (r.xt() * r.xc()))]),
            most_of_sum([
                sum * (1.0 / r.yt() - 1.0 / r.yc()),
                sum.squared() * (1.0 / (r.yt() * r.yc())),
                s.s23().squared() * per_s23,
                s.s22() * s.s33() * -per_s23,
                (s.s12().squared() + s.s31().squared()) * (1.0 / (r.s12() * r.s12())),
            ]),
        ]);
    }
}

impl Plugin for Christensen {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "christensen",
        summary: "fibre and matrix, tension and compression in one polynomial each",
        source: "Christensen, J. Eng. Mater. Technol. 119 (1997) 12; The Theory of Materials Failure (2013)",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self)))
    }
}
