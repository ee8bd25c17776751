//! Octahedral shear in the resin between two plies.

use crate::prelude::*;

/// AFWAL-TR-87-4117, eq. (42), made dimensionally consistent.
///
/// ```text
/// J2/τ²,  J2 = [(σ11 − σ22)² + (σ22 − σ33)² + (σ33 − σ11)²]/6 + σ12² + σ23² + σ31²,  τ = S12 of the resin
/// ```
///
/// The report prints J2/τ. With J2/τ² a pure shear fails at τ. The octahedral shear stress is √(2/3 J2), so that to
/// compare it with τ itself would be unsafe by 22 %. Equal tension on all sides never fails: an interface that opens
/// with little shear needs a criterion with a normal strength beside this one.
#[derive(Debug, Clone, Copy, Default)]
pub struct Octahedral;

impl Octahedral {
    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 1] {
        let (a, b, c) = (s.s11() - s.s22(), s.s22() - s.s33(), s.s33() - s.s11());
        let shear = s.s12() * s.s12() + s.s23() * s.s23() + s.s31() * s.s31();
        let tau = m.strengths.s12();
        [Terms::quadratic(((a * a + b * b + c * c) / 6.0 + shear) / (tau * tau))]
    }
}

impl FailureCriterion for Octahedral {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Interface,
            modes: &["interface shear"],
            strengths: &[Strength::S12],
            invariant_about_fibre: true,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let (a, b, c) = (s.s11() - s.s22(), s.s22() - s.s33(), s.s33() - s.s11());
        let shear = s.s12().squared() + s.s23().squared() + s.s31().squared();
        let tau = m.strengths.s12();
        out[0] = ((a.squared() + b.squared() + c.squared()).high / 6.0 + shear.high) / (tau * tau);
    }
}

impl Plugin for Octahedral {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "octahedral",
        summary: "second deviatoric invariant of the resin's stress between two plies against its shear strength",
        source: "AFWAL-TR-87-4117, eq. (42) with the square that its dimensions require",
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
        let resin = Material {
            name: "3502 resin".into(),
            elastic: Elastic::isotropic(3.79e9, 0.36),
            density: None,
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
            strengths: Strengths::default().with(Strength::S12, 62e6),
        };
        let index = |s: [f64; 6]| {
            let mut out = [f64::NAN];
            Octahedral.indices(&Stress6::new(s), &resin, &mut out);
            out[0]
        };
        assert!((index([0.0, 0.0, 0.0, 62e6, 0.0, 0.0]) - 1.0).abs() < 1e-15);
        assert!((index([0.0, 0.0, 0.0, 0.0, -31e6, 0.0]) - 0.25).abs() < 1e-15);
        // Uniaxial tension: J2 = σ²/3, so that it fails at √3 τ.
        assert!((index([62e6 * 3.0_f64.sqrt(), 0.0, 0.0, 0.0, 0.0, 0.0]) - 1.0).abs() < 1e-15);
        assert_eq!(index([1e9, 1e9, 1e9, 0.0, 0.0, 0.0]), 0.0);
    }
}
