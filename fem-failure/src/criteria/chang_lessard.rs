//! Chang and Lessard's criterion in Shokrieh and Lessard's three-dimensional form.

use crate::prelude::*;

/// Seven modes of a ply, among them the fibre-matrix shear that goes with fibre compression.
///
/// ```text
/// fibre tension       σ11 ≥ 0  (σ11/Xt)² + (σ12/S12)² + (σ31/S12)²
/// fibre compression   σ11 < 0  (σ11/Xc)²
/// fibre-matrix shear  σ11 < 0  (σ11/Xc)² + (σ12/S12)² + (σ31/S12)²
/// matrix              σ22      (σ22/Y)² + (σ12/S12)² + (σ23/S23)²    Y = Yt or Yc by sign
/// thickness           σ33      (σ33/Y)² + (σ31/S12)² + (σ23/S23)²
/// ```
///
/// Linear shear. Not invariant about the fibre.
#[derive(Debug, Clone, Copy, Default)]
pub struct ChangLessard;

impl ChangLessard {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 7] {
        let r = &m.strengths;
        let (a, b) = ((s.s12() / r.s12()).powi(2), (s.s31() / r.s12()).powi(2));
        let c = (s.s23() / r.s23()).powi(2);
        let (fibre, matrix, normal) = (s.s11() >= 0.0, s.s22() >= 0.0, s.s33() >= 0.0);
        let compressed = (s.s11() / r.xc()).powi(2);
        [
            Terms::quadratic((s.s11() / r.xt()).powi(2) + a + b).when(fibre),
            Terms::quadratic(compressed).when(!fibre),
            Terms::quadratic(compressed + a + b).when(!fibre),
            Terms::quadratic((s.s22() / r.yt()).powi(2) + a + c).when(matrix),
            Terms::quadratic((s.s22() / r.yc()).powi(2) + a + c).when(!matrix),
            Terms::quadratic((s.s33() / r.yt()).powi(2) + b + c).when(normal),
            Terms::quadratic((s.s33() / r.yc()).powi(2) + b + c).when(!normal),
        ]
    }
}

impl FailureCriterion for ChangLessard {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &[
                "fibre tension",
                "fibre compression",
                "fibre-matrix shear",
                "matrix tension",
                "matrix compression",
                "thickness tension",
                "thickness compression",
            ],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12, Strength::S23],
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let r = &m.strengths;
        let square = |v: f64| v * v;
        let shear = |of: Interval, strength: f64| square(of.magnitude() / strength);
        let (a, b, c) = (shear(s.s12(), r.s12()), shear(s.s31(), r.s12()), shear(s.s23(), r.s23()));
        let tension = |of: Interval, strength: f64, shears: f64| {
            when(of.reaches_positive(), square(of.positive().high / strength) + shears)
        };
        let compression = |of: Interval, strength: f64, shears: f64| {
            when(of.reaches_negative(), square(of.negative().low / strength) + shears)
        };
        out.copy_from_slice(&[
            tension(s.s11(), r.xt(), a + b),
            compression(s.s11(), r.xc(), 0.0),
            compression(s.s11(), r.xc(), a + b),
            tension(s.s22(), r.yt(), a + c),
            compression(s.s22(), r.yc(), a + c),
            tension(s.s33(), r.yt(), b + c),
            compression(s.s33(), r.yc(), b + c),
        ]);
    }
}

impl Plugin for ChangLessard {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "chang-lessard",
        summary: "fibre, matrix, fibre-matrix shear and thickness, three-dimensional",
        source: "Chang and Lessard, J. Compos. Mater. 25 (1991) 2; Shokrieh and Lessard (2000)",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self)))
    }
}
