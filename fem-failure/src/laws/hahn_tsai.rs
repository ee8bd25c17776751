//! Shear in the plane of a ply that softens.

use super::shear;
use fem_core::energy::Energy;
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::ply_law::{LawError, LawInfo, LawPoint, PlyLaw, PlyResponse};
use fem_core::tensor::{Matrix6, Ply, Strain6, Stress6, apply};

/// Row of the shear 12.
const SHEAR: usize = 3;

/// How a ply unloads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unloading {
    /// With the slope G₁₂, so that a strain α τ³ is left; reversed, it yields at the largest |τ| so far (isotropic hardening).
    Permanent,
    /// Along the curve.
    Elastic,
}

/// Nonlinear shear in the plane of a ply, γ₁₂ = τ/G₁₂ + α τ³ (Hahn and Tsai, J. Compos. Mater. 7 (1973) 102-118), τ = σ₁₂.
///
/// The other components are those of linear elasticity. The curve is solved in closed form: with k = 2/√(3 α G₁₂)
///
/// τ = k sinh(⅓ arsinh(3 G₁₂ γ₁₂ / k)), ∂τ/∂γ₁₂ = G₁₂ / (1 + 3 α G₁₂ τ²).
///
/// Along the curve ½ τ²/G₁₂ + ¾ α τ⁴ is stored. With a permanent strain ¾ α τ⁴ of the largest |τ| is dissipated, and more
/// where the shear is reversed beyond it.
///
/// Limits: the theory is one of plane stress, so that shears 23 and 31 stay linear; it knows no end of the curve, so that
/// stresses beyond the shear strength must be judged by a criterion.
#[derive(Debug, Clone)]
pub struct HahnTsai {
    /// α, 1/Pa³.
    alpha: f64,
    unloading: Unloading,
}

impl HahnTsai {
    /// 1/Pa³
    pub const ALPHA: Dimension = Dimension([3.0, -3.0, 6.0, 0.0]);

    /// `alpha`: positive, 1/Pa³.
    pub fn new(alpha: f64, unloading: Unloading) -> Self {
        Self { alpha, unloading }
    }

    fn excess(&self, stress: f64) -> f64 {
        self.alpha * stress.powi(3)
    }
}

impl PlyLaw for HahnTsai {
    fn info(&self) -> &LawInfo {
        const ELASTIC: LawInfo = LawInfo { state: &[], strengths: &[], toughness: &[] };
        const PERMANENT: LawInfo =
            LawInfo { state: &["permanent shear strain", "its length"], strengths: &[], toughness: &[] };
        match self.unloading {
            Unloading::Elastic => &ELASTIC,
            Unloading::Permanent => &PERMANENT,
        }
    }

    fn respond(
        &self,
        point: &LawPoint<'_>,
        strain: &Strain6<Ply>,
        old: &[f64],
        new: &mut [f64],
        tangent: Option<&mut Matrix6>,
    ) -> Result<PlyResponse, LawError> {
        let g = point.stiffness[SHEAR][SHEAR];
        // What is left, and the length of the way there; along the curve a ply has always just come to where it is.
        let (left, way) = if let [left, way] = old { (*left, *way) } else { (0.0, 0.0) };
        let elastic = g * (strain.g12() - left);
        let yielding = elastic.abs() > (way / self.alpha).cbrt();
        let (size, on_curve) = if yielding {
            let size = shear::on_curve(self.alpha, g, elastic.abs() / g + way);
            (size, self.excess(size) - way)
        } else {
            (elastic.abs(), 0.0)
        };
        let shear = size.copysign(elastic);
        if let [new_left, new_way] = new {
            *new_left = left + on_curve.copysign(elastic);
            *new_way = way + on_curve;
        }
        if let Some(tangent) = tangent {
            *tangent = *point.stiffness;
            if yielding {
                tangent[SHEAR][SHEAR] = g / (1.0 + 3.0 * self.alpha * g * size * size);
            }
        }
        let mut stress = apply(point.stiffness, &strain.0);
        let linear = (0..6).filter(|k| *k != SHEAR).map(|k| stress[k] * strain.0[k]).sum::<f64>();
        stress[SHEAR] = shear;
        let beside = shear::lost(self.alpha, way + on_curve);
        let recoverable = 0.5 * (linear + shear * shear / g);
        let energy = match self.unloading {
            Unloading::Elastic => Energy { stored: recoverable + beside, dissipated: 0.0 },
            Unloading::Permanent => Energy { stored: recoverable, dissipated: beside },
        };
        Ok(PlyResponse { stress: Stress6::new(stress), energy })
    }
}

const ALPHA: ParamInfo =
    ParamInfo::quantity("alpha", "alpha of the curve, such as \"2.4e-8 1/MPa^3\"", HahnTsai::ALPHA).above(0.0);
const UNLOADING: ParamInfo = ParamInfo::word(
    "unloading",
    "way back",
    &[("permanent", "with G12, a strain alpha tau^3 is left"), ("elastic", "along the curve")],
);

impl Plugin for HahnTsai {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::PlyLaw,
        name: "hahn-tsai",
        summary: "nonlinear shear in the plane of the ply, gamma12 = tau/G12 + alpha tau^3",
        source: "Hahn and Tsai 1973",
        params: &[ALPHA, UNLOADING],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let alpha = params.number(&ALPHA)?;
        let unloading = match params.word(&UNLOADING)? {
            "elastic" => Unloading::Elastic,
            _ => Unloading::Permanent,
        };
        Ok(Built::PlyLaw(Box::new(Self::new(alpha, unloading))))
    }
}
