//! Tsai-Hill and Azzi-Tsai, plane stress.

use super::plane_stress::OutOfPlane;
use crate::prelude::*;

/// Interaction term of the plane Hill form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interaction {
    /// −σ11 σ22/X².
    #[default]
    TsaiHill,
    /// −|σ11 σ22|/X².
    AzziTsai,
}

/// Hill's form for a ply in plane stress, strengths by the sign of each stress.
///
/// ```text
/// (σ11/X)² − σ11 σ22/X² + (σ22/Y)² + (σ12/S12)²
/// ```
///
/// Plane stress only: Hill's three-dimensional form with strengths chosen by sign is indefinite, so that a fifth of all
/// stresses would never fail. `hoffman` is its three-dimensional relative.
#[derive(Debug, Clone, Copy, Default)]
pub struct TsaiHill {
    /// Interaction of σ11 and σ22.
    pub interaction: Interaction,
    /// Treatment of the other three stresses.
    pub out_of_plane: OutOfPlane,
}

impl TsaiHill {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 1] {
        if !self.out_of_plane.admits(s) {
            return [Terms::REFUSED];
        }
        let r = &m.strengths;
        let x = if s.s11() >= 0.0 { r.xt() } else { r.xc() };
        let y = if s.s22() >= 0.0 { r.yt() } else { r.yc() };
        let product = match self.interaction {
            Interaction::TsaiHill => s.s11() * s.s22(),
            Interaction::AzziTsai => (s.s11() * s.s22()).abs(),
        };
        [Terms::quadratic(
            (s.s11() * s.s11() - product) / (x * x) + (s.s22() / y).powi(2) + (s.s12() / r.s12()).powi(2),
        )]
    }
}

impl FailureCriterion for TsaiHill {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["ply failure"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12],
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        if !self.out_of_plane.admits_all(s) {
            return out.fill(f64::INFINITY);
        }
        let (r, s22) = (&m.strengths, s.s22());
        let along = |s11: Interval, x: f64| {
            let product = match self.interaction {
                Interaction::TsaiHill => s11 * s22,
                Interaction::AzziTsai => Interval { low: 0.0, high: 0.0 },
            };
            most_of_sum([s11.squared(), product * -1.0]) / (x * x)
        };
        let across = f64::max(s22.positive().high / r.yt(), -s22.negative().low / r.yc());
        let along = f64::max(along(s.s11().positive(), r.xt()), along(s.s11().negative(), r.xc()));
        out[0] = along + across.powi(2) + (s.s12().magnitude() / r.s12()).powi(2);
    }

    fn scope(&self) -> &'static str {
        self.out_of_plane.scope()
    }
}

const INTERACTION: ParamInfo = ParamInfo::word(
    "interaction",
    "product of s11 and s22",
    &[("tsai-hill", "-s11 s22/X^2"), ("azzi-tsai", "-|s11 s22|/X^2")],
);

impl Plugin for TsaiHill {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "tsai-hill",
        summary: "Hill's quadratic form in plane stress, one index for the ply",
        source: "Azzi and Tsai, Exp. Mech. 5 (1965) 283; Hill (1950)",
        params: &[INTERACTION, OutOfPlane::PARAM],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let interaction = match params.word(&INTERACTION)? {
            "azzi-tsai" => Interaction::AzziTsai,
            _ => Interaction::TsaiHill,
        };
        Ok(Built::Criterion(Box::new(Self { interaction, out_of_plane: OutOfPlane::from_params(params)? })))
    }
}
