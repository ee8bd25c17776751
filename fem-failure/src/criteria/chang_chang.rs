//! Chang and Chang, plane stress.

use super::plane_stress::OutOfPlane;
use crate::prelude::*;
use crate::terms;
use fem_core::failure::{Reserve, search_reserve};
use fem_core::plugin::Dimension;

/// Chang and Chang (1987) for a ply in plane stress.
///
/// ```text
/// fibre tension       σ11 ≥ 0  (σ11/Xt)² + β T
/// fibre compression   σ11 < 0  (σ11/Xc)²
/// matrix tension      σ22 ≥ 0  (σ22/Yt)² + T
/// matrix compression  σ22 < 0  (σ22/2S12)² + [(Yc/2S12)² − 1] σ22/Yc + T
/// T = (σ12²/2G12 + ¾ α σ12⁴) / (S12²/2G12 + ¾ α S12⁴)
/// ```
///
/// T compares shear energies under γ12 = σ12/G12 + α σ12³; with α = 0 it is (σ12/S12)². β = 1 in the paper. A manual that
/// prints β σ12/S12 instead makes the index depend on the sign of the shear.
#[derive(Debug, Clone, Copy)]
pub struct ChangChang {
    /// Share of the shear in fibre tension.
    pub beta: f64,
    /// Cubic coefficient of the shear strain, Pa⁻³; 0 is linear shear.
    pub alpha: f64,
    /// Treatment of the other three stresses.
    pub out_of_plane: OutOfPlane,
}

impl Default for ChangChang {
    fn default() -> Self {
        Self { beta: BETA.default_number(), alpha: ALPHA.default_number(), out_of_plane: OutOfPlane::default() }
    }
}

impl ChangChang {
    /// T.
    #[inline]
    fn shear(&self, tau: f64, m: &Material) -> f64 {
        let softening = |tau: f64| 1.0 + 1.5 * self.alpha * m.elastic.g12 * tau * tau;
        let s12 = m.strengths.s12();
        (tau / s12).powi(2) * (softening(tau) / softening(s12))
    }

    /// Exact for linear shear only; the quartic part of T counts as quadratic here.
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 4] {
        if !self.out_of_plane.admits(s) {
            return [Terms::REFUSED; 4];
        }
        let r = &m.strengths;
        let shear = self.shear(s.s12(), m);
        let (fibre, matrix) = (s.s11() >= 0.0, s.s22() >= 0.0);
        let twice = 2.0 * r.s12();
        let closing = Terms {
            linear: ((r.yc() / twice).powi(2) - 1.0) * s.s22() / r.yc(),
            quadratic: (s.s22() / twice).powi(2) + shear,
        };
        [
            Terms::quadratic((s.s11() / r.xt()).powi(2) + self.beta * shear).when(fibre),
            Terms::quadratic((s.s11() / r.xc()).powi(2)).when(!fibre),
            Terms::quadratic((s.s22() / r.yt()).powi(2) + shear).when(matrix),
            closing.when(!matrix),
        ]
    }
}

impl FailureCriterion for ChangChang {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["fibre tension", "fibre compression", "matrix tension", "matrix compression"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12],
            invariant_about_fibre: false,
        };
        &INFO
    }

    #[inline]
    fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
        terms::indices(self.terms(s, m), out);
    }

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        if !self.out_of_plane.admits_all(s) {
            return out.fill(f64::INFINITY);
        }
        let r = &m.strengths;
        let square = |v: f64| v * v;
        let (s11, s22, shear, twice) = (s.s11(), s.s22(), self.shear(s.s12().magnitude(), m), 2.0 * r.s12());
        let closing = (s22.negative() * (((r.yc() / twice).powi(2) - 1.0) / r.yc())).high.max(0.0);
        out.copy_from_slice(&[
            when(s11.reaches_positive(), square(s11.positive().high / r.xt()) + self.beta * shear),
            when(s11.reaches_negative(), square(s11.negative().low / r.xc())),
            when(s22.reaches_positive(), square(s22.positive().high / r.yt()) + shear),
            when(s22.reaches_negative(), closing + square(s22.negative().low / twice) + shear),
        ]);
    }

    fn reserve_factor(&self, s: &Stress6<Ply>, m: &Material) -> Reserve {
        if self.alpha == 0.0 {
            terms::reserve(s, |s| self.terms(s, m))
        } else {
            search_reserve(|s, out| self.indices(s, m, out), 4, s, m)
        }
    }

    fn scope(&self) -> &'static str {
        self.out_of_plane.scope()
    }
}

const BETA: ParamInfo = ParamInfo::number("beta", "share of the shear in fibre tension; published is 1")
    .at_least(0.0)
    .at_most(1.0)
    .default(1.0);
const PER_PRESSURE_CUBED: Dimension = Dimension([3.0, -3.0, 6.0, 0.0]);
const ALPHA: ParamInfo =
    ParamInfo::quantity("alpha", "in g12 = s12/G12 + alpha s12^3; 0 is linear shear", PER_PRESSURE_CUBED)
        .at_least(0.0)
        .default(0.0);

impl Plugin for ChangChang {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "chang-chang",
        summary: "fibre and matrix in plane stress, with nonlinear shear on request",
        source: "Chang and Chang, J. Compos. Mater. 21 (1987) 834",
        params: &[BETA, ALPHA, OutOfPlane::PARAM],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let (beta, alpha) = (params.number(&BETA)?, params.number(&ALPHA)?);
        Ok(Built::Criterion(Box::new(Self { beta, alpha, out_of_plane: OutOfPlane::from_params(params)? })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fem_core::material::{Elastic, Strengths, Toughnesses};

    #[test]
    fn nonlinear_shear_weighs_energies() {
        let m = Material {
            name: "m".into(),
            elastic: Elastic::isotropic(2.0, 0.0),
            density: None,
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
            strengths: Strength::ALL.iter().fold(Strengths::default(), |s, which| s.with(*which, 2.0)),
        };
        // G = 1, S = 2, α = 1/3: T(1) = (1/2 + 1/4)/(2 + 4) = 1/8.
        let c = ChangChang { alpha: 1.0 / 3.0, ..ChangChang::default() };
        let mut out = [0.0; 4];
        let s = Stress6::new([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
        c.indices(&s, &m, &mut out);
        assert!((out[2] - 0.125).abs() < 1e-15, "{out:?}");
        let reserve = c.reserve_factor(&s, &m);
        assert!((reserve.factor - 2.0).abs() < 1e-14, "{reserve:?}");
        assert!(ChangChang::default().reserve_factor(&s, &m).factor == 2.0);
    }
}
