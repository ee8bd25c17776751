//! Criteria of an interface by its tractions σ33, σ23, σ31.

use crate::prelude::*;

const STRENGTHS: &[Strength] = &[Strength::Zt, Strength::S23, Strength::S13];

/// Quadratic interaction of the tractions of an interface.
///
/// ```text
/// (⟨σ33⟩/Zt)² + (σ31/S13)² + (σ23/S23)²
/// ```
///
/// Compression neither harms nor helps. The onset criterion of most cohesive laws.
#[derive(Debug, Clone, Copy, Default)]
pub struct QuadraticStress;

/// Largest of the tractions of an interface over their strengths, each a mode: ⟨σ33⟩/Zt, |σ31|/S13, |σ23|/S23.
#[derive(Debug, Clone, Copy, Default)]
pub struct MaxStressInterface;

/// Brewer and Lagace's quadratic delamination criterion.
///
/// ```text
/// (σ33/Zt)² or (σ33/Zc)² by sign, + (σ31/S13)² + (σ23/S23)²
/// ```
///
/// Meant for stresses averaged over a distance of about one ply thickness from the edge: pointwise stresses at a free edge
/// are singular and make it a function of the mesh.
#[derive(Debug, Clone, Copy, Default)]
pub struct BrewerLagace;

#[inline]
fn shear(s: &Stress6<Ply>, m: &Material) -> f64 {
    (s.s31() / m.strengths.s13()).powi(2) + (s.s23() / m.strengths.s23()).powi(2)
}

/// What [`shear`] does not exceed.
#[inline]
fn shear_bound(s: &StressRange, m: &Material) -> f64 {
    (s.s31().magnitude() / m.strengths.s13()).powi(2) + (s.s23().magnitude() / m.strengths.s23()).powi(2)
}

impl QuadraticStress {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 1] {
        let opening = macaulay(s.s33() / m.strengths.zt());
        [Terms::quadratic(opening * opening + shear(s, m))]
    }
}

impl MaxStressInterface {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 3] {
        let r = &m.strengths;
        [
            Terms::linear(macaulay(s.s33() / r.zt())),
            Terms::linear(s.s31().abs() / r.s13()),
            Terms::linear(s.s23().abs() / r.s23()),
        ]
    }
}

impl BrewerLagace {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 1] {
        let normal = s.s33() / if s.s33() >= 0.0 { m.strengths.zt() } else { m.strengths.zc() };
        [Terms::quadratic(normal * normal + shear(s, m))]
    }
}

impl FailureCriterion for QuadraticStress {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Interface,
            modes: &["delamination"],
            strengths: STRENGTHS,
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        out[0] = (s.s33().positive().high / m.strengths.zt()).powi(2) + shear_bound(s, m);
    }
}

impl FailureCriterion for MaxStressInterface {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Interface,
            modes: &["opening", "shear 31", "shear 23"],
            strengths: STRENGTHS,
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let r = &m.strengths;
        out.copy_from_slice(&[
            s.s33().positive().high / r.zt(),
            s.s31().magnitude() / r.s13(),
            s.s23().magnitude() / r.s23(),
        ]);
    }
}

impl FailureCriterion for BrewerLagace {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Interface,
            modes: &["delamination"],
            strengths: &[Strength::Zt, Strength::Zc, Strength::S23, Strength::S13],
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let normal = (s.s33().positive().high / m.strengths.zt()).max(-s.s33().negative().low / m.strengths.zc());
        out[0] = normal * normal + shear_bound(s, m);
    }
}

macro_rules! plugin {
    ($criterion:ident, $name:literal, $summary:literal, $source:literal) => {
        impl Plugin for $criterion {
            const INFO: PluginInfo =
                PluginInfo { kind: Kind::Criterion, name: $name, summary: $summary, source: $source, params: &[] };

            fn build(_: &Params) -> Result<Built, ParamError> {
                Ok(Built::Criterion(Box::new(Self)))
            }
        }
    };
}
plugin!(
    QuadraticStress,
    "quadratic-stress",
    "quadratic interaction of an interface's tractions, blind to compression",
    "common practice; QUADS of cohesive laws"
);
plugin!(
    MaxStressInterface,
    "max-stress-interface",
    "each traction of an interface against its strength",
    "common practice; MAXS of cohesive laws"
);
plugin!(
    BrewerLagace,
    "brewer-lagace",
    "quadratic interaction of an interface's averaged tractions",
    "Brewer and Lagace, J. Compos. Mater. 22 (1988) 1141"
);
