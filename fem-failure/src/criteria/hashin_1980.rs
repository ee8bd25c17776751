//! Hashin's criterion for unidirectional composites, three-dimensional.

use crate::prelude::*;

/// Hashin (1980), quadratic in the invariants of transverse isotropy.
///
/// ```text
/// fibre tension       σ11 ≥ 0        (σ11/Xt)² + (σ12² + σ31²)/S12²
/// fibre compression   σ11 < 0        (σ11/Xc)²
/// matrix tension      σ22 + σ33 ≥ 0  ((σ22 + σ33)/Yt)² + (σ23² − σ22 σ33)/S23² + (σ12² + σ31²)/S12²
/// matrix compression  σ22 + σ33 < 0  [(Yc/2S23)² − 1] (σ22 + σ33)/Yc + (σ22 + σ33)²/4S23²
///                                    + (σ23² − σ22 σ33)/S23² + (σ12² + σ31²)/S12²
/// ```
///
/// The paper prints fibre compression as −σ11 = Xc: the same surface. The matrix modes meet continuously, the fibre modes
/// do not: at σ11 = 0 the index falls from (σ12² + σ31²)/S12² to 0. With Yc > 2 S23, as usual, equal compression across
/// the fibre never fails and its index is negative; with Yc < 2 S23 it fails early. S23 is rarely measured.
#[derive(Debug, Clone, Copy, Default)]
pub struct Hashin1980;

impl Hashin1980 {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 4] {
        let r = &m.strengths;
        let along = (s.s12() * s.s12() + s.s31() * s.s31()) / (r.s12() * r.s12());
        let (across, s23) = (s.s23() * s.s23(), r.s23() * r.s23());
        let (sum, half) = (s.s22() + s.s33(), 0.5 * (s.s22() - s.s33()));
        let (fibre, opening) = (s.s11() >= 0.0, sum >= 0.0);
        let closing = Terms {
            linear: (r.yc() * r.yc() / (4.0 * s23) - 1.0) * sum / r.yc(),
            // (σ22 + σ33)²/4 − σ22 σ33 without its cancellation.
            quadratic: (half * half + across) / s23 + along,
        };
        [
            Terms::quadratic((s.s11() / r.xt()).powi(2) + along).when(fibre),
            Terms::quadratic((s.s11() / r.xc()).powi(2)).when(!fibre),
            Terms::quadratic((sum / r.yt()).powi(2) + (across - s.s22() * s.s33()) / s23 + along).when(opening),
            closing.when(!opening),
        ]
    }
}

/// Without it equal tension across the fibre never fails.
pub(crate) fn check_transverse_tension(m: &Material) -> Result<(), UnmetCondition> {
    let (s23, yt) = (m.strengths.s23(), m.strengths.yt());
    if s23 > 0.5 * yt {
        return Ok(());
    }
    Err(UnmetCondition {
        condition: "S23 > Yt/2",
        reason: "otherwise equal tension across the fibre never fails",
        values: vec![("S23".into(), s23, "Pa"), ("Yt".into(), yt, "Pa")],
    })
}

impl FailureCriterion for Hashin1980 {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["fibre tension", "fibre compression", "matrix tension", "matrix compression"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12, Strength::S23],
            invariant_about_fibre: true,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let r = &m.strengths;
        let along = (s.s12().squared() + s.s31().squared()).high / (r.s12() * r.s12());
        let (across, s23) = (s.s23().squared(), r.s23() * r.s23());
        let (sum, half) = (s.s22() + s.s33(), (s.s22() - s.s33()) * 0.5);
        let linear = sum.negative() * (r.yc() * r.yc() / (4.0 * s23) - 1.0) * (1.0 / r.yc());
        out.copy_from_slice(&[
            when(s.s11().reaches_positive(), (s.s11().positive().high / r.xt()).powi(2) + along),
            when(s.s11().reaches_negative(), (s.s11().low / r.xc()).powi(2)),
            when(
                sum.reaches_positive(),
                (sum.positive().high / r.yt()).powi(2) + (across - s.s22() * s.s33()).high / s23 + along,
            ),
            when(sum.reaches_negative(), linear.high.max(0.0) + (half.squared() + across).high / s23 + along),
        ]);
    }

    fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        check_transverse_tension(m)
    }
}

impl Plugin for Hashin1980 {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "hashin-1980",
        summary: "fibre and matrix, tension and compression, three-dimensional",
        source: "Hashin, J. Appl. Mech. 47 (1980) 329",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self)))
    }
}
