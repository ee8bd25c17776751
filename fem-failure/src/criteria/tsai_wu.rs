//! Tsai-Wu.

use crate::prelude::*;

/// How σ22 σ33 enters the Tsai-Wu polynomial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Transverse {
    /// F23 = −F22/2, in analogy with von Mises; a rotation about the fibre changes the index.
    #[default]
    Half,
    /// F23 = F22 − F44/2, the only choice that a rotation about the fibre leaves unchanged.
    Isotropic,
}

/// Tsai and Wu's tensor polynomial for a transversely isotropic ply, one index for all modes.
///
/// ```text
/// F1 σ11 + F2 (σ22 + σ33) + F11 σ11² + F22 (σ22² + σ33²) + F44 σ23² + F66 (σ12² + σ31²)
///   + 2 F12 σ11 (σ22 + σ33) + 2 F23 σ22 σ33
/// F1 = 1/Xt − 1/Xc, F11 = 1/(Xt Xc), F2, F22 alike, F44 = 1/S23², F66 = 1/S12², F12 = f12 √(F11 F22)
/// ```
///
/// f12 = −1/2 by default, in analogy with von Mises; a biaxial test gives better. A choice that makes the quadratic part
/// indefinite for the material at hand, an open surface, is refused.
#[derive(Debug, Clone, Copy)]
pub struct TsaiWu {
    /// Normalised interaction of σ11 with σ22 and σ33, between −1 and 1.
    pub f12: f64,
    /// Interaction of σ22 and σ33.
    pub transverse: Transverse,
}

impl Default for TsaiWu {
    fn default() -> Self {
        Self { f12: F12.default_number(), transverse: Transverse::Half }
    }
}

struct Coefficients {
    f1: f64,
    f2: f64,
    f11: f64,
    f22: f64,
    f44: f64,
    f66: f64,
    f12: f64,
    f23: f64,
}

impl TsaiWu {
    const fn describe(invariant_about_fibre: bool) -> CriterionInfo {
        CriterionInfo {
            site: Site::Ply,
            modes: &["ply failure"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12, Strength::S23],
            invariant_about_fibre,
        }
    }

    #[inline]
    fn coefficients(&self, m: &Material) -> Coefficients {
        let r = &m.strengths;
        let (f11, f22) = (1.0 / (r.xt() * r.xc()), 1.0 / (r.yt() * r.yc()));
        let f44 = 1.0 / (r.s23() * r.s23());
        Coefficients {
            f1: 1.0 / r.xt() - 1.0 / r.xc(),
            f2: 1.0 / r.yt() - 1.0 / r.yc(),
            f11,
            f22,
            f44,
            f66: 1.0 / (r.s12() * r.s12()),
            f12: self.f12 * (f11 * f22).sqrt(),
            f23: match self.transverse {
                Transverse::Half => -0.5 * f22,
                Transverse::Isotropic => f22 - 0.5 * f44,
            },
        }
    }

    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 1] {
        let f = self.coefficients(m);
        let sum = s.s22() + s.s33();
        [Terms {
            linear: f.f1 * s.s11() + f.f2 * sum,
            quadratic: f.f11 * s.s11() * s.s11()
                + f.f22 * (s.s22() * s.s22() + s.s33() * s.s33())
                + f.f44 * s.s23() * s.s23()
                + f.f66 * (s.s12() * s.s12() + s.s31() * s.s31())
                + 2.0 * (f.f12 * s.s11() * sum + f.f23 * s.s22() * s.s33()),
        }]
    }
}

impl FailureCriterion for TsaiWu {
    fn info(&self) -> &CriterionInfo {
        const HALF: CriterionInfo = TsaiWu::describe(false);
        const ISOTROPIC: CriterionInfo = TsaiWu::describe(true);
        match self.transverse {
            Transverse::Half => &HALF,
            Transverse::Isotropic => &ISOTROPIC,
        }
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let (f, s11, sum) = (self.coefficients(m), s.s11(), s.s22() + s.s33());
        out[0] = most_of_sum([
            s11 * f.f1,
            sum * f.f2,
            s11.squared() * f.f11,
            (s.s22().squared() + s.s33().squared()) * f.f22,
            s.s23().squared() * f.f44,
            (s.s12().squared() + s.s31().squared()) * f.f66,
            s11 * sum * (2.0 * f.f12),
            s.s22() * s.s33() * (2.0 * f.f23),
        ]);
    }

    fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        let f = self.coefficients(m);
        let require = |holds: bool, condition| match holds {
            true => Ok(()),
            false => Err(UnmetCondition {
                condition,
                reason: "otherwise the failure surface is open",
                values: [("F11", f.f11), ("F22", f.f22), ("F12", f.f12), ("F23", f.f23)]
                    .map(|(name, value)| (name.into(), value, "1/Pa^2"))
                    .into(),
            }),
        };
        // The default choice meets the last condition with equality: a paraboloid.
        let rounding = 1.0 - 1e-12;
        require(f.f11 * f.f22 >= rounding * f.f12 * f.f12, "F11 F22 >= F12^2")?;
        require(f.f22 >= rounding * f.f23.abs(), "|F23| <= F22")?;
        require(f.f22 + f.f23 >= rounding * 2.0 * f.f12 * f.f12 / f.f11, "F22 + F23 >= 2 F12^2/F11")
    }
}

const F12: ParamInfo = ParamInfo::number("f12", "F12/sqrt(F11 F22)").at_least(-1.0).at_most(1.0).default(-0.5);
const F23: ParamInfo = ParamInfo::word(
    "f23",
    "interaction of s22 and s33",
    &[("half", "F23 = -F22/2"), ("isotropic", "F23 = F22 - F44/2, invariant about the fibre")],
);

impl Plugin for TsaiWu {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "tsai-wu",
        summary: "tensor polynomial, one index for the ply",
        source: "Tsai and Wu, J. Compos. Mater. 5 (1971) 58",
        params: &[F12, F23],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let transverse = match params.word(&F23)? {
            "isotropic" => Transverse::Isotropic,
            _ => Transverse::Half,
        };
        Ok(Built::Criterion(Box::new(Self { f12: params.number(&F12)?, transverse })))
    }
}
