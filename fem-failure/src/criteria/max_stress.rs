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

/// What no [`limits`] exceed, of components 11 22 33 and 12 23 31 in these intervals.
#[inline]
pub(crate) fn bounds(
    normal: [Interval; 3],
    sheared: [Interval; 3],
    tension: [f64; 3],
    compression: [f64; 3],
    shear: [f64; 3],
) -> [f64; 9] {
    let of = |i: usize| [normal[i].high.max(0.0) / tension[i], (-normal[i].low).max(0.0) / compression[i]];
    let [[t1, c1], [t2, c2], [t3, c3]] = [of(0), of(1), of(2)];
    let [s12, s23, s31] = [0, 1, 2].map(|i| sheared[i].magnitude() / shear[i]);
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
        let (r, sheared) = (&m.strengths, [s.s12(), s.s23(), s.s31()]);
        let (normal, shear) = ([s.s11(), s.s22(), s.s33()], [r.s12(), r.s23(), r.s12()]);
        out.copy_from_slice(&bounds(normal, sheared, [r.xt(), r.yt(), r.yt()], [r.xc(), r.yc(), r.yc()], shear));
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
