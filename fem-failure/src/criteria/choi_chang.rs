//! Choi and Chang's impact-induced matrix crack.

use crate::prelude::*;

/// The critical matrix crack of Choi and Chang's impact damage model, from stresses averaged over a ply.
///
/// ```text
/// (σ22/Y)² + (σ23/S23)²,  Y = Yt for σ22 ≥ 0, Yc for σ22 < 0
/// ```
///
/// Strengths are meant in situ. The model's delamination index combines stresses of the two plies beside an interface,
/// each in its own axes, and is checked only after a crack: it is not a function of one stress and not part of this.
#[derive(Debug, Clone, Copy, Default)]
pub struct ChoiChang;

impl ChoiChang {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 1] {
        let r = &m.strengths;
        let y = if s.s22() >= 0.0 { r.yt() } else { r.yc() };
        [Terms::quadratic((s.s22() / y).powi(2) + (s.s23() / r.s23()).powi(2))]
    }
}

impl FailureCriterion for ChoiChang {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["matrix cracking"],
            strengths: &[Strength::Yt, Strength::Yc, Strength::S23],
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let r = &m.strengths;
        let across = f64::max(s.s22().positive().high / r.yt(), -s.s22().negative().low / r.yc());
        out[0] = across.powi(2) + (s.s23().magnitude() / r.s23()).powi(2);
    }
}

impl Plugin for ChoiChang {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "choi-chang",
        summary: "matrix crack by transverse tension and interlaminar shear under impact",
        source: "Choi and Chang, J. Compos. Mater. 26 (1992) 2134",
        params: &[],
    };

    fn build(_: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fem_core::material::{Elastic, Strengths, Toughnesses};

    #[test]
    fn hand_values() {
        let strengths = Strengths::default().with(Strength::Yt, 4.0).with(Strength::Yc, 8.0).with(Strength::S23, 5.0);
        let m = Material {
            name: "m".into(),
            elastic: Elastic::isotropic(1.0, 0.0),
            density: None,
            strengths,
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
        };
        let index = |s22, s23| {
            let mut out = [f64::NAN];
            ChoiChang.indices(&Stress6::new([9.0, s22, 9.0, 9.0, s23, 9.0]), &m, &mut out);
            out[0]
        };
        assert_eq!(index(2.0, 0.0), 0.25);
        assert_eq!(index(-4.0, 0.0), 0.25);
        assert!((index(2.4, -4.0) - 1.0).abs() < 1e-15);
    }
}
