//! Yamada and Sun's criterion: a plug-in in one file.
use fem_core::failure::{CriterionInfo, FailureCriterion, Site};
use fem_core::material::{Material, Strength};
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::tensor::{Ply, Stress6};

/// Fibre failure: (σ11/X)² + (σ12² + σ31²)/Sc², where X is Xt or Xc by the sign of σ11.
#[derive(Debug, Clone)]
pub struct YamadaSun {
    /// Sc: shear strength of a ply within its laminate, Pa.
    pub shear: f64,
}

impl FailureCriterion for YamadaSun {
    fn info(&self) -> &CriterionInfo {
        &CriterionInfo {
            site: Site::Ply,
            modes: &["fibre failure"],
            strengths: &[Strength::Xt, Strength::Xc],
            invariant_about_fibre: true,
        }
    }

    fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
        let along = if s.s11() < 0.0 { m.strengths.xc() } else { m.strengths.xt() };
        out[0] = (s.s11() / along).powi(2) + (s.s12().powi(2) + s.s31().powi(2)) / self.shear.powi(2);
    }
}

const SHEAR: ParamInfo =
    ParamInfo::quantity("shear", "shear strength of a ply within its laminate", Dimension::PRESSURE).above(0.0);

impl Plugin for YamadaSun {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "yamada-sun",
        summary: "failure of the last ply: its fibres under stress and shear",
        source: "Yamada and Sun, J. Compos. Mater. 12 (1978) 275",
        params: &[SHEAR],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self { shear: params.number(&SHEAR)? })))
    }
}
