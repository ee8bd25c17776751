//! Maximum stress.

use crate::prelude::*;

/// Modes of the two limit criteria, in the order that [`limits`] writes.
pub(crate) const LIMIT_MODES: &[&str] = &[
    "fibre tension",
    "fibre compression",
    "transverse tension",
    "transverse compression",
    "thickness tension",
    "thickness compression",
    "shear 23",
    "shear 31",
    "shear 12",
];

/// Each component of a tensor (order of [`Stress6`]) over its limit, tension and compression apart.
#[inline]
pub(crate) fn limits(v: &[f64; 6], tension: [f64; 3], compression: [f64; 3], shear: [f64; 3]) -> [Terms; 9] {
    let normal = |i: usize| {
        let pulled = v[i] >= 0.0;
        [Terms::linear(v[i] / tension[i]).when(pulled), Terms::linear(-v[i] / compression[i]).when(!pulled)]
    };
    let [[t1, c1], [t2, c2], [t3, c3]] = [normal(0), normal(1), normal(2)];
    let [s12, s23, s31] = [0, 1, 2].map(|i| Terms::linear(v[3 + i].abs() / shear[i]));
    [t1, c1, t2, c2, t3, c3, s23, s31, s12]
}

/// Every component over its strength: |σi|/strength, with the thickness as strong as the transverse direction and
/// S31 = S12. No interaction; not invariant about the fibre.
#[derive(Debug, Clone, Copy, Default)]
pub struct MaxStress;

impl MaxStress {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 9] {
        let r = &m.strengths;
        let shear = [r.s12(), r.s23(), r.s12()];
        limits(&s.0, [r.xt(), r.yt(), r.yt()], [r.xc(), r.yc(), r.yc()], shear)
    }
}

impl FailureCriterion for MaxStress {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: LIMIT_MODES,
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12, Strength::S23],
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let r = &m.strengths;
        let (pulled, pressed) = (|v: f64, limit: f64| v.max(0.0) / limit, |v: f64, limit: f64| (-v).max(0.0) / limit);
        out.copy_from_slice(&[
            pulled(s.s11().high, r.xt()),
            pressed(s.s11().low, r.xc()),
            pulled(s.s22().high, r.yt()),
            pressed(s.s22().low, r.yc()),
            pulled(s.s33().high, r.yt()),
            pressed(s.s33().low, r.yc()),
            s.s23().magnitude() / r.s23(),
            s.s31().magnitude() / r.s12(),
            s.s12().magnitude() / r.s12(),
        ]);
    }
}

impl Plugin for MaxStress {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "max-stress",
        summary: "each stress component against its strength, no interaction",
        source: "common practice",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self)))
    }
}
