//! Maximum strain.

use super::max_stress::{LIMIT_MODES, bounds, limits};
use crate::prelude::*;

/// Every component of ε = S σ over an allowable strain.
///
/// The allowables are parameters, one set for all plies, and never derived from strengths: X/E1, Y/E2 are not what a
/// coupon strains at, and with them the Poisson strain of a fibre compression exceeds the transverse allowable long before
/// Xc. The thickness has the transverse allowables and 31 that of 12. Not invariant about the fibre.
#[derive(Debug, Clone, Copy)]
pub struct MaxStrain {
    /// Along the fibres, tension.
    pub e1t: f64,
    /// Along the fibres, compression (positive).
    pub e1c: f64,
    /// Across the fibres, tension.
    pub e2t: f64,
    /// Across the fibres, compression (positive).
    pub e2c: f64,
    /// Engineering shear 12 and 31.
    pub g12: f64,
    /// Engineering shear 23.
    pub g23: f64,
}

impl MaxStrain {
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 9] {
        let e = &m.elastic;
        let (n1, n2, n3) = (s.s11() / e.e1, s.s22() / e.e2, s.s33() / e.e3);
        let strain = [
            n1 - (e.nu12 * s.s22() + e.nu13 * s.s33()) / e.e1,
            n2 - e.nu12 * s.s11() / e.e1 - e.nu23 * s.s33() / e.e2,
            n3 - e.nu13 * s.s11() / e.e1 - e.nu23 * s.s22() / e.e2,
            s.s12() / e.g12,
            s.s23() / e.g23,
            s.s31() / e.g13,
        ];
        limits(&strain, [self.e1t, self.e2t, self.e2t], [self.e1c, self.e2c, self.e2c], [self.g12, self.g23, self.g12])
    }
}

impl FailureCriterion for MaxStrain {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo =
            CriterionInfo { site: Site::Ply, modes: LIMIT_MODES, strengths: &[], invariant_about_fibre: false };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let (e, [s11, s22, s33]) = (&m.elastic, [s.s11(), s.s22(), s.s33()]);
        let strain = |parts: [Interval; 3]| Interval {
            low: -most_of_sum(parts.map(|part| part * -1.0)),
            high: most_of_sum(parts),
        };
        let normal = [
            strain([s11 * (1.0 / e.e1), s22 * (-e.nu12 / e.e1), s33 * (-e.nu13 / e.e1)]),
            strain([s22 * (1.0 / e.e2), s11 * (-e.nu12 / e.e1), s33 * (-e.nu23 / e.e2)]),
            strain([s33 * (1.0 / e.e3), s11 * (-e.nu13 / e.e1), s22 * (-e.nu23 / e.e2)]),
        ];
        let sheared = [s.s12() * (1.0 / e.g12), s.s23() * (1.0 / e.g23), s.s31() * (1.0 / e.g13)];
        out.copy_from_slice(&bounds(
            normal,
            sheared,
            [self.e1t, self.e2t, self.e2t],
            [self.e1c, self.e2c, self.e2c],
            [self.g12, self.g23, self.g12],
        ));
    }
}

const fn allowable(name: &'static str, about: &'static str) -> ParamInfo {
    ParamInfo::number(name, about).above(0.0)
}

const ALLOWABLES: [ParamInfo; 6] = [
    allowable("e1t", "allowable tensile strain along the fibres"),
    allowable("e1c", "allowable compressive strain along the fibres"),
    allowable("e2t", "allowable tensile strain across the fibres"),
    allowable("e2c", "allowable compressive strain across the fibres"),
    allowable("g12", "allowable engineering shear strain 12 and 31"),
    allowable("g23", "allowable engineering shear strain 23"),
];

impl Plugin for MaxStrain {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "max-strain",
        summary: "each strain component against its allowable, no interaction",
        source: "common practice",
        params: &ALLOWABLES,
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let [e1t, e1c, e2t, e2c, g12, g23] = ALLOWABLES.each_ref().map(|row| params.number(row));
        Ok(Built::Criterion(Box::new(Self { e1t: e1t?, e1c: e1c?, e2t: e2t?, e2c: e2c?, g12: g12?, g23: g23? })))
    }
}
