//! Hashin and Rotem's criterion with its usual companion through the thickness.

use crate::prelude::*;

/// Hashin and Rotem (1973) for plane stress, and the same shape on σ33 for delamination.
///
/// ```text
/// fibre tension             σ11 ≥ 0   σ11/Xt
/// fibre compression         σ11 < 0   −σ11/Xc
/// matrix tension            σ22 ≥ 0   (σ22/Yt)² + (σ12/S12)²
/// matrix compression        σ22 < 0   (σ22/Yc)² + (σ12/S12)²
/// delamination tension      σ33 ≥ 0   (σ33/Yt)² + (σ31/S12)² + (σ23/S23)²
/// delamination compression  σ33 < 0   (σ33/Yc)² + (σ31/S12)² + (σ23/S23)²
/// ```
///
/// The delamination modes are not in the paper. Not invariant about the fibre.
#[derive(Debug, Clone, Copy, Default)]
pub struct HashinRotem;

impl HashinRotem {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 6] {
        let r = &m.strengths;
        let in_plane = (s.s12() / r.s12()).powi(2);
        let interlaminar = (s.s31() / r.s12()).powi(2) + (s.s23() / r.s23()).powi(2);
        let (fibre, matrix, normal) = (s.s11() >= 0.0, s.s22() >= 0.0, s.s33() >= 0.0);
        [
            Terms::linear(s.s11() / r.xt()).when(fibre),
            Terms::linear(-s.s11() / r.xc()).when(!fibre),
            Terms::quadratic((s.s22() / r.yt()).powi(2) + in_plane).when(matrix),
            Terms::quadratic((s.s22() / r.yc()).powi(2) + in_plane).when(!matrix),
            Terms::quadratic((s.s33() / r.yt()).powi(2) + interlaminar).when(normal),
            Terms::quadratic((s.s33() / r.yc()).powi(2) + interlaminar).when(!normal),
        ]
    }
}

impl FailureCriterion for HashinRotem {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &[
                "fibre tension",
                "fibre compression",
                "matrix tension",
                "matrix compression",
                "delamination tension",
                "delamination compression",
            ],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12, Strength::S23],
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let r = &m.strengths;
        let in_plane = (s.s12().magnitude() / r.s12()).powi(2);
        let interlaminar = (s.s31().magnitude() / r.s12()).powi(2) + (s.s23().magnitude() / r.s23()).powi(2);
        let pulled = |along: Interval, strength: f64, shear: f64| {
            when(along.reaches_positive(), (along.positive().high / strength).powi(2) + shear)
        };
        let pressed = |along: Interval, strength: f64, shear: f64| {
            when(along.reaches_negative(), (along.low / strength).powi(2) + shear)
        };
        out.copy_from_slice(&[
            when(s.s11().reaches_positive(), s.s11().high / r.xt()),
            when(s.s11().reaches_negative(), -s.s11().low / r.xc()),
            pulled(s.s22(), r.yt(), in_plane),
            pressed(s.s22(), r.yc(), in_plane),
            pulled(s.s33(), r.yt(), interlaminar),
            pressed(s.s33(), r.yc(), interlaminar),
        ]);
    }
}

impl Plugin for HashinRotem {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "hashin-rotem",
        summary: "fibre and matrix in plane stress, and delamination of the same shape",
        source: "Hashin and Rotem, J. Compos. Mater. 7 (1973) 448; delamination modes are customary",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self)))
    }
}
